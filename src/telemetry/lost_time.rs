//! The real time that a flight has lost.

use std::time::Duration;

/// The lag of a flight that should follow the wall clock.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LostTime {
    /// The wall time lost since the start.
    pub sum: Duration,
    /// The multiple of real time achieved lately.
    pub achieved: f64,
}

impl LostTime {
    /// The least loss that is reported. Less does not matter: a machine is busy now and then.
    const NOTABLE: Duration = Duration::from_millis(500);

    /// Returns `true` if the loss is large enough for a report.
    pub fn is_notable(&self) -> bool {
        self.sum >= Self::NOTABLE
    }
}

impl std::fmt::Display for LostTime {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.1} s, at {:.2} times real time", self.sum.as_secs_f64(), self.achieved)
    }
}
