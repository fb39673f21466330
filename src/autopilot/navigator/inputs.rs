//! Keeps the inputs finite, whatever the estimator delivers.

use nalgebra::Vector2;

use crate::autopilot::io::NavInputs;

/// Replaces numbers that are not finite by their last value.
#[derive(Debug, Clone, Default)]
pub(super) struct InputFilter {
    last: Option<NavInputs>,
}

impl InputFilter {
    /// Returns the inputs with every number finite. A number that is not finite keeps its last value, and a broken
    /// position clears the fix.
    pub(super) fn apply(&mut self, inputs: &NavInputs) -> NavInputs {
        let mut now = inputs.clone();
        now.dt = if now.dt.is_finite() { now.dt.clamp(0.0, 0.1) } else { 0.01 };
        let position_ok = now.pos_ne.iter().chain(now.vel_ne.iter()).all(|value| value.is_finite());
        now.fix &= position_ok;
        let last = self.last.as_ref();
        if !position_ok {
            now.pos_ne = last.map_or_else(Vector2::zeros, |last| last.pos_ne);
            now.vel_ne = Vector2::zeros();
        }
        let keep = |value: &mut f64, old: fn(&NavInputs) -> f64, otherwise: f64| {
            if !value.is_finite() {
                *value = last.map_or(otherwise, old);
            }
        };
        keep(&mut now.alt_m, |last| last.alt_m, 0.0);
        keep(&mut now.climb_mps, |_| 0.0, 0.0);
        keep(&mut now.heading_rad, |last| last.heading_rad, 0.0);
        keep(&mut now.yaw_rate_rps, |_| 0.0, 0.0);
        keep(&mut now.roll_rad, |_| 0.0, 0.0);
        keep(&mut now.pitch_down_rad, |_| 0.0, 0.0);
        keep(&mut now.cos_tilt, |_| 1.0, 1.0);
        keep(&mut now.throttle_us, |last| last.throttle_us, 1000.0);
        keep(&mut now.stick_roll, |_| 0.0, 0.0);
        keep(&mut now.stick_pitch, |_| 0.0, 0.0);
        keep(&mut now.stick_yaw, |_| 0.0, 0.0);
        now.accel_ne = now.accel_ne.map(|value| if value.is_finite() { value } else { 0.0 });
        self.last = Some(now.clone());
        now
    }
}
