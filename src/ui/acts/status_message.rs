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

fn metric(state: &Shared) -> Option<StatusMessage> {
    let vehicle = &state.view.vehicle;
    let craft = &vehicle.craft;
    let key = |action| state.key(action);
    let flying_again = state.view.timeline.as_ref().and_then(|timeline| timeline.flying_again);
    if let Some((reached, until)) = flying_again {
        let (reached_s, until_s) = (reached.as_secs_f64(), until.as_secs_f64());
        let condition = format!("The firmware flies again: {reached_s:.0} of {until_s:.0} s.");
        return message(Severity::Info, condition, format!("{} stops it", key(Action::FlyOn)));
    }
    if let Some(replay) = &state.view.replay {
        return of_replay(state, replay);
    }
    if let Some(rewound_s) = state.rewound_s() {
        let condition = format!("Rewound by {rewound_s:.1} s: the flight waits.");
        let flies_on = if state.flies_again() {
            format!("{} flies on from here, ", key(Action::FlyOn))
        } else {
            String::new()
        };
        let action = format!("{flies_on}{} goes to the end", key(Action::Newest));
        return message(Severity::Info, condition, action);
    }
    if let Some(reported) = state.view.remote.as_ref().and_then(|outside| remote::current(state, outside)) {
        return Some(reported);
    }
    match state.view.simulator {
        Some(LinkState::Silent) => {
            return message(
                Severity::Fault,
                "The simulator is silent: time is stopped.",
                "let it go on, or start it again",
            );
        }
        Some(LinkState::Waiting) => {
            let action = "start it; it sends to the door udp fdm";
            return message(Severity::Warn, "No simulator yet.", action);
        }
        Some(LinkState::Flowing) | None => {}
    }
    if let Some(truth) = &vehicle.truth {
        if truth.crashed {
            let action = format!("{}{} puts it back home", way_back(state), key(Action::ResetCraft));
            return message(Severity::Fault, "The craft crashed.", action);
        }
        if truth.diverged {
            return message(
                Severity::Fault,
                "The simulation left its valid range.",
                format!("{} resets", key(Action::ResetCraft)),
            );
        }
    }
    if let Some(ahead) = craft.failsafe_ahead {
        return failsafe_ahead(state, ahead);
    }
    if vehicle.is_engaged() {
        return in_flight(state);
    }
    if state.is_disarmed_in_the_air() {
        return disarmed_in_the_air(state);
    }
    let switched_on = transmitter::switch_is_on(state, Mode::Autopilot);
    if state.view.rc_cut {
        return message(
            Severity::Fault,
            "The RC link is cut.",
            format!("{} restores it", key(Action::CutRc)),
        );
    }
    let Some(armed) = craft.armed else {
        return message(
            Severity::Warn,
            "The flight controller does not report arming.",
            "wait for an answer",
        );
    };
    if armed {
        if craft.failsafe_stage.is_some_and(|stage| stage > 0) {
            return message(Severity::Fault, "Failsafe: the RC link is lost.", "send RC frames again");
        }
        if let Some(refusal) = vehicle.nav.as_ref().and_then(|nav| nav.refusal).filter(|_| switched_on) {
            let condition = format!("AUTOPILOT refused: {}", refusal.sentence());
            return message(Severity::Fault, condition, action_after(state, refusal));
        }
        if let Some(doing) = state.view.pilot {
            return message(
                Severity::Info,
                format!("The pilot flies: {doing}."),
                format!("{} stops it", key(Action::Fly)),
            );
        }
        return by_hand(state);
    }
    let outside = state.view.simulator.is_some();
    if vehicle.nav.as_ref().is_some_and(|nav| nav.state == NavState::Complete) {
        let again = format!("{} flies again", key(Action::Fly));
        let action = if outside {
            again
        } else {
            format!("{} puts the craft back home, {again}", key(Action::ResetCraft))
        };
        return message(Severity::Good, "Mission complete.", action);
    }
    if let Some(doing) = state.view.pilot {
        if let Some(flag) = most_useful_flag(craft.arming_flags()).filter(|_| craft.has_fix()) {
            let condition = format!("The pilot waits, arming is blocked: {flag}.");
            return message(Severity::Info, condition, arming_hint(state, flag));
        }
        return message(
            Severity::Info,
            format!("The pilot prepares: {doing}."),
            format!("{} stops it", key(Action::Fly)),
        );
    }
    if craft.gps_fix == Some(false) {
        return message(
            Severity::Warn,
            "No GPS fix yet.",
            format!("wait for satellites; {} waits by itself", key(Action::Fly)),
        );
    }
    if let Some(flag) = most_useful_flag(craft.arming_flags()) {
        return message(Severity::Warn, format!("Arming is blocked: {flag}."), arming_hint(state, flag));
    }
    let refused_open = findings::refusal_of_the_open(state).map(|refusal| {
        let title = state.editor.plan().title();
        let plan = key(Action::Show(Panel::Plan));
        let condition = format!("The autopilot would refuse {title}: {}.", refusal.reason());
        (condition, format!("{plan} edits the plan"))
    });
    if vehicle.stored_plan.as_ref().is_some_and(|plan| plan.waypoints.is_empty()) {
        if let Some((condition, action)) = refused_open {
            return message(Severity::Warn, condition, action);
        }
        let action = if state.plan().waypoints.is_empty() {
            {
                let (opens, inserts) =
                    (key(Action::Show(Panel::Plan)), key(Action::Edit(EditAction::Insert)));
                format!("{opens} opens the plan editor: `{inserts}` inserts a waypoint")
            }
        } else {
            let (upload, fly) = (key(Action::Upload), key(Action::Fly));
            let fence = settings_in_force::replaced_fence(state, state.editor.document());
            let fence = fence.map_or_else(String::new, |fence| format!(". {}", fence.trim_end_matches('.')));
            format!("{upload} uploads {}; {fly} does it and flies{fence}", state.editor.plan().title())
        };
        return message(Severity::Warn, "The craft has no plan.", action);
    }
    if switched_on {
        let action = format!("{} switches it off, then {} arms", key(Action::Autopilot), key(Action::Arm));
        return message(Severity::Warn, "AUTOPILOT is on while disarmed.", action);
    }
    if let Some(refusal) = findings::refusal_of_the_stored(state) {
        let (plan, upload) = (key(Action::Show(Panel::Plan)), key(Action::Upload));
        let condition = format!("The autopilot would refuse: {}.", refusal.reason());
        return message(Severity::Warn, condition, format!("{plan} edits the plan, {upload} uploads it"));
    }
    if transmitter::switch(state, Mode::Arm).is_err() {
        let action = match craft.mode_ranges {
            None => "wait for an answer".to_owned(),
            Some(_) => {
                format!("`aux 0 0 0 1700 2100` in the CLI ({}) assigns one", key(Action::Show(Panel::Cli)))
            }
        };
        return message(Severity::Warn, "No switch arms the craft.", action);
    }
    if let Some((condition, action)) = refused_open {
        let fly = key(Action::Fly);
        return message(
            Severity::Warn,
            condition,
            format!("{action}; {fly} asks, the craft has another plan"),
        );
    }
    let by_hand = [Action::Arm, Action::Throttle, Action::Autopilot].map(key).join(", ");
    let fly = key(Action::Fly);
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
        Refusal::Aborted(AbortReason::Stalled | AbortReason::Flyaway) => {
            format!("{} off and on again resumes", key(Action::Autopilot))
        }
    }
}
