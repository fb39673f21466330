//! The descent and the touchdown.

use betadeck_core::autopilot::guidance::{Spiral, landing_setpoint_m, spiral_offset};
use betadeck_core::autopilot::land_detector::{GroundFacts, TouchdownFacts, TouchdownGuards, TouchdownTimer};
use betadeck_core::autopilot::machine::{Facts, Outcome, transition};
use betadeck_core::autopilot::params::Params;
use betadeck_core::signals::SimTime;
use betadeck_core::telemetry::NavState;
use nalgebra::Vector2;

use crate::autopilot::vectors::{cases, close, flag, num, set};

#[test]
fn landing_profiles() {
    for case in cases("landing_profile", "cases") {
        let (altitude, low) = (num(&case, "altitude_cm") / 100.0, num(&case, "landing_altitude_m"));
        let t = num(&case, "t_s");
        let start = num(&case, "start_altitude_cm") / 100.0;
        let setpoint = landing_setpoint_m(start, num(&case, "descent_rate_cms") / 100.0, t, altitude, low);
        close(setpoint * 100.0, num(&case, "setpoint_cm"), 1.0, &case);
        let mut params = Params { landing_spiral_enable: flag(&case, "spiral_enable"), ..Params::default() };
        set(&mut params, "ap_landing_spiral_radius", &case, "spiral_radius_cm");
        set(&mut params, "ap_landing_spiral_rate", &case, "spiral_rate_dps");
        set(&mut params, "ap_landing_altitude_m", &case, "landing_altitude_m");
        let offset = Spiral::from_params(&params)
            .map_or(Vector2::zeros(), |spiral| spiral_offset(&spiral, t, altitude));
        close(offset.x * 100.0, num(&case, "offset_north_cm"), 0.5, &case);
        close(offset.y * 100.0, num(&case, "offset_east_cm"), 0.5, &case);
    }
}

#[test]
fn touchdowns() {
    for case in cases("touchdown", "cases") {
        let mut params = Params::default();
        set(&mut params, "ap_landing_altitude_m", &case, "landing_altitude_m");
        set(&mut params, "ap_landing_velocity_threshold", &case, "velocity_threshold_cms");
        set(&mut params, "ap_landing_throttle_threshold", &case, "throttle_threshold_us");
        set(&mut params, "ap_landing_descent_rate", &case, "descent_rate_cms");
        let facts = TouchdownFacts::new(
            &params,
            num(&case, "hover_throttle_us"),
            num(&case, "altitude_cm") / 100.0,
            num(&case, "ground_speed_cms") / 100.0,
            num(&case, "throttle_us"),
            num(&case, "climb_rate_cms") / 100.0,
        );
        let want = ["altitude", "speed", "throttle", "not_descending"]
            .map(|condition| flag(&case["conditions"], condition));
        let guards = TouchdownGuards::new(&facts, &GroundFacts::CERTAIN);
        let got: Vec<bool> = guards.iter().take(4).map(|guard| guard.holds()).collect();
        assert_eq!(got, want, "{case}");
        assert_eq!(guards.all_hold(), flag(&case, "all"), "{case}");
        assert_eq!(want.iter().all(|holds| *holds), flag(&case, "all"));
        let held = Facts { touchdown: guards, touchdown_held_us: Some(9_000_000), ..Facts::default() };
        let decision = transition(NavState::Landing, &held);
        let touched = decision.is_some_and(|decision| decision.outcome == Outcome::Touchdown);
        assert_eq!(touched, flag(&case, "all"), "guards in {case}");
    }
    for case in cases("touchdown", "timer") {
        let mut timer = TouchdownTimer::default();
        let mut facts =
            Facts { detection_time_ds: num(&case, "detection_time_ds") as u8, ..Facts::default() };
        let at = case["samples"].as_array().unwrap().iter().find_map(|sample| {
            let (t, holds) = (sample[0].as_f64().unwrap(), sample[1].as_bool().unwrap());
            let touchdown = TouchdownFacts {
                altitude_m: if holds { -1.0 } else { 1.0 },
                max_speed_mps: 1.0,
                max_throttle_us: 1.0,
                min_climb_mps: -1.0,
                ..TouchdownFacts::default()
            };
            facts.touchdown = TouchdownGuards::new(&touchdown, &GroundFacts::CERTAIN);
            facts.touchdown_held_us = timer.update(SimTime::from_secs_f64(t), facts.touchdown.all_hold());
            transition(NavState::Landing, &facts).map(|_| t)
        });
        assert_eq!(at, case["touchdown_at_s"].as_f64(), "{case}");
    }
}
