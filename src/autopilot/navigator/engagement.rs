//! What outlasts a mission until the switch is cycled or the craft disarmed: why it was given up, the fix, the refusal.

use crate::autopilot::io::NavInputs;
use crate::signals::SimTime;
use crate::telemetry::{AbortReason, Refusal};

/// How long a lost fix must be back before a mission resumes, s.
const FIX_BACK_S: f64 = 2.0;

/// A change of the arming state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ArmingEdge {
    /// Armed since the last update.
    Armed,
    /// Disarmed since the last update.
    Disarmed,
}

/// Memory between missions.
#[derive(Debug, Clone, Default)]
pub(super) struct Engagement {
    was_armed: bool,
    /// Touched down and disarmed; the state reads COMPLETE until the next arming.
    landed: bool,
    fix_since: Option<SimTime>,
    /// Why the last mission was given up, until the switch is cycled; after a lost fix until it is back.
    given_up: Option<AbortReason>,
    refused: Option<Refusal>,
}

impl Engagement {
    /// Follows arming and fix.
    pub(super) fn update(&mut self, now: &NavInputs) -> Option<ArmingEdge> {
        self.fix_since = if now.fix { self.fix_since.or(Some(now.time)) } else { None };
        match (std::mem::replace(&mut self.was_armed, now.armed), now.armed) {
            (true, false) => Some(ArmingEdge::Disarmed),
            (false, true) => {
                self.landed = false;
                Some(ArmingEdge::Armed)
            }
            (true, true) | (false, false) => None,
        }
    }

    /// Whether the craft has touched down since arming.
    pub(super) fn has_landed(&self) -> bool {
        self.landed
    }

    /// The mission ended on the ground.
    pub(super) fn land(&mut self) {
        self.landed = true;
    }

    /// The mission was given up.
    pub(super) fn give_up(&mut self, why: AbortReason) {
        match why {
            AbortReason::Stalled | AbortReason::Flyaway | AbortReason::GpsLost => self.given_up = Some(why),
            // A new plan is a new mission.
            AbortReason::NoPlan => {}
        }
    }

    /// Why the craft was left to the wind, if it was.
    pub(super) fn aborted(&self) -> Option<AbortReason> {
        self.given_up.filter(|why| *why != AbortReason::GpsLost)
    }

    /// Whether a mission waits for the fix to be back.
    pub(super) fn waits_for_fix(&self, now: &NavInputs) -> bool {
        let is_back =
            now.fix && self.fix_since.is_some_and(|since| now.time.seconds_since(since) >= FIX_BACK_S);
        self.given_up == Some(AbortReason::GpsLost) && !is_back
    }

    /// Why the switch has no effect, if it has none.
    pub(super) fn refused(&self) -> Option<Refusal> {
        self.refused
    }

    /// Remembers a refusal; returns whether it is a new one.
    pub(super) fn refuse(&mut self, refusal: Refusal) -> bool {
        self.refused.replace(refusal) != Some(refusal)
    }

    /// The switch was cycled, or a mission begins: neither refusal nor a mission given up count any more.
    pub(super) fn clear(&mut self) {
        self.given_up = None;
        self.refused = None;
    }

    /// The craft was disarmed.
    pub(super) fn forget_mission(&mut self) {
        self.given_up = None;
    }
}
