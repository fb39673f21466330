//! The climb on the spot before the first leg.

use nalgebra::Vector2;

/// The climb. There is at most one per engagement.
#[derive(Debug, Clone, Default)]
pub(super) struct Climb {
    done: bool,
    /// Place where the craft holds while it climbs (north, east, m).
    pub at: Option<Vector2<f64>>,
}

impl Climb {
    /// Returns `true` if the climb may still begin.
    pub(super) fn is_pending(&self) -> bool {
        !self.done && self.at.is_none()
    }

    /// Returns `true` while the craft climbs.
    pub(super) fn is_on(&self) -> bool {
        self.at.is_some()
    }

    pub(super) fn begin(&mut self, at: Vector2<f64>) {
        self.at = Some(at);
    }

    /// Ends the climb for the rest of the engagement, since it is not needed or the craft is high enough. Returns
    /// `true` if it was active.
    pub(super) fn finish(&mut self) -> bool {
        self.done = true;
        self.break_off()
    }

    /// Ends the climb because something else is flown. Returns `true` if it was active.
    pub(super) fn break_off(&mut self) -> bool {
        self.at.take().is_some()
    }
}
