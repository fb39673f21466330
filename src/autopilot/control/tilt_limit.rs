//! Altitude before tilt: limits the tilt so that the craft keeps its altitude.

use super::altitude::AltitudeController;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::math;

const DEG: f64 = std::f64::consts::PI / 180.0;
/// The rates at which the limit falls while the craft sinks at full throttle, and rises while there is throttle to
/// spare, rad/s.
const FALL_RPS: f64 = 10.0 * DEG;
const RISE_RPS: f64 = 5.0 * DEG;
/// The limit never falls below this, rad.
const MIN_RAD: f64 = 5.0 * DEG;
/// The reserve of thrust over weight that a tilt must leave.
const RESERVE: f64 = 1.05;
/// The smallest reduction worth reporting, rad.
const TOLD_RAD: f64 = 1.0 * DEG;

/// The tilt that the thrust allows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct TiltLimiter {
    /// Limit found in flight, rad, or `None` while the maximum tilt of the parameters can be flown.
    found_rad: Option<f64>,
    is_reduced: bool,
}

impl TiltLimiter {
    /// Returns the limit after a cycle in which the altitude controller computed its throttle, rad.
    ///
    /// Thrust grows with the square of the throttle above its zero, so a tilt needs `cos tilt ≥ ((hover −
    /// zero)/(maximum − zero))²`. Drag and moving air may need more. The craft then sinks at full throttle.
    pub(super) fn update(&mut self, now: &NavInputs, altitude: &AltitudeController, params: &Params) -> f64 {
        let max_rad = params.max_tilt_rad();
        let zero_us = params.throttle_zero_us();
        let available_us = (f64::from(params.throttle_max) - zero_us).max(1.0);
        let needed = RESERVE * math::powi((altitude.hover_us() - zero_us) / available_us, 2);
        let by_thrust_rad = math::acos(needed.clamp(0.0, 1.0));
        let found_rad = self.found_rad.unwrap_or(f64::INFINITY);
        self.found_rad = if altitude.sinks_at_full_throttle(now) {
            let tilt_rad = math::acos(now.cos_tilt.clamp(0.0, 1.0));
            Some(found_rad.min(tilt_rad.max(MIN_RAD)).min(max_rad) - FALL_RPS * now.dt)
        } else if altitude.has_throttle_to_spare() {
            Some(found_rad + RISE_RPS * now.dt)
        } else {
            Some(found_rad)
        }
        .filter(|found| *found < max_rad)
        .map(|found| found.max(MIN_RAD));
        let limit_rad = self.found_rad.unwrap_or(max_rad).min(by_thrust_rad.max(MIN_RAD)).min(max_rad);
        self.is_reduced = limit_rad < max_rad - TOLD_RAD;
        limit_rad
    }

    /// Returns `true` if the limit is lower than that of the parameters by an amount worth reporting.
    pub(super) fn is_reduced(&self) -> bool {
        self.is_reduced
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::control::AltitudeTarget;

    /// Flies for `seconds` towards an altitude. Returns the tilt limit at the end, degrees.
    fn limit_deg(
        limiter: &mut TiltLimiter,
        altitude: &mut AltitudeController,
        now: &NavInputs,
        target_m: f64,
        seconds: f64,
    ) -> f64 {
        let params = Params::default();
        let mut limit_rad = 0.0;
        for _ in 0..(seconds / now.dt).round() as usize {
            altitude.update(&now.into(), AltitudeTarget::Altitude(target_m), &params, now.dt);
            limit_rad = limiter.update(now, altitude, &params);
        }
        limit_rad.to_degrees()
    }

    #[test]
    fn a_craft_that_sinks_at_full_throttle_leans_less_until_it_has_throttle_to_spare() {
        let params = Params::default();
        let whole_deg = f64::from(params.max_angle);
        let hovering = NavInputs::hovering();
        let mut altitude = AltitudeController::default();
        altitude.engage(&(&hovering).into(), &params);
        let mut limiter = TiltLimiter::default();
        assert_eq!(limit_deg(&mut limiter, &mut altitude, &hovering, 20.0, 5.0), whole_deg);

        // Full throttle that makes the craft climb is enough.
        let cos_tilt = 30_f64.to_radians().cos();
        let climbing = NavInputs { throttle_us: 1900.0, climb_mps: 0.5, cos_tilt, ..hovering.clone() };
        assert_eq!(limit_deg(&mut limiter, &mut altitude, &climbing, 100.0, 15.0), whole_deg);
        assert!(altitude.is_at_full_throttle());

        let sinking = NavInputs { climb_mps: -0.5, ..climbing };
        let after_2_s = limit_deg(&mut limiter, &mut altitude, &sinking, 100.0, 2.0);
        assert!((5.0..20.0).contains(&after_2_s), "{after_2_s}° of a tilt of 30°");
        assert!(limiter.is_reduced());
        let after_12_s = limit_deg(&mut limiter, &mut altitude, &sinking, 100.0, 10.0);
        assert!(after_12_s > 4.9, "{after_12_s}° must be left to steer with");

        assert_eq!(limit_deg(&mut limiter, &mut altitude, &hovering, 20.0, 30.0), whole_deg);
        assert!(!limiter.is_reduced());
    }
}
