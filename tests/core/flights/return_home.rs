//! The return home by command.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, SEEDS, world};
use betadeck_core::plan::WaypointType;
use betadeck_core::sim::Wind;
use betadeck_core::telemetry::{EventKind, NavState, PlanSource};
use betadeck_core::vehicle::VehicleCommand;

fn return_home(seed: u64, wind: Wind) -> Option<String> {
    let (mut world, extra) = world(seed);
    world.wind = wind;
    let windy = wind.speed_mps > 0.0;
    let lines = "set ap_max_velocity = 1000\nwaypoint insert 0 40.4644005 -79.5176105 2000 500 HOLD 0 NONE";
    let mut rig = Rig::new(world, lines, 20.0);
    rig.engaged().until_state(90.0, NavState::Holding).fly(5.0);
    rig.vehicle.apply(&VehicleCommand::ReturnHome).accepted().unwrap();
    let command = rig.t();
    rig.until(150.0, "disarm", |rig| rig.disarmed().is_some());
    let mut checks = Checks::default();
    let (source, plan) = rig.plans().pop().unwrap();
    checks.same("source", source, PlanSource::Rth);
    let kinds: Vec<_> = plan.waypoints.iter().map(|waypoint| waypoint.kind).collect();
    checks.same("types", kinds, vec![WaypointType::Flyover, WaypointType::Land]);
    let home = rig.vehicle.embedded().unwrap().home().unwrap();
    for waypoint in &plan.waypoints {
        checks.same("place", waypoint.position, home);
        let alt = waypoint.altitude.above_home_m();
        checks.within("altitude", alt - rig.at(command).alt, -0.5 - extra.v, 0.5 + extra.v);
    }
    checks.holds(
        "states",
        rig.path().ends_with("APPROACHING 0, ARRIVED 0, APPROACHING 1, ARRIVED 1, LANDING 1, COMPLETE 1"),
    );
    let after: Vec<_> = rig.transitions().into_iter().filter(|entry| entry.t > command + 0.1).collect();
    checks.within("home after", after[0].t - command, 13.0, if windy { 26.0 } else { 22.0 });
    checks.at_most("ARRIVED 0 within", rig.at(after[0].t).from([0.0, 0.0]), 5.0 + extra.h);
    checks.at_most("ARRIVED 1 within", rig.at(after[2].t).from([0.0, 0.0]), 2.0 + extra.h);
    let landing = rig.entered(NavState::Landing, 1);
    let contact = rig.event_at(|kind| matches!(kind, EventKind::Contact { .. })).unwrap();
    checks.within("contact after LANDING", contact - landing, 38.0 - 2.0 * extra.v, 43.0 + 2.0 * extra.v);
    let start = *rig.at(command);
    let length = start.n.hypot(start.e);
    let off = rig.span(command + 5.0, after[0].t).map(|s| ((s.n * start.e - s.e * start.n) / length).abs());
    checks.at_most("off the straight line", greatest(off), 5.0 + extra.h);
    let alt = greatest(rig.span(command, landing).map(|s| (s.alt - 20.0).abs()));
    checks.at_most("altitude", alt, 1.6 + extra.v);
    let last = rig.samples.last().unwrap();
    checks.at_most("touchdown", last.from([0.0, 0.0]), if windy { 1.5 } else { 1.0 } + extra.h);
    checks.same(
        "stored plan",
        rig.vehicle.embedded().unwrap().stored_plan().waypoints[0].kind,
        WaypointType::Hold,
    );
    checks.verdict(&format!("return home, seed {seed}, wind {wind}"), &rig.story())
}

#[test]
fn return_home_flies_straight_and_lands() {
    let winds = [Wind::CALM, "5@45".parse().unwrap()];
    assert_met(SEEDS.into_iter().flat_map(|seed| winds.map(|wind| return_home(seed, wind))));
}
