//! Following a line in crosswind.

use crate::flights::checks::{Checks, assert_met, greatest, mean};
use crate::flights::rig::{Rig, SEEDS, Sample, world};
use betadeck_core::sim::{Fault, Wind, WorldCommand};
use betadeck_core::telemetry::{NavState, Turbulence};
use betadeck_core::vehicle::VehicleCommand;

const LINE: &str = "
waypoint insert 0 40.4635901 -79.5182000 2000 500 FLYOVER 0 ORBIT
waypoint insert 1 40.4653911 -79.5182000 2000 500 FLYOVER 0 ORBIT";

struct Air {
    wind: &'static str,
    rough: bool,
    /// The greatest and the mean cross-track error.
    xte: (f64, f64),
    /// Roll and pitch (nose up) in the steady part, and their tolerance.
    tilt: Option<(f64, f64, f64)>,
}

const AIRS: [Air; 4] = [
    Air { wind: "calm", rough: false, xte: (0.5, 0.5), tilt: None },
    Air { wind: "5@270", rough: false, xte: (2.0, 0.8), tilt: Some((-7.8, -7.9, 1.5)) },
    Air { wind: "8@270", rough: false, xte: (3.0, 1.2), tilt: Some((-13.9, -8.0, 2.0)) },
    Air { wind: "5@270", rough: true, xte: (4.0, 1.5), tilt: None },
];

fn line(seed: u64, air: &Air) -> Option<String> {
    let (mut world, extra) = world(seed);
    world.wind = air.wind.parse().unwrap();
    if air.rough {
        world.gust_mps = 2.0;
        world.turbulence = Turbulence::Light;
    }
    let mut rig = Rig::new(world, LINE, 20.0);
    rig.engaged().until_state(90.0, NavState::Complete);
    let mut checks = Checks::default();
    let complete = rig.entered(NavState::Complete, 1);
    checks.within("COMPLETE at", complete, 40.0, 52.0);
    let leg: Vec<_> =
        rig.span(0.0, complete).filter(|s| s.wp == 1 && s.n > 40.0 && s.n < 200.0).copied().collect();
    let xte = || leg.iter().map(|s| s.e);
    checks.at_most("cross-track", greatest(xte().map(f64::abs)), air.xte.0 + extra.h);
    if air.rough {
        let rms = mean(xte().map(|e| e * e)).sqrt();
        checks.at_most("cross-track rms", rms, air.xte.1 + extra.h);
    } else {
        checks.at_most("cross-track mean", mean(xte()).abs(), air.xte.1 + extra.h);
        let speeds = || leg.iter().filter(|s| s.n > 60.0).map(Sample::speed);
        checks.within("slowest", -greatest(speeds().map(|v| -v)), 4.75 - extra.speed, 5.25 + extra.speed);
        checks.at_most("fastest", greatest(speeds()), 5.25 + extra.speed);
    }
    checks.within("speed", mean(leg.iter().map(Sample::speed)), 4.75 - extra.speed, 5.25 + extra.speed);
    if let Some((roll, pitch, tolerance)) = air.tilt {
        let steady = || leg.iter().filter(|s| s.n > 100.0);
        let tolerance = tolerance + extra.angle;
        checks.within("roll", mean(steady().map(|s| s.roll)), roll - tolerance, roll + tolerance);
        checks.within("pitch", mean(steady().map(|s| s.pitch)), pitch - tolerance, pitch + tolerance);
        let heading = steady().map(|s| ((s.heading + 180.0).rem_euclid(360.0) - 180.0).abs());
        checks.at_most("nose", greatest(heading), 5.0 + extra.angle);
    }
    checks.at_most("lean", greatest(rig.span(0.0, 1e9).map(Sample::tilt)), 27.0 + extra.angle);
    checks.verdict(
        &format!("line, seed {seed}, {}{}", air.wind, if air.rough { " rough" } else { "" }),
        &rig.story(),
    )
}

#[test]
fn line_is_followed_in_calm_and_crosswind() {
    assert_met(SEEDS.into_iter().flat_map(|seed| AIRS.iter().map(move |air| line(seed, air))));
}

#[test]
fn displaced_craft_comes_back_to_the_line() {
    let (mut world, _) = world(0);
    world.wind = "5@270".parse::<Wind>().unwrap();
    let mut rig = Rig::new(world, LINE, 20.0);
    rig.engaged().until(60.0, "70 m north", |rig| rig.samples.last().is_some_and(|s| s.n > 70.0));
    let (from, n) = (rig.t(), rig.samples.last().unwrap().n);
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::Teleport([0.0, 20.0, 0.0]), None)))
        .accepted()
        .unwrap();
    rig.until_state(90.0, NavState::Complete);
    let mut checks = Checks::default();
    let back = greatest(rig.span(from, 1e9).filter(|s| s.e > 2.0).map(|s| s.t)) - from;
    checks.at_most("back within 2 m after", back, 14.0);
    let along = greatest(rig.span(from, 1e9).filter(|s| s.e > 2.0).map(|s| s.n)) - n;
    checks.at_most("back within 2 m along", along, 60.0);
    checks.at_most("undershoot", greatest(rig.span(from, 1e9).map(|s| -s.e)), 2.0);
    assert_met([checks.verdict("teleport", &rig.story())]);
}

#[test]
fn without_l1_it_heads_for_the_waypoint() {
    let (mut world, _) = world(0);
    world.wind = "5@270".parse::<Wind>().unwrap();
    let mut rig = Rig::new(world, &format!("{LINE}\nset ap_l1_enable = OFF"), 20.0);
    rig.engaged().until(60.0, "70 m north", |rig| rig.samples.last().is_some_and(|s| s.n > 70.0));
    rig.vehicle
        .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::Teleport([0.0, 20.0, 0.0]), None)))
        .accepted()
        .unwrap();
    rig.tick();
    let start = *rig.samples.last().unwrap();
    rig.until(60.0, "half way", |rig| rig.samples.last().is_some_and(|s| s.n > start.n + 70.0));
    let half = rig.samples.last().unwrap();
    assert!((half.e - 10.0).abs() <= 3.0, "{}", half.e);
}
