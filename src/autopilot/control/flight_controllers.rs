//! The controllers of a flight, lent to whoever flies.

use super::altitude::{AltitudeController, AltitudeMeasurement};
use super::lean_limit::LeanLimiter;
use super::position::{PositionController, PositionMeasurement};
use crate::autopilot::io::NavInputs;
use crate::autopilot::land_detector::LandDetector;
use crate::autopilot::params::Params;

/// The one altitude controller, the one position controller and the one land detector of a craft.
///
/// They are lent to the navigator or to the hold modes. Whoever takes one over engages it, so that the demand does not
/// step, and updates it in every cycle; a controller that nobody flies with tracks the flight, so that wind and hover
/// throttle are known at the next takeover.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlightControllers {
    /// Throttle.
    pub altitude: AltitudeController,
    /// Lean.
    pub position: PositionController,
    /// Ground or air.
    pub land: LandDetector,
    /// Altitude before lean.
    pub lean: LeanLimiter,
}

impl FlightControllers {
    /// Takes both over: setpoints start at the craft, demands where they were.
    pub fn engage(&mut self, now: &NavInputs, params: &Params) {
        self.altitude.engage(&AltitudeMeasurement::from(now), params);
        self.position.engage(&PositionMeasurement::from(now));
    }

    /// Lets the lean be no greater than the thrust allows, after the altitude controller was updated.
    pub fn limit_lean(&mut self, now: &NavInputs, params: &Params) {
        let limit_rad = self.lean.update(now, &self.altitude, params);
        self.position.limit_lean(limit_rad);
    }

    /// Tracks a cycle whose throttle is not this altitude controller's.
    pub fn track_altitude(&mut self, now: &NavInputs, params: &Params) {
        self.altitude.track(&AltitudeMeasurement::from(now), params, now.dt);
    }

    /// Tracks a cycle whose lean is not this position controller's; without a fix there is nothing to track.
    pub fn track_position(&mut self, now: &NavInputs) {
        if now.fix {
            self.position.track(&PositionMeasurement::from(now), now.dt);
        }
    }
}
