//! The rate control loop outside the profiles.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{U8, U16};
use super::{Group, number, switch};

#[rustfmt::skip]
pub(super) const CONTROL_LOOP: Group = Group::new("Control loop", Scope::Master, &[
    number("pid_process_denom", U8, 1, 16, 1, Live, "Number of gyro samples per control loop."),
    switch("runaway_takeoff_prevention", U8, true, Live, "Stop the motors when a take-off gets out of control."),
    number("runaway_takeoff_deactivate_delay", U16, 100, 1000, 500, Live, "Duration of normal flight that ends this check, ms."),
    number("runaway_takeoff_deactivate_throttle_percent", U8, 0, 100, 20, Live, "Throttle that counts as flight, percent."),
]);

#[rustfmt::skip]
pub(super) const SIMPLIFIED_FILTER: Group = Group::new("Simplified tuning", Scope::Master, &[
    switch("simplified_gyro_filter", U8, true, Carry, "The gyro filters follow one slider in the configurator."),
    number("simplified_gyro_filter_multiplier", U8, 10, 200, 100, Carry, "Position of that slider, percent."),
]);
