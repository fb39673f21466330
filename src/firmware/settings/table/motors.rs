//! Motors, throttle correction and mixer.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{I8, U8, U16};
use super::{Group, array, choice, number, switch};

#[rustfmt::skip]
pub(super) const MOTORS: Group = Group::new("Motors", Scope::Master, &[
    number("max_throttle", U16, 750, 2250, 2000, Live, "Motor output at full throttle, µs."),
    number("min_command", U16, 750, 2250, 1000, Live, "Motor output while disarmed, µs."),
    number("motor_kv", U16, 1, 40000, 1960, Carry, "Motor constant, rpm per volt.").hardware(),
    number("motor_idle", U16, 0, 2000, 550, Live, "Motor output at zero throttle while armed, 0.01 percent of the range."),
    switch("use_unsynced_pwm", U8, true, Carry, "Run the motor output at its own rate, not that of the control loop; here it always follows the loop."),
    choice("motor_pwm_protocol", U8, &["PWM", "ONESHOT125", "ONESHOT42", "MULTISHOT", "BRUSHED", "DSHOT150", "DSHOT300", "DSHOT600", "PROSHOT1000", "DISABLED", "DRONECAN"], 0, Live, "Protocol of the ESCs; every value except DISABLED flies here."),
    number("motor_pwm_rate", U16, 200, 32000, 480, Carry, "Rate of unsynced motor output, Hz."),
    switch("motor_pwm_inversion", U8, false, Carry, "Invert the motor signal."),
    number("motor_poles", U8, 4, 255, 14, Carry, "Magnets of a motor, to turn ESC telemetry into rpm."),
    array("motor_output_reordering", U8, &[0, 1, 2, 3, 4, 5, 6, 7], Carry, "Assignment of outputs to motors."),
]);

#[rustfmt::skip]
pub(super) const THROTTLE_CORRECTION: Group = Group::new("Throttle correction", Scope::Master, &[
    number("thr_corr_value", U8, 0, 150, 0, Live, "Throttle added in level modes at full tilt, 0.1 percent."),
    number("thr_corr_angle", U16, 1, 900, 800, Live, "Tilt at which that throttle is added in full, 0.1 deg."),
]);

#[rustfmt::skip]
pub(super) const MIXER: Group = Group::new("Mixer", Scope::Master, &[
    switch("yaw_motors_reversed", I8, false, Live, "The motors turn in the opposite direction."),
    choice("mixer_type", U8, &["LEGACY", "LINEAR", "DYNAMIC", "EZLANDING"], 0, Carry, "Handling of the throttle when the motors saturate; here always LEGACY."),
    number("crashflip_motor_percent", U8, 0, 100, 0, Carry, "Output of the motors that the sticks do not command in a crash flip, percent."),
    number("crashflip_rate", U8, 0, 250, 0, Carry, "Maximum rate of a crash flip."),
    switch("crashflip_auto_rearm", I8, false, Carry, "Arm again automatically after a crash flip."),
]);

#[rustfmt::skip]
pub(super) const REVERSIBLE_MOTORS: Group = Group::new("Reversible motors", Scope::Master, &[
    number("3d_deadband_low", U16, 750, 1500, 1406, Carry, "Upper end of the reversed range, µs."),
    number("3d_deadband_high", U16, 1500, 2250, 1514, Carry, "Lower end of the forward range, µs."),
    number("3d_neutral", U16, 750, 2250, 1460, Carry, "Motor output at standstill, µs."),
    number("3d_deadband_throttle", U16, 1, 100, 50, Carry, "Throttle range around the centre in which the motors stand still, µs."),
    number("3d_limit_low", U16, 750, 1500, 1000, Carry, "Full reverse output, µs."),
    number("3d_limit_high", U16, 1500, 2250, 2000, Carry, "Full forward output, µs."),
    switch("3d_switched_mode", U8, false, Carry, "Reverse with a switch instead of the throttle."),
]);
