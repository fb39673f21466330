//! How fast to fly.

use crate::autopilot::params::Params;

/// Speed of a leg, m/s: the waypoint's own speed (cm/s) within 1 m/s and `ap_max_velocity`, which also stands for 0.
pub fn leg_speed_mps(waypoint_speed_cms: u16, params: &Params) -> f64 {
    match waypoint_speed_cms {
        0 => params.max_velocity_mps(),
        speed => (f64::from(speed) / 100.0).max(1.0).min(params.max_velocity_mps()),
    }
}

/// Speed (m/s) at `distance_m` from a point to stop at: proportional near it (0.025·`ap_position_p` per second), on
/// the parabola of 0.35·g·sin(greatest lean) farther out, never above the leg's speed.
pub fn stop_speed_mps(distance_m: f64, leg_speed_mps: f64, params: &Params) -> f64 {
    let gain = 0.025 * f64::from(params.position_p);
    let decel = 0.35 * params.max_accel_mps2();
    leg_speed_mps.min(gain * distance_m).min((2.0 * decel * distance_m).sqrt())
}
