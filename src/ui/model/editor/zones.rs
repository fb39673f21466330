//! The findings about the zones of the backdrop. They are computed when plan, home, backdrop or estimate have changed,
//! because a backdrop may have many vertices.

use std::path::PathBuf;

use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::plan::review::Finding;
use crate::ui::model::plan_id::PlanId;

/// The findings about zones, and their input.
#[derive(Debug, Default)]
pub(crate) struct ZoneReview {
    pub(in crate::ui) basis: Option<ZoneBasis>,
    pub(in crate::ui) findings: Vec<Finding>,
}

/// The input of the findings.
#[derive(Debug, PartialEq)]
pub(crate) struct ZoneBasis {
    pub(in crate::ui) id: PlanId,
    pub(in crate::ui) plan: FlightPlan,
    pub(in crate::ui) home: LatLon,
    pub(in crate::ui) layers: Vec<(PathBuf, usize)>,
    /// The revision of the flown estimate, if it is the newest.
    pub(in crate::ui) flown: Option<u64>,
}

impl ZoneReview {
    /// Returns the findings about the shown plan.
    pub(crate) fn findings(&self) -> &[Finding] {
        &self.findings
    }
}
