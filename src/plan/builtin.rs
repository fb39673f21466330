//! The plans in the executable, by name: the same files as in `plans/`.

use super::format::{Format, PlanError, PlanFile, parse};
use crate::text::did_you_mean;

/// The plan that is loaded if no other is named: the square of the Betaflight SITL autopilot guide.
pub const DEMO: &str = "square";

/// A plan that is part of the executable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltinPlan {
    /// The name on the command line.
    pub name: &'static str,
    /// The text, in [`Format::Toml`].
    pub text: &'static str,
}

/// All built-in plans, the demo first.
pub const PLANS: &[BuiltinPlan] = &[
    BuiltinPlan { name: "square", text: include_str!("../../plans/square.toml") },
    BuiltinPlan { name: "flyover", text: include_str!("../../plans/flyover.toml") },
    BuiltinPlan { name: "flyby", text: include_str!("../../plans/flyby.toml") },
    BuiltinPlan { name: "hold-orbit", text: include_str!("../../plans/hold-orbit.toml") },
    BuiltinPlan { name: "hold-figure8", text: include_str!("../../plans/hold-figure8.toml") },
    BuiltinPlan { name: "hold-none", text: include_str!("../../plans/hold-none.toml") },
    BuiltinPlan { name: "land", text: include_str!("../../plans/land.toml") },
    BuiltinPlan { name: "takeoff", text: include_str!("../../plans/takeoff.toml") },
    BuiltinPlan { name: "alt-change", text: include_str!("../../plans/alt-change.toml") },
    BuiltinPlan { name: "delay", text: include_str!("../../plans/delay.toml") },
    BuiltinPlan { name: "yaw-rate", text: include_str!("../../plans/yaw-rate.toml") },
];

impl BuiltinPlan {
    /// Returns the built-in plan with this name.
    pub fn find(name: &str) -> Option<Self> {
        PLANS.iter().copied().find(|plan| plan.name.eq_ignore_ascii_case(name))
    }

    /// Returns the built-in name that is closest to `name`.
    pub fn suggest(name: &str) -> Option<&'static str> {
        did_you_mean::closest(name, PLANS.iter().map(|plan| plan.name))
    }

    /// Reads the plan.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`parse`]. A test reads the plans of this executable, so they have none.
    pub fn read(self) -> Result<PlanFile, Vec<PlanError>> {
        parse(self.name, self.text, Format::Toml)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_builtin_plan_reads_and_is_called_what_it_says() {
        for plan in PLANS {
            let file = plan.read().unwrap_or_else(|errors| panic!("{errors:?}"));
            assert_eq!(file.name, plan.name);
            assert!(!file.description.is_empty());
        }
        assert_eq!(PLANS[0].name, DEMO);
    }

    #[test]
    fn names_are_found_and_suggested() {
        assert_eq!(BuiltinPlan::find("SQUARE").map(|plan| plan.name), Some("square"));
        assert_eq!(BuiltinPlan::find("nowhere"), None);
        assert_eq!(BuiltinPlan::suggest("sqare"), Some("square"));
    }
}
