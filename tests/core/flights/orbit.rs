//! Holding on a circle.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, SEEDS, Sample, world};
use betadeck_core::sim::Wind;
use betadeck_core::telemetry::NavState;

const ORBIT: &str = "
set ap_hold_orbit_radius = 1000
set ap_max_turn_rate = 3
waypoint insert 0 40.4640403 -79.5182000 2000 500 HOLD 0 ORBIT";

fn ring(
    checks: &mut Checks,
    rig: &Rig,
    from: f64,
    to: f64,
    tolerance: f64,
    extra: crate::flights::rig::Allowance,
) {
    let centre = rig.waypoint(0);
    let start = rig.entered(NavState::Orbiting, 0);
    let azimuth = |s: &Sample| (s.e - centre[1]).atan2(s.n - centre[0]).to_degrees();
    let span = || rig.span(from, to);
    checks.at_most("radius", greatest(span().map(|s| (s.from(centre) - 10.0).abs())), tolerance + extra.h);
    checks.at_most("altitude", greatest(span().map(|s| (s.alt - 20.0).abs())), 0.5 + extra.v);
    let lag = |s: &Sample| {
        let error = 3.0 * (s.t - start) - azimuth(s);
        (error + 180.0).rem_euclid(360.0) - 180.0
    };
    checks.at_most("lag", greatest(span().map(|s| lag(s).abs())), 10.0 + extra.angle);
}

fn endless(seed: u64, wind: Wind) -> Option<String> {
    let (mut world, extra) = world(seed);
    world.wind = wind;
    let windy = wind.speed_mps > 0.0;
    let mut rig = Rig::new(world, ORBIT, 20.0);
    rig.engaged().fly(180.0);
    let mut checks = Checks::default();
    checks.same("states", rig.path().as_str(), "APPROACHING 0, ARRIVED 0, HOLDING 0, ORBITING 0");
    let arrived = rig.entered(NavState::Arrived, 0);
    let orbiting = rig.entered(NavState::Orbiting, 0);
    checks.within("ARRIVED at", arrived, 12.0, 22.0);
    checks.within("ORBITING after", orbiting - arrived, 0.019, 0.021);
    let place = rig.waypoint(0);
    checks.at_most("arrival", rig.at(arrived).from(place), 2.0 + extra.h);
    ring(&mut checks, &rig, orbiting + 20.0, 180.0, if windy { 1.0 } else { 0.6 }, extra);
    if !windy && seed == 0 {
        let speed = greatest(rig.span(orbiting + 20.0, 180.0).map(|s| (s.speed() - 0.524).abs()));
        checks.at_most("speed", speed, 0.05);
    }
    let north: Vec<f64> = rig
        .samples
        .windows(2)
        .filter(|pair| pair[0].t > orbiting + 20.0)
        .filter(|pair| pair[0].n > place[0] && pair[0].e < place[1] && pair[1].e >= place[1])
        .map(|pair| pair[1].t)
        .collect();
    checks.within("passes of north", north.len() as f64, 1.0, 2.0);
    let east: Vec<f64> = rig
        .samples
        .windows(2)
        .filter(|pair| pair[0].t > orbiting + 20.0)
        .filter(|pair| pair[0].e > place[1] && pair[0].n > place[0] && pair[1].n <= place[0])
        .map(|pair| pair[1].t)
        .collect();
    if let [first, second, ..] = east[..] {
        checks.within("lap", second - first, 119.0 - extra.h, 121.0 + extra.h);
    } else {
        checks.holds("two passes of east", false);
    }
    checks.verdict(&format!("orbit, seed {seed}, wind {wind}"), &rig.story())
}

#[test]
fn orbit_keeps_its_ring_and_its_pace() {
    let winds = [Wind::CALM, "5@270".parse().unwrap()];
    assert_met(SEEDS.into_iter().flat_map(|seed| winds.map(|wind| endless(seed, wind))));
}

fn timed(seed: u64) -> Option<String> {
    let (world, _) = world(seed);
    let lines = ORBIT.replace("HOLD 0", "HOLD 600")
        + "\nwaypoint insert 1 40.4636801 -79.5172568 2000 500 FLYOVER 0 ORBIT";
    let mut rig = Rig::new(world, &lines, 20.0);
    rig.engaged().until_state(180.0, NavState::Complete);
    let mut checks = Checks::default();
    let holding = rig.entered(NavState::Holding, 0);
    checks.within("next leg after", rig.entered(NavState::Approaching, 1) - holding, 59.95, 60.05);
    let left: Vec<f64> = rig.span(holding, holding + 59.9).map(|s| s.hold_remaining_s).collect();
    checks.same("hold remaining begins", left.first().copied(), Some(60.0));
    checks.holds("hold remaining falls", left.windows(2).all(|pair| pair[1] <= pair[0]));
    checks.at_most("hold remaining ends", *left.last().unwrap(), 0.1);
    checks.verdict(&format!("timed orbit, seed {seed}"), &rig.story())
}

#[test]
fn orbit_ends_after_its_time() {
    assert_met([timed(0), timed(1)]);
}

/// Flies an orbit whose rate is limited by the speed or by the tilt: radius, m; rate, °/s; `ap_max_velocity`,
/// cm/s.
fn fast(radius_m: f64, rate_dps: u32, speed_cms: u32, holds: &str) -> Option<String> {
    let (world, _) = world(0);
    let lines = format!(
        "set ap_hold_orbit_radius = {:.0}\nset ap_max_turn_rate = {rate_dps}\nset ap_max_velocity = {speed_cms}\n{holds}\n\
         waypoint insert 0 40.4636400 -79.5182000 2000 0 HOLD 0 ORBIT",
        100.0 * radius_m
    );
    let mut rig = Rig::new(world, &lines, 20.0);
    rig.engaged().fly(180.0);
    let mut checks = Checks::default();
    let centre = rig.waypoint(0);
    let radii: Vec<f64> = rig.span(90.0, 180.0).map(|s| s.from(centre)).collect();
    checks.within("least radius", -greatest(radii.iter().map(|r| -r)), 0.95 * radius_m, 1.05 * radius_m);
    checks.within("greatest radius", greatest(radii.iter().copied()), 0.95 * radius_m, 1.05 * radius_m);
    let speed = greatest(rig.span(90.0, 180.0).map(Sample::speed));
    checks.at_most("speed", speed, 1.15 * f64::from(speed_cms) / 100.0);
    checks.verdict(&format!("{radius_m} m at {rate_dps} deg/s, {speed_cms} cm/s {holds}"), &rig.story())
}

#[test]
fn a_fast_orbit_keeps_its_radius() {
    assert_met([
        fast(3.0, 30, 500, ""),
        fast(3.0, 90, 500, ""),
        fast(10.0, 20, 500, ""),
        fast(10.0, 30, 500, ""),
        fast(10.0, 60, 1000, ""),
        fast(10.0, 60, 1000, "set ap_max_angle = 50"),
        fast(20.0, 20, 500, ""),
        fast(50.0, 10, 1000, ""),
        fast(10.0, 30, 500, "set ap_velocity_control_enable = OFF"),
    ]);
}
