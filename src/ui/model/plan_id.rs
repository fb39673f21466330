//! The identifier of an open plan.

/// Identifies an open plan in requests to the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct PlanId(pub u32);
