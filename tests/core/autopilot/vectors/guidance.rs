//! The geometry of legs, corners and patterns, and the speed along them.

use betadeck_core::autopilot::guidance::{
    CornerArc, L1Limits, PlaneCrossing, figure8, l1, leg_speed_mps, orbit, pattern_rate_rps, plane_crossing,
    stop_speed_mps, turn_radius_m,
};
use betadeck_core::autopilot::machine::{Facts, Outcome, transition};
use betadeck_core::autopilot::params::Params;
use betadeck_core::geo::offset_to_latlon;
use betadeck_core::plan::LegSpeed;
use betadeck_core::telemetry::{L1Mode, NavState};

use crate::autopilot::vectors::{
    cases, close, close_angle, close_place, flag, metres, num, point, set, text,
};

#[test]
fn turn_radius() {
    for case in cases("turn_radius", "cases") {
        let tilt = num(&case, "max_angle_deg").to_radians();
        let radius = turn_radius_m(num(&case, "ground_speed_cms") / 100.0, tilt) * 100.0;
        close(radius, num(&case, "radius_cm"), num(&case, "radius_cm") * 2e-3, &case);
    }
}

/// Returns the facts of a FLYOVER that is not the last waypoint.
fn flyover() -> Facts {
    let mut facts = Facts { count: 3, ..Facts::default() };
    facts.waypoint.last = false;
    facts
}

#[test]
fn plane_crossings() {
    for case in cases("plane_crossing", "cases") {
        let (start, wp) = (metres(&case["leg_start"]), metres(&case["waypoint"]));
        let (prev, pos) = (metres(&case["prev"]), metres(&case["position"]));
        let plane = plane_crossing(start, wp, prev, pos);
        let mut facts = flyover();
        facts.approach.plane = plane;
        facts.approach.distance_m = (wp - pos).norm();
        facts.approach.arrival_radius_m = num(&case, "arrival_radius_cm") / 100.0;
        facts.waypoint.missed = flag(&case, "missed_before");
        let outcome = transition(NavState::Approaching, &facts).map(|decision| decision.outcome);
        let expect = &case["expect"];
        assert_eq!(outcome == Some(Outcome::Arrive), flag(expect, "arrived"), "{case}");
        let missed = facts.waypoint.missed || outcome == Some(Outcome::Missed);
        assert_eq!(missed, flag(expect, "missed"), "{case}");
        if let Some(lateral) = expect["lateral_cm"].as_f64() {
            let PlaneCrossing::Crossed { lateral_m } = plane else { panic!("no crossing in {case}") };
            close(lateral_m * 100.0, lateral, 1.0, &case);
        }
    }
}

#[test]
fn orbits() {
    for case in cases("orbit", "cases") {
        let centre = point(&case["centre"]);
        let offset = orbit(num(&case, "radius_cm") / 100.0, num(&case, "angle_deg").to_radians()).offset;
        close(offset.x * 100.0, num(&case, "north_cm"), 0.5, &case);
        close(offset.y * 100.0, num(&case, "east_cm"), 0.5, &case);
        close_place(offset_to_latlon(centre, offset), point(&case["target"]), centre, &case);
    }
    for case in cases("orbit", "rate") {
        let mut params = Params::default();
        set(&mut params, "ap_max_turn_rate", &case, "turn_rate_dps");
        set(&mut params, "ap_max_angle", &case, "max_angle_deg");
        let speed = num(&case, "leg_speed_cms") / 100.0;
        let rate = pattern_rate_rps(num(&case, "radius_cm") / 100.0, speed, &params);
        let want = num(&case, "effective_rate_dps");
        close(rate.to_degrees(), want, want * 2e-3, &case);
        close(std::f64::consts::TAU / rate, num(&case, "lap_s"), num(&case, "lap_s") * 2e-3, &case);
    }
    for case in cases("orbit", "timeline") {
        let angle = (num(&case, "turn_rate_dps") * num(&case, "t_s")).rem_euclid(360.0);
        close_angle(angle, num(&case, "angle_deg"), 1e-6, &case);
    }
}

#[test]
fn figures_of_eight() {
    for case in cases("figure8", "cases") {
        let centre = point(&case["centre"]);
        let at = figure8(num(&case, "width_cm") / 100.0, num(&case, "phase_deg").to_radians());
        close(at.offset.x * 100.0, num(&case, "north_cm"), 0.5, &case);
        close(at.offset.y * 100.0, num(&case, "east_cm"), 0.5, &case);
        close_angle(at.heading_rad.to_degrees(), num(&case, "heading_deg"), 0.5, &case);
        close_place(offset_to_latlon(centre, at.offset), point(&case["target"]), centre, &case);
    }
}

#[test]
fn l1_law() {
    for case in cases("l1", "cases") {
        let limits = L1Limits {
            period_s: num(&case, "period_ds") / 10.0,
            min_lookahead_m: num(&case, "min_lookahead_cm") / 100.0,
            max_lookahead_m: num(&case, "max_lookahead_cm") / 100.0,
            max_cross_track_m: num(&case, "max_xte_cm") / 100.0,
        };
        let position = metres(&case["position"]);
        let got =
            l1(metres(&case["start"]), metres(&case["end"]), position, metres(&case["velocity"]), &limits);
        let expect = &case["expect"];
        let mode = if text(expect, "mode") == "TRACK" { L1Mode::Track } else { L1Mode::Direct };
        assert_eq!(got.mode, mode, "{case}");
        let aim = metres(&expect["aim"]);
        assert!((got.aim - aim).norm() <= (aim.norm() * 5e-4).max(0.01), "aim {} in {case}", got.aim);
        for (value, key) in [
            (got.length_m, "length_cm"),
            (got.along_m, "along_cm"),
            (got.xte_m, "xte_cm"),
            (got.lookahead_m, "lookahead_cm"),
            (got.effective_lookahead_m, "effective_lookahead_cm"),
        ] {
            if let Some(want) = expect[key].as_f64() {
                close(value * 100.0, want, (want.abs() * 5e-4).max(1.0), &case);
            }
        }
        if let Some(reanchor) = expect["reanchor"].as_bool() {
            assert_eq!(got.reanchor, reanchor, "{case}");
        }
        if let Some(bearing) = expect["bearing_to_aim_deg"].as_f64() {
            let to_aim = got.aim - position;
            close_angle(to_aim.y.atan2(to_aim.x).to_degrees(), bearing, 0.1, &case);
        }
        if let Some(eta) = expect["eta_deg"].as_f64() {
            close_angle(got.eta_rad.unwrap().to_degrees(), eta, 0.1, &case);
            let want = num(expect, "a_lat_cms2");
            close(got.a_lat_mps2 * 100.0, want, (want.abs() * 5e-3).max(1.0), &case);
        }
    }
}

#[test]
fn l1_arcs() {
    for case in cases("l1_arc", "cases") {
        let leg = num(&case, "leg_bearing_deg").to_radians();
        let rate = num(&case, "turn_rate_dps").to_radians();
        let arc = CornerArc::begin(num(&case, "course_deg").to_radians(), leg, rate);
        assert_eq!(arc.is_some(), flag(&case, "arc"), "{case}");
        if let (Some(mut arc), Some(want)) = (arc, case["bearing_after_0_1s"].as_f64()) {
            let goes_on = arc.advance(0.1, leg);
            assert!(goes_on, "{case}");
            let got = arc.bearing_rad.to_degrees();
            let other_way = num(&case, "change_deg").abs() == 180.0;
            let mirrored = 2.0 * num(&case, "course_deg") - want;
            let want = if other_way && (got - 180.0) > 0.0 { mirrored } else { want };
            close_angle(got, want, 0.05, &case);
        }
    }
}

#[test]
fn speed_demands() {
    for case in cases("speed_demand", "cases") {
        let mut params = Params::default();
        set(&mut params, "ap_position_p", &case, "position_p");
        set(&mut params, "ap_max_angle", &case, "max_angle_deg");
        let leg = num(&case, "leg_speed_cms") / 100.0;
        let got = match text(&case, "kind") {
            "pass" => leg,
            _ => stop_speed_mps(num(&case, "distance_cm") / 100.0, leg, &params),
        };
        let want = num(&case, "speed_cms");
        close(got * 100.0, want, (want * 5e-3).max(1.0), &case);
    }
    for case in cases("speed_demand", "leg_speed") {
        let mut params = Params::default();
        set(&mut params, "ap_max_velocity", &case, "max_velocity_cms");
        let got = leg_speed_mps(LegSpeed::from_mps(num(&case, "waypoint_speed_cms") / 100.0), &params);
        close(got * 100.0, num(&case, "leg_speed_cms"), 1.0, &case);
    }
    for case in cases("speed_demand", "build_up_accel") {
        let mut params = Params::default();
        set(&mut params, "ap_velocity_buildup_max_pitch", &case, "buildup_max_pitch_deg");
        set(&mut params, "ap_max_angle", &case, "max_angle_deg");
        let want = num(&case, "accel_cms2");
        close(params.build_up_accel_mps2() * 100.0, want, (want * 5e-3).max(1.0), &case);
    }
}
