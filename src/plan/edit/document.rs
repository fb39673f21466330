//! The parts of a plan that can be edited and saved.

use crate::plan::FlightPlan;
use crate::plan::format::{HomePosition, PlanFile};

/// A plan during editing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanDocument {
    /// Name of the plan.
    pub name: String,
    /// A description for people; may be empty.
    pub description: String,
    /// The place of the craft at boot, if the plan gives one.
    pub home: Option<HomePosition>,
    /// The settings for the plan, as `name = value`.
    pub settings: Vec<String>,
    /// The plan as it is now.
    pub plan: FlightPlan,
}

impl From<PlanFile> for PlanDocument {
    fn from(file: PlanFile) -> Self {
        let PlanFile { name, description, home, settings, plan, rest: _, notes: _, losses: _ } = file;
        Self { name, description, home, settings, plan }
    }
}

impl From<PlanDocument> for PlanFile {
    fn from(document: PlanDocument) -> Self {
        let PlanDocument { name, description, home, settings, plan } = document;
        Self { name, description, home, settings, plan, ..PlanFile::default() }
    }
}
