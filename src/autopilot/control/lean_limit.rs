//! Altitude before lean: limits the lean so that the craft keeps its altitude.

use super::altitude::AltitudeController;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;

const DEG: f64 = std::f64::consts::PI / 180.0;
/// The rates at which the limit falls while the craft sinks at full throttle, and rises while there is throttle to
/// spare, rad/s.
const FALL_RPS: f64 = 10.0 * DEG;
const RISE_RPS: f64 = 5.0 * DEG;
/// The limit never falls below this, rad.
const LEAST_RAD: f64 = 5.0 * DEG;
/// The reserve of thrust over weight that a lean must leave.
const RESERVE: f64 = 1.05;
/// The smallest reduction worth reporting, rad.
const TOLD_RAD: f64 = 1.0 * DEG;

/// The lean that the thrust allows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct LeanLimiter {
    /// Limit found in flight, rad, or `None` while the maximum lean of the parameters can be flown.
    found_rad: Option<f64>,
    is_reduced: bool,
}

impl LeanLimiter {
    /// Returns the limit after a cycle in which the altitude controller computed its throttle, rad.
    ///
    /// Thrust grows with the square of the throttle above its zero, so a tilt needs `cos tilt ≥ ((hover −
    /// zero)/(maximum − zero))²`. Drag and moving air may need more. The craft then sinks at full throttle.
    pub(super) fn update(&mut self, now: &NavInputs, altitude: &AltitudeController, params: &Params) -> f64 {
        let max_rad = params.max_lean_rad();
        let zero_us = params.throttle_zero_us();
        let available_us = (f64::from(params.throttle_max) - zero_us).max(1.0);
        let needed = RESERVE * ((altitude.hover_us() - zero_us) / available_us).powi(2);
        let by_thrust_rad = needed.clamp(0.0, 1.0).acos();
        let found_rad = self.found_rad.unwrap_or(f64::INFINITY);
        self.found_rad = if altitude.sinks_at_full_throttle(now) {
            let tilt_rad = now.cos_tilt.clamp(0.0, 1.0).acos();
            Some(found_rad.min(tilt_rad.max(LEAST_RAD)).min(max_rad) - FALL_RPS * now.dt)
        } else if altitude.has_throttle_to_spare() {
            Some(found_rad + RISE_RPS * now.dt)
        } else {
            Some(found_rad)
        }
        .filter(|found| *found < max_rad)
        .map(|found| found.max(LEAST_RAD));
        let limit_rad = self.found_rad.unwrap_or(max_rad).min(by_thrust_rad.max(LEAST_RAD)).min(max_rad);
        self.is_reduced = limit_rad < max_rad - TOLD_RAD;
        limit_rad
    }

    /// Returns `true` if the limit is lower than that of the parameters by an amount worth reporting.
    pub(super) fn is_reduced(&self) -> bool {
        self.is_reduced
    }
}
