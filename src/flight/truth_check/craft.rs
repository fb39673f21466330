//! The true motion of the craft, for the checks.

use nalgebra::Vector2;

use crate::signals::SimTime;

/// The true motion of the craft at one instant, and the source of its control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::flight) struct CraftTruth {
    pub(in crate::flight) time: SimTime,
    /// North and east of the boot place, m.
    pub(in crate::flight) ne: Vector2<f64>,
    /// Above the place where the craft was armed, m.
    pub(in crate::flight) alt_m: f64,
    /// Ground speed, m/s.
    pub(in crate::flight) speed_mps: f64,
    /// `true` while the pilot's sticks fly instead of the autopilot.
    pub(in crate::flight) stick_override: bool,
    /// `true` during the climb before the first leg.
    pub(in crate::flight) climbing: bool,
}
