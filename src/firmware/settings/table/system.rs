//! System, arming, statistics and names.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{I8, I16, U8, U16, U32};
use super::{DEBUG_MODE, Group, choice, number, switch, text};

#[rustfmt::skip]
pub(super) const SYSTEM: Group = Group::new("System", Scope::Master, &[
    number("reboot_character", U8, 48, 126, 82, Carry, "Byte that starts the boot loader of a real board over a serial port."),
    number("serial_update_rate_hz", U16, 100, 2000, 100, Carry, "Rate at which serial ports are served, Hz; here after every step."),
]);

#[rustfmt::skip]
pub(super) const ARMING: Group = Group::new("Arming", Scope::Master, &[
    number("auto_disarm_delay", U8, 0, 60, 5, Live, "Time at low throttle until a craft armed with the sticks disarms, s; 0 for never."),
    switch("gyro_cal_on_first_arm", U8, false, Live, "Calibrate the gyro at the first arming after boot; the craft arms when that is done."),
    switch("prearm_allow_rearm", U8, false, Live, "Allow several armings with one PREARM."),
]);

#[rustfmt::skip]
pub(super) const MAINTENANCE: Group = Group::new("Maintenance", Scope::Master, &[
    switch("task_statistics", I8, true, Live, "Measure the run time of tasks."),
    choice("debug_mode", U8, DEBUG_MODE, 0, Live, "Source of the eight debug values of logs."),
    switch("rate_6pos_switch", U8, false, Carry, "Select rate profiles with a six-position switch."),
    number("pwr_on_arm_grace", U8, 0, 30, 5, Live, "Time after boot before arming is allowed, s."),
    switch("enable_stick_arming", U8, false, Live, "Allow arming with the sticks when no ARM switch is set up."),
]);

#[rustfmt::skip]
pub(super) const STATISTICS: Group = Group::new("Clock and statistics", Scope::Master, &[
    number("timezone_offset_minutes", I16, -780, 780, 0, Carry, "Offset of local time from UTC, minutes."),
    number("stats_min_armed_time_s", I8, -1, 127, -1, Carry, "Flights shorter than this do not count, s; -1 counts none."),
    number("stats_total_flights", U32, 0, 4294967295, 0, Carry, "Flights so far."),
    number("stats_total_time_s", U32, 0, 4294967295, 0, Carry, "Time flown so far, s."),
    number("stats_total_dist_m", U32, 0, 4294967295, 0, Carry, "Distance flown so far, m."),
    number("stats_save_move_limit", U8, 0, 255, 20, Carry, "Stick movement that postpones saving the statistics, percent."),
]);

#[rustfmt::skip]
pub(super) const IDENTITY: Group = Group::new("Identity", Scope::Master, &[
    text("craft_name", 16, Live, "Name of the craft."),
]);

#[rustfmt::skip]
pub(super) const USER_BOXES: Group = Group::new("User modes", Scope::Master, &[
    text("box_user_1_name", 16, Carry, "Name shown for mode USER1.").hardware(),
    text("box_user_2_name", 16, Carry, "Name shown for mode USER2.").hardware(),
    text("box_user_3_name", 16, Carry, "Name shown for mode USER3.").hardware(),
    text("box_user_4_name", 16, Carry, "Name shown for mode USER4.").hardware(),
]);
