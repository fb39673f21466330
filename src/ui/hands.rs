//! Flying by hand: which channel a switch is on, and what the next frame of the virtual sticks is.

use std::time::Duration;

use crate::session::Command;
use crate::signals::{RC_CHANNELS, RcFrame, RcSource};
use crate::vehicle::snapshot::ModeRange;

use super::advice;
use super::log::Level;
use super::message::Effect;
use super::quantity::within;
use super::state::AppState;

/// Channel of the throttle.
const THROTTLE: usize = 2;
/// The stick at the bottom, µs.
const LOW_US: u16 = 1000;
/// A stick in the middle, µs.
const MIDDLE_US: u16 = 1500;
/// Above this the throttle counts as raised, which the hold modes and the autopilot wait for, µs.
const RAISED_US: u16 = 1300;
/// The modes that hold the craft in place while the hands are off the sticks.
const HOLD_MODES: [&str; 3] = ["ANGLE", "ALTHOLD", "POS HOLD"];
/// Below this the craft counts as standing when no simulator tells, m.
const STANDING_BELOW_M: f64 = 0.5;
/// Longest time that sticks not yet confirmed by the session count.
const CONFIRM_WITHIN: Duration = Duration::from_millis(500);

/// A switch: its channel and the value that turns it on and off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Switch {
    /// Index of the channel.
    pub channel: usize,
    /// Value that turns the mode on, µs.
    pub on_us: u16,
    /// Value that turns the mode off, µs.
    pub off_us: u16,
}

/// The frame that the next change starts from: what was sent last, until the session shows it or moves on.
#[must_use]
pub fn frame(state: &AppState) -> RcFrame {
    match state.sticks_sent {
        Some((frame, at)) if within(state.now, at, CONFIRM_WITHIN) && state.view.pilot.is_none() => frame,
        _ => state.view.sticks,
    }
}

/// The switch of a mode.
///
/// # Errors
/// A sentence when no channel is assigned to it.
pub fn switch_channel(state: &AppState, mode: &str) -> Result<Switch, String> {
    let ranges = &state.view.vehicle.craft.mode_ranges;
    let own = |range: &&ModeRange| range.name == mode && range.start_us < range.end_us;
    let range = ranges.iter().find(own).ok_or_else(|| {
        let line = if mode == "ARM" { "aux 0 0 0 1700 2100" } else { "aux 1 56 1 1700 2100" };
        format!("No switch is assigned to {mode}: `{line}` in the CLI (5) does it.")
    })?;
    let channel = usize::from(range.channel).min(RC_CHANNELS - 1);
    let active = |us: u16| {
        ranges.iter().filter(own).any(|r| r.channel == range.channel && (r.start_us..r.end_us).contains(&us))
    };
    let off_us = [1000, 1500, 2000].into_iter().find(|&us| !active(us)).unwrap_or(LOW_US);
    Ok(Switch { channel, on_us: u16::midpoint(range.start_us, range.end_us), off_us })
}

/// Whether the switch of a mode is on, as the craft sees it.
#[must_use]
pub fn switch_is_on(state: &AppState, mode: &str) -> bool {
    let craft = &state.view.vehicle.craft;
    is_on(state, &craft.channels, mode)
}

/// Whether the switch of a mode is on with these channels.
fn is_on(state: &AppState, channels: &[u16; RC_CHANNELS], mode: &str) -> bool {
    state.view.vehicle.craft.mode_ranges.iter().any(|range| {
        range.name == mode
            && channels
                .get(usize::from(range.channel))
                .is_some_and(|us| (range.start_us..range.end_us).contains(us))
    })
}

/// Whether a channel arms or engages, so that only the keys for that may move it.
fn is_reserved(state: &AppState, channel: usize) -> bool {
    let ranges = &state.view.vehicle.craft.mode_ranges;
    channel <= 3
        || ranges
            .iter()
            .any(|range| usize::from(range.channel) == channel && matches!(range.name, "ARM" | "AUTOPILOT"))
}

/// Puts the switches of the hold modes on or off, as far as they have channels of their own: without them a craft
/// that is flown by keys, or whose autopilot is switched off, has nobody who levels it.
fn set_hold(state: &AppState, next: &mut RcFrame, on: bool) {
    for mode in HOLD_MODES {
        let Ok(switch) = switch_channel(state, mode) else { continue };
        if is_reserved(state, switch.channel) || is_on(state, &next.channels, mode) == on {
            continue;
        }
        next.channels[switch.channel] = if on { switch.on_us } else { switch.off_us };
    }
}

/// Whether the craft stands and the throttle of this frame is low, so that nothing needs to be held.
fn at_rest(state: &AppState, next: &RcFrame) -> bool {
    let vehicle = &state.view.vehicle;
    let standing = match &vehicle.truth {
        Some(truth) => truth.on_ground,
        None => vehicle.estimate.alt.is_none_or(|alt| alt < STANDING_BELOW_M),
    };
    next.channels[THROTTLE] < RAISED_US && (standing || !vehicle.craft.armed)
}

/// Whether the throttle stick is up.
#[must_use]
pub fn throttle_is_raised(state: &AppState) -> bool {
    frame(state).channels[THROTTLE] >= RAISED_US
}

/// Whether moving the ARM switch now does what the user wants.
///
/// # Errors
/// The sentence that says what blocks arming and what to do.
pub fn can_arm(state: &AppState) -> Result<(), String> {
    let switch = switch_channel(state, "ARM")?;
    let craft = &state.view.vehicle.craft;
    if craft.armed || frame(state).channels[switch.channel] == switch.on_us {
        return Ok(());
    }
    // The last two only say "switch off, then on again", which is what the key does.
    let cause = craft.arming_blocked_by.iter().find(|flag| !matches!(**flag, "ARM_SWITCH" | "NOT_DISARMED"));
    match cause {
        None => Ok(()),
        Some(_) => {
            let flag = advice::most_useful(&craft.arming_blocked_by);
            Err(format!("Cannot arm, {flag}: {}.", advice::arming_hint(flag)))
        }
    }
}

/// Moves the ARM switch; disarming releases the hold modes, which would block the next arming.
pub fn toggle_arm(state: &mut AppState) -> Vec<Effect> {
    let Ok(switch) = switch_channel(state, "ARM") else { return Vec::new() };
    let mut next = frame(state);
    let on = state.view.vehicle.craft.armed || next.channels[switch.channel] == switch.on_us;
    next.channels[switch.channel] = if on { switch.off_us } else { switch.on_us };
    if on {
        set_hold(state, &mut next, false);
    }
    send(state, next)
}

/// Moves the AUTOPILOT switch; engaging also puts the hold modes on, which take over when it is switched off.
pub fn toggle_autopilot(state: &mut AppState) -> Vec<Effect> {
    let Ok(switch) = switch_channel(state, "AUTOPILOT") else { return Vec::new() };
    let mut next = frame(state);
    let on = next.channels[switch.channel] == switch.on_us;
    next.channels[switch.channel] = if on { switch.off_us } else { switch.on_us };
    if on && at_rest(state, &next) {
        set_hold(state, &mut next, false);
    } else if !on && (state.view.vehicle.craft.armed || next.channels[THROTTLE] >= RAISED_US) {
        set_hold(state, &mut next, true);
    }
    send(state, next)
}

/// Throttle stick to hover with the hold modes on, or to low when it is up: in the air the hold modes stay on, so that
/// the craft does not fall; on the ground they are released.
pub fn toggle_throttle(state: &mut AppState) -> Vec<Effect> {
    let mut next = frame(state);
    if next.channels[THROTTLE] >= RAISED_US {
        next.channels[THROTTLE] = LOW_US;
        if at_rest(state, &next) {
            set_hold(state, &mut next, false);
        }
    } else {
        set_hold(state, &mut next, true);
        next.channels[THROTTLE] = hover_us(state);
    }
    send(state, next)
}

/// Where the throttle stick hovers, with ALTHOLD and without: the configured hover throttle.
fn hover_us(state: &AppState) -> u16 {
    match state.view.vehicle.settings.hover_throttle_us {
        0 => MIDDLE_US,
        us => us.max(RAISED_US),
    }
}

/// Changes a channel by some µs.
pub fn nudge(state: &mut AppState, channel: usize, by_us: i32) -> Vec<Effect> {
    let mut next = frame(state);
    let Some(value) = next.channels.get_mut(channel) else { return Vec::new() };
    *value = (i32::from(*value) + by_us).clamp(1000, 2000) as u16;
    send(state, next)
}

/// Sets a channel.
pub fn set(state: &mut AppState, channel: usize, us: u16) -> Vec<Effect> {
    let mut next = frame(state);
    let Some(value) = next.channels.get_mut(channel) else { return Vec::new() };
    *value = us.clamp(1000, 2000);
    send(state, next)
}

/// Centres a stick, lowers the throttle, or moves a switch from low to high and back.
pub fn flip(state: &mut AppState, channel: usize) -> Vec<Effect> {
    let now = frame(state).channels.get(channel).copied().unwrap_or(MIDDLE_US);
    let us = match channel {
        THROTTLE => LOW_US,
        0..=3 => MIDDLE_US,
        _ if now >= MIDDLE_US => LOW_US,
        _ => 2000,
    };
    set(state, channel, us)
}

/// Sends a frame; the hand takes over from the scripted pilot.
fn send(state: &mut AppState, next: RcFrame) -> Vec<Effect> {
    let mut effects = Vec::new();
    if state.view.pilot.is_some() {
        effects.push(Effect::Send(Command::Pilot(false)));
        state.notify(Level::Info, "The pilot let go: the sticks are yours.");
    }
    match state.view.vehicle.craft.rc_source {
        Some(RcSource::Udp | RcSource::Msp) if state.view.vehicle.craft.rc_link => {
            state.notify(Level::Warn, "Another RC source drives the craft: stop it to fly by keys.");
        }
        _ if state.view.rc_cut => {
            state.notify(Level::Warn, "The RC link is cut: `x` restores it.");
        }
        _ => {}
    }
    state.sticks_sent = Some((next, state.now));
    effects.push(Effect::Send(Command::Sticks(next)));
    effects
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;
    use crate::ui::{CliHelp, OpenPlan, Theme, UiConfig};

    fn state(ranges: &[(&'static str, u8, u16, u16)]) -> AppState {
        let mut view = SessionView::default();
        let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
        vehicle.craft.mode_ranges = ranges
            .iter()
            .map(|&(name, channel, start_us, end_us)| ModeRange { name, channel, start_us, end_us })
            .collect();
        let config = UiConfig {
            theme: Theme::default(),
            cli: CliHelp::default(),
            sentence: |_| String::new(),
            plan: OpenPlan::default(),
            mouse: false,
        };
        AppState::new(config, (80, 24), view)
    }

    fn sticks(effects: &[Effect]) -> RcFrame {
        match effects.last() {
            Some(Effect::Send(Command::Sticks(frame))) => *frame,
            other => panic!("sticks expected, got {other:?}"),
        }
    }

    #[test]
    fn switches_are_found_where_the_craft_has_them() {
        let mut state = state(&[("ARM", 7, 900, 1200), ("AUTOPILOT", 9, 1700, 2100)]);
        assert_eq!(switch_channel(&state, "ARM"), Ok(Switch { channel: 7, on_us: 1050, off_us: 1500 }));
        let frame = sticks(&toggle_autopilot(&mut state));
        assert_eq!(frame.channels[9], 1900);
        assert_eq!(sticks(&toggle_autopilot(&mut state)).channels[9], 1000, "unconfirmed sticks count");
    }

    #[test]
    fn a_missing_switch_is_explained_with_the_cure() {
        let sentence = switch_channel(&state(&[]), "AUTOPILOT").expect_err("no switch");
        assert!(sentence.contains("`aux 1 56 1 1700 2100`"), "{sentence}");
    }

    #[test]
    fn the_throttle_goes_to_hover_and_back() {
        let mut state = state(&[]);
        std::sync::Arc::make_mut(&mut state.view.vehicle).settings.hover_throttle_us = 1420;
        assert_eq!(sticks(&toggle_throttle(&mut state)).channels[2], 1420);
        assert_eq!(sticks(&toggle_throttle(&mut state)).channels[2], 1000);
    }

    const HOLDS: [(&str, u8, u16, u16); 5] = [
        ("ARM", 4, 1700, 2100),
        ("AUTOPILOT", 5, 1700, 2100),
        ("ANGLE", 6, 1300, 2100),
        ("ALTHOLD", 6, 1700, 2100),
        ("POS HOLD", 7, 900, 1200),
    ];

    #[test]
    fn the_throttle_brings_the_hold_modes_and_takes_them_back_on_the_ground() {
        let mut state = state(&HOLDS);
        let up = sticks(&toggle_throttle(&mut state));
        assert!(HOLD_MODES.iter().all(|mode| is_on(&state, &up.channels, mode)), "{up:?}");
        assert_eq!(up.channels[THROTTLE], 1500);
        let down = sticks(&toggle_throttle(&mut state));
        assert!(!HOLD_MODES.iter().any(|mode| is_on(&state, &down.channels, mode)), "{down:?}");
    }

    #[test]
    fn switching_the_autopilot_off_in_the_air_leaves_the_craft_held() {
        let mut state = state(&HOLDS);
        let vehicle = std::sync::Arc::make_mut(&mut state.view.vehicle);
        vehicle.craft.armed = true;
        vehicle.estimate.alt = Some(20.0);
        for (keys, autopilot) in [("g on", true), ("g off", false)] {
            let frame = sticks(&toggle_autopilot(&mut state));
            assert_eq!(is_on(&state, &frame.channels, "AUTOPILOT"), autopilot, "{keys}");
            assert!(HOLD_MODES.iter().all(|mode| is_on(&state, &frame.channels, mode)), "{keys}: {frame:?}");
        }
        toggle_throttle(&mut state);
        let low = sticks(&toggle_throttle(&mut state));
        assert!(is_on(&state, &low.channels, "ALTHOLD"), "in the air a low throttle does not drop the craft");
        let disarmed = sticks(&toggle_arm(&mut state));
        assert!(!is_on(&state, &disarmed.channels, "ALTHOLD"), "it would block the next arming");
    }

    #[test]
    fn a_hold_mode_on_the_arm_channel_is_left_alone() {
        let mut state = state(&[("ARM", 4, 1700, 2100), ("ANGLE", 4, 900, 1300)]);
        assert_eq!(sticks(&toggle_arm(&mut state)).channels[4], 1900);
        assert_eq!(sticks(&toggle_throttle(&mut state)).channels[4], 1900);
    }

    #[test]
    fn arming_is_refused_with_the_cause_but_disarming_never() {
        let mut state = state(&[("ARM", 4, 1700, 2100)]);
        let vehicle = std::sync::Arc::make_mut(&mut state.view.vehicle);
        vehicle.craft.arming_blocked_by.push("BOOTGRACE");
        vehicle.craft.arming_blocked_by.push("ARM_SWITCH");
        let sentence = can_arm(&state).expect_err("blocked");
        assert!(sentence.contains("BOOTGRACE"), "{sentence}");
        std::sync::Arc::make_mut(&mut state.view.vehicle).craft.armed = true;
        assert_eq!(can_arm(&state), Ok(()));
        assert_eq!(sticks(&toggle_arm(&mut state)).channels[4], 1000);
    }
}
