//! The flights flown ahead of time: the newest request of each kind, and the newest answer.

pub(in crate::ui) mod estimate_basis;
pub(in crate::ui) mod setting_change;

use std::time::Duration;

use crate::flight::forecast::{Forecast, PathPoint};
use crate::lookahead::{ForecastJob, ForecastRequest};
use crate::signals::SimTime;

use crate::ui::formatting::within;
use crate::ui::model::effect::Effect;
use crate::ui::model::plan_id::PlanId;
use crate::ui::model::settings::Assignment;

pub(in crate::ui) use estimate_basis::EstimateBasis;
pub(in crate::ui) use setting_change::difference;

/// A requested forecast, and the newest answer.
#[derive(Debug, Default)]
pub(in crate::ui) struct Asked {
    /// The revision of the newest request.
    pub(in crate::ui) revision: u64,
    /// The time of the newest request, wall clock.
    pub(in crate::ui) at: Duration,
    /// `true` while an answer to it is on its way.
    pub(in crate::ui) waiting: bool,
    /// The newest answer, perhaps to an older request.
    pub(in crate::ui) answer: Option<Result<Box<Forecast>, String>>,
}

impl Asked {
    pub(in crate::ui) fn ask(&mut self, revision: u64, now: Duration) {
        self.revision = revision;
        self.at = now;
        self.waiting = true;
    }

    /// Returns `true` if no answer has come for longer than `patience`, as when the session did not keep up.
    pub(in crate::ui) fn is_lost(&self, now: Duration, patience: Duration) -> bool {
        self.waiting && !within(now, self.at, patience)
    }

    pub(in crate::ui) fn forecast(&self) -> Option<&Forecast> {
        self.answer.as_ref()?.as_ref().ok().map(|forecast| &**forecast)
    }
}

/// The look-ahead while it is on.
#[derive(Debug, Default)]
pub(in crate::ui) struct LookAhead {
    pub(in crate::ui) asked: Asked,
    /// The instant of the flight from which it was last requested.
    pub(in crate::ui) from: SimTime,
}

/// The chosen what-if.
#[derive(Debug)]
pub(in crate::ui) struct ChosenWhatIf {
    pub(in crate::ui) title: String,
    pub(in crate::ui) asked: Asked,
}

/// A value of a setting that is tried.
#[derive(Debug)]
pub(in crate::ui) struct TriedSetting {
    pub(in crate::ui) assignment: Assignment,
    pub(in crate::ui) asked: Asked,
}

/// The forecasts of the user interface.
#[derive(Debug, Default)]
pub struct ForecastState {
    /// The revision of the newest request of any kind.
    pub(in crate::ui) revision: u64,
    /// `true` once the session has sent a picture. Before that there is nothing to estimate.
    pub(in crate::ui) has_session: bool,
    /// `true` if the next picture triggers a new estimate.
    settings_changed: bool,
    /// The input of the newest estimate.
    pub(in crate::ui) basis: Option<EstimateBasis>,
    pub(in crate::ui) estimate: Asked,
    /// The plan of the estimate.
    pub(in crate::ui) estimated: Option<PlanId>,
    pub(in crate::ui) look_ahead: Option<LookAhead>,
    pub(in crate::ui) what_if: Option<ChosenWhatIf>,
    pub(in crate::ui) tried: Option<TriedSetting>,
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
    pub(in crate::ui) fn flown_path(&self) -> Option<(u64, &[PathPoint])> {
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
    pub(in crate::ui) fn take_view(&mut self) {
        self.has_session = true;
        if std::mem::take(&mut self.settings_changed) {
            self.basis = None;
        }
    }

    /// Records that settings of the craft may have changed in a way that its pictures do not show.
    pub(in crate::ui) fn settings_changed(&mut self) {
        self.settings_changed = true;
    }

    pub(in crate::ui) fn job(&mut self, request: ForecastRequest) -> Effect {
        self.revision += 1;
        Effect::Forecast(ForecastJob { revision: self.revision, request })
    }

    /// Drops the what-if and the tried setting, because the flight continues from another instant.
    pub(in crate::ui) fn forget_what_if(&mut self) {
        self.what_if = None;
        self.tried = None;
    }

    /// Drops the tried setting, because the craft has another value now.
    pub(in crate::ui) fn forget_tried(&mut self) {
        self.tried = None;
    }

    /// Returns the tried value of a setting, with the answer if there is one.
    pub(in crate::ui) fn tried(&self, name: &str) -> Option<(&str, Option<&Forecast>)> {
        let tried = self.tried.as_ref().filter(|tried| tried.assignment.name == name)?;
        Some((&tried.assignment.value, tried.asked.forecast()))
    }

    /// Removes the ghost and its line from the map. Returns `true` if there were any.
    pub(in crate::ui) fn dismiss(&mut self) -> bool {
        let tried = self.tried.take().is_some();
        let what_if = self.what_if.take().is_some();
        self.look_ahead.take().is_some() || what_if || tried
    }
}
