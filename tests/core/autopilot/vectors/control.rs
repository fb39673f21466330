//! The vectors of throttle and yaw.

use betadeck_core::autopilot::control::{
    ThrottleTerms, YawFacts, desired_heading, throttle_share, yaw_rate_dps,
};
use betadeck_core::autopilot::params::{Params, YawMode};
use strum::IntoEnumIterator;

use crate::autopilot::vectors::{cases, close, close_angle, num, set, text};

#[test]
fn altitude_throttle() {
    for case in cases("altitude_throttle", "cases") {
        let mut params = Params::default();
        set(&mut params, "ap_altitude_p", &case, "altitude_p");
        set(&mut params, "ap_altitude_d", &case, "altitude_d");
        set(&mut params, "ap_altitude_f", &case, "altitude_f");
        set(&mut params, "min_check", &case, "min_check_us");
        let terms = ThrottleTerms {
            error_cm: num(&case, "altitude_error_cm"),
            integral_us: num(&case, "integral_us"),
            setpoint_rate_cms: num(&case, "setpoint_rate_cms"),
            climb_rate_cms: num(&case, "climb_rate_cms"),
            hover_us: num(&case, "hover_throttle_us"),
            cos_tilt: num(&case, "cos_tilt"),
        };
        let throttle =
            terms.throttle_us(&params).clamp(num(&case, "throttle_min_us"), num(&case, "throttle_max_us"));
        close(throttle, num(&case, "throttle_us"), 0.5, &case);
        close(throttle_share(throttle, &params), num(&case, "out"), 0.001, &case);
    }
}

#[test]
fn yaw() {
    for case in cases("yaw", "cases") {
        let mut params = Params::default();
        set(&mut params, "ap_yaw_p", &case, "yaw_p");
        set(&mut params, "ap_yaw_d", &case, "yaw_d");
        let facts = YawFacts {
            heading_rad: num(&case, "heading_deg").to_radians(),
            yaw_rate_rps: num(&case, "yaw_rate_dps").to_radians(),
            course_rad: num(&case, "course_deg").to_radians(),
            ground_speed_mps: num(&case, "ground_speed_cms") / 100.0,
            bearing_rad: num(&case, "bearing_deg").to_radians(),
            distance_m: num(&case, "distance_cm") / 100.0,
            acceptance_radius_m: num(&case, "acceptance_radius_cm") / 100.0,
        };
        let mode = YawMode::iter().find(|mode| mode.to_string() == text(&case, "mode")).unwrap();
        let trusted = num(&case, "ground_speed_cms") >= num(&case, "min_forward_velocity_cms");
        let desired = desired_heading(mode, &facts, trusted, None);
        assert_eq!(desired.is_some(), !case["desired_deg"].is_null(), "{case}");
        let cap = num(&case, "yaw_rate_cap_dps");
        let limit = if cap > 0.0 { cap } else { f64::INFINITY }.min(num(&case, "max_yaw_rate_dps"));
        let rate = desired.map_or(0.0, |desired| {
            close_angle(desired.to_degrees(), num(&case, "desired_deg"), 0.1, &case);
            yaw_rate_dps(desired, &facts, num(&case, "ramp"), limit, &params)
        });
        close(rate, num(&case, "rate_dps"), 0.05, &case);
    }
}
