//! The preconditions of an engagement in their order, with messages for people.

use super::fence;
use super::params::Params;
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::plan::validate::{PlanFault, check_plan};
use crate::telemetry::{AbortReason, Refusal};

/// The facts for the decision. Each line of the displayed list is one field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EngageFacts {
    /// `true` if the craft is armed.
    pub armed: bool,
    /// `true` if the throttle has been above 25 % since arming.
    pub throttle_raised: bool,
    /// `true` if a 3-D fix is present.
    pub fix: bool,
    /// `true` if the altitude estimate is valid.
    pub altitude_valid: bool,
    /// `true` if the heading is known.
    pub heading_valid: bool,
    /// The check that the plan can be flown.
    pub plan: Result<(), PlanFault>,
    /// The check of the plan against the fence; only used if the plan can be flown.
    pub fence: Result<(), Refusal>,
    /// The check that the craft can descend with its minimum throttle.
    pub floor: Result<(), Refusal>,
    /// `true` while stage 2 of the failsafe is active.
    pub failsafe: bool,
    /// The reason why the last mission since the switch went on was given up, if it was.
    pub aborted: Option<AbortReason>,
}

impl EngageFacts {
    /// A craft that is ready for a plan that can be flown.
    pub const READY: Self = Self {
        armed: true,
        throttle_raised: true,
        fix: true,
        altitude_valid: true,
        heading_valid: true,
        plan: Ok(()),
        fence: Ok(()),
        floor: Ok(()),
        failsafe: false,
        aborted: None,
    };

    /// Returns the facts about the plan: the check that it can be flown, and the check against the fence.
    pub fn plan_facts(
        stored: &FlightPlan,
        home: Option<LatLon>,
        params: &Params,
    ) -> (Result<(), PlanFault>, Result<(), Refusal>) {
        (check_plan(stored), fence::check_plan(params.max_distance_from_home, home, stored))
    }
}

/// Checks the minimum throttle against the hover throttle learned in flight, µs. Without a learned value the check
/// passes.
///
/// # Errors
/// Fails if the craft would climb with the minimum throttle.
pub fn check_floor(throttle_min_us: u16, hover_us: Option<f64>) -> Result<(), Refusal> {
    match hover_us {
        // Saturates. Hover throttles are below 2000 µs.
        Some(hover_us) if f64::from(throttle_min_us) > hover_us => {
            Err(Refusal::ThrottleMin { throttle_min_us, hover_us: hover_us.round() as u16 })
        }
        Some(_) | None => Ok(()),
    }
}

/// Checks the preconditions in their order.
///
/// # Errors
/// Fails with the first precondition that does not hold.
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

/// Checks the preconditions that also hold for commands that bring their own plan.
///
/// # Errors
/// Fails with the first precondition that does not hold.
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
