//! The message at the top of the State panel: the obstacle to flying or the state of the flight, and the next step.

mod remote;

use crate::telemetry::{
    AbortReason, CannotHold, FailsafeAhead, FailsafeProcedure, HoldLimit, LinkState, Mode, NavState, Refusal,
};

use super::{findings, settings_in_force, transmitter};
use crate::session::ReplayView;
use crate::ui::acts::arming_hint::{arming_hint, most_useful_flag};
use crate::ui::acts::transmitter::ThrottleMove;
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::event_log::Severity;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;
use crate::ui::units::Units;

/// The state of the craft as a sentence, and the next step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StatusMessage {
    pub severity: Severity,
    /// The obstacle to flying, or the state of the flight.
    pub condition: String,
    pub action: String,
}

fn message(
    severity: Severity,
    condition: impl Into<String>,
    action: impl Into<String>,
) -> Option<StatusMessage> {
    Some(StatusMessage { severity, condition: condition.into(), action: action.into() })
}

/// Returns the current message in the shown units; `None` while the mission flies.
pub fn current(state: &Shared) -> Option<StatusMessage> {
    let StatusMessage { severity, condition, action } = metric(state)?;
    message(severity, state.units.in_sentence(condition), state.units.in_sentence(action))
}

/// A situation and its message; `None` if the craft is in another situation.
type Rule = fn(&Shared) -> Option<StatusMessage>;

/// The situations that come first, with the craft engaged or not.
const ALWAYS: [Rule; 8] =
    [flies_again, replay, rewound, remote_craft, simulator, crashed, diverged, link_is_lost];
/// The situations of a craft that the autopilot does not fly.
const NOT_ENGAGED: [Rule; 3] = [disarmed_in_the_air, rc_is_cut, arming_is_unknown];
/// The situations of an armed craft that the autopilot does not fly.
const ARMED: [Rule; 4] = [failsafe, refused_autopilot, pilot_flies, by_hand];
/// The situations of a disarmed craft.
const DISARMED: [Rule; 10] = [
    complete,
    pilot_prepares,
    no_fix,
    arming_is_blocked,
    no_plan,
    switched_on_while_disarmed,
    refused_stored_plan,
    no_switch_arms,
    refused_open_plan,
    ready,
];

/// Returns the message of the first situation that the craft is in.
fn first(rules: &[Rule], state: &Shared) -> Option<StatusMessage> {
    rules.iter().find_map(|rule| rule(state))
}

fn metric(state: &Shared) -> Option<StatusMessage> {
    let vehicle = &state.view.vehicle;
    first(&ALWAYS, state).or_else(|| match vehicle.craft.armed {
        _ if vehicle.is_engaged() => in_flight(state),
        Some(true) => first(&NOT_ENGAGED, state).or_else(|| first(&ARMED, state)),
        _ => first(&NOT_ENGAGED, state).or_else(|| first(&DISARMED, state)),
    })
}

fn flies_again(state: &Shared) -> Option<StatusMessage> {
    let (reached, until) = state.view.timeline.as_ref()?.flying_again?;
    let (reached_s, until_s) = (reached.as_secs_f64(), until.as_secs_f64());
    let condition = format!("The firmware flies again: {reached_s:.0} of {until_s:.0} s.");
    message(Severity::Info, condition, format!("{} stops it", state.key(Action::FlyOn)))
}

fn replay(state: &Shared) -> Option<StatusMessage> {
    of_replay(state, state.view.replay.as_deref()?)
}

fn rewound(state: &Shared) -> Option<StatusMessage> {
    let rewound_s = state.rewound_s()?;
    let condition = format!("Rewound by {rewound_s:.1} s: the flight waits.");
    let flies_on = match state.flies_again() {
        true => format!("{} flies on from here, ", state.key(Action::FlyOn)),
        false => String::new(),
    };
    message(Severity::Info, condition, format!("{flies_on}{} goes to the end", state.key(Action::Newest)))
}

fn remote_craft(state: &Shared) -> Option<StatusMessage> {
    remote::current(state, state.view.remote.as_ref()?)
}

fn simulator(state: &Shared) -> Option<StatusMessage> {
    match state.view.simulator? {
        LinkState::Silent => message(
            Severity::Fault,
            "The simulator is silent: time is stopped.",
            "let it go on, or start it again",
        ),
        LinkState::Waiting => {
            message(Severity::Warn, "No simulator yet.", "start it; it sends to the door udp fdm")
        }
        LinkState::Flowing => None,
    }
}

fn crashed(state: &Shared) -> Option<StatusMessage> {
    state.view.vehicle.truth.as_ref().filter(|truth| truth.crashed)?;
    let action = format!("{}{} puts it back home", way_back(state), state.key(Action::ResetCraft));
    message(Severity::Fault, "The craft crashed.", action)
}

fn diverged(state: &Shared) -> Option<StatusMessage> {
    state.view.vehicle.truth.as_ref().filter(|truth| truth.diverged)?;
    let action = format!("{} resets", state.key(Action::ResetCraft));
    message(Severity::Fault, "The simulation left its valid range.", action)
}

fn link_is_lost(state: &Shared) -> Option<StatusMessage> {
    failsafe_ahead(state, state.view.vehicle.craft.failsafe_ahead?)
}

fn rc_is_cut(state: &Shared) -> Option<StatusMessage> {
    if !state.view.rc_cut {
        return None;
    }
    message(Severity::Fault, "The RC link is cut.", format!("{} restores it", state.key(Action::CutRc)))
}

fn arming_is_unknown(state: &Shared) -> Option<StatusMessage> {
    if state.view.vehicle.craft.armed.is_some() {
        return None;
    }
    message(Severity::Warn, "The flight controller does not report arming.", "wait for an answer")
}

fn failsafe(state: &Shared) -> Option<StatusMessage> {
    state.view.vehicle.craft.failsafe_stage.filter(|stage| *stage > 0)?;
    message(Severity::Fault, "Failsafe: the RC link is lost.", "send RC frames again")
}

fn refused_autopilot(state: &Shared) -> Option<StatusMessage> {
    let refusal = state.view.vehicle.nav.as_ref()?.refusal?;
    if !transmitter::switch_is_on(state, Mode::Autopilot) {
        return None;
    }
    let condition = format!("AUTOPILOT refused: {}", refusal.sentence());
    message(Severity::Fault, condition, action_after(state, refusal))
}

fn pilot_flies(state: &Shared) -> Option<StatusMessage> {
    let condition = format!("The pilot flies: {}.", state.view.pilot?);
    message(Severity::Info, condition, format!("{} stops it", state.key(Action::Fly)))
}

fn complete(state: &Shared) -> Option<StatusMessage> {
    state.view.vehicle.nav.as_ref().filter(|nav| nav.state == NavState::Complete)?;
    let again = format!("{} flies again", state.key(Action::Fly));
    let action = match state.view.simulator {
        Some(_) => again,
        None => format!("{} puts the craft back home, {again}", state.key(Action::ResetCraft)),
    };
    message(Severity::Good, "Mission complete.", action)
}

fn pilot_prepares(state: &Shared) -> Option<StatusMessage> {
    let doing = state.view.pilot?;
    let craft = &state.view.vehicle.craft;
    if let Some(flag) = most_useful_flag(craft.arming_flags()).filter(|_| craft.has_fix()) {
        let condition = format!("The pilot waits, arming is blocked: {flag}.");
        return message(Severity::Info, condition, arming_hint(state, flag));
    }
    let condition = format!("The pilot prepares: {doing}.");
    message(Severity::Info, condition, format!("{} stops it", state.key(Action::Fly)))
}

fn no_fix(state: &Shared) -> Option<StatusMessage> {
    state.view.vehicle.craft.gps_fix.filter(|has_fix| !has_fix)?;
    let action = format!("wait for satellites; {} waits by itself", state.key(Action::Fly));
    message(Severity::Warn, "No GPS fix yet.", action)
}

fn arming_is_blocked(state: &Shared) -> Option<StatusMessage> {
    let flag = most_useful_flag(state.view.vehicle.craft.arming_flags())?;
    message(Severity::Warn, format!("Arming is blocked: {flag}."), arming_hint(state, flag))
}

fn no_plan(state: &Shared) -> Option<StatusMessage> {
    if !lacks_plan(state) {
        return None;
    }
    if let Some((condition, action)) = refusal_of_the_open(state) {
        return message(Severity::Warn, condition, action);
    }
    let action = if state.plan().waypoints.is_empty() {
        let opens = state.key(Action::Show(Panel::Plan));
        let inserts = state.key(Action::Edit(EditAction::Insert));
        format!("{opens} opens the plan editor: `{inserts}` inserts a waypoint")
    } else {
        let (upload, fly) = (state.key(Action::Upload), state.key(Action::Fly));
        let fence = settings_in_force::replaced_fence(state, state.editor.document());
        let fence = fence.map_or_else(String::new, |fence| format!(". {}", fence.trim_end_matches('.')));
        format!("{upload} uploads {}; {fly} does it and flies{fence}", state.editor.plan().title())
    };
    message(Severity::Warn, "The craft has no plan.", action)
}

fn switched_on_while_disarmed(state: &Shared) -> Option<StatusMessage> {
    if !transmitter::switch_is_on(state, Mode::Autopilot) {
        return None;
    }
    let (autopilot, arm) = (state.key(Action::Autopilot), state.key(Action::Arm));
    let action = format!("{autopilot} switches it off, then {arm} arms");
    message(Severity::Warn, "AUTOPILOT is on while disarmed.", action)
}

fn refused_stored_plan(state: &Shared) -> Option<StatusMessage> {
    let refusal = findings::refusal_of_the_stored(state)?;
    let (plan, upload) = (state.key(Action::Show(Panel::Plan)), state.key(Action::Upload));
    let condition = format!("The autopilot would refuse: {}.", refusal.reason());
    message(Severity::Warn, condition, format!("{plan} edits the plan, {upload} uploads it"))
}

fn no_switch_arms(state: &Shared) -> Option<StatusMessage> {
    transmitter::switch(state, Mode::Arm).err()?;
    let action = match state.view.vehicle.craft.mode_ranges {
        None => "wait for an answer".to_owned(),
        Some(_) => {
            let cli = state.key(Action::Show(Panel::Cli));
            format!("`aux 0 0 0 1700 2100` in the CLI ({cli}) assigns one")
        }
    };
    message(Severity::Warn, "No switch arms the craft.", action)
}

fn refused_open_plan(state: &Shared) -> Option<StatusMessage> {
    let (condition, action) = refusal_of_the_open(state)?;
    let fly = state.key(Action::Fly);
    message(Severity::Warn, condition, format!("{action}; {fly} asks, the craft has another plan"))
}

/// Returns the reason why the autopilot would refuse the open plan, and the next step.
fn refusal_of_the_open(state: &Shared) -> Option<(String, String)> {
    let refusal = findings::refusal_of_the_open(state)?;
    let title = state.editor.plan().title();
    let condition = format!("The autopilot would refuse {title}: {}.", refusal.reason());
    Some((condition, format!("{} edits the plan", state.key(Action::Show(Panel::Plan)))))
}

fn ready(state: &Shared) -> Option<StatusMessage> {
    let by_hand =
        [Action::Arm, Action::Throttle, Action::Autopilot].map(|action| state.key(action)).join(", ");
    let fly = state.key(Action::Fly);
    let flies = if settings_in_force::craft_has_another(state) {
        let title = state.editor.plan().title();
        format!("{fly} asks: the craft does not have {title} as edited")
    } else if state.plan().waypoints.is_empty() {
        format!("{fly} flies the craft's plan")
    } else {
        format!("{fly} flies the plan")
    };
    message(Severity::Good, "Ready.", format!("{flies}; by hand: {by_hand}"))
}

/// Returns the message for a recorded flight.
fn of_replay(state: &Shared, replay: &ReplayView) -> Option<StatusMessage> {
    let file = &replay.file;
    if replay.reading.is_some() {
        return message(
            Severity::Info,
            format!("Reading {file}."),
            format!("{} quits", state.key(Action::Quit)),
        );
    }
    let [play, back, on] =
        [Action::Pause, Action::EventBack, Action::EventForward].map(|action| state.key(action));
    let condition = match state.rewound_s() {
        Some(left_s) => format!("Recorded flight {file}, {left_s:.1} s before its end."),
        None => format!("The end of the recorded flight {file}."),
    };
    let plays = match (state.rewound_s(), state.view.paused) {
        (None, _) => "plays it again",
        (Some(_), true) => "plays it",
        (Some(_), false) => "pauses",
    };
    message(Severity::Info, condition, format!("{play} {plays}; `{back}` and `{on}` go from event to event"))
}

/// Returns the time that the lost link has to come back, and the failsafe action after it.
fn failsafe_ahead(state: &Shared, ahead: FailsafeAhead) -> Option<StatusMessage> {
    let does = match ahead.procedure {
        FailsafeProcedure::Drop => "motors off",
        FailsafeProcedure::AutoLand => "it comes down here, level",
        FailsafeProcedure::GpsRescue => "it flies home and lands",
        FailsafeProcedure::Continue => "the mission goes on",
        FailsafeProcedure::Land => "it lands here",
    };
    let severity = match ahead.procedure {
        FailsafeProcedure::Continue => Severity::Warn,
        _ => Severity::Fault,
    };
    let condition = format!("Failsafe in {:.1} s: {}, {does}.", ahead.in_s, ahead.procedure);
    let action = if state.view.rc_cut {
        format!("{} restores the link", state.key(Action::CutRc))
    } else {
        "send RC frames again".to_owned()
    };
    message(severity, condition, action)
}

/// Returns the message for a craft that falls without its motors.
fn disarmed_in_the_air(state: &Shared) -> Option<StatusMessage> {
    if !state.is_disarmed_in_the_air() {
        return None;
    }
    let action = if state.view.simulator.is_some() {
        "reset the simulator's world".to_owned()
    } else {
        format!("{}{} puts the craft back home", way_back(state), state.key(Action::ResetCraft))
    };
    message(Severity::Fault, "Disarmed in the air.", action)
}

/// Returns the keys that rewind to before the crash, if the flight is recorded.
fn way_back(state: &Shared) -> String {
    if !state.flies_again() {
        return String::new();
    }
    format!("{}, then {} takes it back; ", state.key(Action::StateBack), state.key(Action::FlyOn))
}

/// Returns the message for a mission in flight.
fn in_flight(state: &Shared) -> Option<StatusMessage> {
    let nav = state.view.vehicle.nav.as_ref()?;
    if let Some(deviation) = nav.cannot_hold {
        return cannot_hold_message(deviation, state.units);
    }
    if nav.held_by_command {
        let (on, to) = (state.key(Action::Resume), state.key(Action::GoTo));
        let action = format!("{on} goes on to WP{}, {to} to another", nav.wp);
        return message(Severity::Info, "Holds here by command.", action);
    }
    if state.flies_older_plan() {
        let condition = "The craft has a new plan, for the next engagement.";
        let action = format!("{} continues on it from a waypoint", state.key(Action::GoTo));
        return message(Severity::Info, condition, action);
    }
    None
}

/// Returns the message for a craft that is blown off its place or cannot keep its altitude.
fn cannot_hold_message(deviation: CannotHold, units: Units) -> Option<StatusMessage> {
    let CannotHold { distance_m, vertical_m, limit } = deviation;
    let side = if vertical_m < 0.0 { "low" } else { "high" };
    let (off, vertical) = (units.length_text(distance_m, 0), units.length_text(vertical_m.abs(), 0));
    let condition = format!("Cannot hold: {off} off, {vertical} too {side}.");
    let action = match limit {
        HoldLimit::Tilt => "the tilt is at its limit: raise ap_max_angle, or land",
        HoldLimit::Throttle => "the throttle is at its limit: land",
        HoldLimit::Battery => "the battery is too low for its thrust: land",
        HoldLimit::None => "no limit binds: sticks take over; check sensors and gains",
    };
    message(Severity::Warn, condition, action)
}

/// Returns `true` if the craft has no plan to fly.
fn lacks_plan(state: &Shared) -> bool {
    state.view.vehicle.stored_plan.as_ref().is_some_and(|plan| plan.waypoints.is_empty())
}

/// Returns the message for an armed craft flown by hand: its state, and the keys for the next step.
fn by_hand(state: &Shared) -> Option<StatusMessage> {
    let craft = &state.view.vehicle.craft;
    let [arm, throttle, autopilot, home, upload] =
        [Action::Arm, Action::Throttle, Action::Autopilot, Action::ReturnHome, Action::Upload]
            .map(|action| state.key(action));
    if let Some(refusal) = findings::refusal_of_the_stored(state) {
        let condition = format!("The autopilot would refuse: {}.", refusal.reason());
        let action = match (transmitter::is_standing(state), transmitter::throttle_move(state)) {
            (true, _) => format!("{arm} disarms"),
            (false, _) if transmitter::is_sinking(state) => format!("{throttle} stops the descent"),
            (false, ThrottleMove::Sink(_)) => format!("{throttle} comes down, {home} flies home"),
            (false, ThrottleMove::Hover) => format!("{throttle} holds the place"),
            (false, ThrottleMove::Low) => format!("{home} flies home"),
        };
        return message(Severity::Warn, condition, action);
    }
    let (condition, action) = match (transmitter::is_standing(state), transmitter::throttle_move(state)) {
        (true, ThrottleMove::Low) if lacks_plan(state) => {
            ("Armed, on the ground.", format!("{upload} uploads the plan, then {autopilot} takes off"))
        }
        (true, ThrottleMove::Low) => {
            ("Armed, on the ground.", format!("{autopilot} takes off; {throttle} low, then {arm} disarms"))
        }
        (true, _) => {
            ("Armed, throttle low.", format!("{throttle} raises it and holds, then {autopilot} engages"))
        }
        (false, _) if transmitter::is_sinking(state) => {
            ("Coming down.", format!("{throttle} stops that; on the ground {arm} disarms"))
        }
        (false, ThrottleMove::Sink(_)) if craft.is_active(Mode::PosHold) => {
            ("Holds its place.", format!("{autopilot} engages, {throttle} comes down, {home} flies home"))
        }
        (false, ThrottleMove::Sink(_)) => {
            ("Holds its height.", format!("{autopilot} engages, {throttle} comes down"))
        }
        (false, ThrottleMove::Hover) => {
            ("Flown by hand.", format!("{throttle} holds the place, {autopilot} engages"))
        }
        (false, ThrottleMove::Low) => ("Flown by hand.", format!("{autopilot} engages the autopilot")),
    };
    message(Severity::Info, condition, action)
}

/// Returns the advice after a refusal, with its keys.
fn action_after(state: &Shared, refusal: Refusal) -> String {
    let key = |action| state.key(action);
    match refusal {
        Refusal::NotArmed => format!("{} arms, then {} again", key(Action::Arm), key(Action::Autopilot)),
        Refusal::Throttle => format!("{} raises it", key(Action::Throttle)),
        Refusal::NoFix => "wait for satellites".to_owned(),
        Refusal::NoHeading => "fly straight ahead by hand for a few seconds".to_owned(),
        Refusal::NoAltitude => "wait for the barometer or GPS".to_owned(),
        Refusal::NoPlan => format!("{} uploads the plan", key(Action::Upload)),
        Refusal::PlanCorrupt => format!("{} uploads it again", key(Action::Upload)),
        Refusal::BadWaypoint(_) => format!("{} Plan shows why", key(Action::Show(Panel::Plan))),
        Refusal::NoHome => "disarm, wait for the fix, arm again".to_owned(),
        Refusal::Geofence { .. } => {
            let cli = key(Action::Show(Panel::Cli));
            format!("{cli} CLI: set ap_max_distance_from_home, or move the waypoint")
        }
        Refusal::ThrottleMin { .. } => {
            format!("{} CLI: set ap_throttle_min", key(Action::Show(Panel::Cli)))
        }
        Refusal::Failsafe => format!("{} restores the link", key(Action::CutRc)),
        Refusal::Aborted(AbortReason::GpsLost) => {
            format!("wait for satellites, or {} switches AUTOPILOT off: fly by hand", key(Action::Autopilot))
        }
        Refusal::Aborted(AbortReason::NoPlan) => {
            format!(
                "{} uploads the plan, {} off and on again flies it",
                key(Action::Upload),
                key(Action::Autopilot)
            )
        }
        Refusal::Aborted(AbortReason::Stalled | AbortReason::Flyaway | AbortReason::MagFault) => {
            format!("{} off and on again resumes", key(Action::Autopilot))
        }
    }
}
