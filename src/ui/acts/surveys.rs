//! The requests of surveys, and the replies.

use crate::campaign::{Forecast, ForecastAnswer};
use crate::flight::forecast::{FlightResult, ForecastEnd};
use crate::flight::sweep::Fate;
use crate::lookahead::{SurveyJob, SurveyNews, SurveyReply, SurveyRequest};
use crate::sim::ScheduledFault;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::forecast::EstimateBasis;
use crate::ui::model::survey::{Shown, SurveyState, Surveyed, SweepSoFar};
use crate::ui::shared::Shared;

/// The fault of the first sweep.
const FIRST_FAULT: &str = "gps-loss,6";

/// Checks that there is a plan to fly.
///
/// # Errors
/// Returns the reason for a refusal, in a sentence.
pub(in crate::ui) fn can_ask(state: &Shared) -> Result<(), String> {
    if state.plan().waypoints.is_empty() {
        return Err("The plan has no waypoints, so there is nothing to fly.".to_owned());
    }
    Ok(())
}

/// Ends the sweep that is shown, or begins one with the fault of the last one.
pub(in crate::ui) fn toggle_sweep(state: &mut Shared) -> Vec<Effect> {
    if state.survey.sweep().is_some() {
        return dismiss(state).into_iter().collect();
    }
    match state.survey.fault.map_or_else(|| ScheduledFault::without_time(FIRST_FAULT), Ok) {
        Ok(fault) => ask_sweep(state, fault),
        Err(problem) => state.only_notify(Severity::Fault, problem),
    }
}

/// Begins a sweep with this fault.
pub(in crate::ui) fn ask_sweep(state: &mut Shared, fault: ScheduledFault) -> Vec<Effect> {
    state.survey.fault = Some(fault);
    let sweep = SweepSoFar { fault, points: Vec::new() };
    ask(state, SurveyRequest::Sweep(fault), Surveyed::Sweep(sweep))
}

/// Begins a hundred flights.
pub(in crate::ui) fn ask_go_no_go(state: &mut Shared) -> Vec<Effect> {
    ask(state, SurveyRequest::GoNoGo, Surveyed::GoNoGo(0, None))
}

fn ask(state: &mut Shared, request: SurveyRequest, what: Surveyed) -> Vec<Effect> {
    // One line on the map at a time.
    state.forecast.dismiss();
    let basis = EstimateBasis::of(state);
    let plan = Box::new(basis.surveyed());
    let survey = &mut state.survey;
    survey.revision += 1;
    survey.shown = Some(Shown { basis, is_over: false, what });
    vec![Effect::Survey(SurveyJob { revision: survey.revision, plan, request })]
}

/// Removes the survey from the screen. Returns the effect that ends it; `None` if there is none.
pub(in crate::ui) fn dismiss(state: &mut Shared) -> Option<Effect> {
    let survey: &mut SurveyState = &mut state.survey;
    survey.shown.take()?;
    survey.revision += 1;
    Some(Effect::EndSurvey(survey.revision))
}

/// Ends the survey if the plan or the air is another now.
pub(in crate::ui) fn follow(state: &mut Shared) -> Option<Effect> {
    let shown = state.survey.shown.as_ref()?;
    if shown.basis.still_holds(state) {
        return None;
    }
    if shown.basis.is_uploaded(state) {
        let basis = EstimateBasis::of(state);
        state.survey.shown.as_mut()?.basis = basis;
        return None;
    }
    if !shown.is_over {
        state.notify(Severity::Info, "The plan or the air has changed: its flights in the background ended.");
    }
    dismiss(state)
}

/// Processes a reply. `sentence` returns the answer of a hundred flights in one sentence.
pub(in crate::ui) fn take_reply(
    state: &mut Shared,
    reply: SurveyReply,
    sentence: fn(&str, &ForecastAnswer) -> String,
) {
    let name = state.editor.document().name.clone();
    let survey = &mut state.survey;
    let Some(shown) = survey.shown.as_mut().filter(|_| survey.revision == reply.revision) else { return };
    shown.is_over = reply.news.is_last();
    match (reply.news, &mut shown.what) {
        (SurveyNews::Point(point), Surveyed::Sweep(sweep)) => sweep.points.push(*point),
        (SurveyNews::SweepEnd, Surveyed::Sweep(sweep)) => {
            let mut text = sweep.sentence();
            let flown = state.forecast.estimate().filter(|_| !state.forecast.is_estimating());
            if flown.is_some_and(|flown| flown.end != ForecastEnd::Flight(FlightResult::Complete)) {
                text.push_str(" The plan fails without the fault, too.");
            }
            let is_lost = sweep.points.iter().any(|point| point.fate == Fate::Lost);
            state.notify(if is_lost { Severity::Warn } else { Severity::Good }, text);
        }
        (SurveyNews::Flown(flown), Surveyed::GoNoGo(so_far, _)) => *so_far = flown,
        (SurveyNews::GoNoGo(answer), Surveyed::GoNoGo(_, known)) => {
            let text = sentence(&name, &answer);
            let is_go = answer.is_go(Forecast::GO_FROM);
            *known = Some(text.clone());
            state.notify(if is_go { Severity::Good } else { Severity::Warn }, text);
        }
        (SurveyNews::Refused(reason), _) => {
            survey.shown = None;
            let reason = state.keymap.in_force(&reason);
            state.notify(Severity::Warn, reason);
        }
        // A reply to another request has another revision.
        _ => {}
    }
}

impl SweepSoFar {
    /// Returns the result in a sentence: `gps-loss,6 at every second: …; lost from 0:12 to 0:18.`
    fn sentence(&self) -> String {
        let worst = [Fate::Lost, Fate::Off].into_iter().find_map(|fate| {
            let mut of_fate = self.points.iter().filter(|point| point.fate == fate);
            let first = of_fate.next()?;
            Some((fate, first, of_fate.next_back().unwrap_or(first)))
        });
        let worst = worst.map_or_else(String::new, |(fate, first, last)| {
            let word = if fate == Fate::Lost { "lost" } else { "landed off" };
            let minutes = |second: u32| format!("{}:{:02}", second / 60, second % 60);
            match (minutes(first.second), minutes(last.second)) {
                (first, last) if first == last => format!("; {word} at {first}"),
                (from, to) => format!("; {word} between {from} and {to}"),
            }
        });
        format!("{} at every second: {}{worst}.", self.fault.timeless(), self.counts())
    }
}
