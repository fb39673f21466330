//! Every landing ends on the ground, disarmed and upright, whatever the barometer, thresholds and receiver
//! do.

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, Sample, world};
use betadeck_core::sim::{Fault, Wind, WorldCommand};
use betadeck_core::telemetry::{DisarmReason, Mode, NavState};
use betadeck_core::vehicle::VehicleCommand;

const LAND: &str = "waypoint insert 0 40.4635000 -79.5182000 2000 0 LAND 0 NONE";

fn fault(rig: &mut Rig, name: &str, value: &str, for_s: Option<f64>) {
    let command = WorldCommand::FaultOn(Fault::parse(name, Some(value)).unwrap(), for_s);
    rig.vehicle.apply(&VehicleCommand::from(command)).accepted().unwrap();
}

/// Returns a craft that has begun its landing from 20 m.
fn landing(seed: u64, lines: &str) -> Rig {
    let mut rig = Rig::new(world(seed).0, &format!("{lines}\n{LAND}"), 20.0);
    rig.engaged().until_state(30.0, NavState::Landing);
    rig
}

/// Checks that the craft came to rest at the right place and that the landing ended the flight.
fn is_down(checks: &mut Checks, rig: &Rig, radius_m: f64) {
    let (disarm, reason) = rig.disarmed().unwrap();
    checks.same("reason", reason, DisarmReason::Landing);
    let rest = rig.at(disarm);
    checks.at_most("height at the disarm", rest.alt, 0.03);
    checks.at_most("lean at the disarm", rest.tilt(), 3.0);
    checks.at_most("place", rest.from([0.0, 0.0]), radius_m);
    let tilt = greatest(rig.span(disarm, 1e9).map(Sample::tilt));
    checks.at_most("lean afterwards", tilt, 3.0);
}

/// Returns the sink rate at the first contact with the ground after `from`, m/s.
fn impact_mps(rig: &Rig, from: f64) -> f64 {
    let mut span = rig.span(from, 1e9).skip_while(|s| s.alt < 0.3);
    let mut before = 0.0;
    span.find(|s| {
        let down = s.alt < 0.005;
        if !down {
            before = -s.vu;
        }
        down
    });
    before
}

#[test]
fn a_barometer_that_is_ten_metres_off_does_not_keep_the_craft_up() {
    assert_met([-10.0_f64, 10.0].into_iter().flat_map(|rate| {
        [0, 1, 2, 3].map(|seed| {
            let mut rig = landing(seed, "");
            rig.fly(16.0);
            fault(&mut rig, "baro-drift", &rate.to_string(), Some(12.0));
            rig.until(150.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
            let mut checks = Checks::default();
            is_down(&mut checks, &rig, 4.0);
            checks.verdict(&format!("baro {rate} Pa/s, seed {seed}"), &rig.story())
        })
    }));
}

#[test]
fn a_landing_after_a_minute_of_drift_ends() {
    assert_met([1, 2].map(|seed| {
        let plan = "
waypoint insert 0 40.4635000 -79.5182000 2000 500 HOLD 300 NONE
waypoint insert 1 40.4635000 -79.5182000 2000 500 LAND 0 NONE";
        let mut rig = Rig::new(world(seed).0, plan, 20.0);
        rig.engaged();
        fault(&mut rig, "baro-drift", "-1", Some(60.0));
        rig.until(240.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
        let mut checks = Checks::default();
        is_down(&mut checks, &rig, 3.0);
        checks.verdict(&format!("seed {seed}"), &rig.story())
    }));
}

#[test]
fn a_throttle_threshold_that_can_never_be_met_does_not_keep_the_motors_running() {
    let rows = [
        ("set ap_landing_throttle_threshold = 300", 1),
        ("set ap_landing_throttle_threshold = 500", 2),
        ("set ap_landing_throttle_threshold = 300\nset ap_hover_throttle = 1200", 3),
        ("set ap_landing_altitude_m = 1\nset ap_hover_throttle = 1700", 4),
    ];
    assert_met(rows.map(|(lines, seed)| {
        let mut rig = landing(seed, lines);
        rig.until(120.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
        let mut checks = Checks::default();
        is_down(&mut checks, &rig, 3.0);
        checks.verdict(&format!("{lines}, seed {seed}"), &rig.story())
    }));
}

#[test]
fn a_land_far_below_the_craft_is_approached_at_the_climb_rate() {
    let plan = "
waypoint insert 0 40.4635000 -79.5182000 30000 500 HOLD 50 NONE
waypoint insert 1 40.4635000 -79.5182000 2000 500 LAND 0 NONE";
    assert_met([0, 1].map(|seed| {
        let mut rig = Rig::new(world(seed).0, plan, 20.0);
        rig.engaged().until(400.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
        let begun = rig.entered(NavState::Landing, 1);
        let mut checks = Checks::default();
        is_down(&mut checks, &rig, 3.0);
        // 280 m at 5 m/s, 20 m at 0.5 m/s.
        checks.at_most("time of the landing", rig.disarmed().unwrap().0 - begun, 125.0);
        checks.at_most("sink rate", greatest(rig.span(begun, 1e9).map(|s| -s.vu)), 6.5);
        let low = |s: &&Sample| s.alt < 18.0;
        checks.at_most("sink rate below", greatest(rig.span(begun, 1e9).filter(low).map(|s| -s.vu)), 1.0);
        checks.verdict(&format!("seed {seed}"), &rig.story())
    }));
}

#[test]
fn the_landing_of_the_failsafe_feels_for_the_ground() {
    let turbulence = betadeck_core::telemetry::Turbulence::Light;
    assert_met((1..=8).map(|seed| {
        let mut world = world(seed).0;
        world.wind = Wind { speed_mps: 3.0, from_deg: 45.0 * seed as f64 };
        world.turbulence = turbulence;
        let plan = "waypoint insert 0 40.4635000 -79.5182000 1500 500 HOLD 0 NONE";
        let mut rig = Rig::new(world, &format!("set failsafe_procedure = AUTO-LAND\n{plan}"), 15.0);
        rig.engaged().until_state(30.0, NavState::Holding).fly(5.0);
        let lost = rig.t();
        rig.vehicle
            .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::RxLoss, None)))
            .accepted()
            .unwrap();
        rig.until(90.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
        let mut checks = Checks::default();
        is_down(&mut checks, &rig, 4.0);
        checks.at_most("impact", impact_mps(&rig, lost), 0.9);
        checks.verdict(&format!("seed {seed}"), &rig.story())
    }));
}

#[test]
fn a_fix_lost_while_landing_does_not_leave_the_craft_half_a_metre_up() {
    assert_met((0..=6).map(|seed| {
        let mut world = world(seed).0;
        world.wind = "5@270".parse().unwrap();
        let mut rig = Rig::new(world, LAND, 20.0);
        rig.engaged()
            .until_state(30.0, NavState::Landing)
            .until(80.0, "low", |rig| rig.samples.last().is_some_and(|s| s.alt < 3.0));
        let lost = rig.t();
        rig.vehicle
            .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, Some(30.0))))
            .accepted()
            .unwrap();
        rig.fly(0.5);
        let mut checks = Checks::default();
        checks.same("state", rig.samples.last().unwrap().state, NavState::Idle);
        checks.holds("level, altitude held", rig.samples.last().unwrap().modes.has(Mode::AltHold));
        rig.until(40.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
        // Without a position the wind carries the craft.
        is_down(&mut checks, &rig, 50.0);
        checks.at_most("impact", impact_mps(&rig, lost), 0.8);
        checks.at_most("time", rig.disarmed().unwrap().0 - lost, 18.0);
        checks.verdict(&format!("seed {seed}"), &rig.story())
    }));
}

#[test]
fn a_fix_that_comes_back_lands_the_craft_and_never_climbs() {
    assert_met([1, 2, 3].map(|seed| {
        let mut rig = landing(seed, "");
        rig.fly(10.0);
        let lost = rig.t();
        rig.vehicle
            .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, Some(6.0))))
            .accepted()
            .unwrap();
        rig.fly(1.0);
        let height = rig.samples.last().unwrap().alt;
        rig.until_state(20.0, NavState::Landing);
        rig.until(90.0, "disarm", |rig| rig.disarmed().is_some()).fly(2.0);
        let mut checks = Checks::default();
        is_down(&mut checks, &rig, 3.5);
        checks.at_most("height", greatest(rig.span(lost + 1.0, 1e9).map(|s| s.alt)), height + 0.5);
        checks.verdict(&format!("seed {seed}"), &rig.story())
    }));
}

#[test]
fn the_throttle_stick_takes_a_landing_without_a_fix_over() {
    let mut rig = landing(1, "");
    rig.fly(6.0);
    rig.vehicle.apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, None))).accepted().unwrap();
    rig.fly(3.0);
    let sinking = *rig.samples.last().unwrap();
    assert!(sinking.vu < -0.25, "{}", sinking.vu);
    rig.vehicle.apply(&VehicleCommand::StopPilot);
    // Within the deadband the stick has no effect.
    let throttle = 2;
    let left = rig.vehicle.transmitter().sticks().channels[throttle];
    rig.stick(throttle, left + 40);
    rig.fly(3.0);
    assert!(rig.samples.last().unwrap().vu < -0.25);
    rig.stick(throttle, left + 60);
    rig.fly(6.0);
    let held = rig.samples.last().unwrap();
    assert!(held.vu.abs() < 0.3, "{}", held.vu);
}

#[test]
fn a_failsafe_in_low_fast_flight_does_not_fly_the_craft_into_the_ground() {
    let plan = "
waypoint insert 0 40.4653000 -79.5182000 400 1000 FLYOVER 0 NONE
waypoint insert 1 40.4680000 -79.5182000 400 1000 LAND 0 NONE";
    assert_met([1, 2, 3].map(|seed| {
        let lines = format!(
            "set failsafe_procedure = AUTO-LAND\nset ap_max_distance_from_home = 0\n\
             set ap_max_velocity = 1000\n{plan}"
        );
        let mut rig = Rig::new(world(seed).0, &lines, 4.0);
        rig.engaged().fly(14.0);
        let lost = rig.t();
        rig.vehicle
            .apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::RxLoss, None)))
            .accepted()
            .unwrap();
        rig.until(90.0, "disarm", |rig| rig.disarmed().is_some() || rig.vehicle.crashed()).fly(2.0);
        let mut checks = Checks::default();
        checks.holds("not crashed", !rig.vehicle.crashed());
        checks.holds("was fast", rig.at(lost).speed() > 6.0);
        checks.verdict(&format!("seed {seed}"), &rig.story())
    }));
}
