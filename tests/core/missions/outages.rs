//! Loss of the fix in each phase of a mission: a flight is never `complete` if its true path contradicts it.
//!
//! `cargo test --release --test core -- --ignored --nocapture outages` flies all of them.

use betadeck_core::flight::FlightResult;
use betadeck_core::geo::LatLon;
use betadeck_core::plan::FlightPlan;
use betadeck_core::sim::{ScheduledFault, Wind};
use betadeck_core::telemetry::NavState;

use crate::missions::dice::{Dice, in_parallel};
use crate::missions::mission::{Mission, assert_none, plan};
use crate::missions::oracle;

/// Every phase in one flight: a climb on the spot, legs, a hold, both patterns, a wait and a landing.
const ALL_PHASES: &str = "waypoint insert 0 40.4637702 -79.5182000 2000 600 FLYOVER 0 NONE\n\
                          waypoint insert 1 40.4639500 -79.5179000 2500 600 HOLD 80 NONE\n\
                          waypoint insert 2 40.4639500 -79.5176000 2000 600 HOLD 150 ORBIT\n\
                          waypoint insert 3 40.4636500 -79.5176000 1800 600 FLYBY 0 NONE\n\
                          waypoint insert 4 40.4634500 -79.5178000 2200 600 HOLD 150 FIGURE8\n\
                          waypoint insert 5 40.4637702 -79.5182000 2000 600 LAND 50 NONE";
/// A landing far from home, during which the craft drifts with the wind in an outage.
const LAND: &str = "waypoint insert 0 40.4637702 -79.5182000 2000 0 LAND 0 NONE";
/// A mission that ends parked in the air.
const PARK: &str = "waypoint insert 0 40.4637702 -79.5182000 2000 600 FLYOVER 0 NONE\n\
                    waypoint insert 1 40.4639500 -79.5179000 2500 600 HOLD 60 NONE";

/// The plans, each with the state in which the fix is lost. The first APPROACHING begins with a climb on the spot.
const PHASES: [(&str, NavState); 10] = [
    (ALL_PHASES, NavState::Approaching),
    (ALL_PHASES, NavState::Holding),
    (ALL_PHASES, NavState::Orbiting),
    (ALL_PHASES, NavState::Figure8),
    (ALL_PHASES, NavState::Landing),
    (LAND, NavState::Approaching),
    (LAND, NavState::Landing),
    (PARK, NavState::Approaching),
    (PARK, NavState::Holding),
    (PARK, NavState::Complete),
];

/// The result of a flight with an outage.
#[derive(Debug, Clone, PartialEq)]
struct Flown {
    phase: NavState,
    result: FlightResult,
    /// The problem with the result, if there is one.
    problem: Option<String>,
}

fn mission(lines: &str, dice: &mut Dice, seed: u64) -> (Mission, FlightPlan) {
    let plan = plan(lines);
    let takeoff_m = dice.pick(&[2.0, 10.0, 20.0]);
    let mut mission = Mission { takeoff_m, timeout_s: 600.0, ..Mission::new(plan.clone()) }
        .set("ap_hover_throttle", 1500)
        .set("ap_max_turn_rate", 20);
    mission.world.seed = seed;
    let speed_mps = if dice.one_in(4) { 0.0 } else { dice.between(2.0, 9.0) };
    mission.world.wind = Wind { speed_mps, from_deg: dice.between(0.0, 359.0).floor() };
    (mission, plan)
}

/// Flies the mission of a seed twice: without an outage to find the time of the phase, then with an outage in it.
fn fly(seed: u64) -> Flown {
    let (lines, phase) = PHASES[(seed % PHASES.len() as u64) as usize];
    let (calm, _) = mission(lines, &mut Dice(seed), seed);
    let dice = &mut Dice(seed);
    let (mut mission, plan) = mission(lines, dice, seed);
    let undisturbed = calm.fly();
    let spans: Vec<(f64, f64)> = undisturbed
        .states
        .iter()
        .zip(undisturbed.states[1..].iter().map(|(until, _)| *until).chain([undisturbed.end.flown_s]))
        .filter(|((from, state), until)| *state == phase && *until > *from + 0.5)
        .map(|((from, _), until)| (*from, until))
        .collect();
    assert!(!spans.is_empty(), "seed {seed}: no {phase} in {:?}", undisturbed.states);
    let (from, until) = dice.pick(&spans);
    let (at, for_s) = (dice.between(from, until), dice.between(1.0, 25.0));
    let fault = format!("gps-loss@{at:.2},{for_s:.1}");
    mission.world.faults.push(fault.parse::<ScheduledFault>().unwrap());
    let reported = format!(
        "seed {seed}: {fault} in {phase}, wind {}, takeoff {}",
        mission.world.wind, mission.takeoff_m
    );
    let (settings, wind) = (mission.settings.clone(), mission.world.wind);
    let outcome = mission.fly();
    let result = outcome.result();
    let problem = match result {
        FlightResult::Complete => oracle::denies(&plan, &settings, &outcome),
        FlightResult::Diverged | FlightResult::Timeout => Some(outcome.end.verdict.reason.clone()),
        // Without a fix the craft comes down with the wind's speed over ground.
        FlightResult::Crashed if wind.speed_mps < 3.0 => Some(outcome.end.verdict.reason.clone()),
        _ => None,
    };
    Flown {
        phase,
        result,
        problem: problem.map(|problem| format!("{reported}: {result} although {problem}")),
    }
}

fn check(flown: Vec<Flown>) {
    for phase in [
        NavState::Approaching,
        NavState::Holding,
        NavState::Orbiting,
        NavState::Figure8,
        NavState::Landing,
        NavState::Complete,
    ] {
        let of_phase: Vec<_> = flown.iter().filter(|flight| flight.phase == phase).collect();
        let count = |result| of_phase.iter().filter(|flight| flight.result == result).count();
        println!(
            "{phase}: {} flights, {} complete, {} missed, {} landed, {} crashed",
            of_phase.len(),
            count(FlightResult::Complete),
            count(FlightResult::Missed),
            count(FlightResult::Landed),
            count(FlightResult::Crashed),
        );
    }
    assert_none(flown.into_iter().map(|flight| flight.problem));
}

#[test]
fn a_mission_with_an_outage_in_any_phase_is_complete_only_where_the_truth_agrees() {
    check(in_parallel(0..8, fly));
}

#[test]
#[ignore = "search: 400 flights"]
fn two_hundred_outages_in_every_phase_are_complete_only_where_the_truth_agrees() {
    check(in_parallel(0..400, fly));
}

/// Returns the plan and the mission of [`LAND`], with the fix lost at `at_s` for 12 s in a wind of 7 m/s.
fn blown_landing(at_s: f64) -> (FlightPlan, Mission) {
    let plan = plan(LAND);
    let mut mission = Mission { takeoff_m: 20.0, ..Mission::new(plan.clone()) };
    mission.world.wind = Wind { speed_mps: 7.0, from_deg: 200.0 };
    mission.world.faults.push(format!("gps-loss@{at_s},12").parse::<ScheduledFault>().unwrap());
    (plan, mission)
}

#[test]
fn a_landing_that_the_wind_took_away_in_an_outage_is_not_complete() {
    let (plan, mission) = blown_landing(30.0);
    let outcome = mission.fly();
    let land = outcome.end.truth.waypoints[0];
    let at: LatLon = plan.waypoints[0].position;
    let enu = outcome.frame.to_enu(at.lat_deg(), at.lon_deg(), outcome.frame.alt_amsl_m);
    let away_m = (outcome.path.last().unwrap().ne - nalgebra::Vector2::new(enu.y, enu.x)).norm();
    assert!(away_m > 30.0, "it lands {away_m} m away");
    assert_eq!(outcome.result(), FlightResult::Missed, "{:?}", outcome.end.verdict);
    assert!((land.miss_m - away_m).abs() < 1.0, "{land:?}, {away_m} m away");
    let reason = &outcome.end.verdict.reason;
    assert!(reason.contains("touched down") && reason.contains("from waypoint 0 (LAND)"), "{reason}");
}
