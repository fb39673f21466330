//! The altitude setpoint and the spiral of a landing.

use nalgebra::Vector2;

use crate::autopilot::params::Params;
use crate::math;

/// Returns the altitude setpoint of a landing, m: from `start_m` down at `rate_mps` for `elapsed_s`, and on below
/// zero until the touchdown. Above the landing altitude it is never more than 5 m below the craft, so that it cannot
/// wind up.
pub fn landing_setpoint_m(
    start_m: f64,
    rate_mps: f64,
    elapsed_s: f64,
    altitude_m: f64,
    landing_altitude_m: f64,
) -> f64 {
    let setpoint = start_m - rate_mps * elapsed_s;
    if altitude_m > landing_altitude_m { setpoint.max(altitude_m - 5.0) } else { setpoint }
}

/// The shape of the landing spiral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spiral {
    /// Radius above the landing altitude, m.
    pub radius_m: f64,
    /// Angular rate, rad/s.
    pub rate_rps: f64,
    /// Landing altitude, m. The spiral closes between it and half of it.
    pub landing_altitude_m: f64,
}

impl Spiral {
    /// Returns the spiral given by the parameters, if it is enabled.
    pub fn from_params(params: &Params) -> Option<Self> {
        params.landing_spiral_enable.then(|| Self {
            radius_m: f64::from(params.landing_spiral_radius) / 100.0,
            rate_rps: f64::from(params.landing_spiral_rate).to_radians(),
            landing_altitude_m: f64::from(params.landing_altitude_m),
        })
    }
}

/// Returns the offset of the horizontal target from the centre of the landing (north, east), m. With a landing
/// altitude of zero the spiral closes below 1 m.
pub fn spiral_offset(spiral: &Spiral, elapsed_s: f64, altitude_m: f64) -> Vector2<f64> {
    let half = spiral.landing_altitude_m / 2.0;
    let open =
        if half > 0.0 { ((altitude_m - half) / half).clamp(0.0, 1.0) } else { f64::from(altitude_m >= 1.0) };
    let (sin, cos) = math::sin_cos(spiral.rate_rps * elapsed_s);
    Vector2::new(cos, sin) * (spiral.radius_m * open)
}
