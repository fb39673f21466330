//! The settings of a rescue.

/// The settings of a rescue, beyond a plain return. A rescue first climbs to its altitude on the spot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rescue {
    /// Altitude of the return, m above home, if it is higher than the craft.
    pub altitude_m: f64,
    /// The climb before the way home if home is nearer than the least distance of a rescue, m.
    pub near_climb_m: Option<f64>,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Ground speed, m/s.
    pub speed_mps: f64,
    /// Sink rate down to the last 4 m, m/s.
    pub descend_mps: f64,
    /// `true` if the rescue is given up when it makes no progress or flies away from home.
    pub is_watched: bool,
}
