//! Missions over several waypoints: basic navigation, and the guide's square from boot to touchdown.

use crate::flights::checks::{Checks, assert_met, greatest, mean};
use crate::flights::rig::{Rig, SEEDS, Sample, world};
use betadeck_core::telemetry::{DisarmReason, Mode, NavState};

const TRIANGLE: &str = "
waypoint insert 0 40.4640403 -79.5182000 2000 500 FLYOVER 0 ORBIT
waypoint insert 1 40.4640403 -79.5174926 2000 500 FLYOVER 0 ORBIT
waypoint insert 2 40.4635000 -79.5174926 2000 500 FLYOVER 0 ORBIT";

const SQUARE: &str = "
waypoint clear
waypoint insert 0 40.4640000 -79.5175000 5000 0 FLYOVER 0 ORBIT
waypoint insert 1 40.4630000 -79.5175000 5000 0 FLYBY 0 ORBIT
waypoint insert 2 40.4630000 -79.5190000 5000 0 HOLD 300 ORBIT
waypoint insert 3 40.4640000 -79.5190000 5000 0 LAND 0 ORBIT";

fn basic_navigation(seed: u64) -> Option<String> {
    let (world, extra) = world(seed);
    let mut rig = Rig::new(world, TRIANGLE, 20.0);
    rig.engaged().until_state(120.0, NavState::Complete).fly(45.0);
    let mut checks = Checks::default();
    checks.same(
        "states",
        rig.path().as_str(),
        "APPROACHING 0, ARRIVED 0, APPROACHING 1, ARRIVED 1, APPROACHING 2, ARRIVED 2, COMPLETE 2",
    );
    let arrived = [0, 1, 2].map(|wp| rig.entered(NavState::Arrived, wp));
    let complete = rig.entered(NavState::Complete, 2);
    checks.within("ARRIVED 0 at", arrived[0], 12.5, 18.0);
    checks.within("ARRIVED 1 at", arrived[1], 25.0, 36.0);
    checks.within("COMPLETE at", complete, 36.0, 54.0);
    let place = [0, 1, 2].map(|wp| rig.waypoint(wp));
    let (first, second, third) = (*rig.at(arrived[0]), *rig.at(arrived[1]), *rig.at(arrived[2]));
    checks.within("behind the plane of 0", first.n - place[0][0], 0.0 - extra.h, 0.3 + extra.h);
    checks.within("beside 0", first.e - place[0][1], -1.0 - extra.h, 1.0 + extra.h);
    checks.within("behind the plane of 1", second.e - place[1][1], 0.0 - extra.h, 0.3 + extra.h);
    checks.within("beside 1", second.n - place[1][0], -1.0 - extra.h, 1.0 + extra.h);
    checks.within("before 2", third.from(place[2]), 4.5 - extra.h, 5.0 + extra.h);
    let starts = [0.0, arrived[0], arrived[1]];
    let ends = [arrived[0], arrived[1], arrived[2]];
    for leg in 0..3 {
        let third = (ends[leg] - starts[leg]) / 3.0;
        let cruise = mean(rig.span(starts[leg] + third, ends[leg] - third).map(Sample::speed));
        checks.within(&format!("cruise {leg}"), cruise, 4.75 - extra.speed, 5.25 + extra.speed);
        let samples: Vec<_> = rig.span(starts[leg] + 4.0, ends[leg]).step_by(10).collect();
        let falling = samples.windows(2).filter(|pair| pair[1].distance < pair[0].distance).count();
        let share = falling as f64 / (samples.len() - 1) as f64;
        checks.within(&format!("distance falls on leg {leg}"), share, 0.98, 1.0);
    }
    checks.at_most("top speed", greatest(rig.span(0.0, 1e9).map(Sample::speed)), 5.75 + extra.speed);
    let parked = rig.span(complete + 12.0, complete + 42.0).map(|s| s.from(place[2]));
    checks.at_most("parked", greatest(parked), 1.0 + extra.h);
    let after_start = greatest(rig.span(12.0, complete).map(|s| (s.alt - 20.0).abs()));
    checks.at_most("altitude", after_start, 0.7 + extra.v);
    checks.at_most(
        "altitude at first",
        greatest(rig.span(0.0, 12.0).map(|s| (s.alt - 20.0).abs())),
        1.6 + extra.v,
    );
    checks.at_most("lean", greatest(rig.span(0.0, 1e9).map(Sample::tilt)), 27.0 + extra.angle);
    let last = rig.samples.last().unwrap();
    checks.holds("armed, AUTOPILOT on", last.armed && last.modes.has(Mode::Autopilot));
    checks.verdict(&format!("basic navigation, seed {seed}"), &rig.story())
}

#[test]
fn basic_navigation_visits_each_waypoint_in_order() {
    assert_met(SEEDS.map(basic_navigation));
}

fn square(seed: u64) -> Option<String> {
    let (world, extra) = world(seed);
    let mut rig = Rig::new(world, SQUARE, 10.0);
    rig.engaged().until(300.0, "disarm", |rig| rig.disarmed().is_some()).fly(10.0);
    let mut checks = Checks::default();
    checks.same(
        "states",
        rig.path().as_str(),
        "APPROACHING 0, ARRIVED 0, APPROACHING 1, ARRIVED 1, APPROACHING 2, ARRIVED 2, HOLDING 2, ORBITING 2, \
         APPROACHING 3, ARRIVED 3, LANDING 3, COMPLETE 3",
    );
    let (at, reason) = rig.disarmed().unwrap();
    checks.same("reason", reason, DisarmReason::Landing);
    let place = rig.waypoint(3);
    checks.at_most("touchdown", rig.at(at).from(place), 1.0 + extra.h);
    let climb = greatest(rig.span(0.0, rig.entered(NavState::Landing, 3)).map(|s| s.alt - 50.0));
    checks.at_most("altitude overshoot", climb, 1.5 + extra.v);
    checks.at_most("lean", greatest(rig.span(0.0, 1e9).map(Sample::tilt)), 27.0 + extra.angle);
    checks.verdict(&format!("square, seed {seed}"), &rig.story())
}

#[test]
fn guides_square_lands_at_its_last_waypoint() {
    assert_met(SEEDS.map(square));
}
