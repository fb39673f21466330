//! Tests of the keys that fly by hand, and of their frames.

use super::*;
use crate::session::SessionView;
use crate::telemetry::ArmingFlag;
use crate::vehicle::VehicleCommand;

const SINK_US: u16 = 1194;

fn state(ranges: &[(Mode, u8, u16, u16)]) -> Shared {
    let mut view = SessionView::default();
    let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
    let range = |&(mode, channel, start_us, end_us): &(Mode, u8, u16, u16)| ModeRange {
        mode_box: mode.into(),
        channel,
        start_us,
        end_us,
    };
    vehicle.craft.mode_ranges = Some(ranges.iter().map(range).collect());
    let settings = vehicle.settings.get_or_insert_default();
    settings.hover_stick_us = 1500;
    settings.raised_stick_us = 1300;
    settings.sink_stick_us = Some(SINK_US);
    Shared::bare((80, 24), view)
}

fn sticks(effects: &[Effect]) -> RcFrame {
    match effects.last() {
        Some(Effect::Send(Command::Vehicle(VehicleCommand::Sticks(frame)))) => *frame,
        other => panic!("sticks expected, got {other:?}"),
    }
}

#[test]
fn switches_are_found_where_the_craft_has_them() {
    let mut state = state(&[(Mode::Arm, 7, 900, 1200), (Mode::Autopilot, 9, 1700, 2100)]);
    assert_eq!(switch(&state, Mode::Arm), Ok(Switch { channel: 7, on_us: 1050, off_us: 1500 }));
    let frame = sticks(&toggle_autopilot(&mut state));
    assert_eq!(frame.channels[9], 1900);
    assert_eq!(sticks(&toggle_autopilot(&mut state)).channels[9], 1000, "unconfirmed sticks count");
}

#[test]
fn a_missing_switch_is_explained_with_the_cure() {
    let sentence = switch(&state(&[]), Mode::Autopilot).expect_err("no switch");
    assert!(sentence.contains("`aux 1 56 1 1700 2100`"), "{sentence}");
}

#[test]
fn the_throttle_goes_to_hover_and_back() {
    let mut state = state(&[]);
    std::sync::Arc::make_mut(&mut state.view.vehicle).settings.get_or_insert_default().hover_stick_us = 1420;
    assert_eq!(sticks(&move_throttle(&mut state)).channels[2], 1420);
    assert_eq!(sticks(&move_throttle(&mut state)).channels[2], 1000);
}

#[test]
fn without_a_word_of_the_hover_the_throttle_goes_to_the_middle() {
    let mut state = state(&[]);
    std::sync::Arc::make_mut(&mut state.view.vehicle).settings = None;
    assert_eq!(sticks(&move_throttle(&mut state)).channels[2], 1500);
    assert_eq!(sticks(&move_throttle(&mut state)).channels[2], 1000);
}

const HOLDS: [(Mode, u8, u16, u16); 5] = [
    (Mode::Arm, 4, 1700, 2100),
    (Mode::Autopilot, 5, 1700, 2100),
    (Mode::Angle, 6, 1300, 2100),
    (Mode::AltHold, 6, 1700, 2100),
    (Mode::PosHold, 7, 900, 1200),
];

#[test]
fn the_throttle_brings_the_hold_modes_and_takes_them_back_on_the_ground() {
    let mut state = state(&HOLDS);
    let up = sticks(&move_throttle(&mut state));
    assert!(HOLD_MODES.iter().all(|&mode| is_on(&state, &up, mode)), "{up:?}");
    assert_eq!(up.channels[THROTTLE], 1500);
    let down = sticks(&move_throttle(&mut state));
    assert!(!HOLD_MODES.iter().any(|&mode| is_on(&state, &down, mode)), "{down:?}");
}

#[test]
fn switching_the_autopilot_off_in_the_air_leaves_the_craft_held() {
    let mut state = state(&HOLDS);
    let vehicle = std::sync::Arc::make_mut(&mut state.view.vehicle);
    vehicle.craft.armed = Some(true);
    vehicle.estimate.alt = Some(20.0);
    for (keys, autopilot) in [("g on", true), ("g off", false)] {
        let frame = sticks(&toggle_autopilot(&mut state));
        assert_eq!(is_on(&state, &frame, Mode::Autopilot), autopilot, "{keys}");
        assert!(HOLD_MODES.iter().all(|&mode| is_on(&state, &frame, mode)), "{keys}: {frame:?}");
    }
}

/// Returns an armed craft 20 m up, with all switches.
fn flying() -> Shared {
    let mut state = state(&HOLDS);
    let vehicle = std::sync::Arc::make_mut(&mut state.view.vehicle);
    vehicle.craft.armed = Some(true);
    vehicle.estimate.alt = Some(20.0);
    state
}

#[test]
fn in_the_air_the_throttle_key_holds_then_sinks_and_never_drops_the_craft() {
    let mut state = flying();
    for (throttle, sinking) in [(1500, false), (SINK_US, true), (1500, false), (SINK_US, true)] {
        let frame = sticks(&move_throttle(&mut state));
        assert_eq!((frame.channels[THROTTLE], is_sinking(&state)), (throttle, sinking));
        assert!(HOLD_MODES.iter().all(|&mode| is_on(&state, &frame, mode)), "{frame:?}");
    }
    std::sync::Arc::make_mut(&mut state.view.vehicle).estimate.alt = Some(0.1);
    let down = sticks(&move_throttle(&mut state));
    assert_eq!(down.channels[THROTTLE], 1000, "on the ground it is low");
    assert!(!is_on(&state, &down, Mode::AltHold), "it would block the next arming");
}

#[test]
fn without_altitude_hold_the_throttle_key_knows_up_and_low_only() {
    let mut state = flying();
    std::sync::Arc::make_mut(&mut state.view.vehicle).craft.mode_ranges.as_mut().unwrap().truncate(3);
    assert_eq!(sticks(&move_throttle(&mut state)).channels[THROTTLE], 1500);
    assert_eq!(sticks(&move_throttle(&mut state)).channels[THROTTLE], 1000);
}

#[test]
fn a_craft_that_was_sinking_is_held_when_the_autopilot_gives_it_back() {
    for engage in [toggle_autopilot, toggle_return] {
        let mut state = flying();
        move_throttle(&mut state);
        move_throttle(&mut state);
        assert!(is_sinking(&state));
        engage(&mut state);
        assert_eq!(frame(&state).channels[THROTTLE], 1500);
    }
}

#[test]
fn disarming_leaves_nothing_that_blocks_the_next_arming() {
    let mut state = flying();
    move_throttle(&mut state);
    let disarmed = sticks(&toggle_arm(&mut state));
    assert_eq!(disarmed.channels[THROTTLE], 1000);
    assert!(!is_on(&state, &disarmed, Mode::AltHold), "{disarmed:?}");
}

#[test]
fn a_return_home_is_taken_back_by_its_own_key_and_by_that_of_the_autopilot() {
    let mut state = flying();
    let effects = toggle_return(&mut state);
    assert!(
        matches!(effects.last(), Some(Effect::Send(Command::Vehicle(VehicleCommand::ReturnHome)))),
        "{effects:?}"
    );
    assert!(is_on(&state, &frame(&state), Mode::PosHold), "who gets the craft back must find it held");
    std::sync::Arc::make_mut(&mut state.view.vehicle).craft.commanded = Some(true);
    for key in [toggle_return, toggle_autopilot] {
        let effects = key(&mut state);
        assert!(
            matches!(effects[..], [Effect::Send(Command::Vehicle(VehicleCommand::CancelReturn))]),
            "{effects:?}"
        );
    }
}

#[test]
fn a_hold_mode_on_the_arm_channel_is_left_alone() {
    let mut state = state(&[(Mode::Arm, 4, 1700, 2100), (Mode::Angle, 4, 900, 1300)]);
    assert_eq!(sticks(&toggle_arm(&mut state)).channels[4], 1900);
    assert_eq!(sticks(&move_throttle(&mut state)).channels[4], 1900);
}

#[test]
fn arming_is_refused_with_the_cause_but_disarming_never() {
    let mut state = state(&[(Mode::Arm, 4, 1700, 2100)]);
    let vehicle = std::sync::Arc::make_mut(&mut state.view.vehicle);
    vehicle.craft.arming_blocked_by.get_or_insert_default().set(ArmingFlag::BootGrace, true);
    vehicle.craft.arming_blocked_by.get_or_insert_default().set(ArmingFlag::ArmSwitch, true);
    let sentence = can_arm(&state).expect_err("blocked");
    assert!(sentence.contains("BOOTGRACE"), "{sentence}");
    std::sync::Arc::make_mut(&mut state.view.vehicle).craft.armed = Some(true);
    assert_eq!(can_arm(&state), Ok(()));
    assert_eq!(sticks(&toggle_arm(&mut state)).channels[4], 1000);
}
