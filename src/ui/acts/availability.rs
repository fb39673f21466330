//! Decides which actions are possible now, and gives the reason for each refusal.

use super::{stick_keys, transmitter};
use crate::fc::{Access, Denial, NO_RETURN_SWITCH, RemoteState};
use crate::session::policy::{self, Facts, NOT_KNOWN_YET, Refusal};
use crate::telemetry::{Mode, NavState};
use crate::ui::acts::surveys;
use crate::ui::shared::Shared;

use crate::ui::acts::intent::intent_of;
use crate::ui::model::action::{Action, PanelAction};

/// Checks that the action is possible now.
///
/// # Errors
/// Returns the reason for a refusal and the way out, in one sentence.
pub fn enabled(state: &Shared, action: Action) -> Result<(), String> {
    match policy::check(&Facts::from(&state.view), intent_of(state, action)) {
        // The user is asked for a missing permission.
        Ok(()) | Err(Refusal::Access(Denial::NotPermitted)) => can_do(state, action),
        Err(refusal) => Err(state.keymap.in_force(&refusal.to_string())),
    }
}

/// Checks that an action that the policy allows has an effect in this state of the craft.
fn can_do(state: &Shared, action: Action) -> Result<(), String> {
    let craft = &state.view.vehicle.craft;
    match action {
        Action::AllowChanges => match state.view.remote.as_ref().map(|remote| remote.access) {
            Some(Access::Reading) => Ok(()),
            Some(Access::Changing) => {
                Err("Changes are permitted already, until the connection ends.".to_owned())
            }
            Some(Access::Everything) | None => {
                Err("The craft is simulated: changes need no permission.".to_owned())
            }
        },
        Action::GoTo | Action::HoldHere | Action::Resume => can_command(state, action),
        Action::LookAhead if state.forecast.looks_ahead() => Ok(()),
        // The list has the flights of the plan from home, too.
        Action::WhatIf if surveys::can_ask(state).is_ok() => Ok(()),
        Action::WhereMay if state.survey.sweep().is_some() => Ok(()),
        Action::WhereMay | Action::GoNoGo => surveys::can_ask(state),
        Action::LookAhead | Action::WhatIf => flies(state),
        Action::Arm => transmitter::can_arm(state).map_err(|why| or_not_known_yet(state, why)),
        Action::Autopilot => {
            let switch = transmitter::switch(state, Mode::Autopilot);
            switch.map(drop).map_err(|why| or_not_known_yet(state, why))
        }
        Action::ShiftEarlier | Action::ShiftLater if state.other.is_none() => {
            Err("There is no second flight to shift: `betadeck replay A B` shows two.".to_owned())
        }
        Action::Panel(PanelAction::Play) => stick_keys::can_play(state),
        Action::Throttle if state.view.vehicle.is_engaged() => Err(format!(
            "The autopilot has the throttle: `{}` switches it off.",
            state.key(Action::Autopilot)
        )),
        Action::ReturnHome if craft.armed == Some(false) => {
            let fly = state.key(Action::Fly);
            Err(format!("Nothing to bring home: the craft is disarmed. `{fly}` flies the plan."))
        }
        Action::ReturnHome
            if state.view.remote.is_some() && transmitter::switch(state, Mode::GpsRescue).is_err() =>
        {
            Err(or_not_known_yet(state, NO_RETURN_SWITCH.to_owned()))
        }
        Action::ReturnHome if craft.home.is_none() => {
            Err("Home is unknown: it is the place of arming with a GPS fix.".to_owned())
        }
        Action::Upload if state.plan().waypoints.is_empty() => {
            Err("No plan is open, so there is nothing to upload.".to_owned())
        }
        Action::Fly if state.view.pilot.is_none() && is_wrecked(state) => {
            let reset = state.key(Action::ResetCraft);
            Err(format!("The craft crashed and cannot fly: `{reset}` puts it back home."))
        }
        Action::Fly if state.view.pilot.is_none() && craft.is_armed() => {
            let (engage, arm) = (state.key(Action::Autopilot), state.key(Action::Arm));
            if !transmitter::is_standing(state) {
                return Err(format!("The craft is in the air already: `{engage}` engages the autopilot."));
            }
            Err(format!(
                "The craft is armed already: `{engage}` engages the autopilot, or disarm with `{arm}` first."
            ))
        }
        _ => Ok(()),
    }
}

/// Checks that there is a flight to look ahead to.
///
/// # Errors
/// Returns the reason and the way out, in one sentence.
pub(in crate::ui) fn flies(state: &Shared) -> Result<(), String> {
    if state.view.vehicle.craft.is_armed() || state.view.pilot.is_some() {
        return Ok(());
    }
    if state.is_disarmed_in_the_air() {
        let reset = state.key(Action::ResetCraft);
        return Err(format!(
            "The craft falls disarmed, so there is no flight to look ahead to: `{reset}` puts it back home."
        ));
    }
    let fly = state.key(Action::Fly);
    Err(format!("The craft is disarmed, so there is no flight to look ahead to: `{fly}` flies the plan."))
}

/// Replaces the reason for a missing switch while the remote firmware has not yet reported its switches.
fn or_not_known_yet(state: &Shared, why: String) -> String {
    match &state.view.remote {
        Some(remote) if remote.state != RemoteState::Ready => NOT_KNOWN_YET.to_owned(),
        _ => why,
    }
}

/// Checks that the navigator accepts a command in flight.
fn can_command(state: &Shared, action: Action) -> Result<(), String> {
    let vehicle = &state.view.vehicle;
    let Some(nav) = vehicle.nav.as_ref().filter(|nav| nav.engaged) else {
        let (engage, fly) = (state.key(Action::Autopilot), state.key(Action::Fly));
        return Err(format!("The autopilot does not fly: `{engage}` engages it, `{fly}` flies the plan."));
    };
    let stored = vehicle.stored_plan.as_ref();
    match action {
        _ if !state.flies_stored_plan() => {
            let back = state.key(Action::ReturnHome);
            Err(format!(
                "The autopilot flies home or lands by a plan of its own: `{back}` cancels a return home."
            ))
        }
        Action::GoTo if stored.is_none_or(|plan| plan.waypoints.is_empty()) => {
            Err(format!("The craft has no plan: `{}` uploads one.", state.key(Action::Upload)))
        }
        Action::HoldHere if nav.state == NavState::Complete => {
            let go_to = state.key(Action::GoTo);
            Err(format!("The plan is complete and the craft keeps its place: `{go_to}` goes to a waypoint."))
        }
        Action::Resume if !nav.held_by_command => {
            Err(format!("Nothing is held: `{}` holds here.", state.key(Action::HoldHere)))
        }
        _ => Ok(()),
    }
}

/// Returns `true` if the craft has crashed, so that only a reset helps.
pub(in crate::ui) fn is_wrecked(state: &Shared) -> bool {
    state.view.vehicle.truth.as_ref().is_some_and(|truth| truth.crashed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;
    use crate::session::policy::REWOUND;
    use crate::timeline::TimelineView;

    #[test]
    fn a_craft_that_falls_disarmed_does_not_stand() {
        let mut view = SessionView::default();
        let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
        vehicle.craft.armed = Some(false);
        let mut state = Shared::bare((80, 24), view.clone());
        assert!(enabled(&state, Action::LookAhead).unwrap_err().contains("is disarmed"));
        let truth = crate::telemetry::snapshot::TruthView { alt: 30.0, ..Default::default() };
        std::sync::Arc::make_mut(&mut state.view.vehicle).truth = Some(truth);
        let reported = enabled(&state, Action::LookAhead).unwrap_err();
        assert!(
            reported.contains("falls disarmed") && reported.contains("`R` puts it back home"),
            "{reported}"
        );
    }

    #[test]
    fn nothing_steers_while_an_earlier_instant_is_shown() {
        let mut state = Shared::bare((80, 24), SessionView::default());
        state.view.timeline = Some(TimelineView { rewound: true, ..TimelineView::default() });
        for action in
            [Action::Fly, Action::Arm, Action::CutRc, Action::Upload, Action::Panel(PanelAction::Raise)]
        {
            assert_eq!(enabled(&state, action), Err(REWOUND.to_owned()));
        }
        for action in [Action::Pause, Action::Earlier, Action::FlyOn, Action::Zoom, Action::Quit] {
            assert_eq!(enabled(&state, action), Ok(()));
        }
    }
}
