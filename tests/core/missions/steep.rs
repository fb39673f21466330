//! Steep legs: the review reports before the flight which altitudes will be missed, and a HOLD waits for its altitude.
//!
//! `cargo test --release --test core -- --ignored --nocapture heights` flies the whole search.

use betadeck_core::autopilot::Params;
use betadeck_core::autopilot::control::{AltitudeController, AltitudeMeasurement, AltitudeTarget};
use betadeck_core::flight::FlightResult;
use betadeck_core::geo::{LatLon, offset_to_latlon};
use betadeck_core::plan::WaypointRecord;
use betadeck_core::plan::edit::PlanDocument;
use betadeck_core::plan::edit::fix::fix;
use betadeck_core::plan::estimate::{Assumptions, estimate};
use betadeck_core::plan::review::{Finding, SteepLeg, review};
use betadeck_core::plan::setpoint::AltitudeSetpoint;
use betadeck_core::plan::{FlightPlan, HoldPattern, Waypoint, WaypointType, plan_lines};
use betadeck_core::sim::{Airframe, Wind};
use betadeck_core::telemetry::{NavState, PlanSource};
use nalgebra::Vector2;

use crate::missions::dice::{Dice, in_parallel};
use crate::missions::mission::{Mission, plan};

const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);
/// The altitude error above which a flight is `missed`, m.
const TOLERANCE_M: f64 = 10.0;
/// The altitude error below which a warning about a leg is in vain, m.
const LEVEL_M: f64 = 4.0;
/// A plan that once missed an altitude by 58 m without a warning from the review.
const STEEP: &str = "waypoint insert 0 40.4640000 -79.5182000 1500 1000 FLYOVER 0 NONE\n\
                     waypoint insert 1 40.4642700 -79.5182000 8000 1000 FLYOVER 0 NONE\n\
                     waypoint insert 2 40.4635000 -79.5182000 1500 0 LAND 0 NONE";

fn steep_legs(plan: &FlightPlan, settings: &[String], takeoff_m: f64) -> Vec<SteepLeg> {
    let assumptions = Assumptions { start_alt_m: takeoff_m, ..Assumptions::from_settings(settings) };
    let found = review(plan, HOME, &assumptions).into_iter();
    found
        .filter_map(|finding| match finding {
            Finding::SteepLeg(leg) => Some(leg),
            _ => None,
        })
        .collect()
}

/// Returns a mission with legs of all lengths and slopes.
fn random_mission(seed: u64) -> Mission {
    let dice = &mut Dice(seed ^ 0x57EE);
    let mut place = Vector2::zeros();
    let count = 2 + dice.below(5);
    let waypoints = (0..count).map(|index| {
        let kinds = [WaypointType::Flyover, WaypointType::Flyover, WaypointType::Flyby, WaypointType::Hold];
        let kind = if index + 1 == count { WaypointType::Land } else { dice.pick(&kinds) };
        let reach_m = dice.pick(&[25.0, 60.0, 150.0, 150.0]);
        place += Vector2::new(dice.between(-reach_m, reach_m), dice.between(-reach_m, reach_m));
        let top_m = dice.pick(&[25.0, 25.0, 40.0, 100.0]);
        let record = WaypointRecord {
            position: offset_to_latlon(HOME, place),
            alt_cm: (100.0 * dice.between(6.0, top_m)) as i32,
            speed: if dice.one_in(3) { 0 } else { dice.between(150.0, 1000.0) as u16 },
            duration_ds: if kind == WaypointType::Hold { 20 + dice.below(150) as u16 } else { 0 },
            kind,
            pattern: dice.pick(&[HoldPattern::None, HoldPattern::None, HoldPattern::Orbit]),
        };
        Waypoint::from(record)
    });
    let plan = FlightPlan { waypoints: waypoints.collect() };
    let takeoff_m = dice.pick(&[2.0, 10.0, 20.0]);
    let mut mission = Mission { takeoff_m, ..Mission::new(plan) };
    for (name, low, high) in [
        ("ap_max_angle", 20.0, 50.0),
        ("ap_max_velocity", 400.0, 1000.0),
        ("alt_hold_climb_rate", 20.0, 60.0),
        ("ap_waypoint_arrival_radius", 300.0, 1000.0),
    ] {
        if dice.one_in(3) {
            mission = mission.set(name, dice.between(low, high) as u32);
        }
    }
    mission.world.seed = seed;
    mission.world.airframe = dice.pick(&[Airframe::iris(), Airframe::five_inch()]);
    if dice.one_in(2) {
        mission.world.wind =
            Wind { speed_mps: dice.between(0.0, 4.0), from_deg: dice.between(0.0, 359.0).floor() };
    }
    mission
}

/// The review's findings about the legs of a flight, compared with the flight.
#[derive(Debug, Default)]
struct Heights {
    legs: usize,
    /// Legs that missed their altitude and that the review had found.
    found: usize,
    /// Legs that missed their altitude and that the review had not found.
    overlooked: Vec<String>,
    /// Legs that the review had found and that passed between [`LEVEL_M`] and [`TOLERANCE_M`] off.
    within_tolerance: usize,
    /// Legs that the review had found and that passed less than [`LEVEL_M`] off.
    in_vain: Vec<String>,
    /// The greatest difference between the predicted and the flown error of a found leg, m.
    worst_m: f64,
    crashes: Vec<String>,
}

fn heights(seed: u64) -> Heights {
    let mission = random_mission(seed);
    let steep = steep_legs(&mission.plan, &mission.settings, mission.takeoff_m);
    let reported = format!(
        "seed {seed}: {}, takeoff {} m, wind {}, {:?}\n{}",
        mission.world.airframe.name,
        mission.takeoff_m,
        mission.world.wind,
        mission.settings,
        plan_lines(&mission.plan).collect::<Vec<_>>().join("\n")
    );
    let outcome = mission.fly();
    let mut heights = Heights::default();
    if !matches!(outcome.result(), FlightResult::Complete | FlightResult::Missed) {
        heights.crashes.push(format!("{reported}\n{:?}", outcome.end.verdict));
    }
    for truth in outcome.end.truth.waypoints.iter().filter(|truth| truth.source == PlanSource::Stored) {
        let passes = matches!(truth.kind, WaypointType::Flyover | WaypointType::Flyby);
        let Some(error_m) = truth.alt_error_m.filter(|_| passes) else { continue };
        heights.legs += 1;
        let said = steep.iter().find(|leg| leg.index == usize::from(truth.wp));
        let line =
            |said: f64| format!("waypoint {}: said {said:.1} m, flown {error_m:.1} m; {reported}", truth.wp);
        match said {
            Some(leg) if error_m.abs() > TOLERANCE_M => {
                heights.found += 1;
                heights.worst_m = heights.worst_m.max((leg.error_m - error_m).abs());
            }
            Some(leg) if error_m.abs() < LEVEL_M => heights.in_vain.push(line(leg.error_m)),
            Some(_) => heights.within_tolerance += 1,
            None if error_m.abs() > TOLERANCE_M => heights.overlooked.push(line(0.0)),
            None => {}
        }
    }
    heights
}

fn check_heights(missions: u64) {
    let all = in_parallel(0..missions, heights);
    let sum = |of: fn(&Heights) -> usize| all.iter().map(of).sum::<usize>();
    let lines = |of: fn(&Heights) -> &[String]| all.iter().flat_map(of).cloned().collect::<Vec<_>>();
    let (legs, found, within) = (sum(|h| h.legs), sum(|h| h.found), sum(|h| h.within_tolerance));
    let (overlooked, in_vain) = (lines(|h| &h.overlooked), lines(|h| &h.in_vain));
    let crashes = lines(|h| &h.crashes);
    let worst_m = all.iter().map(|h| h.worst_m).fold(0.0, f64::max);
    println!(
        "{missions} missions, {legs} legs to a FLYOVER or FLYBY: {found} missed and found before, {} missed and overlooked, \
         {within} found and passed {LEVEL_M} to {TOLERANCE_M} m off, {} found in vain; errors said are at most {worst_m:.1} m off",
        overlooked.len(),
        in_vain.len()
    );
    assert!(overlooked.is_empty(), "{}", overlooked.join("\n"));
    assert!(crashes.is_empty(), "{}", crashes.join("\n"));
    assert!(in_vain.len() * 1000 <= legs, "{}", in_vain.join("\n"));
    assert!(found * 100 >= legs, "the search flies steep legs");
}

#[test]
fn the_review_finds_every_height_that_will_be_missed() {
    check_heights(15);
}

#[test]
#[ignore = "search: 2 000 missions"]
fn the_review_finds_all_heights_that_will_be_missed_in_two_thousand_missions() {
    check_heights(2000);
}

#[test]
fn a_steep_leg_is_said_before_the_flight_and_its_edit_makes_the_flight_complete() {
    let steep = plan(STEEP);
    let settings = ["ap_max_velocity = 1000".to_owned()];
    let found = steep_legs(&steep, &settings, 10.0);
    assert_eq!(found.len(), 1, "{found:?}");
    let outcome = Mission::new(steep.clone()).set("ap_max_velocity", 1000).fly();
    let flown_m =
        outcome.end.truth.waypoints.iter().find(|truth| truth.wp == 1).unwrap().alt_error_m.unwrap();
    assert_eq!(outcome.result(), FlightResult::Missed);
    assert!((found[0].error_m - flown_m).abs() < 3.0, "said {:.1} m, flown {flown_m:.1} m", found[0].error_m);
    let mut document = PlanDocument { plan: steep, ..PlanDocument::default() };
    document = fix(&document, &Finding::SteepLeg(found[0]), HOME).unwrap().document;
    assert_eq!(document.plan.waypoints.len(), 3, "the leg is slowed");
    assert!(steep_legs(&document.plan, &settings, 10.0).is_empty());
    let outcome = Mission::new(document.plan).set("ap_max_velocity", 1000).fly();
    assert_eq!(outcome.result(), FlightResult::Complete, "{:?}", outcome.end.verdict);
}

#[test]
fn a_leg_too_short_for_any_speed_gets_a_hold_before_it_that_reaches_the_height() {
    let steep = plan(
        "waypoint insert 0 40.4640000 -79.5182000 1500 0 FLYOVER 0 NONE\n\
         waypoint insert 1 40.4640500 -79.5182000 8000 0 FLYOVER 0 NONE\n\
         waypoint insert 2 40.4642500 -79.5182000 8000 0 FLYOVER 0 NONE\n\
         waypoint insert 3 40.4635000 -79.5182000 2000 0 LAND 0 NONE",
    );
    let mut document = PlanDocument { plan: steep, ..PlanDocument::default() };
    let mut edits = 0;
    while let Some(&leg) = steep_legs(&document.plan, &[], 10.0).first() {
        document = fix(&document, &Finding::SteepLeg(leg), HOME).unwrap().document;
        edits += 1;
        assert!(edits < 5, "{:?}", document.plan);
    }
    assert_eq!(document.plan.waypoints[1].kind, WaypointType::Hold, "{:?}", document.plan);
    let outcome = Mission::new(document.plan).fly();
    assert_eq!(outcome.result(), FlightResult::Complete, "{:?}", outcome.end.verdict);
}

#[test]
fn a_hold_waits_for_its_altitude_and_the_estimate_counts_the_wait() {
    let lines = "waypoint insert 0 40.4636500 -79.5182000 9000 0 HOLD 50 NONE\n\
                 waypoint insert 1 40.4636500 -79.5182000 2000 0 LAND 0 NONE";
    let outcome = Mission::new(plan(lines)).fly();
    assert_eq!(outcome.result(), FlightResult::Complete, "{:?}", outcome.end.verdict);
    let held = outcome.end.truth.waypoints[0];
    assert!(held.alt_error_m.is_some_and(|error_m| error_m.abs() < 4.0), "{held:?}");
    let holding_s = outcome.states.iter().find(|(_, state)| *state == NavState::Holding).unwrap().0;
    assert!(holding_s > 15.0, "80 m of climb take longer than {holding_s:.1} s");
    let estimated = estimate(&plan(lines), HOME, &Assumptions::default());
    let begins_s = estimated.legs[0].done_s.unwrap() - 5.0;
    assert!((begins_s - holding_s).abs() < 4.0 && begins_s <= holding_s, "{begins_s} s, flown {holding_s} s");
    assert!(estimated.time_s.unwrap() <= outcome.end.flown_s, "{estimated:?}, {} s", outcome.end.flown_s);
}

#[test]
fn a_craft_that_cannot_climb_to_a_hold_does_not_hang_there() {
    let mut mission = Mission {
        timeout_s: 400.0,
        ..Mission::new(plan(
            "waypoint insert 0 40.4636500 -79.5182000 30000 0 HOLD 50 NONE\n\
         waypoint insert 1 40.4636500 -79.5182000 2000 0 LAND 0 NONE",
        ))
    }
    // The autopilot may use little more than the hover throttle.
    .set("ap_throttle_max", 1510);
    mission.world.airframe = Airframe::iris();
    let outcome = mission.fly();
    assert!(outcome.states.iter().any(|(_, state)| *state == NavState::Holding), "{:?}", outcome.states);
    assert_eq!(outcome.result(), FlightResult::Missed, "{:?}", outcome.end.verdict);
}

#[test]
fn the_review_moves_the_altitude_as_the_altitude_controller_does() {
    let params = Params::default();
    for (from_m, to_m) in [(10.0_f64, 80.0_f64), (60.0, 12.0), (20.0, 1.0), (10.0, 14.0), (30.0, -20.0)] {
        let assumed = Assumptions::default();
        let mut ahead = AltitudeSetpoint::at(from_m);
        let mut controller = AltitudeController::default();
        let mut now =
            AltitudeMeasurement { altitude_m: from_m, climb_mps: 0.0, cos_tilt: 1.0, throttle_us: 1500.0 };
        controller.engage(&now, &params);
        for second in 1..60 {
            for _ in 0..100 {
                // The navigator keeps targets off the ground.
                let target_m = if to_m >= -2.0 || now.altitude_m >= 4.0 {
                    to_m
                } else {
                    to_m.max(controller.setpoint_m() - 0.125)
                };
                now.altitude_m = controller.setpoint_m();
                controller.update(&now, AltitudeTarget::Altitude(target_m), &params, 0.01);
            }
            ahead.run(to_m, &assumed.setpoint_limits(), 1.0);
            let controlled_m = controller.setpoint_m();
            let apart_m = (ahead.altitude_m - controlled_m).abs();
            assert!(
                apart_m < 0.5,
                "{from_m} to {to_m} m, {second} s: {} and {controlled_m} m",
                ahead.altitude_m
            );
        }
    }
}
