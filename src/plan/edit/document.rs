//! Everything of a plan that can be edited and saved.

use crate::plan::FlightPlan;
use crate::plan::format::{HomePosition, PlanFile};

/// A plan as it is edited.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanDocument {
    /// Name of the plan.
    pub name: String,
    /// What the plan shows, for people; may be empty.
    pub description: String,
    /// Where the craft stands at boot, if the plan asks for a place.
    pub home: Option<HomePosition>,
    /// Settings the plan is made for, as `name = value`.
    pub settings: Vec<String>,
    pub plan: FlightPlan,
}

impl From<PlanFile> for PlanDocument {
    fn from(file: PlanFile) -> Self {
        let PlanFile { name, description, home, settings, plan, notes: _ } = file;
        Self { name, description, home, settings, plan }
    }
}

impl From<PlanDocument> for PlanFile {
    fn from(document: PlanDocument) -> Self {
        let PlanDocument { name, description, home, settings, plan } = document;
        Self { name, description, home, settings, plan, notes: Vec::new() }
    }
}
