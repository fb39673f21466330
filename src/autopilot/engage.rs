//! Why the autopilot engages, or not: the preconditions in their order, with words for people.

use super::fence;
use super::params::Params;
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::plan::validate::{PlanFault, check_plan};
use crate::telemetry::{AbortReason, Refusal};

/// Facts for the decision, each line of the list one field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EngageFacts {
    /// Whether the craft is armed.
    pub armed: bool,
    /// Whether the throttle has been above 25 % since arming.
    pub throttle_raised: bool,
    /// Whether a 3-D fix is present.
    pub fix: bool,
    /// Whether the altitude estimate is valid.
    pub altitude_valid: bool,
    /// Whether the heading is known.
    pub heading_valid: bool,
    /// Whether the plan can be flown.
    pub plan: Result<(), PlanFault>,
    /// Whether the fence allows the plan; only looked at when the plan can be flown.
    pub fence: Result<(), Refusal>,
    /// Whether the craft can come down with its least throttle.
    pub floor: Result<(), Refusal>,
    /// Whether stage 2 of the failsafe is active.
    pub failsafe: bool,
    /// Why the last mission was given up since the switch went on, if it was.
    pub aborted: Option<AbortReason>,
}

impl EngageFacts {
    /// The facts about the plan: whether it can be flown, and whether the fence allows it.
    pub fn plan_facts(
        stored: &FlightPlan,
        home: Option<LatLon>,
        params: &Params,
    ) -> (Result<(), PlanFault>, Result<(), Refusal>) {
        (check_plan(stored), fence::check_plan(params.max_distance_from_home, home, stored))
    }
}

/// Checks the least throttle against the hover throttle that the flight has shown, µs; before it has shown one there is
/// nothing to compare.
///
/// # Errors
/// When the craft would climb with the least throttle.
pub fn check_floor(throttle_min_us: u16, hover_us: Option<f64>) -> Result<(), Refusal> {
    match hover_us {
        // Saturates; hover throttles lie below 2000 µs.
        Some(hover_us) if f64::from(throttle_min_us) > hover_us => {
            Err(Refusal::ThrottleMin { throttle_min_us, hover_us: hover_us.round() as u16 })
        }
        Some(_) | None => Ok(()),
    }
}

/// The first precondition that fails.
///
/// # Errors
/// With the reason to show.
pub fn check(facts: &EngageFacts) -> Result<(), Refusal> {
    check_craft(facts)?;
    facts.plan.map_err(|fault| match fault {
        PlanFault::Empty => Refusal::NoPlan,
        PlanFault::Corrupt(_) => Refusal::PlanCorrupt,
        PlanFault::BadWaypoint { index, .. } => Refusal::BadWaypoint(index),
    })?;
    facts.fence?;
    facts.floor?;
    if facts.failsafe {
        return Err(Refusal::Failsafe);
    }
    facts.aborted.map_or(Ok(()), |why| Err(Refusal::Aborted(why)))
}

/// The preconditions that also hold for commands that bring their own plan.
///
/// # Errors
/// With the reason to show.
pub fn check_craft(facts: &EngageFacts) -> Result<(), Refusal> {
    if !facts.armed {
        return Err(Refusal::NotArmed);
    }
    if !facts.throttle_raised {
        return Err(Refusal::Throttle);
    }
    if !facts.fix {
        return Err(Refusal::NoFix);
    }
    if !facts.altitude_valid {
        return Err(Refusal::NoAltitude);
    }
    if !facts.heading_valid {
        return Err(Refusal::NoHeading);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fence_refusal_says_both_distances() {
        let refusal = Refusal::Geofence { wp: 3, distance_cm: 15_040, limit_m: 100 };
        assert_eq!(refusal.to_string(), "GEOFENCE");
        assert_eq!(refusal.sentence(), "Waypoint 3 is 150 m from home, the fence is 100 m.");
    }
}
