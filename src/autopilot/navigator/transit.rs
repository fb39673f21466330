//! Carries out the decisions of the machine.

use super::Navigator;
use super::entry::here;
use super::observed::Observed;
use crate::autopilot::fence::{self, FenceFacts};
use crate::autopilot::io::NavInputs;
use crate::autopilot::machine::{Facts, Outcome, Transition, transition};
use crate::autopilot::params::Params;
use crate::geo::LatLon;
use crate::plan::WaypointType;
use crate::telemetry::{AbortReason, FenceAction, Guard, NavEvent, NavState, TransitionReason};

impl Navigator {
    /// Makes at most one transition. Returns `true` if there was one.
    pub(super) fn step(&mut self, facts: &Facts, now: &NavInputs, params: &Params) -> bool {
        let Some(Transition { outcome, reason, guard }) = transition(self.state, facts) else {
            return false;
        };
        match outcome {
            Outcome::Abort(why) => self.abort(why, reason, guard),
            Outcome::Fence(action) => self.fence(action, reason, guard, &facts.fence, now, params),
            Outcome::LandHere => self.land_here(reason, guard, now),
            Outcome::Climbed => {
                self.finish_climb();
                self.leg.start = here(now);
            }
            Outcome::Missed => {
                self.leg.missed = true;
                // The craft turns back, which is another leg to the monitors.
                self.progress.pause();
            }
            Outcome::Arrive => self.enter(NavState::Arrived, reason, guard),
            Outcome::Hold => {
                self.hold.begin(now.time);
                self.enter(NavState::Holding, reason, guard);
            }
            Outcome::Orbit => {
                self.hold.begin_pattern();
                self.enter(NavState::Orbiting, reason, guard);
            }
            Outcome::Figure8 => {
                self.hold.begin_pattern();
                self.enter(NavState::Figure8, reason, guard);
            }
            Outcome::Land => {
                self.clear_clocks();
                self.enter(NavState::Landing, reason, guard);
            }
            Outcome::Next => self.advance(reason, guard, now, params),
            Outcome::Complete => self.complete(reason, guard),
            Outcome::Touchdown => {
                self.cursor.forget_mission();
                self.engagement.land();
                self.enter(NavState::Complete, reason, guard);
                self.push(NavEvent::Disarm);
            }
        }
        true
    }

    /// Goes on to the next positional waypoint. The leg begins at the previous waypoint, or at the craft if it stayed
    /// there or came back to it.
    fn advance(&mut self, reason: TransitionReason, guard: Option<Guard>, now: &NavInputs, params: &Params) {
        let Some(next) = self.cursor.following() else {
            self.complete(reason, guard);
            return;
        };
        let kind = self.cursor.kind();
        let start = self.leg_end(kind, now);
        let modifiers_from = self.cursor.index().saturating_add(1);
        self.begin_leg(next, modifiers_from, start, reason, guard, now, params);
    }

    fn leg_end(&self, kind: WaypointType, now: &NavInputs) -> LatLon {
        if kind.passes() && !self.leg.missed { self.leg.waypoint } else { here(now) }
    }

    pub(super) fn complete(&mut self, reason: TransitionReason, guard: Option<Guard>) {
        self.cursor.finish();
        self.progress.pause();
        self.enter(NavState::Complete, reason, guard);
    }

    fn abort(&mut self, why: AbortReason, reason: TransitionReason, guard: Option<Guard>) {
        let lands = why == AbortReason::GpsLost && self.state == NavState::Landing;
        self.engagement.give_up(why, lands.then_some(self.leg.waypoint));
        if why == AbortReason::NoPlan {
            self.cursor.forget_mission();
        }
        self.go_idle(reason, guard);
    }

    fn fence(
        &mut self,
        action: FenceAction,
        reason: TransitionReason,
        guard: Option<Guard>,
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
            FenceAction::Land => self.land_here(reason, guard, now),
            FenceAction::Rth => self.fly_home(reason, guard, None, now, params),
        }
    }

    /// Checks the fence after an abort. The wind carries the craft off after an abort, so the fence stays active
    /// until the switch is cycled.
    pub(super) fn check_fence_after_abort(&mut self, now: &NavInputs, params: &Params, seen: &Observed) {
        if self.engagement.aborted().is_none()
            || !now.armed
            || !now.fix
            || !now.altitude_valid
            || now.failsafe
        {
            return;
        }
        // The same facts as on the leg that was given up.
        let fence = FenceFacts { state: NavState::Approaching, ..self.fence_facts(params, seen) };
        let outside = fence::guard(&fence).filter(Guard::holds);
        if outside.is_some() {
            self.fence(fence.action, TransitionReason::Fence, outside, &fence, now, params);
        }
    }

    pub(super) fn go_idle(&mut self, reason: TransitionReason, guard: Option<Guard>) {
        self.enter(NavState::Idle, reason, guard);
        self.takes_over = false;
        if self.engagement.landing_at().is_none() {
            self.cursor.unload();
        }
        self.yaw_cap_dps = None;
        self.rescue = None;
        self.clear_clocks();
        self.yaw.reset();
    }

    /// Ends the climb before the first leg, once per engagement.
    pub(super) fn finish_climb(&mut self) {
        if self.climb.finish() {
            self.push(NavEvent::Climbing(false));
        }
    }

    /// Changes the state. No other function does.
    pub(super) fn enter(&mut self, to: NavState, reason: TransitionReason, guard: Option<Guard>) {
        let from = self.state;
        self.state = to;
        self.reason = Some(reason);
        if to != NavState::Approaching {
            if self.climb.break_off() {
                self.push(NavEvent::Climbing(false));
            }
            self.progress.pause();
        }
        let kind = self.cursor.current().map(|waypoint| waypoint.kind);
        // A command between two updates is visible at once.
        self.report_status();
        self.push(NavEvent::State {
            from,
            to,
            wp: self.cursor.index(),
            kind,
            reason,
            guard,
            target: self.leg.waypoint,
            target_alt_m: self.leg.altitude_m,
        });
    }

    pub(super) fn push(&mut self, event: NavEvent) {
        // The queue is full only if nothing drains it. The newest events are dropped then.
        let _ = self.events.try_push(event);
    }
}
