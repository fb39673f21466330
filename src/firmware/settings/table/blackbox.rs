//! Flight recording.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{U8, U32};
use super::{BAUD, Group, choice, port, switch};

#[rustfmt::skip]
pub(super) const BLACKBOX: Group = Group::new("Blackbox", Scope::Master, &[
    choice("blackbox_sample_rate", U8, &["1/1", "1/2", "1/4", "1/8", "1/16"], 2, Live, "Fraction of control loops that is recorded."),
    choice("blackbox_device", U8, &["NONE", "SPIFLASH", "SDCARD", "SERIAL", "VIRTUAL"], 0, Live, "Storage device for flight recordings.").hardware(),
    switch("blackbox_disable_pids", U32, false, Live, "Leave the PID terms out of recordings."),
    switch("blackbox_disable_rc", U32, false, Live, "Leave the sticks out of recordings."),
    switch("blackbox_disable_setpoint", U32, false, Live, "Leave the setpoints out of recordings."),
    switch("blackbox_disable_bat", U32, false, Live, "Leave the battery out of recordings."),
    switch("blackbox_disable_mag", U32, false, Live, "Leave the compass out of recordings."),
    switch("blackbox_disable_alt", U32, false, Live, "Leave the altitude out of recordings."),
    switch("blackbox_disable_rssi", U32, false, Live, "Leave the signal strength out of recordings."),
    switch("blackbox_disable_gyro", U32, false, Live, "Leave the filtered gyro out of recordings."),
    switch("blackbox_disable_gyrounfilt", U32, false, Live, "Leave the raw gyro out of recordings."),
    switch("blackbox_disable_acc", U32, false, Live, "Leave the accelerometer out of recordings."),
    switch("blackbox_disable_attitude", U32, false, Live, "Leave the attitude out of recordings."),
    switch("blackbox_disable_debug", U32, false, Live, "Leave the debug values out of recordings."),
    switch("blackbox_disable_motors", U32, false, Live, "Leave the motors out of recordings."),
    switch("blackbox_disable_gps", U32, false, Live, "Leave the GPS out of recordings."),
    choice("blackbox_mode", U8, &["NORMAL", "MOTOR_TEST", "ALWAYS"], 0, Live, "Condition for recording a flight."),
    switch("blackbox_high_resolution", U8, false, Live, "Record values at ten times the resolution."),
    port("blackbox_uart", 0, Carry, "Serial port of the recorder."),
    choice("blackbox_baud", U8, BAUD, 5, Carry, "Baud rate of the recorder's port."),
]);
