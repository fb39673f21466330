//! The flights flown ahead of time: the requests of the user interface and the answers.
//!
//! The flown estimate of the open plan keeps itself up to date: [`follow_plan`] compares the input of the newest
//! request with the current one. The look-ahead is requested again and again while it is on, a what-if once.

mod estimate_basis;
mod estimate_line;
mod ghost;

use std::time::Duration;

use crate::flight::forecast::{Forecast, ForecastKind, WhatIf};
use crate::session::{ForecastJob, ForecastReply, ForecastRequest};
use crate::signals::SimTime;

use super::app_state::AppState;
use super::editor::PlanId;
use super::event_log::Severity;
use super::formatting::within;
use super::message::Effect;
use estimate_basis::EstimateBasis;

pub(super) use estimate_line::lines as estimate_lines;
pub(super) use ghost::ghost;

/// The shortest time between two look-aheads while it is on.
const LOOK_AHEAD_INTERVAL: Duration = Duration::from_secs(1);
/// The time without an answer after which a forecast is requested again.
const LOST_AFTER: Duration = Duration::from_secs(30);

/// A requested forecast, and the newest answer.
#[derive(Debug, Default)]
struct Asked {
    /// The revision of the newest request.
    revision: u64,
    /// The time of the newest request, wall clock.
    at: Duration,
    /// `true` while an answer to it is on its way.
    waiting: bool,
    /// The newest answer, perhaps to an older request.
    answer: Option<Result<Box<Forecast>, String>>,
}

impl Asked {
    fn ask(&mut self, revision: u64, now: Duration) {
        self.revision = revision;
        self.at = now;
        self.waiting = true;
    }

    /// Returns `true` if no answer will come any more, as when the session did not keep up.
    fn is_lost(&self, now: Duration) -> bool {
        self.waiting && !within(now, self.at, LOST_AFTER)
    }

    fn forecast(&self) -> Option<&Forecast> {
        self.answer.as_ref()?.as_ref().ok().map(|forecast| &**forecast)
    }
}

/// The look-ahead while it is on.
#[derive(Debug, Default)]
struct LookAhead {
    asked: Asked,
    /// The instant of the flight from which it was last requested.
    from: SimTime,
}

/// The chosen what-if.
#[derive(Debug)]
struct ChosenWhatIf {
    what_if: WhatIf,
    asked: Asked,
}

/// The forecasts of the user interface.
#[derive(Debug, Default)]
pub struct ForecastState {
    /// The revision of the newest request of any kind.
    revision: u64,
    /// `true` once the session has sent a picture. Before that there is nothing to estimate.
    has_session: bool,
    /// `true` if the next picture triggers a new estimate.
    settings_changed: bool,
    /// The input of the newest estimate.
    basis: Option<EstimateBasis>,
    estimate: Asked,
    /// The plan of the estimate.
    estimated: Option<PlanId>,
    look_ahead: Option<LookAhead>,
    what_if: Option<ChosenWhatIf>,
}

impl ForecastState {
    /// Returns the newest flown estimate of the open plan; of an older state of it while [`Self::is_estimating`].
    pub fn estimate(&self) -> Option<&Forecast> {
        self.estimate.forecast()
    }

    /// Returns `true` while a newer estimate is on its way.
    pub fn is_estimating(&self) -> bool {
        self.estimate.waiting
    }

    /// Returns the reason for a missing estimate, as a sentence.
    pub fn estimate_refusal(&self) -> Option<&str> {
        self.estimate.answer.as_ref()?.as_ref().err().map(String::as_str)
    }

    /// Returns `true` if the look-ahead is on.
    pub fn looks_ahead(&self) -> bool {
        self.look_ahead.is_some()
    }

    /// Records that the session has sent a picture.
    pub(super) fn take_view(&mut self) {
        self.has_session = true;
        if std::mem::take(&mut self.settings_changed) {
            self.basis = None;
        }
    }

    /// Records that settings of the craft may have changed in a way that its pictures do not show.
    pub(super) fn settings_changed(&mut self) {
        self.settings_changed = true;
    }

    fn job(&mut self, request: ForecastRequest) -> Effect {
        self.revision += 1;
        Effect::Forecast(ForecastJob { revision: self.revision, request })
    }

    /// Drops the what-if, because the flight continues from another instant.
    pub(super) fn forget_what_if(&mut self) {
        self.what_if = None;
    }

    /// Removes the ghost and its line from the map. Returns `true` if there were any.
    pub(super) fn dismiss(&mut self) -> bool {
        let what_if = self.what_if.take().is_some();
        self.look_ahead.take().is_some() || what_if
    }
}

/// Requests an estimate of the open plan if the newest one was for another plan or other air.
pub(super) fn follow_plan(state: &mut AppState) -> Option<Effect> {
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
pub(super) fn repeat(state: &mut AppState) -> Option<Effect> {
    if state.forecast.estimate.is_lost(state.now) {
        state.forecast.basis = None;
        return follow_plan(state);
    }
    look_ahead_again(state)
}

fn look_ahead_again(state: &mut AppState) -> Option<Effect> {
    let (now, time) = (state.now, state.view.vehicle.time);
    let look_ahead = state.forecast.look_ahead.as_ref()?;
    let asked = &look_ahead.asked;
    let is_old = !asked.waiting && !within(now, asked.at, LOOK_AHEAD_INTERVAL) && look_ahead.from != time;
    (is_old || asked.is_lost(now)).then(|| ask_look_ahead(state))
}

fn ask_look_ahead(state: &mut AppState) -> Effect {
    let (now, from) = (state.now, state.view.vehicle.time);
    let forecast = &mut state.forecast;
    let effect = forecast.job(ForecastRequest::LookAhead);
    let look_ahead = forecast.look_ahead.get_or_insert_default();
    look_ahead.asked.ask(forecast.revision, now);
    look_ahead.from = from;
    effect
}

/// Turns the look-ahead on or off.
pub(super) fn toggle_look_ahead(state: &mut AppState) -> Vec<Effect> {
    if state.forecast.look_ahead.take().is_some() {
        return Vec::new();
    }
    // One ghost at a time.
    state.forecast.what_if = None;
    vec![ask_look_ahead(state)]
}

/// Requests a flight ahead with something going wrong now.
pub(super) fn ask_what_if(state: &mut AppState, what_if: WhatIf) -> Vec<Effect> {
    let now = state.now;
    let forecast = &mut state.forecast;
    forecast.look_ahead = None;
    let effect = forecast.job(ForecastRequest::WhatIf(what_if));
    let mut asked = Asked::default();
    asked.ask(forecast.revision, now);
    forecast.what_if = Some(ChosenWhatIf { what_if, asked });
    vec![effect]
}

/// Processes an answer.
pub(super) fn take_answer(state: &mut AppState, reply: ForecastReply) {
    let forecast = &mut state.forecast;
    let asked = match reply.kind {
        ForecastKind::PlanEstimate => Some(&mut forecast.estimate),
        ForecastKind::LookAhead => forecast.look_ahead.as_mut().map(|look_ahead| &mut look_ahead.asked),
        ForecastKind::WhatIf => forecast.what_if.as_mut().map(|chosen| &mut chosen.asked),
    };
    let Some(asked) = asked.filter(|asked| asked.revision == reply.revision) else { return };
    asked.waiting = false;
    let refusal = reply.forecast.as_ref().err().cloned();
    asked.answer = Some(reply.forecast);
    match (reply.kind, refusal) {
        (ForecastKind::PlanEstimate, _) => {}
        // The flight is over, or there never was one to look ahead to.
        (ForecastKind::LookAhead | ForecastKind::WhatIf, Some(reason)) => {
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
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Waypoint, WaypointType};
    use crate::session::SessionView;
    use crate::session::command::CliOutput;
    use crate::ui::message::Msg;
    use crate::ui::panel::Panel;
    use crate::ui::update::update;

    /// Shows the same picture of the session again. Returns the number of estimates that are requested.
    fn estimates(state: &mut AppState) -> usize {
        let view = state.view.clone();
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
        state.editor.insert("a plan", &[land]).expect("a place for a waypoint");
        assert_eq!(estimates(&mut state), 1);
        assert_eq!(estimates(&mut state), 0, "nothing has changed");
        state.focus = Panel::Cli;
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
