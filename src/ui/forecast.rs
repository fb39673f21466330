//! What the user interface knows of flights flown ahead of time, and when it asks for them.
//!
//! The flown estimate of the open plan is kept up to date by itself: [`follow_plan`] compares what the newest one was asked
//! for with what it would be asked for now. The look-ahead is asked for again while it is on; a what-if once.

mod estimate_basis;
mod estimate_line;
mod ghost;

use std::time::Duration;

use crate::session::{Forecast, ForecastJob, ForecastKind, ForecastReply, ForecastRequest, WhatIf};
use crate::signals::SimTime;

use super::app_state::AppState;
use super::editor::PlanId;
use super::event_log::Severity;
use super::formatting::within;
use super::message::Effect;
use estimate_basis::EstimateBasis;

pub(super) use estimate_line::lines as estimate_lines;
pub(super) use ghost::ghost;

/// Shortest time between two look-aheads while it is on.
const LOOK_AHEAD_INTERVAL: Duration = Duration::from_secs(1);
/// After this time without an answer it is asked for again.
const LOST_AFTER: Duration = Duration::from_secs(30);

/// A forecast that was asked for, and the newest one that came.
#[derive(Debug, Default)]
struct Asked {
    /// Of the newest request.
    revision: u64,
    /// When that was made, wall clock.
    at: Duration,
    /// An answer to it is on its way.
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

    /// Whether no answer will come any more, as when the session did not keep up.
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
    /// From which instant of the flight it was asked for last.
    from: SimTime,
}

/// A what-if that was chosen.
#[derive(Debug)]
struct ChosenWhatIf {
    what_if: WhatIf,
    asked: Asked,
}

/// What the user interface knows of forecasts.
#[derive(Debug, Default)]
pub struct ForecastState {
    /// Of the newest request of any kind.
    revision: u64,
    /// A picture of the session has come, so that there is something to ask.
    has_session: bool,
    /// With the next picture the estimate is asked for anew.
    settings_changed: bool,
    /// What the newest estimate was asked for.
    basis: Option<EstimateBasis>,
    estimate: Asked,
    /// The plan that the estimate is of.
    estimated: Option<PlanId>,
    look_ahead: Option<LookAhead>,
    what_if: Option<ChosenWhatIf>,
}

impl ForecastState {
    /// The newest flown estimate of the open plan; of an older state of it while [`Self::is_estimating`].
    pub fn estimate(&self) -> Option<&Forecast> {
        self.estimate.forecast()
    }

    /// Whether a newer estimate is on its way.
    pub fn is_estimating(&self) -> bool {
        self.estimate.waiting
    }

    /// Why there is no estimate, as a sentence.
    pub fn estimate_refusal(&self) -> Option<&str> {
        self.estimate.answer.as_ref()?.as_ref().err().map(String::as_str)
    }

    /// Whether the look-ahead is on.
    pub fn looks_ahead(&self) -> bool {
        self.look_ahead.is_some()
    }

    /// The session has sent a picture.
    pub(super) fn take_view(&mut self) {
        self.has_session = true;
        if std::mem::take(&mut self.settings_changed) {
            self.basis = None;
        }
    }

    /// Settings of the craft may have changed in a way that its pictures do not show.
    pub(super) fn settings_changed(&mut self) {
        self.settings_changed = true;
    }

    fn job(&mut self, request: ForecastRequest) -> Effect {
        self.revision += 1;
        Effect::Forecast(ForecastJob { revision: self.revision, request })
    }

    /// The flight goes on from another instant than the one a what-if was flown from.
    pub(super) fn forget_what_if(&mut self) {
        self.what_if = None;
    }

    /// The ghost and its line are not wanted any more; says whether there were any.
    pub(super) fn dismiss(&mut self) -> bool {
        let what_if = self.what_if.take().is_some();
        self.look_ahead.take().is_some() || what_if
    }
}

/// Asks for an estimate of the open plan when the newest one was for another, or for other air.
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
        // A result of the plan before, as numbers or as a refusal, says nothing of this one.
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

/// Asks again for what grows old, or whose answer was lost.
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

/// Flies ahead with something going wrong now.
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

/// Takes an answer in.
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
