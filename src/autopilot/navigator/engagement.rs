//! What outlasts a mission until the switch is cycled or the craft disarmed: why it was given up, the fix, the refusal.

use crate::autopilot::io::NavInputs;
use crate::geo::LatLon;
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

#[derive(Debug, Clone, Default)]
pub(super) struct Engagement {
    was_armed: bool,
    /// Touched down and disarmed; the state reads COMPLETE until the next arming.
    landed: bool,
    fix_since: Option<SimTime>,
    /// Why the last mission was given up, until the next one begins or the switch is cycled.
    given_up: Option<AbortReason>,
    /// Where the landing is to end that was given up for the lost fix.
    landing_at: Option<LatLon>,
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

    /// The mission was given up; `landing_at` is where its landing was to end, if one was under way.
    pub(super) fn give_up(&mut self, why: AbortReason, landing_at: Option<LatLon>) {
        self.given_up = Some(why);
        self.landing_at = landing_at;
    }

    /// Why the last mission was given up, while nothing has taken its place.
    pub(super) fn given_up(&self) -> Option<AbortReason> {
        self.given_up
    }

    /// Where the landing is to end that was given up for the lost fix.
    pub(super) fn landing_at(&self) -> Option<LatLon> {
        self.landing_at
    }

    /// Why the craft was left to the wind and is not taken over again before the switch is cycled, if so.
    pub(super) fn aborted(&self) -> Option<AbortReason> {
        // A lost fix comes back, and a new plan is a new mission.
        self.given_up.filter(|why| matches!(why, AbortReason::Stalled | AbortReason::Flyaway))
    }

    /// Whether a mission waits for the fix to be back.
    pub(super) fn waits_for_fix(&self, now: &NavInputs) -> bool {
        self.given_up == Some(AbortReason::GpsLost) && !self.has_fix_back(now)
    }

    /// Whether there has been a fix for long enough to fly by it again.
    pub(super) fn has_fix_back(&self, now: &NavInputs) -> bool {
        now.fix && self.fix_since.is_some_and(|since| now.time.seconds_since(since) >= FIX_BACK_S)
    }

    /// Why the switch has no effect, if it has none.
    pub(super) fn refused(&self) -> Option<Refusal> {
        self.refused
    }

    /// Remembers a refusal; returns whether it is a new one. The estimate of the hover throttle moves all the time: the
    /// floor that is above it stays one refusal, with the figure of its first instant.
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

    /// The switch was cycled, or a mission begins: neither refusal nor a mission given up count any more.
    pub(super) fn clear(&mut self) {
        self.forget_mission();
        self.refused = None;
    }

    /// The mission that was given up is not waited for any more.
    pub(super) fn forget_mission(&mut self) {
        self.given_up = None;
        self.landing_at = None;
    }
}
