//! What the checks look at: where the craft truly is.

use nalgebra::Vector2;

use crate::signals::SimTime;

/// The true motion of the craft at one instant, and who flies it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::flight) struct CraftTruth {
    pub(in crate::flight) time: SimTime,
    /// North and east of the boot place, m.
    pub(in crate::flight) ne: Vector2<f64>,
    /// Above the place where the craft was armed, m.
    pub(in crate::flight) alt_m: f64,
    /// Ground speed, m/s.
    pub(in crate::flight) speed_mps: f64,
    /// The pilot's sticks fly, not the autopilot.
    pub(in crate::flight) stick_override: bool,
    /// The climb before the first leg is on.
    pub(in crate::flight) climbing: bool,
}
