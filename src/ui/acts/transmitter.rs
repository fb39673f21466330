//! The keyboard as an RC transmitter: computes the next frame of sticks and switches when a key is pressed.

use std::time::Duration;

use crate::session::Command;
use crate::signals::{RcFrame, RcSource};
use crate::telemetry::snapshot::{ModeRange, SettingsView};
use crate::telemetry::switch::Switch;
use crate::telemetry::{Mode, ModeBox, switch};
use crate::vehicle::VehicleCommand;

use crate::ui::acts::arming_hint::{arming_hint, most_useful_flag};
use crate::ui::formatting::within;
use crate::ui::model::action::Action;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;

/// The time within which a second press of a key confirms the first.
pub(in crate::ui) const TWICE_WITHIN: Duration = Duration::from_secs(2);
/// The channel of the throttle.
const THROTTLE: usize = 2;
/// The stick at the bottom, µs.
const LOW_US: u16 = 1000;
/// A stick in the middle, µs.
const MIDDLE_US: u16 = 1500;
/// The modes that hold the craft level and in place with centred sticks.
const HOLD_MODES: [Mode; 3] = [Mode::Angle, Mode::AltHold, Mode::PosHold];
/// The altitude below which the craft counts as standing if no simulator reports it, m.
const STANDING_BELOW_M: f64 = 0.5;
/// The longest time for which sticks not yet confirmed by the session count.
const CONFIRM_WITHIN: Duration = Duration::from_millis(500);

/// The next position of the throttle stick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum ThrottleMove {
    /// Hover, with the hold modes on.
    Hover,
    /// The position at which ALTHOLD lets the craft descend, µs.
    Sink(u16),
    Low,
}

/// Returns the base of the next change: the frame sent last, until the session confirms it or it is too old.
pub(in crate::ui) fn frame(state: &Shared) -> RcFrame {
    match state.sticks_sent {
        Some((frame, at)) if within(state.now, at, CONFIRM_WITHIN) && state.view.pilot.is_none() => frame,
        _ => state.view.sticks,
    }
}

/// Returns the switch of a mode.
///
/// # Errors
/// Returns a sentence if no channel is assigned to it.
pub(in crate::ui) fn switch(state: &Shared, mode: Mode) -> Result<Switch, String> {
    let Some(ranges) = &state.view.vehicle.craft.mode_ranges else {
        return Err(format!("The flight controller does not tell which switch turns {mode} on."));
    };
    Switch::of(mode, ranges).ok_or_else(|| {
        let line = if mode == Mode::Arm { "aux 0 0 0 1700 2100" } else { "aux 1 56 1 1700 2100" };
        let cli = state.key(Action::Show(Panel::Cli));
        format!("No switch is assigned to {mode}: `{line}` in the CLI ({cli}) does it.")
    })
}

/// Returns `true` if the craft sees the switch of a mode as on.
pub(in crate::ui) fn switch_is_on(state: &Shared, mode: Mode) -> bool {
    state.view.vehicle.craft.is_switched_on(mode)
}

/// Returns `true` if the switch of a mode is on in this frame.
fn is_on(state: &Shared, frame: &RcFrame, mode: Mode) -> bool {
    switch::is_on(mode, state.view.vehicle.craft.mode_ranges(), &frame.channels)
}

/// Returns the switch of a hold mode, unless its channel also arms, engages or is a stick.
fn hold_switch(state: &Shared, mode: Mode) -> Option<Switch> {
    let switch = switch(state, mode).ok()?;
    let is_reserved = |range: &ModeRange| {
        usize::from(range.channel) == switch.channel
            && matches!(range.mode_box, ModeBox::Arm | ModeBox::Autopilot)
    };
    let free = switch.channel > 3 && !state.view.vehicle.craft.mode_ranges().iter().any(is_reserved);
    free.then_some(switch)
}

/// Sets the switches of the hold modes that have channels of their own. Without these modes nothing levels a craft that
/// is flown by keys, or whose autopilot is switched off.
fn set_hold_modes(state: &Shared, next: &mut RcFrame, on: bool) {
    for mode in HOLD_MODES {
        if let Some(switch) = hold_switch(state, mode)
            && is_on(state, next, mode) != on
        {
            next.channels[switch.channel] = if on { switch.on_us } else { switch.off_us };
        }
    }
}

/// Prepares the sticks for the moment when the navigator releases the craft, so that it holds its place and neither
/// sinks nor climbs.
fn prepare_hold(state: &Shared, next: &mut RcFrame) {
    rest_throttle(state, next);
    set_hold_modes(state, next, true);
}

/// Moves the throttle stick of a flying craft to the position where ALTHOLD keeps the altitude.
fn rest_throttle(state: &Shared, next: &mut RcFrame) {
    if is_airborne(state) {
        next.channels[THROTTLE] = hover_us(state);
    }
}

/// Returns `true` if the craft is on the ground.
pub(in crate::ui) fn is_standing(state: &Shared) -> bool {
    let vehicle = &state.view.vehicle;
    match &vehicle.truth {
        Some(truth) => truth.on_ground,
        None => vehicle.estimate.alt.is_none_or(|alt| alt < STANDING_BELOW_M),
    }
}

/// Returns `true` if the craft is armed and in the air.
fn is_airborne(state: &Shared) -> bool {
    state.view.vehicle.craft.is_armed() && !is_standing(state)
}

/// Returns `true` if the throttle stick of a frame counts as raised.
fn is_raised(state: &Shared, frame: &RcFrame) -> bool {
    frame.channels[THROTTLE] >= settings(state).raised_stick_us
}

/// Returns `true` if the throttle stick lets the craft sink in ALTHOLD.
pub(in crate::ui) fn is_sinking(state: &Shared) -> bool {
    let frame = frame(state);
    let throttle_us = frame.channels[THROTTLE];
    // The hover throttle changes a little while it is learned, and the sinking stick with it.
    let is_below = |sink_us: u16| throttle_us <= u16::midpoint(sink_us, hover_us(state));
    is_airborne(state)
        && is_on(state, &frame, Mode::AltHold)
        && throttle_us > LOW_US
        && settings(state).sink_stick_us.is_some_and(is_below)
}

/// Returns the current effect of the throttle key. On the ground it alternates between hover and low. In the air the
/// first press holds the craft, the next lets it sink: a low stick in ALTHOLD would leave it hanging.
pub(in crate::ui) fn throttle_move(state: &Shared) -> ThrottleMove {
    let now = frame(state);
    if !is_airborne(state) {
        return if now.channels[THROTTLE] > LOW_US { ThrottleMove::Low } else { ThrottleMove::Hover };
    }
    let sink_us = settings(state).sink_stick_us;
    match (hold_switch(state, Mode::AltHold), sink_us) {
        (Some(_), Some(us)) if is_on(state, &now, Mode::AltHold) && !is_sinking(state) => {
            ThrottleMove::Sink(us)
        }
        (Some(_), Some(_)) => ThrottleMove::Hover,
        _ if is_raised(state, &now) => ThrottleMove::Low,
        _ => ThrottleMove::Hover,
    }
}

/// Checks that moving the ARM switch now arms or disarms the craft.
///
/// # Errors
/// Returns a sentence with the cause that blocks arming and the remedy.
pub(in crate::ui) fn can_arm(state: &Shared) -> Result<(), String> {
    let switch = switch(state, Mode::Arm)?;
    let craft = &state.view.vehicle.craft;
    if craft.is_armed() || frame(state).channels[switch.channel] == switch.on_us {
        return Ok(());
    }
    // The other flags only say "switch off, then on again", which is the effect of the key.
    match most_useful_flag(craft.arming_flags().causes()) {
        None => Ok(()),
        Some(flag) => Err(format!("Cannot arm, {flag}: {}.", arming_hint(state, flag))),
    }
}

/// Moves the ARM switch. Disarming also lowers the throttle and releases the hold modes, which would block the next
/// arming.
pub(in crate::ui) fn toggle_arm(state: &mut Shared) -> Vec<Effect> {
    let Ok(switch) = switch(state, Mode::Arm) else { return Vec::new() };
    let mut next = frame(state);
    let on = state.view.vehicle.craft.is_armed() || next.channels[switch.channel] == switch.on_us;
    next.channels[switch.channel] = if on { switch.off_us } else { switch.on_us };
    if on {
        next.channels[THROTTLE] = LOW_US;
        set_hold_modes(state, &mut next, false);
    }
    send(state, next)
}

/// Like [`toggle_arm`], but in the air the key disarms only if it is pressed again within [`TWICE_WITHIN`].
pub(in crate::ui) fn arm_key(state: &mut Shared) -> Vec<Effect> {
    if ends_flight_at_once(state, Action::Arm, "The motors would stop, and the craft fall", "disarm") {
        return toggle_arm(state);
    }
    Vec::new()
}

/// Puts the craft back home; in the air only if the key is pressed again within [`TWICE_WITHIN`].
pub(in crate::ui) fn reset_key(state: &mut Shared) -> Vec<Effect> {
    if !ends_flight_at_once(state, Action::ResetCraft, "The flight would end", "put the craft back home") {
        return Vec::new();
    }
    state.track.await_reset();
    state.sticks_sent = None;
    vec![VehicleCommand::ResetCraft.into()]
}

/// Returns `true` on the ground, and in the air if the same key was pressed just before. Else it says what the key does, and
/// waits for the second press.
fn ends_flight_at_once(state: &mut Shared, action: Action, consequence: &str, does: &str) -> bool {
    let asked = state.asked_in_flight.take();
    let was_asked = asked.is_some_and(|(about, at)| about == action && within(state.now, at, TWICE_WITHIN));
    if !is_airborne(state) || was_asked {
        return true;
    }
    state.asked_in_flight = Some((action, state.now));
    let key = state.key(action);
    state.notify(Severity::Warn, format!("{consequence}: press `{key}` again within 2 s to {does}."));
    false
}

/// Moves the AUTOPILOT switch. Engaging also switches on the hold modes, which take over when the autopilot is switched
/// off. While a command flies the craft, the switch could only wait for its end, so the command is cancelled instead.
pub(in crate::ui) fn toggle_autopilot(state: &mut Shared) -> Vec<Effect> {
    let Ok(switch) = switch(state, Mode::Autopilot) else { return Vec::new() };
    let mut next = frame(state);
    let on = next.channels[switch.channel] == switch.on_us;
    if state.view.vehicle.craft.is_commanded() && !on {
        return vec![Effect::Send(Command::Vehicle(VehicleCommand::CancelReturn))];
    }
    next.channels[switch.channel] = if on { switch.off_us } else { switch.on_us };
    if on && is_on(state, &next, Mode::AltHold) {
        rest_throttle(state, &mut next);
    }
    if on && !is_raised(state, &next) && !is_airborne(state) {
        set_hold_modes(state, &mut next, false);
    } else if !on && (state.view.vehicle.craft.is_armed() || is_raised(state, &next)) {
        prepare_hold(state, &mut next);
    }
    send(state, next)
}

/// Sends the craft home, or cancels that. Switches on the hold modes, which take over after a cancel; the scripted
/// pilot has them on.
pub(in crate::ui) fn toggle_return(state: &mut Shared) -> Vec<Effect> {
    if state.view.vehicle.craft.is_commanded() {
        return vec![Effect::Send(Command::Vehicle(VehicleCommand::CancelReturn))];
    }
    let before = frame(state);
    let mut next = before;
    prepare_hold(state, &mut next);
    let mut effects = Vec::new();
    if next != before && state.view.pilot.is_none() {
        effects = send(state, next);
    }
    effects.push(Effect::Send(Command::Vehicle(VehicleCommand::ReturnHome)));
    effects
}

/// Moves the throttle stick to the position given by [`throttle_move`].
pub(in crate::ui) fn move_throttle(state: &mut Shared) -> Vec<Effect> {
    let mut next = frame(state);
    let to = throttle_move(state);
    next.channels[THROTTLE] = match to {
        ThrottleMove::Hover => hover_us(state),
        ThrottleMove::Sink(us) => us,
        ThrottleMove::Low => LOW_US,
    };
    match to {
        ThrottleMove::Low if is_airborne(state) => {}
        ThrottleMove::Low => set_hold_modes(state, &mut next, false),
        ThrottleMove::Hover | ThrottleMove::Sink(_) => set_hold_modes(state, &mut next, true),
    }
    send(state, next)
}

/// Returns the settings of the sticks; with hover at mid-throttle if the flight controller does not report them.
fn settings(state: &Shared) -> SettingsView {
    let unknown =
        SettingsView { hover_stick_us: MIDDLE_US, raised_stick_us: MIDDLE_US, ..SettingsView::default() };
    state.view.vehicle.settings.unwrap_or(unknown)
}

/// Returns the stick position for hovering, with ALTHOLD and without; it always counts as raised.
fn hover_us(state: &Shared) -> u16 {
    let settings = settings(state);
    settings.hover_stick_us.max(settings.raised_stick_us)
}

/// Returns the value of a channel, changed by some µs.
pub(in crate::ui) fn nudged(state: &Shared, channel: usize, by_us: i32) -> u16 {
    (i32::from(channel_us(state, channel)) + by_us).clamp(1000, 2000) as u16
}

fn channel_us(state: &Shared, channel: usize) -> u16 {
    frame(state).channels.get(channel).copied().unwrap_or(MIDDLE_US)
}

pub(in crate::ui) fn set(state: &mut Shared, channel: usize, us: u16) -> Vec<Effect> {
    let mut next = frame(state);
    let Some(value) = next.channels.get_mut(channel) else { return Vec::new() };
    *value = us.clamp(1000, 2000);
    send(state, next)
}

/// Returns the value of a centred stick, the lowered throttle, or a switch that is moved from low to high or back.
pub(in crate::ui) fn flipped(state: &Shared, channel: usize) -> u16 {
    match channel {
        THROTTLE => LOW_US,
        0..=3 => MIDDLE_US,
        _ if channel_us(state, channel) >= MIDDLE_US => LOW_US,
        _ => 2000,
    }
}

/// Sends a frame. The keys take over from the scripted pilot.
fn send(state: &mut Shared, next: RcFrame) -> Vec<Effect> {
    let mut effects = Vec::new();
    if state.stick_recording.stop_playing() {
        state.notify(Severity::Info, "Playing stopped. You have the sticks.");
    }
    if state.view.pilot.is_some() {
        effects.push(Effect::Send(Command::Vehicle(VehicleCommand::StopPilot)));
        state.notify(Severity::Info, "Scripted pilot stopped. You have the sticks.");
    }
    match state.view.vehicle.craft.rc_source {
        Some(RcSource::Udp | RcSource::Msp) if state.view.vehicle.craft.rc_link == Some(true) => {
            state.notify(Severity::Warn, "Another RC source drives the craft: stop it to fly by keys.");
        }
        _ if state.view.rc_cut => {
            let text = format!("The RC link is cut: `{}` restores it.", state.key(Action::CutRc));
            state.notify(Severity::Warn, text);
        }
        _ => {}
    }
    state.sticks_sent = Some((next, state.now));
    effects.push(Effect::Send(Command::Vehicle(VehicleCommand::Sticks(next))));
    effects
}

#[cfg(test)]
mod tests;
