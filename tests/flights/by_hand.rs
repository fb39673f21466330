//! Flying by hand with the hold modes: coming down by the throttle stick, and a return home that is taken back.

use crate::checks::greatest;
use crate::rig::{Rig, world};
use betadeck::signals::RcFrame;
use betadeck::telemetry::{EventKind, Mode, NavState};

/// A craft that hovers ten metres up, held by the switches of the scripted pilot, who has let go.
fn hovering() -> (Rig, RcFrame) {
    let mut rig = Rig::new(world(1).0, "", 10.0);
    rig.until(60.0, "hover", |rig| rig.vehicle.transmitter().pilot_doing() == Some("hovering"));
    rig.vehicle.transmitter_mut().stop_pilot();
    rig.fly(3.0);
    let sticks = rig.vehicle.transmitter().sticks();
    (rig, sticks)
}

#[test]
fn the_sinking_stick_brings_the_craft_down_softly() {
    let (mut rig, mut sticks) = hovering();
    sticks.channels[2] = rig.vehicle.embedded().unwrap().sink_stick_us().unwrap();
    *rig.vehicle.transmitter_mut().sticks_mut() = sticks;
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
    assert!(!rig.vehicle.world().unwrap().truth().crashed);
}

#[test]
fn a_return_home_that_is_taken_back_leaves_the_craft_held() {
    let (mut rig, _) = hovering();
    rig.vehicle.embedded_mut().unwrap().return_to_home().unwrap();
    rig.fly(1.0);
    assert!(
        rig.vehicle.snapshot().craft.is_commanded()
            && rig.vehicle.embedded().unwrap().modes().has(Mode::Autopilot)
    );
    rig.vehicle.embedded_mut().unwrap().cancel_command();
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
