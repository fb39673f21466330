//! The input of a flown estimate, as far as the screen knows it.

use crate::lookahead::{ForecastRequest, SurveyedPlan};
use crate::plan::FlightPlan;
use crate::telemetry::Turbulence;
use crate::telemetry::snapshot::{SettingsView, WindView};

/// The input of an estimate.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct EstimateBasis {
    pub(in crate::ui) plan: FlightPlan,
    pub(in crate::ui) settings: Vec<String>,
    pub(in crate::ui) craft: Option<SettingsView>,
    pub(in crate::ui) air: Air,
}

/// The air and the craft in it.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct Air {
    pub(in crate::ui) airframe: String,
    pub(in crate::ui) wind: Option<WindView>,
    pub(in crate::ui) gust_mps: f64,
    pub(in crate::ui) turbulence: Turbulence,
    pub(in crate::ui) noise: bool,
}

impl EstimateBasis {
    /// Returns `true` if the plan has waypoints to fly.
    pub(in crate::ui) fn has_waypoints(&self) -> bool {
        !self.plan.waypoints.is_empty()
    }

    /// Returns the plan for a survey.
    pub(in crate::ui) fn surveyed(&self) -> SurveyedPlan {
        SurveyedPlan { plan: self.plan.clone(), settings: self.settings.clone() }
    }

    /// Returns the request for this input.
    pub(in crate::ui) fn request(&self) -> ForecastRequest {
        ForecastRequest::PlanEstimate { plan: Box::new(self.plan.clone()), settings: self.settings.clone() }
    }
}
