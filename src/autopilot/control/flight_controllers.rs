//! The controllers of a flight, lent to the code that flies the craft.

use super::altitude::{AltitudeController, AltitudeMeasurement};
use super::position::{PositionController, PositionMeasurement};
use super::tilt_limit::TiltLimiter;
use crate::autopilot::io::NavInputs;
use crate::autopilot::land_detector::LandDetector;
use crate::autopilot::params::Params;

/// The altitude controller, the position controller, the tilt limiter and the land detector of a craft. There is one
/// of each.
///
/// They are lent to the navigator or to the hold modes. The borrower engages a controller when it takes over, so that
/// the demand does not step, and updates it in every cycle. A controller that is not in use tracks the flight, so
/// that wind and hover throttle are known at the next takeover.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlightControllers {
    pub altitude: AltitudeController,
    pub position: PositionController,
    pub land: LandDetector,
    tilt: TiltLimiter,
}

impl FlightControllers {
    /// Takes over both controllers. Setpoints start at the craft and demands where they were.
    pub fn engage(&mut self, now: &NavInputs, params: &Params) {
        self.altitude.engage(&AltitudeMeasurement::from(now), params);
        self.position.engage(&PositionMeasurement::from(now));
    }

    /// Limits the tilt to what the thrust allows. Call it after the altitude controller was updated.
    pub fn limit_tilt(&mut self, now: &NavInputs, params: &Params) {
        let limit_rad = self.tilt.update(now, &self.altitude, params);
        self.position.limit_tilt(Some(limit_rad));
    }

    /// Returns `true` if the thrust is too low for the commanded tilt.
    pub fn thrust_limits_tilt(&self) -> bool {
        self.tilt.is_reduced() && self.position.is_saturated()
    }

    /// Tracks a cycle whose throttle does not come from this altitude controller. The pilot balances tilt against
    /// altitude.
    pub fn track_altitude(&mut self, now: &NavInputs, params: &Params) {
        self.tilt = TiltLimiter::default();
        self.position.limit_tilt(None);
        self.altitude.track(&AltitudeMeasurement::from(now), params, now.dt);
    }

    /// Tracks a cycle whose tilt does not come from this position controller. Does nothing without a fix.
    pub fn track_position(&mut self, now: &NavInputs) {
        if now.fix {
            self.position.track(&PositionMeasurement::from(now), now.dt);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::control::{AltitudeTarget, PositionTarget};
    use nalgebra::Vector2;

    /// Returns the controllers of a craft that hovers at 1900 µs and flies at full speed for a second, with at most
    /// 60° of tilt.
    fn weak_craft() -> (FlightControllers, NavInputs, Params) {
        let params = Params { max_angle: 60, hover_throttle: 1900, ..Params::default() };
        let now = NavInputs { throttle_us: 1900.0, ..NavInputs::hovering() };
        let mut controllers = FlightControllers::default();
        controllers.engage(&now, &params);
        let far = PositionTarget {
            speed_mps: 25.0,
            pass_through: true,
            ..PositionTarget::stay(Vector2::new(3000.0, 0.0), &params)
        };
        for _ in 0..300 {
            controllers.altitude.update(&(&now).into(), AltitudeTarget::Altitude(20.0), &params, now.dt);
            controllers.limit_tilt(&now, &params);
            controllers.position.update(&(&now).into(), &far, &params, now.dt);
        }
        (controllers, now, params)
    }

    #[test]
    fn a_tilt_that_the_thrust_cuts_is_reported() {
        let (controllers, _, params) = weak_craft();
        assert!(controllers.position.max_tilt_rad(&params) < 0.5);
        assert!(controllers.thrust_limits_tilt());
    }

    #[test]
    fn a_pilot_who_flies_the_altitude_gets_the_whole_tilt() {
        let (mut controllers, now, params) = weak_craft();
        controllers.track_altitude(&now, &params);
        assert_eq!(controllers.position.max_tilt_rad(&params), params.max_tilt_rad());
        assert!(!controllers.thrust_limits_tilt());
    }
}
