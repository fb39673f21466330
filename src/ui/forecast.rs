//! The flights flown ahead of time: the requests of the user interface and the answers.
//!
//! The flown estimate of the open plan keeps itself up to date: [`follow_plan`] compares the input of the newest
//! request with the current one. The look-ahead is requested again and again while it is on, a what-if once.

mod estimate_basis;
mod estimate_line;
mod ghost;
mod requests;
mod setting_change;

use std::time::Duration;

use crate::flight::forecast::{Forecast, PathPoint};
use crate::lookahead::{ForecastJob, ForecastRequest};
use crate::signals::SimTime;

use super::editor::PlanId;
use super::formatting::within;
use super::message::Effect;
use super::settings::Assignment;

pub(super) use estimate_basis::EstimateBasis;
pub(super) use estimate_line::lines as estimate_lines;
pub(super) use ghost::ghost;
pub(super) use requests::{
    ask_setting_change, ask_what_if, follow_plan, repeat, take_answer, toggle_look_ahead,
};
pub(super) use setting_change::difference;

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
    title: String,
    asked: Asked,
}

/// A value of a setting that is tried.
#[derive(Debug)]
struct TriedSetting {
    assignment: Assignment,
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
    tried: Option<TriedSetting>,
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

    /// Returns the revision and the path of the flown estimate of the open plan, unless a newer one is on its way.
    pub(super) fn flown_path(&self) -> Option<(u64, &[PathPoint])> {
        let forecast = self.estimate.forecast().filter(|_| !self.estimate.waiting)?;
        Some((self.estimate.revision, &forecast.path))
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

    /// Drops the what-if and the tried setting, because the flight continues from another instant.
    pub(super) fn forget_what_if(&mut self) {
        self.what_if = None;
        self.tried = None;
    }

    /// Drops the tried setting, because the craft has another value now.
    pub(super) fn forget_tried(&mut self) {
        self.tried = None;
    }

    /// Returns the tried value of a setting, with the answer if there is one.
    pub(super) fn tried(&self, name: &str) -> Option<(&str, Option<&Forecast>)> {
        let tried = self.tried.as_ref().filter(|tried| tried.assignment.name == name)?;
        Some((&tried.assignment.value, tried.asked.forecast()))
    }

    /// Removes the ghost and its line from the map. Returns `true` if there were any.
    pub(super) fn dismiss(&mut self) -> bool {
        let tried = self.tried.take().is_some();
        let what_if = self.what_if.take().is_some();
        self.look_ahead.take().is_some() || what_if || tried
    }
}
