//! State that outlasts a mission until the switch is cycled or the craft is disarmed: the reason of an abort, the
//! fix, the refusal.

use crate::autopilot::io::NavInputs;
use crate::geo::LatLon;
use crate::signals::SimTime;
use crate::telemetry::{AbortReason, Refusal};

/// The time that a lost fix must be back before a mission resumes, s.
const FIX_BACK_S: f64 = 2.0;

/// A change of the arming state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ArmingEdge {
    Armed,
    Disarmed,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Engagement {
    was_armed: bool,
    /// `true` after a touchdown with disarming. The state reads COMPLETE until the next arming.
    pub landed: bool,
    fix_since: Option<SimTime>,
    /// Reason why the last mission was given up, until the next one begins or the switch is cycled.
    pub given_up: Option<AbortReason>,
    /// Planned place of the landing that was given up for the lost fix.
    pub landing_at: Option<LatLon>,
    pub refused: Option<Refusal>,
}

impl Engagement {
    /// Follows arming and fix. Returns a change of the arming state.
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

    /// Gives up the mission. `landing_at` is the planned place of its landing, if one was under way.
    pub(super) fn give_up(&mut self, why: AbortReason, landing_at: Option<LatLon>) {
        self.given_up = Some(why);
        self.landing_at = landing_at;
    }

    /// Returns the reason why the craft was left to the wind and is not taken over again before the switch is cycled,
    /// if so.
    pub(super) fn aborted(&self) -> Option<AbortReason> {
        // A lost fix comes back, and a new plan is a new mission.
        self.given_up.filter(|why| matches!(why, AbortReason::Stalled | AbortReason::Flyaway))
    }

    /// Returns `true` while a mission waits for the fix to come back.
    pub(super) fn waits_for_fix(&self, now: &NavInputs) -> bool {
        self.given_up == Some(AbortReason::GpsLost) && !self.has_fix_back(now)
    }

    /// Returns `true` if there has been a fix for long enough to fly by it again.
    pub(super) fn has_fix_back(&self, now: &NavInputs) -> bool {
        now.fix && self.fix_since.is_some_and(|since| now.time.seconds_since(since) >= FIX_BACK_S)
    }

    /// Remembers a refusal. Returns `true` if it is a new one. The estimate of the hover throttle changes all the
    /// time, so a floor above it stays one refusal, with the value of its first instant.
    pub(super) fn refuse(&mut self, refusal: Refusal) -> bool {
        let floor_us = |refusal| match refusal {
            Refusal::ThrottleMin { throttle_min_us, .. } => Some(throttle_min_us),
            _ => None,
        };
        if floor_us(refusal).is_some() && self.refused.and_then(floor_us) == floor_us(refusal) {
            return false;
        }
        self.refused.replace(refusal) != Some(refusal)
    }

    /// Clears the refusal and the mission that was given up: the switch was cycled, or a mission begins.
    pub(super) fn clear(&mut self) {
        self.forget_mission();
        self.refused = None;
    }

    /// Forgets the mission that was given up, so that nothing waits for it.
    pub(super) fn forget_mission(&mut self) {
        self.given_up = None;
        self.landing_at = None;
    }
}
