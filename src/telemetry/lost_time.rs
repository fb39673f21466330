//! Real time that a flight could not keep up with.

use std::time::Duration;

/// How far a flight that should run with the wall clock has fallen behind it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LostTime {
    /// Wall time lost since the start.
    pub sum: Duration,
    /// Achieved times real time, lately.
    pub achieved: f64,
}

impl LostTime {
    /// Less than this is no matter: a machine is busy now and then.
    const NOTABLE: Duration = Duration::from_millis(500);

    /// Whether it is worth to be told.
    pub fn is_notable(&self) -> bool {
        self.sum >= Self::NOTABLE
    }
}

impl std::fmt::Display for LostTime {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.1} s, at {:.2} times real time", self.sum.as_secs_f64(), self.achieved)
    }
}
