//! The speed of a leg and of a stop.

use crate::autopilot::params::Params;
use crate::plan::LegSpeed;

/// Returns the speed of a leg, m/s: the waypoint's own speed between 1 m/s and `ap_max_velocity`, or
/// `ap_max_velocity` if it has none.
pub fn leg_speed_mps(speed: LegSpeed, params: &Params) -> f64 {
    let most_mps = params.max_velocity_mps();
    speed.own_mps().map_or(most_mps, |mps| mps.max(1.0).min(most_mps))
}

/// Returns the speed (m/s) at `distance_m` from a point to stop at. Near the point it is proportional to the distance
/// (0.025·`ap_position_p` per second), farther out it is on the parabola of 0.35·g·sin(maximum tilt). It is never
/// above the speed of the leg.
pub fn stop_speed_mps(distance_m: f64, leg_speed_mps: f64, params: &Params) -> f64 {
    let gain = 0.025 * f64::from(params.position_p);
    let decel = 0.35 * params.max_accel_mps2();
    leg_speed_mps.min(gain * distance_m).min((2.0 * decel * distance_m).sqrt())
}
