//! Altitude and position hold and the altitude estimate.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{I8, U8, U16};
use super::{Group, choice, number};

#[rustfmt::skip]
pub(super) const HOLD: Group = Group::new("Altitude and position hold", Scope::Master, &[
    super::autopilot::setting("alt_hold_climb_rate"),
    number("alt_hold_deadband", U8, 0, 70, 20, Live, "Range of the throttle stick around hover that keeps the altitude, percent."),
    number("pos_hold_deadband", U8, 0, 50, 5, Live, "Stick movement beyond which the pilot steers in position hold, percent."),
    choice("poshold_position_source", U8, &["AUTO", "GPS_ONLY", "OPTICALFLOW_ONLY"], 0, Live, "Position source of position hold; OPTICALFLOW_ONLY provides none here."),
    number("poshold_opticalflow_quality_min", U8, 0, 100, 30, Carry, "Minimum quality of optical flow, percent."),
    number("poshold_opticalflow_max_range", U16, 50, 1000, 400, Carry, "Maximum height for optical flow, cm."),
]);

#[rustfmt::skip]
pub(super) const ALTITUDE: Group = Group::new("Altitude estimate", Scope::Master, &[
    choice("altitude_source", I8, &["DEFAULT", "BARO_ONLY", "GPS_ONLY", "RANGEFINDER_PREFER", "RANGEFINDER_ONLY"], 0, Live, "Sensors used for the altitude."),
    number("altitude_prefer_baro", I8, 0, 100, 100, Live, "Weight of the barometer against the GPS, percent."),
    number("altitude_lpf", U16, 10, 5000, 300, Live, "Smoothing of the shown altitude, 0.01 Hz."),
    number("rangefinder_max_range_cm", U16, 50, 1000, 400, Carry, "Maximum height for a rangefinder, cm."),
    number("altitude_d_lpf", U16, 10, 5000, 300, Live, "Smoothing of the climb rate, 0.01 Hz."),
]);
