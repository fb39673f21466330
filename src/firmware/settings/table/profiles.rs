//! Rate and battery profiles.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{U8, U16};
use super::{Group, choice, number, switch, text};

#[rustfmt::skip]
pub(super) const BATTERY_PROFILE: Group = Group::new("Battery profile", Scope::BatteryProfile, &[
    text("battery_profile_name", 8, Live, "Name of the battery profile."),
    number("bat_capacity", U16, 0, 20000, 0, Live, "Capacity of the battery, mAh; 0 for unknown."),
    number("vbat_max_cell_voltage", U16, 100, 500, 430, Live, "Maximum voltage of one cell, used to count the cells, 0.01 V."),
    number("vbat_full_cell_voltage", U16, 100, 500, 410, Carry, "Voltage of a full cell, 0.01 V."),
    number("vbat_min_cell_voltage", U16, 100, 500, 330, Live, "Voltage at which a cell is critical, 0.01 V."),
    number("vbat_warning_cell_voltage", U16, 100, 500, 350, Live, "Voltage at which a cell is low, 0.01 V."),
    number("cbat_alert_percent", U8, 0, 100, 10, Carry, "Remaining capacity that triggers a warning, percent."),
    number("force_battery_cell_count", U8, 0, 24, 0, Live, "Number of battery cells; 0 detects it."),
]);

#[rustfmt::skip]
pub(super) const RATE_PROFILE: Group = Group::new("Rate profile", Scope::RateProfile, &[
    text("rateprofile_name", 8, Live, "Name of the rate profile."),
    number("thr_mid", U8, 0, 100, 50, Live, "Stick position at the middle of the throttle curve, percent."),
    number("thr_expo", U8, 0, 100, 0, Live, "Flatness of the throttle curve around its middle, percent."),
    number("thr_hover", U8, 0, 100, 50, Live, "Throttle in the middle of the curve, percent."),
    choice("rates_type", U8, &["BETAFLIGHT", "RACEFLIGHT", "KISS", "ACTUAL", "QUICK"], 3, Live, "Formula of the rates."),
    switch("quickrates_rc_expo", U8, false, Live, "Apply the expo of QUICK rates to the stick."),
    number("roll_rc_rate", U8, 1, 255, 7, Live, "Roll rate around the centre, in the units of the formula."),
    number("pitch_rc_rate", U8, 1, 255, 7, Live, "Pitch rate around the centre, in the units of the formula."),
    number("yaw_rc_rate", U8, 1, 255, 7, Live, "Yaw rate around the centre, in the units of the formula."),
    number("roll_expo", U8, 0, 100, 0, Live, "Flatness of roll around the centre, percent."),
    number("pitch_expo", U8, 0, 100, 0, Live, "Flatness of pitch around the centre, percent."),
    number("yaw_expo", U8, 0, 100, 0, Live, "Flatness of yaw around the centre, percent."),
    number("roll_srate", U8, 0, 255, 67, Live, "Roll rate at full stick, in the units of the formula."),
    number("pitch_srate", U8, 0, 255, 67, Live, "Pitch rate at full stick, in the units of the formula."),
    number("yaw_srate", U8, 0, 255, 67, Live, "Yaw rate at full stick, in the units of the formula."),
    choice("throttle_limit_type", U8, &["OFF", "SCALE", "CLIP"], 0, Live, "Method of limiting the throttle."),
    number("throttle_limit_percent", U8, 25, 100, 100, Live, "Maximum throttle, percent."),
    number("roll_rate_limit", U16, 200, 1998, 1998, Live, "Maximum roll rate, deg/s."),
    number("pitch_rate_limit", U16, 200, 1998, 1998, Live, "Maximum pitch rate, deg/s."),
    number("yaw_rate_limit", U16, 200, 1998, 1998, Live, "Maximum yaw rate, deg/s."),
]);
