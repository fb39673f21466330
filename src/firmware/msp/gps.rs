//! GPS, compass and GPS rescue.

use super::layout::{Field, i16, u8, u16};

/// `GPS_CONFIG`.
pub(super) const GPS: &[Field] = &[
    u8("gps_provider"),
    u8("gps_sbas_mode"),
    u8("gps_auto_config"),
    u8("gps_auto_baud"),
    u8("gps_set_home_point_once"),
    u8("gps_ublox_use_galileo"),
];

/// `COMPASS_CONFIG`.
pub(super) const COMPASS: &[Field] = &[i16("mag_declination")];

/// `GPS_RESCUE`. Angle and throttles are those of the autopilot.
pub(super) const RESCUE: &[Field] = &[
    u16("ap_max_angle"),
    u16("gps_rescue_return_alt"),
    u16("gps_rescue_descent_dist"),
    u16("gps_rescue_ground_speed"),
    u16("ap_throttle_min"),
    u16("ap_throttle_max"),
    u16("ap_hover_throttle"),
    u8("gps_rescue_sanity_checks"),
    u8("gps_rescue_min_sats"),
    u16("gps_rescue_ascend_rate"),
    u16("gps_rescue_descend_rate"),
    u8("gps_rescue_allow_arming_without_fix"),
    u8("gps_rescue_alt_mode"),
    u16("gps_rescue_min_start_dist"),
    u16("gps_rescue_initial_climb"),
];

/// `GPS_RESCUE_PIDS`.
pub(super) const RESCUE_PIDS: &[Field] = &[
    u16("ap_altitude_p"),
    u16("ap_altitude_i"),
    u16("ap_altitude_d"),
    u16("ap_position_p"),
    u16("ap_position_i"),
    u16("ap_position_d"),
    u16("gps_rescue_yaw_p"),
];
