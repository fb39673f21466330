//! Manual flight with the hold modes: a descent by the throttle stick, and a return home that is cancelled.

use crate::flights::checks::greatest;
use crate::flights::rig::{Rig, world};
use betadeck_core::signals::RcFrame;
use betadeck_core::sim::{Fault, Truth, WorldCommand};
use betadeck_core::telemetry::{DisarmReason, EventKind, Mode, NavState};
use betadeck_core::vehicle::VehicleCommand;

/// Returns a craft that hovers ten metres up by the switches of the scripted pilot, who no longer acts, and
/// the sticks.
fn hovering() -> (Rig, RcFrame) {
    let mut rig = Rig::new(world(1).0, "", 10.0);
    rig.until(60.0, "hover", |rig| rig.vehicle.transmitter().pilot_doing() == Some("hovering"));
    rig.vehicle.apply(&VehicleCommand::StopPilot);
    rig.fly(3.0);
    let sticks = rig.vehicle.transmitter().sticks();
    (rig, sticks)
}

#[test]
fn the_sinking_stick_brings_the_craft_down_softly() {
    let (mut rig, mut sticks) = hovering();
    sticks.channels[2] = rig.vehicle.embedded().unwrap().sink_stick_us().unwrap();
    rig.vehicle.apply(&VehicleCommand::Sticks(sticks));
    rig.fly(3.0);
    let from = rig.samples.len();
    rig.fly(4.0);
    let sinking: Vec<f64> = rig.samples[from..].iter().map(|sample| -sample.vu).collect();
    let mean = sinking.iter().sum::<f64>() / sinking.len() as f64;
    assert!((0.6..1.4).contains(&mean), "{mean}");
    rig.until(60.0, "touchdown", |rig| {
        rig.events.iter().any(|event| matches!(event.kind, EventKind::Touchdown { .. }))
    });
    let impact = rig.events.iter().find_map(|event| match event.kind {
        EventKind::Touchdown { impact_mps, .. } => Some(impact_mps),
        _ => None,
    });
    assert!(impact.is_some_and(|impact| impact < 1.5), "{impact:?}");
    assert!(!rig.vehicle.truth().unwrap().crashed);
}

#[test]
fn a_return_home_that_is_taken_back_leaves_the_craft_held() {
    let (mut rig, _) = hovering();
    rig.vehicle.apply(&VehicleCommand::ReturnHome).accepted().unwrap();
    rig.fly(1.0);
    assert!(
        rig.vehicle.snapshot().craft.is_commanded()
            && rig.vehicle.embedded().unwrap().modes().has(Mode::Autopilot)
    );
    rig.vehicle.apply(&VehicleCommand::CancelReturn);
    rig.fly(1.0);
    let snapshot = rig.vehicle.snapshot();
    assert_eq!((snapshot.craft.is_commanded(), snapshot.nav.unwrap().state), (false, NavState::Idle));
    assert!(snapshot.craft.is_active(Mode::PosHold) && !snapshot.craft.is_active(Mode::Autopilot));
    let height = rig.vehicle.embedded().unwrap().altitude_m();
    let from = rig.samples.len();
    rig.fly(10.0);
    let fallen = greatest(rig.samples[from..].iter().map(|sample| (sample.alt - height).abs()));
    assert!(fallen < 1.5, "{fallen}");
}

/// Puts a craft on the ground with a hover throttle that is set far too low, hold modes on and this throttle
/// stick. Returns the true state after ten seconds.
fn after_stick(throttle_us: u16) -> Truth {
    let mut rig = Rig::new(world(1).0, "set ap_hover_throttle = 1275\nset alt_hold_deadband = 20", 10.0);
    rig.until(60.0, "the hold modes", |rig| rig.vehicle.embedded().unwrap().modes().has(Mode::AltHold));
    rig.vehicle.apply(&VehicleCommand::StopPilot);
    rig.stick(2, throttle_us);
    rig.fly(10.0);
    *rig.vehicle.truth().unwrap()
}

#[test]
fn a_throttle_stick_above_the_hover_throttle_takes_the_craft_off() {
    assert!(after_stick(1400).on_ground, "inside the dead zone");
    let climbed = after_stick(1600);
    assert!(climbed.pos_enu.z > 1.0, "{}", climbed.pos_enu.z);
}

#[test]
fn a_refused_autopilot_leaves_the_craft_where_it_hovers() {
    let fence = "set ap_max_distance_from_home = 50\nset ap_hover_throttle = 1275
waypoint insert 0 40.4663000 -79.5182000 2000 500 FLYOVER 0 NONE";
    let mut rig = Rig::new(world(1).0, fence, 10.0);
    rig.until(60.0, "the refusal", |rig| rig.vehicle.embedded().unwrap().nav().refusal.is_some());
    let height = rig.vehicle.embedded().unwrap().altitude_m();
    rig.fly(9.0);
    let left = rig.vehicle.embedded().unwrap().altitude_m() - height;
    assert!(left.abs() < 1.0, "{left}");
    let status = rig.vehicle.apply(&VehicleCommand::single_line("status")).line().unwrap().text;
    assert!(status.contains("Autopilot: Waypoint 0 is 311 m from home, the fence is 50 m."), "{status}");
    let status = rig.vehicle.apply(&VehicleCommand::single_line("waypoint status")).line().unwrap().text;
    assert!(status.contains("  inactive\r\n  refused: Waypoint 0 is 311 m from home"), "{status}");
}

#[test]
fn a_rescue_that_loses_its_fix_comes_down_and_disarms() {
    let mut rig = Rig::new(world(1).0, "aux 3 46 3 1700 2100", 10.0);
    rig.until(60.0, "hover", |rig| rig.vehicle.transmitter().pilot_doing() == Some("hovering"));
    rig.vehicle.apply(&VehicleCommand::StopPilot);
    rig.stick(7, 1900);
    rig.fly(3.0);
    assert!(rig.vehicle.embedded().unwrap().modes().has(Mode::Autopilot), "the rescue flies");
    rig.vehicle.apply(&VehicleCommand::from(WorldCommand::FaultOn(Fault::GpsLoss, None))).accepted().unwrap();
    rig.fly(3.0);
    let modes = rig.vehicle.embedded().unwrap().modes();
    assert!(modes.has(Mode::Angle) && modes.has(Mode::AltHold), "{modes:?}");
    rig.until(120.0, "disarmed on the ground", |rig| rig.disarmed().is_some());
    assert_eq!(rig.disarmed().unwrap().1, DisarmReason::Landing);
    let truth = rig.vehicle.truth().unwrap();
    assert!(truth.on_ground && !truth.crashed);
}
