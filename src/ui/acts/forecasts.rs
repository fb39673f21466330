//! The requests of forecasts, and the answers.
//!
//! The flown estimate of the open plan keeps itself up to date: [`follow_plan`] compares the input of the newest
//! request with the current one. The look-ahead is requested again and again while it is on, a what-if once.

use std::time::Duration;

use crate::flight::forecast::{ForecastKind, WhatIf};
use crate::lookahead::{ForecastReply, ForecastRequest};
use crate::session::policy::{self, Facts, Intent};
use crate::ui::acts::estimate_basis::to_upload;
use crate::ui::acts::ghost_path::ghost;
use crate::ui::formatting::within;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::forecast::{Asked, ChosenWhatIf, EstimateBasis, TriedSetting};
use crate::ui::model::settings::Assignment;
use crate::ui::shared::Shared;

/// The shortest time between two look-aheads while it is on.
const LOOK_AHEAD_INTERVAL: Duration = Duration::from_secs(1);
/// The time without an answer after which a forecast is requested again.
const LOST_AFTER: Duration = Duration::from_secs(30);

/// Requests an estimate of the open plan if the plan, the settings or the air have changed since the last estimate.
pub(in crate::ui) fn follow_plan(state: &mut Shared) -> Option<Effect> {
    let holds = state.forecast.basis.as_ref().is_some_and(|basis| basis.still_holds(state));
    if holds || !state.forecast.has_session {
        return None;
    }
    let basis = EstimateBasis::of(state);
    let (now, id) = (state.now, state.editor.plan().id());
    let forecast = &mut state.forecast;
    let is_other = forecast.estimated.replace(id).is_some_and(|estimated| estimated != id);
    if is_other {
        // A result of the previous plan, numbers or a refusal, says nothing about this one.
        forecast.estimate.answer = None;
    }
    let effect = basis.has_waypoints().then(|| forecast.job(basis.request()));
    if effect.is_some() {
        forecast.estimate.ask(forecast.revision, now);
    } else {
        forecast.estimate = Asked::default();
    }
    forecast.basis = Some(basis);
    effect
}

/// Requests a forecast again if it is outdated or its answer was lost.
pub(in crate::ui) fn repeat(state: &mut Shared) -> Option<Effect> {
    if state.forecast.estimate.is_lost(state.now, LOST_AFTER) {
        state.forecast.basis = None;
        return follow_plan(state);
    }
    look_ahead_again(state)
}

fn look_ahead_again(state: &mut Shared) -> Option<Effect> {
    let (now, time) = (state.now, state.view.vehicle.time);
    let look_ahead = state.forecast.look_ahead.as_ref()?;
    let asked = &look_ahead.asked;
    let is_old = !asked.waiting && !within(now, asked.at, LOOK_AHEAD_INTERVAL) && look_ahead.from != time;
    // An executable first computes its flight up to now.
    let patience = if state.view.remote.is_some() { LOST_AFTER * 20 } else { LOST_AFTER };
    (is_old || asked.is_lost(now, patience)).then(|| ask_look_ahead(state))
}

fn ask_look_ahead(state: &mut Shared) -> Effect {
    let (now, from) = (state.now, state.view.vehicle.time);
    let forecast = &mut state.forecast;
    let effect = forecast.job(ForecastRequest::LookAhead);
    let look_ahead = forecast.look_ahead.get_or_insert_default();
    look_ahead.asked.ask(forecast.revision, now);
    look_ahead.from = from;
    effect
}

/// Turns the look-ahead on or off.
pub(in crate::ui) fn toggle_look_ahead(state: &mut Shared) -> Vec<Effect> {
    if state.forecast.look_ahead.take().is_some() {
        return Vec::new();
    }
    // One ghost at a time.
    state.forecast.dismiss();
    report_other_process(state);
    vec![ask_look_ahead(state)]
}

/// Requests a flight ahead with something going wrong now, or if nothing flies, from home.
pub(in crate::ui) fn ask_what_if(state: &mut Shared, what_if: WhatIf, flies: bool) -> Vec<Effect> {
    if flies {
        report_other_process(state);
    }
    let (now, settings) = (state.now, to_upload(state));
    let from_home = if flies { "" } else { ", flown from home" };
    let title = format!("{}{from_home}", what_if.title);
    let request = ForecastRequest::WhatIf { what_if, plan: Box::new(state.plan().clone()), settings };
    let forecast = &mut state.forecast;
    forecast.dismiss();
    let effect = forecast.job(request);
    let mut asked = Asked::default();
    asked.ask(forecast.revision, now);
    forecast.what_if = Some(ChosenWhatIf { title, asked });
    vec![effect]
}

/// Reports that a forecast of the flight of an executable takes a while.
fn report_other_process(state: &mut Shared) {
    if state.view.remote.is_some() {
        let text = "Another process of the firmware boots, computes the flight up to now and flies ahead.";
        state.notify(Severity::Info, text);
    }
}

/// Requests a flight ahead with another value of a setting, and the same one without it.
pub(in crate::ui) fn ask_setting_change(state: &mut Shared, assignment: Assignment) -> Vec<Effect> {
    let possible = policy::check(&Facts::from(&state.view), Intent::Forecast);
    if let Err(refusal) = possible {
        let refusal = state.keymap.in_force(&refusal.to_string());
        return state.only_notify(Severity::Warn, refusal);
    }
    let (now, settings) = (state.now, to_upload(state));
    let request = ForecastRequest::SettingChange {
        changed: vec![assignment.line()],
        plan: Box::new(state.plan().clone()),
        settings,
    };
    let forecast = &mut state.forecast;
    forecast.dismiss();
    let effect = forecast.job(request);
    let mut asked = Asked::default();
    asked.ask(forecast.revision, now);
    forecast.tried = Some(TriedSetting { assignment, asked });
    vec![effect]
}

/// Processes an answer.
pub(in crate::ui) fn take_answer(state: &mut Shared, reply: ForecastReply) {
    let forecast = &mut state.forecast;
    let asked = match reply.kind {
        ForecastKind::PlanEstimate => Some(&mut forecast.estimate),
        ForecastKind::LookAhead => forecast.look_ahead.as_mut().map(|look_ahead| &mut look_ahead.asked),
        ForecastKind::WhatIf => forecast.what_if.as_mut().map(|chosen| &mut chosen.asked),
        ForecastKind::SettingChange => forecast.tried.as_mut().map(|tried| &mut tried.asked),
    };
    let Some(asked) = asked.filter(|asked| asked.revision == reply.revision) else { return };
    asked.waiting = false;
    let refusal = reply.forecast.as_ref().err().cloned();
    asked.answer = Some(reply.forecast);
    match (reply.kind, refusal) {
        (ForecastKind::PlanEstimate, _) => {}
        // The flight is over, or there never was one to look ahead to.
        (ForecastKind::LookAhead | ForecastKind::WhatIf | ForecastKind::SettingChange, Some(reason)) => {
            forecast.dismiss();
            let reason = state.keymap.in_force(&reason);
            state.notify(Severity::Warn, reason);
        }
        (ForecastKind::LookAhead, None) => {}
        (ForecastKind::WhatIf, None) => {
            if let Some(ghost) = ghost(state) {
                let text = format!("What if {}.", ghost.line.trim_end_matches('.'));
                state.notify(Severity::Info, text);
            }
        }
        (ForecastKind::SettingChange, None) => {
            if let Some(ghost) = ghost(state) {
                let text = format!("With {}.", ghost.line.trim_end_matches('.'));
                state.log_only(Severity::Info, text);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Waypoint, WaypointType};
    use crate::session::SessionView;
    use crate::session::command::CliOutput;
    use crate::ui::app_state::AppState;
    use crate::ui::model::message::Msg;
    use crate::ui::model::panel_table::Panel;
    use crate::ui::update::update;

    /// Shows the same picture of the session again. Returns the number of estimates that are requested.
    fn estimates(state: &mut AppState) -> usize {
        let view = state.shared.view.clone();
        estimates_among(&update(state, Msg::View(view)))
    }

    fn estimates_among(effects: &[Effect]) -> usize {
        let is_estimate = |effect: &&Effect| match effect {
            Effect::Forecast(job) => matches!(job.request, ForecastRequest::PlanEstimate { .. }),
            _ => false,
        };
        effects.iter().filter(is_estimate).count()
    }

    #[test]
    fn a_line_entered_in_the_cli_asks_for_the_estimate_again() {
        let mut state = AppState::bare((80, 24), SessionView::default());
        let land = Waypoint { kind: WaypointType::Land, ..Waypoint::default() };
        state.shared.editor.insert("a plan", &[land]).expect("a place for a waypoint");
        assert_eq!(estimates(&mut state), 1);
        assert_eq!(estimates(&mut state), 0, "nothing has changed");
        state.shared.focus = Panel::Cli;
        let effects = update(&mut state, Msg::Paste("set p_roll = 60\n".to_owned()));
        let is_run = |effect: &Effect| matches!(effect, Effect::Cli(line) if line == "set p_roll = 60");
        assert!(effects.iter().any(is_run), "{effects:?}");
        assert_eq!(estimates(&mut state), 0, "the craft has not answered");
        let output = CliOutput { text: "p_roll set to 60\r\n".to_owned(), ..CliOutput::default() };
        let answered = update(&mut state, Msg::CliReply(Some(output)));
        assert_eq!(estimates_among(&answered) + estimates(&mut state), 1, "the craft flies with other gains");
        assert_eq!(estimates(&mut state), 0, "once is enough");
    }
}
