//! A random search over missions: plans, airframes, settings, air and faults, with fixed seeds.
//!
//! `cargo test --release --test core -- --ignored --nocapture ten_thousand` flies the whole search.

use crate::missions::dice::{Dice, in_parallel};
use crate::missions::mission::{Mission, assert_none};
use crate::missions::oracle;
use betadeck_core::flight::FlightResult;
use betadeck_core::geo::{LatLon, offset_to_latlon};
use betadeck_core::plan::WaypointRecord;
use betadeck_core::plan::{FlightPlan, HoldPattern, Waypoint, WaypointType, plan_lines};
use betadeck_core::sim::{Airframe, ScheduledFault, Wind};
use betadeck_core::telemetry::{DisarmReason, Turbulence};
use nalgebra::Vector2;

/// The number of missions of the quick search.
const QUICK: u64 = 15;
/// The altitude above which a craft has not landed, m.
const AIRBORNE_M: f64 = 0.3;
/// The ground speed above which a touchdown may turn the craft over, m/s.
const DRIFT_MPS: f64 = 3.0;
const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

fn random_plan(dice: &mut Dice) -> FlightPlan {
    let count = 1 + dice.below(5);
    let ends_in_land = !dice.one_in(3);
    // Short legs between very different altitudes are steep.
    let (reach_m, top_m) = if dice.one_in(4) { (30.0, 12_000.0) } else { (120.0, 5000.0) };
    let waypoints = (0..count).map(|index| {
        let kinds = [WaypointType::Flyover, WaypointType::Flyby, WaypointType::Hold, WaypointType::Flyover];
        let is_land = ends_in_land && index + 1 == count;
        let kind = if is_land { WaypointType::Land } else { dice.pick(&kinds) };
        let place = Vector2::new(dice.between(-reach_m, reach_m), dice.between(-reach_m, reach_m));
        let patterns = [HoldPattern::None, HoldPattern::Orbit, HoldPattern::Figure8];
        let record = WaypointRecord {
            position: offset_to_latlon(HOME, place),
            alt_cm: dice.between(300.0, top_m) as i32,
            speed: if dice.one_in(3) { 0 } else { dice.between(150.0, 1200.0) as u16 },
            duration_ds: if kind == WaypointType::Hold { 50 + dice.below(250) as u16 } else { 0 },
            kind,
            pattern: dice.pick(&patterns),
        };
        Waypoint::from(record)
    });
    FlightPlan { waypoints: waypoints.collect() }
}

/// Returns random settings, each within a range that a pilot might choose.
fn random_settings(dice: &mut Dice) -> Vec<String> {
    let ranges = [
        ("ap_max_angle", 15.0, 55.0),
        ("ap_max_velocity", 300.0, 1500.0),
        ("ap_hover_throttle", 1150.0, 1700.0),
        ("ap_altitude_p", 10.0, 60.0),
        ("ap_altitude_i", 10.0, 50.0),
        ("ap_altitude_d", 15.0, 50.0),
        ("ap_velocity_p", 30.0, 70.0),
        ("ap_position_p", 20.0, 50.0),
        ("ap_landing_descent_rate", 20.0, 150.0),
        ("ap_landing_throttle_threshold", 20.0, 500.0),
        ("ap_landing_altitude_m", 1.0, 10.0),
        ("ap_landing_detection_time", 5.0, 50.0),
        ("ap_waypoint_arrival_radius", 200.0, 1500.0),
        ("ap_waypoint_hold_radius", 100.0, 500.0),
        ("ap_l1_turn_rate", 0.0, 60.0),
        ("ap_yaw_mode", 0.0, 4.9),
        ("ap_hold_orbit_radius", 500.0, 2500.0),
        ("alt_hold_climb_rate", 20.0, 100.0),
        ("ap_throttle_max", 1800.0, 2000.0),
    ];
    ranges
        .iter()
        .filter_map(|(name, low, high)| {
            let value = dice.between(*low, *high) as i64;
            dice.one_in(3).then(|| {
                let modes = ["VELOCITY", "BEARING", "HYBRID", "FIXED", "DAMPENER"];
                match *name {
                    "ap_yaw_mode" => format!("{name} = {}", modes[value as usize]),
                    _ => format!("{name} = {value}"),
                }
            })
        })
        .collect()
}

/// Returns a random fault, and `true` if it may bring the craft down.
fn random_fault(dice: &mut Dice) -> (String, bool) {
    let at = dice.between(0.0, 60.0).round();
    let for_s = dice.between(1.0, 20.0).round();
    let faults = [
        (format!("gps-loss@{at},{for_s}"), false),
        (format!("gps-glitch@{at},{for_s},20@45"), false),
        (format!("rx-loss@{at},{for_s}"), false),
        (format!("baro-drift@{at},{for_s},{}", if dice.one_in(2) { 4 } else { -4 }), true),
        (format!("baro-spike@{at},{for_s},50"), false),
        (format!("gust@{at},,8@{}", dice.below(360)), false),
        (format!("push@{at},,0.5,up"), false),
        (format!("payload@{at},,0.2"), true),
        (format!("motor@{at},,{}:0.85", 1 + dice.below(4)), true),
        (format!("motor@{at},,{}:0", 1 + dice.below(4)), true),
        (format!("mag-bias@{at},,20"), false),
    ];
    dice.pick(&faults)
}

/// Returns an outage or a jump of the GPS, and `false`: neither may bring the craft down by itself.
fn random_gps_fault(dice: &mut Dice) -> (String, bool) {
    let at = dice.between(0.0, 90.0).round();
    let for_s = dice.between(1.0, 25.0).round();
    if dice.one_in(2) {
        (format!("gps-loss@{at},{for_s}"), false)
    } else {
        let (jump_m, from_deg) = (dice.between(5.0, 30.0).round(), dice.below(360));
        (format!("gps-glitch@{at},{for_s},{jump_m}@{from_deg}"), false)
    }
}

/// Flies the mission of a seed and returns its problem, if there is one.
fn complaint(seed: u64) -> Option<String> {
    let dice = &mut Dice(seed);
    let mut mission =
        Mission { takeoff_m: dice.pick(&[0.5, 2.0, 10.0, 20.0]), ..Mission::new(random_plan(dice)) };
    mission.settings = random_settings(dice);
    mission.world.seed = seed;
    mission.world.airframe = dice.pick(&[Airframe::iris(), Airframe::five_inch()]);
    let wind_mps = if dice.one_in(2) { 0.0 } else { dice.between(0.0, 15.0) };
    mission.world.wind = Wind { speed_mps: wind_mps, from_deg: dice.between(0.0, 359.0).floor() };
    if dice.one_in(2) {
        mission.world.turbulence = Turbulence::Light;
    }
    let mut faults = Vec::new();
    if dice.one_in(2) {
        faults.push(random_fault(dice));
    }
    if dice.one_in(3) {
        faults.push(random_gps_fault(dice));
    }
    let parsed = faults.iter().map(|(text, _)| text.parse::<ScheduledFault>().unwrap());
    mission.world.faults.extend(parsed);
    // With the default failsafe procedure a lost link stops the motors in the air.
    mission.settings.push("failsafe_procedure = AUTO-LAND".to_owned());
    let lines: Vec<String> = plan_lines(&mission.plan).collect();
    let Mission { takeoff_m, settings, world, .. } = &mission;
    let reported = format!(
        "seed {seed}: {}, takeoff {takeoff_m} m, wind {}, {:?}, {faults:?}, {settings:?}\n{}",
        world.airframe.name,
        world.wind,
        world.turbulence,
        lines.join("\n")
    );
    let (plan, settings) = (mission.plan.clone(), mission.settings.clone());
    let outcome = mission.fly();
    // Without a fix the craft comes down with the wind's speed over ground.
    let drifts = |fault: &str| fault.starts_with("gps-loss") && wind_mps > DRIFT_MPS;
    // A jump of the position or of the wind in the last metre moves the craft over the ground during the touchdown.
    let jumps = |fault: &str| fault.starts_with("gps-glitch") || fault.starts_with("gust");
    let is_fatal = faults.iter().any(|(_, fatal)| *fatal) || wind_mps > 10.0;
    let may_crash = is_fatal || faults.iter().any(|(text, _)| drifts(text) || jumps(text));
    let problem = if !outcome.is_finite || outcome.result() == FlightResult::Diverged {
        Some("not a number".to_owned())
    } else if outcome.result() == FlightResult::Crashed && !may_crash {
        Some(outcome.end.verdict.reason.clone())
    } else if let Some(denied) = (outcome.result() == FlightResult::Complete)
        .then(|| oracle::denies(&plan, &settings, &outcome))
        .flatten()
    {
        Some(format!("complete, but {denied}"))
    } else {
        outcome
            .disarms
            .iter()
            .find(|(reason, alt_m)| *alt_m > AIRBORNE_M && *reason != DisarmReason::Switch && !is_fatal)
            .map(|(reason, alt_m)| format!("disarmed by {reason} {alt_m:.1} m up"))
    };
    problem.map(|problem| format!("{reported}: {problem}"))
}

/// Flies the missions of these seeds and returns their problems.
fn complaints(seeds: std::ops::Range<u64>) -> Vec<Option<String>> {
    in_parallel(seeds, complaint)
}

#[test]
fn random_missions_never_stop_the_motors_in_the_air_and_crash_only_for_a_cause() {
    assert_none(complaints(0..QUICK));
}

#[test]
#[ignore = "search: 10 000 missions"]
fn ten_thousand_random_missions_never_stop_the_motors_in_the_air_and_crash_only_for_a_cause() {
    let mut found = Vec::new();
    for start in (0..10_000).step_by(250) {
        let new: Vec<_> = complaints(start..start + 250).into_iter().flatten().collect();
        println!("{} missions, {} complaints {}", start + 250, found.len() + new.len(), new.join("\n"));
        found.extend(new.into_iter().map(Some));
    }
    assert_none(found);
}
