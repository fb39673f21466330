//! Receiver, sticks and failsafe.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{I8, U8, U16, U32};
use super::{Group, choice, number, port, switch};

#[rustfmt::skip]
pub(super) const RECEIVER: Group = Group::new("Receiver", Scope::Master, &[
    number("mid_rc", U16, 1200, 1700, 1500, Live, "Pulse of a centred stick, µs."),
    super::autopilot::setting("min_check"),
    number("max_check", U16, 750, 2250, 1900, Live, "Sticks above this count as high, µs."),
    number("rssi_channel", I8, 0, 18, 0, Live, "Channel that carries the signal strength; 0 for none."),
    switch("rssi_src_frame_errors", I8, false, Carry, "Derive the signal strength from lost frames."),
    number("rssi_scale", U8, 1, 255, 100, Carry, "Scale of the signal strength, percent."),
    number("rssi_offset", I8, -100, 100, 0, Carry, "Offset of the signal strength, percent."),
    switch("rssi_invert", I8, false, Carry, "Invert the signal strength."),
    number("rssi_src_frame_lpf_period", U8, 0, 255, 30, Carry, "Smoothing of the strength derived from lost frames, 0.1 s."),
    number("rssi_smoothing", U8, 0, 255, 125, Carry, "Smoothing of the shown signal strength."),
    switch("rc_smoothing", U8, true, Live, "Smooth the steps between receiver frames."),
    number("rc_smoothing_auto_factor", U8, 0, 250, 30, Live, "Strength of the automatic stick smoothing; higher is smoother but adds delay."),
    number("rc_smoothing_auto_factor_throttle", U8, 0, 250, 30, Live, "Strength of the automatic throttle smoothing."),
    number("rc_smoothing_setpoint_cutoff", U8, 0, 255, 0, Live, "Fixed cutoff of the stick smoothing, Hz; 0 is automatic."),
    number("rc_smoothing_throttle_cutoff", U8, 0, 255, 0, Live, "Fixed cutoff of the throttle smoothing, Hz; 0 is automatic."),
    choice("rc_smoothing_debug_axis", U8, &["ROLL", "PITCH", "YAW", "THROTTLE"], 0, Carry, "Axis that the smoothing debug mode shows."),
    number("fpv_mix_degrees", U8, 0, 90, 0, Carry, "Camera tilt for which yaw and roll are mixed in FPV ANGLE MIX, deg."),
    number("max_aux_channels", U8, 0, 14, 6, Live, "Number of switch channels in use; the others read 1500 µs."),
    number("airmode_start_throttle_percent", U8, 0, 100, 25, Live, "Throttle that counts as raised after arming; holds and the autopilot require it once."),
    number("rx_min_usec", U16, 750, 2250, 885, Live, "Shortest valid pulse, µs."),
    number("rx_max_usec", U16, 750, 2250, 2115, Live, "Longest valid pulse, µs."),
    switch("serialrx_halfduplex", U8, false, Carry, "Receiver on a single wire."),
    port("rx_uart", 0, Carry, "Serial port of the receiver."),
    number("msp_override_channels_mask", U32, 0, 262143, 0, Carry, "Channels that MSP may override, one bit each."),
    switch("msp_override_failsafe", U8, false, Carry, "Keep overridden channels active during a failsafe.").hardware(),
]);

#[rustfmt::skip]
pub(super) const FAILSAFE: Group = Group::new("Failsafe", Scope::Master, &[
    number("failsafe_delay", U8, 1, 200, 15, Live, "Time without a signal until stage 2, 0.1 s."),
    number("failsafe_landing_time", U8, 0, 250, 60, Live, "Maximum duration of an AUTO-LAND descent, s."),
    number("failsafe_throttle", U16, 750, 2250, 1000, Live, "Throttle channel while stage 2 is active, µs."),
    choice("failsafe_switch_mode", U8, &["STAGE1", "KILL", "STAGE2"], 0, Live, "Action of the FAILSAFE switch: act as a lost link, disarm at once, or start stage 2."),
    number("failsafe_throttle_low_delay", U16, 0, 300, 100, Live, "If the throttle was low this long before the loss, the failsafe only disarms, 0.1 s."),
    choice("failsafe_procedure", U8, &["AUTO-LAND", "DROP", "GPS-RESCUE"], 1, Live, "Action of stage 2."),
    number("failsafe_recovery_delay", U16, 1, 200, 5, Live, "Duration of a valid signal that ends a failsafe, 0.1 s."),
    number("failsafe_stick_threshold", U8, 0, 50, 30, Live, "Stick deflection with which the pilot takes back control, percent."),
]);

#[rustfmt::skip]
pub(super) const STICKS: Group = Group::new("Sticks", Scope::Master, &[
    number("deadband", U8, 0, 32, 0, Live, "Stick movement around the centre that is ignored on roll and pitch, µs."),
    number("yaw_deadband", U8, 0, 100, 0, Live, "Stick movement around the centre that is ignored on yaw, µs."),
    switch("yaw_control_reversed", I8, false, Live, "Reverse the yaw stick."),
]);
