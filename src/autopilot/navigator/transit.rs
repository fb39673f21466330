//! Carries out the decisions of the machine.

use super::Navigator;
use super::observed::Observed;
use crate::autopilot::fence::{self, FenceFacts};
use crate::autopilot::io::NavInputs;
use crate::autopilot::machine::{Facts, Outcome, Transition, transition};
use crate::autopilot::params::Params;
use crate::telemetry::{AbortReason, FenceAction, Guard, NavEvent, NavState, TransitionReason};

/// The reason of a transition, with the guard that fired, if there is one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cause {
    reason: TransitionReason,
    guard: Option<Guard>,
}

impl From<TransitionReason> for Cause {
    fn from(reason: TransitionReason) -> Self {
        Self { reason, guard: None }
    }
}

impl Navigator {
    /// Makes at most one transition. Returns `true` if there was one.
    pub(super) fn step(&mut self, facts: &Facts, now: &NavInputs, params: &Params) -> bool {
        let Some(Transition { outcome, reason, guard }) = transition(self.state, facts) else {
            return false;
        };
        let cause = Cause { reason, guard };
        match outcome {
            Outcome::Abort(why) => self.abort(why, cause),
            Outcome::Fence(action) => self.fence(action, cause, &facts.fence, now, params),
            Outcome::LandHere => self.land_here(cause, now),
            Outcome::Climbed => {
                self.finish_climb();
                self.task.leg.start = now.here();
            }
            Outcome::Missed => {
                self.task.leg.missed = true;
                // The craft turns back, which is another leg to the monitors.
                self.task.leg.progress.pause();
            }
            Outcome::Arrive => self.enter(NavState::Arrived, cause),
            Outcome::Hold => {
                self.task.leg.hold.begin(now.time);
                self.enter(NavState::Holding, cause);
            }
            Outcome::Orbit => {
                self.task.leg.hold.phase_rad = 0.0;
                self.enter(NavState::Orbiting, cause);
            }
            Outcome::Figure8 => {
                self.task.leg.hold.phase_rad = 0.0;
                self.enter(NavState::Figure8, cause);
            }
            Outcome::Land => {
                self.task.leg.clear_clocks();
                self.enter(NavState::Landing, cause);
            }
            Outcome::Next => self.advance(cause, now, params),
            Outcome::Complete => self.complete(cause),
            Outcome::Touchdown => {
                self.task.cursor.forget_mission();
                self.engagement.landed = true;
                self.enter(NavState::Complete, cause);
                self.push(NavEvent::Disarm);
            }
        }
        true
    }

    /// Goes on to the next positional waypoint. The leg begins at the previous waypoint, or at the craft if it stayed
    /// there or came back to it.
    fn advance(&mut self, cause: Cause, now: &NavInputs, params: &Params) {
        let Some(next) = self.task.cursor.following() else {
            self.complete(cause);
            return;
        };
        let task = &mut self.task;
        let start =
            if task.cursor.kind().passes() && !task.leg.missed { task.leg.waypoint } else { now.here() };
        task.begin_leg(next, task.cursor.index().saturating_add(1), start, now, params);
        self.enter(NavState::Approaching, cause);
    }

    pub(super) fn complete(&mut self, cause: impl Into<Cause>) {
        self.task.cursor.finish();
        self.task.leg.progress.pause();
        self.enter(NavState::Complete, cause);
    }

    fn abort(&mut self, why: AbortReason, cause: Cause) {
        let lands = why == AbortReason::GpsLost && self.state == NavState::Landing;
        self.engagement.give_up(why, lands.then_some(self.task.leg.waypoint));
        if why == AbortReason::NoPlan {
            self.task.cursor.forget_mission();
        }
        self.go_idle(cause);
    }

    fn fence(
        &mut self,
        action: FenceAction,
        cause: Cause,
        fence: &FenceFacts,
        now: &NavInputs,
        params: &Params,
    ) {
        self.push(NavEvent::Geofence {
            distance_m: fence.distance_m.unwrap_or_default(),
            limit_m: fence.limit_m.unwrap_or_default(),
            action,
        });
        match action {
            FenceAction::Land => self.land_here(cause, now),
            FenceAction::Rth => self.fly_home(cause, None, now, params),
        }
    }

    /// Checks the fence after an abort. The wind carries the craft off after an abort, so the fence stays active
    /// until the switch is cycled.
    pub(super) fn check_fence_after_abort(&mut self, seen: &Observed) {
        if self.engagement.aborted().is_none()
            || !seen.now.armed
            || !seen.now.fix
            || !seen.now.altitude_valid
            || seen.now.failsafe
        {
            return;
        }
        // The same facts as on the leg that was given up.
        let fence = self.task.fence_facts(NavState::Approaching, seen);
        let outside = fence::guard(&fence).filter(Guard::holds);
        if outside.is_some() {
            let cause = Cause { reason: TransitionReason::Fence, guard: outside };
            self.fence(fence.action, cause, &fence, seen.now, seen.params);
        }
    }

    pub(super) fn go_idle(&mut self, cause: impl Into<Cause>) {
        self.enter(NavState::Idle, cause);
        self.steering.release();
        if self.engagement.landing_at.is_none() {
            self.task.cursor.unload();
        }
        self.task.yaw_cap_dps = None;
        self.task.rescue = None;
        self.task.leg.clear_clocks();
    }

    /// Ends the climb before the first leg, once per engagement.
    pub(super) fn finish_climb(&mut self) {
        if self.task.climb.finish() {
            self.push(NavEvent::Climbing(false));
        }
    }

    /// Changes the state. No other function does.
    pub(super) fn enter(&mut self, to: NavState, cause: impl Into<Cause>) {
        let Cause { reason, guard } = cause.into();
        let from = self.state;
        self.state = to;
        self.reason = Some(reason);
        if to != NavState::Approaching {
            if self.task.climb.break_off() {
                self.push(NavEvent::Climbing(false));
            }
            self.task.leg.progress.pause();
        }
        let kind = self.task.cursor.current().map(|waypoint| waypoint.kind);
        // A command between two updates is visible at once.
        self.report_status();
        self.push(NavEvent::State {
            from,
            to,
            wp: self.task.cursor.index(),
            kind,
            reason,
            guard,
            target: self.task.leg.waypoint,
            target_alt_m: self.task.leg.altitude_m,
        });
    }

    pub(super) fn push(&mut self, event: NavEvent) {
        // The queue is full only if nothing drains it. The newest events are dropped then.
        let _ = self.events.try_push(event);
    }
}
