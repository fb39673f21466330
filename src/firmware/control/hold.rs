//! ALTHOLD, POS HOLD and the failsafe descent, flown with the autopilot's controllers.
//!
//! Runs a hundred times a second while the navigator does not fly. A controller that no hold uses tracks the flight, so
//! that wind and hover throttle are known when a hold or the navigator takes over.

use nalgebra::Vector2;

use crate::autopilot::Params;
use crate::autopilot::control::FlightControllers;
use crate::autopilot::io::NavInputs;
use crate::firmware::settings::Settings;

use super::TiltDemand;

mod altitude;
mod position;

use altitude::{AltitudeHold, AltitudeOrder};
use position::PositionHold;

pub use altitude::DescentRate;

/// The holds that are on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HoldModes {
    /// Holds the altitude; the throttle stick climbs and sinks.
    pub altitude: bool,
    /// Holds the position; roll and pitch sticks fly by angle.
    pub position: bool,
    /// Descends and lands; the throttle stick has no effect.
    pub descend: Option<DescentRate>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoldTuning {
    /// The deadband of the throttle stick, as a share of its way from hover to the end, 0…1.
    pub throttle_deadband: f64,
    /// The deadband of the roll and pitch sticks, as a share of their way, 0…1.
    pub stick_deadband: f64,
    /// The centre of the sticks, µs.
    pub mid_us: f64,
    /// The pulse below which the throttle stick has no effect, µs.
    pub low_us: f64,
    /// `true` if the position may come from the GPS. There is no other source here.
    pub uses_gps: bool,
}

impl Default for HoldTuning {
    fn default() -> Self {
        Self::from_settings(&Settings::default())
    }
}

impl HoldTuning {
    /// Reads the tuning from the settings.
    pub fn from_settings(settings: &Settings) -> Self {
        let number = |name: &str| settings.number(name) as f64;
        Self {
            throttle_deadband: number("alt_hold_deadband") / 100.0,
            stick_deadband: number("pos_hold_deadband") / 100.0,
            mid_us: number("mid_rc"),
            low_us: number("min_check"),
            uses_gps: settings.text("poshold_position_source") != "OPTICALFLOW_ONLY",
        }
    }
}

impl HoldTuning {
    /// Returns the throttle stick (µs) whose throttle in master is this one (µs): its range begins at `min_check`.
    pub fn stick_of_throttle_us(&self, throttle_us: f64) -> f64 {
        self.low_us + (throttle_us - 1000.0) * (2000.0 - self.low_us) / 1000.0
    }

    /// Returns the climb rate that the throttle stick (µs) asks of ALTHOLD with this hover throttle (µs), m/s.
    pub fn climb_mps(&self, stick_us: f64, hover_us: f64, params: &Params) -> f64 {
        altitude::climb_share(stick_us, hover_us, self) * params.climb_rate_mps()
    }

    /// Returns the tilt that the roll and pitch sticks ask for in a position hold, with this limit (rad); `None` while both
    /// rest.
    pub fn stick_tilt(&self, now: &NavInputs, limit_rad: f64) -> Option<TiltDemand> {
        let share = |stick| position::share(stick, self.stick_deadband);
        let stick = Vector2::new(share(now.stick_pitch), share(now.stick_roll));
        let tilt = stick.cap_magnitude(1.0) * limit_rad;
        (stick != Vector2::zeros()).then_some(TiltDemand { pitch_down_rad: tilt.x, roll_rad: tilt.y })
    }

    /// Returns `true` while the pilot moves the roll or pitch stick in a position hold.
    pub fn moves_sticks(&self, now: &NavInputs) -> bool {
        [now.stick_roll, now.stick_pitch]
            .iter()
            .any(|&stick| position::share(stick, self.stick_deadband) != 0.0)
    }

    /// Returns the throttle stick (µs) that makes a craft with this hover throttle (µs) sink at a rate (m/s) in
    /// ALTHOLD; `None` if no stick does.
    pub fn sink_stick_us(&self, rate_mps: f64, hover_us: f64, params: &Params) -> Option<f64> {
        altitude::sink_stick_us(rate_mps, hover_us, params, self)
    }
}

/// The demands of the holds; `None` leaves control to the pilot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HoldOutput {
    pub tilt: Option<TiltDemand>,
    /// The throttle, 0…1.
    pub throttle: Option<f64>,
    /// `true` if position hold is requested but position or heading is unknown. The craft is only levelled then.
    pub no_position: bool,
    /// `true` once the descent has reached the ground. The motors must be stopped then.
    pub touchdown: bool,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Holds {
    altitude: AltitudeHold,
    position: PositionHold,
}

impl Holds {
    /// Releases all holds. Called when the navigator flies, or the craft was armed or disarmed.
    pub fn release(&mut self) {
        *self = Self::default();
    }

    /// Runs one update while the navigator does not fly. `throttle_stick_us` is the pilot's throttle; `None` while it
    /// has no effect.
    pub fn update(
        &mut self,
        modes: HoldModes,
        now: &NavInputs,
        throttle_stick_us: Option<f64>,
        params: &Params,
        tuning: &HoldTuning,
        controllers: &mut FlightControllers,
    ) -> HoldOutput {
        let (throttle, touchdown) = if now.altitude_valid && (modes.altitude || modes.descend.is_some()) {
            let order = match (modes.descend, throttle_stick_us) {
                (Some(rate), _) => AltitudeOrder::Descend(rate),
                (None, Some(stick)) => AltitudeOrder::Stick(stick),
                (None, None) => AltitudeOrder::Keep,
            };
            let throttle = self.altitude.update(order, now, params, tuning, controllers);
            (Some(throttle), self.altitude.has_touched_down())
        } else {
            self.altitude.release();
            controllers.land.end_descent();
            controllers.track_altitude(now, params);
            (None, false)
        };
        let keeps_place = modes.position && now.fix && tuning.uses_gps;
        let tilt = if keeps_place && controllers.land.awaits_lift_off() {
            // On the ground, GPS noise would wind up the integral, and the craft would jump at lift-off.
            self.position.release();
            controllers.track_position(now);
            Some(TiltDemand { roll_rad: 0.0, pitch_down_rad: 0.0 })
        } else if keeps_place {
            Some(self.position.update(now, params, tuning, &mut controllers.position))
        } else {
            self.position.release();
            controllers.track_position(now);
            None
        };
        HoldOutput { tilt, throttle, no_position: modes.position && tilt.is_none(), touchdown }
    }
}
