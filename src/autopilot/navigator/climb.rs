//! The climb on the spot before the first leg.

use nalgebra::Vector2;

/// The climb; at most one in an engagement.
#[derive(Debug, Clone, Default)]
pub(super) struct Climb {
    done: bool,
    /// Where it holds while it climbs (north, east, m).
    at: Option<Vector2<f64>>,
}

impl Climb {
    /// Whether it may still begin.
    pub(super) fn is_pending(&self) -> bool {
        !self.done && self.at.is_none()
    }

    /// Whether the craft climbs.
    pub(super) fn is_on(&self) -> bool {
        self.at.is_some()
    }

    /// The place it is held at while it climbs.
    pub(super) fn place(&self) -> Option<Vector2<f64>> {
        self.at
    }

    pub(super) fn begin(&mut self, at: Vector2<f64>) {
        self.at = Some(at);
    }

    /// Not needed, or high enough: never again in this engagement. Returns whether it was on.
    pub(super) fn finish(&mut self) -> bool {
        self.done = true;
        self.break_off()
    }

    /// Something else is flown. Returns whether it was on.
    pub(super) fn break_off(&mut self) -> bool {
        self.at.take().is_some()
    }
}
