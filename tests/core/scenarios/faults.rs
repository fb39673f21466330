//! Faults of the craft or its settings: the scenario reports each of them with the measured number.

use crate::scenarios::rig::{
    assert_fails, assert_met, builtin, case_of, case_with, fly, judged, with_settings,
};
use betadeck_core::plan::WaypointType;
use betadeck_core::scenario::{Action, Insight, Outcome, compare, judge};
use betadeck_core::telemetry::InFlightCommand;
use betadeck_core::vehicle::VehicleCommand;

#[test]
fn guide_1_sees_a_wrong_arrival_radius() {
    let case = case_of("guide-1", "noise none");
    assert_met(&judged(&case));
    let judgements = judged(&with_settings(case, &["ap_waypoint_arrival_radius = 2000"]));
    let name = "the last waypoint is reached at the arrival radius of 5 m";
    assert_fails(&judgements, name, "19.");
    assert_fails(&judgements, name, " m, 4.50 m to 5.00 m (at ");
}

#[test]
fn guide_1_sees_a_craft_that_is_too_slow() {
    let case = with_settings(case_of("guide-1", "noise none"), &["ap_max_velocity = 300"]);
    let judgements = judged(&case);
    assert_fails(&judgements, "cruise at 5 m/s in the middle of leg 1", "mean 3.0");
    assert_fails(&judgements, "COMPLETE in time", "36.00 s to 54.00 s");
}

#[test]
fn guide_2_sees_a_corner_that_is_not_cut() {
    let mut case = case_of("guide-2", "mixed, noise none");
    case.setup.plan.plan.waypoints[2].kind = WaypointType::Flyover;
    let judgements = judged(&case);
    assert_fails(&judgements, "FLYBY 2 turns at the turn radius of its speed", "0.1");
    assert_fails(&judgements, "FLYBY 2 hardly overshoots", "at most 2.50 m");
    let last = "two FLYOVER overshoot at least twice as much as three FLYBY";
    assert_fails(&judgements, last, "at least");
}

#[test]
fn guide_2_sees_that_cutting_corners_gains_nothing() {
    let scenario = builtin("guide-2");
    let mut flyover = case_of("guide-2", "flyover, noise none");
    let names = |base: &str, flyover: &betadeck_core::scenario::Case| {
        let measures = judge(flyover, &fly(flyover)).1;
        measures.into_iter().map(|(name, value)| (format!("{base}.{name}"), value)).collect::<Vec<_>>()
    };
    let mut both = names("flyover", &flyover);
    // The FLYBY waypoints are flown as FLYOVER.
    flyover.name = "flyby".to_owned();
    both.extend(names("flyby", &flyover));
    let judgement = compare(&scenario.compares[0], &both, Insight::Inner);
    assert_fails(&[judgement], &scenario.compares[0].label, "0.000 s, 0.50 s to 10.00 s");
}

#[test]
fn guide_3_sees_a_wrong_radius_and_a_wrong_rate() {
    let case = with_settings(case_of("guide-3", "calm, noise none"), &["ap_hold_orbit_radius = 1500"]);
    assert_fails(&judged(&case), "a circle of 10 m around the waypoint", "15.0");
    let case = with_settings(case_of("guide-3", "calm, noise none"), &["ap_max_turn_rate = 4"]);
    let judgements = judged(&case);
    assert_fails(&judgements, "a lap of 120 s, from east to east", "119.0 s to 121.0 s");
    let lag = "clockwise at 3 degrees a second, with a lag of at most 10 degrees";
    assert_fails(&judgements, lag, "at most 10.00 deg");
}

#[test]
fn guide_4_sees_a_landing_that_never_disarms() {
    // The throttle never falls below the threshold, and the craft shakes too much to be recognised as at rest.
    let shake = "[[input]]\nat = \"contact after LANDING 0\"\ndo = \"fault vibration,,50\"\n";
    let case = case_with("guide-4", "calm, noise none", shake);
    let judgements = judged(&with_settings(case, &["ap_landing_throttle_threshold = 500"]));
    assert_fails(&judgements, "disarmed by the landing, on the ground", "it did not happen");
    assert_fails(&judgements, "straight to the landing", "after LANDING 0 COMPLETE 0 was expected");
    assert_fails(&judgements, "result complete", "it ended timeout");
    let reported = judgements.iter().find(|one| one.label == "result complete").map(|one| &one.outcome);
    assert!(
        matches!(reported, Some(Outcome::Failed { guard: Some(guard), .. }) if guard.contains("touchdown throttle")),
        "{reported:?}"
    );
}

#[test]
fn guide_4_sees_a_descent_that_is_too_fast() {
    let case = with_settings(case_of("guide-4", "calm, noise none"), &["ap_landing_descent_rate = 80"]);
    let judgements = judged(&case);
    assert_fails(&judgements, "mean rate of the descent", "0.80 m/s, 0.42 m/s to 0.58 m/s");
    assert_fails(&judgements, "descent at 50 cm/s", "outside for");
    assert_fails(&judgements, "contact in time, and soft", "38.00 s to 43.00 s");
}

#[test]
fn guide_5_sees_a_fence_that_is_ignored() {
    let ignored = ["ap_max_distance_from_home = 0"];
    let judgements = judged(&with_settings(case_of("guide-5", "rejected, noise none"), &ignored));
    assert_fails(&judgements, "rejected at the start, with both distances", "it did not happen");
    assert_fails(&judgements, "result refused", "it ended complete");
    let mut case = with_settings(case_of("guide-5", "land, noise none"), &ignored);
    case.time_limit_s = 60.0;
    let judgements = judged(&case);
    let one = "one geofence event, just outside by the craft's own measure";
    assert_fails(&judgements, one, "it did not happen");
    assert_fails(&judgements, "never far beyond the fence", "at most 120.0 m");
}

#[test]
fn guide_5_sees_the_wrong_action() {
    let case = with_settings(case_of("guide-5", "land, noise none"), &["ap_geofence_action = RTH"]);
    assert_fails(&judged(&case), "an emergency landing", "after HOLDING 0 came APPROACHING 0 of rth");
}

#[test]
fn guide_6_sees_another_policy_and_another_delay() {
    let case = with_settings(case_of("guide-6", "land, noise none"), &["ap_rx_loss_policy = CONTINUE"]);
    let judgements = judged(&case);
    let landing = "an emergency landing, once, to the end";
    assert_fails(&judgements, landing, "after APPROACHING 0 came ARRIVED 0 (by plane)");
    assert_fails(&judgements, "the active plan is one LAND", "it did not happen");
    let case = with_settings(case_of("guide-6", "land, noise none"), &["failsafe_delay = 30"]);
    let name = "LANDING after the failsafe's delay of 1.5 s";
    assert_fails(&judged(&case), name, "3.05 s, 1.50 s to 1.80 s");
}

#[test]
fn guide_7_sees_that_l1_is_off() {
    let case = with_settings(case_of("guide-7", "displaced, noise none"), &["ap_l1_enable = OFF"]);
    let judgements = judged(&case);
    assert_fails(&judgements, "back at the line within 14 s", "at most 14.00 s");
    assert_fails(&judgements, "and on it from there on", "outside for");
}

#[test]
fn guide_7_sees_wind_from_the_other_side() {
    let mut case = case_of("guide-7", "wind-5, noise none");
    case.airs[0].wind = "5@90".parse().unwrap();
    assert_fails(&judged(&case), "it tilts into the wind", "mean 7.");
}

#[test]
fn guide_8_sees_a_return_that_is_slow_or_none() {
    let case = with_settings(case_of("guide-8", "calm, noise none"), &["ap_max_velocity = 500"]);
    assert_fails(&judged(&case), "home in time", "13.00 s to 22.00 s");
    let mut case = case_of("guide-8", "calm, noise none");
    case.inputs[0].action = Action::Vehicle(VehicleCommand::InFlight(InFlightCommand::HoldHere));
    case.time_limit_s = 60.0;
    let judgements = judged(&case);
    assert_fails(&judgements, "2 waypoints are created: FLYOVER + LAND", "it did not happen");
    assert_fails(&judgements, "result landed", "it ended timeout");
}
