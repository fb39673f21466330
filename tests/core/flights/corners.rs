//! FLYBY cuts corners, FLYOVER overshoots them.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, SEEDS, Sample, world};
use betadeck_core::telemetry::NavState;

const PLACES: [&str; 6] = [
    "40.4640403 -79.5182000",
    "40.4640403 -79.5174926",
    "40.4645807 -79.5174926",
    "40.4645807 -79.5167851",
    "40.4651210 -79.5167851",
    "40.4651210 -79.5160777",
];

fn zigzag(kinds: [&str; 6]) -> String {
    PLACES
        .iter()
        .zip(kinds)
        .enumerate()
        .map(|(index, (place, kind))| format!("waypoint insert {index} {place} 2000 500 {kind} 0 ORBIT\n"))
        .collect()
}

const MIXED: [&str; 6] = ["FLYBY", "FLYOVER", "FLYBY", "FLYOVER", "FLYBY", "FLYOVER"];

/// Returns the distances of a sample along and right of the line from `a` to `b`.
fn along_right(sample: &Sample, a: [f64; 2], b: [f64; 2]) -> (f64, f64) {
    let (dn, de) = (b[0] - a[0], b[1] - a[1]);
    let length = dn.hypot(de);
    let (un, ue) = (dn / length, de / length);
    let (n, e) = (sample.n - a[0], sample.e - a[1]);
    (n * un + e * ue, e * un - n * ue)
}

fn corner_checks(seed: u64) -> Option<String> {
    let (world, extra) = world(seed);
    let mut rig = Rig::new(world, &zigzag(MIXED), 20.0);
    rig.engaged().until_state(150.0, NavState::Complete);
    let mut checks = Checks::default();
    let places: Vec<[f64; 2]> = (0..6).map(|index| rig.waypoint(index)).collect();
    let mut overshoots = [0.0, 0.0];
    for corner in 0..5 {
        let flyby = corner % 2 == 0;
        let name = |what: &str| format!("{} {corner} {what}", MIXED[corner]);
        let before = if corner == 0 { [0.0, 0.0] } else { places[corner - 1] };
        let (here, next) = (places[corner], places[corner + 1]);
        let arrived = rig.entered(NavState::Arrived, corner as u8);
        let sample = rig.at(arrived);
        let near: Vec<&Sample> = rig.span(arrived - 6.0, arrived + 12.0).collect();
        let closest = near.iter().map(|s| s.from(here)).fold(f64::INFINITY, f64::min);
        let overshoot = greatest(near.iter().map(|s| along_right(s, before, here).0)) - 60.0;
        if flyby {
            let v = sample.speed();
            let radius = v * v / (9.8 * 25_f64.to_radians().tan());
            checks.within(
                &name("switches at"),
                sample.from(here) - radius,
                -0.3 - extra.h - 2.5 * extra.speed,
                0.3 + extra.h + 2.5 * extra.speed,
            );
            checks.within(&name("closest"), closest, 1.0 - extra.h, 3.5 + extra.h);
            checks.at_most(&name("overshoot"), overshoot, 2.5 + extra.h);
        } else {
            checks.at_most(&name("closest"), closest, 1.0 + extra.h);
            checks.within(&name("overshoot"), overshoot, 2.0 - extra.h, 6.0 + extra.h);
        }
        overshoots[usize::from(!flyby)] += overshoot.max(0.0);
        // The last point more than 1.5 m off the new leg must be before this distance along it.
        let limit = if flyby { 30.0 } else { 40.0 };
        let leg_end = rig.entered(NavState::Arrived, corner as u8 + 1);
        let last_off = rig
            .span(arrived, leg_end)
            .map(|s| along_right(s, here, next))
            .filter(|(_, right)| right.abs() > 1.5 + extra.h)
            .map(|(along, _)| along);
        checks.at_most(&name("back on the leg by"), greatest(last_off), limit);
    }
    checks.within("FLYOVER against FLYBY", overshoots[1] / overshoots[0].max(0.01), 2.0, f64::INFINITY);
    checks.within("COMPLETE at", rig.entered(NavState::Complete, 5), 70.0, 105.0);
    let tilt = greatest(rig.span(0.0, 1e9).map(Sample::tilt));
    checks.at_most("lean", tilt, 27.0 + extra.angle);
    checks.at_most("altitude", greatest(rig.span(12.0, 1e9).map(|s| (s.alt - 20.0).abs())), 0.7 + extra.v);
    checks.verdict(&format!("corners, seed {seed}"), &rig.story())
}

#[test]
fn flyby_cuts_inside_and_flyover_overshoots() {
    assert_met(SEEDS.map(corner_checks));
}

#[test]
fn all_flyby_is_faster_than_all_flyover() {
    let time = |kind| {
        let mut rig = Rig::new(world(0).0, &zigzag([kind; 6]), 20.0);
        rig.engaged().until_state(150.0, NavState::Complete);
        rig.entered(NavState::Complete, 5)
    };
    let gain = time("FLYOVER") - time("FLYBY");
    assert!((0.5..=10.0).contains(&gain), "{gain}");
}
