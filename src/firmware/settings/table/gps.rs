//! GPS and the return-to-home rescue.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{U8, U16};
use super::{BAUD, Group, choice, number, port, switch, text};

#[rustfmt::skip]
pub(super) const GPS: Group = Group::new("GPS", Scope::Master, &[
    choice("gps_provider", U8, &["NMEA", "UBLOX", "MSP", "VIRTUAL"], 3, Live, "Source of the position."),
    choice("gps_sbas_mode", U8, &["AUTO", "EGNOS", "WAAS", "MSAS", "GAGAN", "NONE"], 5, Carry, "Satellite augmentation system."),
    switch("gps_auto_config", U8, true, Carry, "Configure a real receiver at boot."),
    switch("gps_auto_baud", U8, false, Carry, "Detect the baud rate of a real receiver."),
    choice("gps_ublox_acquire_model", U8, &["PORTABLE", "STATIONARY", "PEDESTRIAN", "AUTOMOTIVE", "AT_SEA", "AIRBORNE_1G", "AIRBORNE_2G", "AIRBORNE_4G"], 1, Carry, "Motion model of a real receiver before the fix."),
    choice("gps_ublox_flight_model", U8, &["PORTABLE", "STATIONARY", "PEDESTRIAN", "AUTOMOTIVE", "AT_SEA", "AIRBORNE_1G", "AIRBORNE_2G", "AIRBORNE_4G"], 7, Carry, "Motion model of a real receiver in flight."),
    number("gps_update_rate_hz", U8, 1, 20, 10, Live, "GPS solutions per second."),
    choice("gps_ublox_utc_standard", U8, &["AUTO", "USNO", "EU", "SU", "NTSC"], 0, Carry, "Time standard of a real receiver."),
    switch("gps_ublox_use_galileo", U8, false, Carry, "Use Galileo satellites."),
    switch("gps_ublox_enable_ana", U8, false, Carry, "Use predicted orbits for a faster fix."),
    switch("gps_set_home_point_once", U8, false, Live, "Keep the first home instead of setting it at each arming."),
    switch("gps_use_3d_speed", U8, false, Carry, "Show the speed along the path instead of the ground speed."),
    switch("gps_sbas_integrity", U8, false, Carry, "Accept only augmentation with integrity data."),
    text("gps_nmea_custom_commands", 64, Carry, "Commands sent to a real NMEA receiver."),
    port("gps_uart", 0, Carry, "Serial port of the GPS."),
    choice("gps_baud", U8, BAUD, 4, Carry, "Baud rate of the GPS port."),
]);

#[rustfmt::skip]
pub(super) const GPS_RESCUE: Group = Group::new("GPS rescue", Scope::Master, &[
    number("gps_rescue_min_start_dist", U16, 5, 30, 15, Live, "Closer to home than this, a rescue does not climb: it flies home at its altitude and lands, m."),
    choice("gps_rescue_alt_mode", U8, &["MAX_ALT", "FIXED_ALT", "CURRENT_ALT"], 0, Live, "Altitude of the return flight."),
    number("gps_rescue_initial_climb", U16, 0, 100, 10, Live, "Climb above the reference altitude, m."),
    number("gps_rescue_ascend_rate", U16, 50, 2500, 750, Live, "Climb rate of a rescue, cm/s."),
    number("gps_rescue_return_alt", U16, 5, 1000, 30, Live, "Altitude of the return flight in mode FIXED_ALT, m."),
    number("gps_rescue_ground_speed", U16, 0, 3000, 750, Live, "Speed of the return flight, cm/s."),
    number("gps_rescue_descent_dist", U16, 5, 500, 20, Carry, "Distance from home at which a real craft starts its descent, m; here it descends over home."),
    number("gps_rescue_descend_rate", U16, 25, 500, 150, Live, "Descent rate of a rescue, cm/s."),
    choice("gps_rescue_sanity_checks", U8, &["RESCUE_SANITY_OFF", "RESCUE_SANITY_ON", "RESCUE_SANITY_FS_ONLY"], 2, Live, "Abort a rescue that makes no progress or flies away: never, always, or only in a failsafe."),
    number("gps_rescue_min_sats", U8, 5, 50, 8, Live, "Satellites needed for home and rescue."),
    switch("gps_rescue_allow_arming_without_fix", U8, false, Live, "Allow arming even if a rescue would have no home."),
    number("gps_rescue_yaw_p", U8, 0, 200, 20, Carry, "Yaw gain with which a real rescue turns towards home; here ap_yaw_p applies."),
]);
