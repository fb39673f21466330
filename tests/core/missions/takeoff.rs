//! Every plan takes off on every airframe, with any hover throttle and to any height.

use crate::missions::mission::{Mission, assert_none};
use betadeck_core::flight::FlightResult;
use betadeck_core::plan::builtin::PLANS;
use betadeck_core::plan::format::{Format, parse};
use betadeck_core::sim::Airframe;

const HEIGHTS_M: [f64; 6] = [0.5, 1.0, 2.0, 4.0, 10.0, 30.0];

/// Flies a built-in plan after a climb to `takeoff_m` and returns its problem, if there is one.
fn complaint(name: &str, airframe: Airframe, takeoff_m: f64, seed: u64) -> Option<String> {
    let builtin = PLANS.iter().find(|plan| plan.name == name).unwrap();
    let file = parse(name, builtin.text, Format::Toml).unwrap();
    let mut mission = Mission { takeoff_m, ..Mission::new(file.plan) };
    mission.settings = file.settings;
    mission.world.airframe = airframe.clone();
    mission.world.seed = seed;
    let outcome = mission.fly();
    let over_m = outcome.climbed_m - takeoff_m;
    let reported = (outcome.result() != FlightResult::Complete)
        .then(|| format!("{:?}: {}", outcome.result(), outcome.end.verdict.reason))
        .or_else(|| (over_m > 0.5 + 0.05 * takeoff_m).then(|| format!("climbed {over_m:.2} m too high")));
    reported
        .map(|reported| format!("{name}, {}, takeoff {takeoff_m} m, seed {seed}: {reported}", airframe.name))
}

/// Flies every `n`-th of all take-offs with these seeds.
fn every(n: usize, seeds: impl Fn(usize) -> Vec<u64>) -> impl Iterator<Item = Option<String>> {
    let airframes = [Airframe::iris(), Airframe::five_inch()];
    let mut rows = Vec::new();
    let mut number = 0;
    for plan in PLANS {
        for airframe in &airframes {
            for height in HEIGHTS_M {
                number += 1;
                if number % n != 0 {
                    continue;
                }
                for seed in seeds(number) {
                    rows.push(complaint(plan.name, airframe.clone(), height, seed));
                }
            }
        }
    }
    rows.into_iter()
}

#[test]
fn every_built_in_plan_takes_off_to_any_height_on_both_airframes() {
    assert_none(every(7, |row| vec![row as u64 % 5 + 1]));
}

#[test]
#[ignore = "search: 660 flights"]
fn every_built_in_plan_takes_off_to_any_height_on_both_airframes_with_five_seeds() {
    assert_none(every(1, |_| (1..=5).collect()));
}

#[test]
fn a_wrong_hover_throttle_does_not_matter_before_the_ground_is_left_nor_after() {
    let airframes = [Airframe::iris(), Airframe::five_inch()];
    let rows = airframes.into_iter().flat_map(|airframe| {
        [0, 1150, 1275, 1500, 1700].into_iter().flat_map(move |hover_us| {
            let airframe = airframe.clone();
            [0.0, 2.0, 10.0].map(move |takeoff_m| {
                let plan = crate::missions::mission::plan(
                    "waypoint insert 0 40.4635000 -79.5182000 1000 500 HOLD 150 NONE\n\
                     waypoint insert 1 40.4635000 -79.5182000 1000 500 LAND 0 NONE",
                );
                let mut mission =
                    Mission { takeoff_m, ..Mission::new(plan) }.set("ap_hover_throttle", hover_us);
                mission.world.airframe = airframe.clone();
                mission.world.seed = 1 + u64::from(hover_us % 7_u16);
                if takeoff_m == 0.0 {
                    mission = mission.set("ap_min_nav_altitude_m", 5);
                }
                let outcome = mission.fly();
                let over_m = outcome.climbed_m - takeoff_m;
                let bad = outcome.result() != FlightResult::Complete
                    || takeoff_m > 0.0 && over_m > 0.5 + 0.05 * takeoff_m;
                bad.then(|| {
                    format!(
                        "{}, hover {hover_us}, takeoff {takeoff_m}: {}, {over_m:.2} m too high",
                        airframe.name, outcome.end.verdict.reason
                    )
                })
            })
        })
    });
    assert_none(rows.collect::<Vec<_>>());
}
