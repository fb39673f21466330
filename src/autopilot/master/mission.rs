//! The mission: the waypoints one after the other, the monitors on the way, holds, landings, the fence.

use arrayvec::ArrayVec;
use nalgebra::Vector2;

use super::hold::Pattern;
use super::landing::Descent;
use super::leg::{End, Flown, Leg, Target, bearing_rad};
use super::monitor::{Angles, HeadingCheck, Margin, Progress};
use super::route::Route;
use crate::autopilot::fence::{self, FenceFacts};
use crate::autopilot::io::NavInputs;
use crate::autopilot::navigator::{EVENT_CAPACITY, Rescue};
use crate::autopilot::params::{Params, YawMode};
use crate::geo::{local_offset, offset_to_latlon};
use crate::plan::{FlightPlan, HoldPattern, WaypointType};
use crate::telemetry::{
    AbortReason, FenceAction, Guard, GuardName, GuardOp, NavEvent, NavState, PlanSource, TransitionReason,
};

/// The longest flight forward in search of a heading, s.
const SEARCH_S: f64 = 15.0;

/// The order of a mission to the controllers in an update.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Order {
    /// Flies to a target.
    Fly(Course),
    /// Flies forward at the present height, so that the GPS shows the heading.
    SearchHeading,
}

/// A target, and the directions for the nose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Course {
    pub(super) target: Target,
    /// The heading that the leg commands.
    pub(super) heading_rad: Option<f64>,
    /// The bearing to the target; `None` within its acceptance radius.
    pub(super) bearing_rad: Option<f64>,
    pub(super) yaw_cap_dps: Option<f64>,
    /// `true` if the place where the craft stopped is held instead of the target, whose height counts.
    pub(super) holds: bool,
}

/// The return home of a fence: the altitude above home, m, and the speed, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Return {
    /// The least altitude above home, m.
    pub altitude_m: f64,
    /// The ground speed, m/s.
    pub speed_mps: f64,
}

/// The clocks and monitors of a mission, for displays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clocks {
    /// The time without progress and the distance, with their limits.
    pub(super) progress: Option<[Margin; 2]>,
    pub(super) heading: Margin,
    pub(super) held_s: f64,
    pub(super) grounded_s: Option<f64>,
    pub(super) phase_rad: Option<f64>,
}

/// The mission, and the state of its current waypoint.
#[derive(Debug, Clone, Default)]
pub(super) struct Mission {
    state: NavState,
    reason: Option<TransitionReason>,
    route: Route,
    leg: Option<Leg>,
    progress: Option<Progress>,
    heading: HeadingCheck,
    pattern: Pattern,
    /// The time in the hold, s.
    held_s: f64,
    descent: Option<Descent>,
    pub(super) rescue: Option<Rescue>,
    /// The time of the flight forward in search of a heading, s.
    searched_s: Option<f64>,
    /// The last commanded target; a line begins there.
    commanded_ne: Option<Vector2<f64>>,
    aborted: Option<AbortReason>,
    flown: Option<Flown>,
    events: ArrayVec<NavEvent, EVENT_CAPACITY>,
}

impl Mission {
    pub(super) fn state(&self) -> NavState {
        self.state
    }

    pub(super) fn reason(&self) -> Option<TransitionReason> {
        self.reason
    }

    pub(super) fn route(&self) -> &Route {
        &self.route
    }

    /// Returns the reason for which the mission was given up.
    pub(super) fn aborted(&self) -> Option<AbortReason> {
        self.aborted
    }

    /// Returns the leg as it was flown in the last update.
    pub(super) fn flown(&self) -> Option<&Flown> {
        self.flown.as_ref()
    }

    pub(super) fn leg(&self) -> Option<&Leg> {
        self.leg.as_ref().filter(|_| self.state == NavState::Approaching)
    }

    pub(super) fn rescue(&self) -> Option<&Rescue> {
        self.rescue.as_ref()
    }

    /// Returns the monitors of the leg, and the time of the hold or of the signs of the ground.
    pub(super) fn clocks(&self) -> Clocks {
        Clocks {
            progress: self.progress.as_ref().map(Progress::margins),
            heading: self.heading.margin(),
            held_s: self.held_s,
            grounded_s: self.descent.as_ref().map(Descent::grounded_s),
            phase_rad: self.pattern.phase_rad(),
        }
    }

    /// Forgets the reason for which the mission was given up.
    pub(super) fn forget_abort(&mut self) {
        self.aborted = None;
    }

    /// Returns `true` while there is a target.
    pub(super) fn has_target(&self) -> bool {
        !matches!(self.state, NavState::Idle | NavState::Complete)
    }

    /// Takes the oldest event that was not taken yet.
    pub(super) fn take_event(&mut self) -> Option<NavEvent> {
        self.events.pop_at(0)
    }

    /// Returns to IDLE after a landing, because the craft is armed again.
    pub(super) fn rest(&mut self) {
        (self.state, self.reason) = (NavState::Idle, None);
    }

    /// Starts a plan whose altitudes differ by `added_m` from those above home.
    pub(super) fn start(
        &mut self,
        (plan, source, added_m): (&FlightPlan, PlanSource, f64),
        reason: TransitionReason,
        guard: Option<Guard>,
        now: &NavInputs,
        params: &Params,
    ) {
        self.route.take(plan, source, added_m);
        let plan = Box::new(self.route.plan().clone());
        self.push(NavEvent::Plan { source, plan });
        self.aborted = None;
        self.heading = HeadingCheck::default();
        (self.commanded_ne, self.rescue, self.searched_s) = (None, None, None);
        if self.route.go_to(0, now, params) {
            self.begin_leg(reason, guard, now);
        } else {
            self.enter(NavState::Complete, reason, guard, now);
        }
    }

    /// Goes to the first positional waypoint from `index` on. Returns `false` if there is none.
    pub(super) fn go_to(&mut self, index: u8, now: &NavInputs, params: &Params) -> bool {
        let found = self.route.go_to(index, now, params);
        if found {
            self.commanded_ne = None;
            self.begin_leg(TransitionReason::SetCurrent, None, now);
        }
        found
    }

    /// Ends the mission, because its switch went off or the craft was disarmed.
    pub(super) fn stop(&mut self, reason: TransitionReason, now: &NavInputs) {
        if self.state != NavState::Idle {
            self.enter(NavState::Idle, reason, None, now);
        }
        self.aborted = None;
    }

    /// Runs one update of `dt` seconds. Returns the order; `None` without a target.
    pub(super) fn update(
        &mut self,
        now: &NavInputs,
        home: Return,
        params: &Params,
        dt: f64,
    ) -> Option<Order> {
        self.watch_fence(now, home, params);
        let order = match self.state {
            _ if self.searched_s.is_some() => self.search_heading(now, params, dt),
            NavState::Idle | NavState::Complete => None,
            NavState::Approaching | NavState::Arrived => self.fly_leg(now, params, dt),
            NavState::Holding | NavState::Orbiting | NavState::Figure8 => self.hold(now, params, dt),
            NavState::Landing => self.land(now, params, dt),
        };
        self.commanded_ne = match order {
            Some(Order::Fly(course)) => Some(course.target.point.ne),
            Some(Order::SearchHeading) | None => None,
        };
        order
    }

    /// Flies forward until the heading is known, then home.
    fn search_heading(&mut self, now: &NavInputs, params: &Params, dt: f64) -> Option<Order> {
        let searched_s = self.searched_s.unwrap_or_default() + dt;
        if now.heading_valid {
            self.searched_s = None;
            return self.advance(TransitionReason::Advance, None, now, params, dt);
        }
        if searched_s > SEARCH_S {
            self.abort(AbortReason::MagFault, None, now);
            return None;
        }
        self.searched_s = Some(searched_s);
        Some(Order::SearchHeading)
    }

    fn fly_leg(&mut self, now: &NavInputs, params: &Params, dt: f64) -> Option<Order> {
        let end = self.route.end(now)?;
        let cruise_mps = self.route.cruise_mps(params, dt);
        let flown = self.leg.as_mut()?.fly(now, &end, cruise_mps, params, dt);
        self.flown = Some(flown);
        if flown.is_reached {
            return self.arrive(&end, flown.gate_m, now, params, dt);
        }
        let way = end.ne - now.pos_ne;
        let bearing = bearing_rad(way);
        let heading_rad = flown.line.and_then(|(_, line)| line.heading_rad);
        let is_turning = flown.line.is_some_and(|(_, line)| line.is_turning);
        if let Some((why, guard)) = self.watch(way.norm(), bearing, is_turning, now, params, dt) {
            self.abort(why, Some(guard), now);
            return None;
        }
        Some(Order::Fly(Course {
            target: flown.target,
            heading_rad,
            bearing_rad: (way.norm() > flown.gate_m).then_some(bearing),
            yaw_cap_dps: self.route.yaw_cap_dps(),
            holds: false,
        }))
    }

    /// Runs the monitors of a leg. Returns the reason for giving the mission up.
    fn watch(
        &mut self,
        distance_m: f64,
        bearing_rad: f64,
        is_turning: bool,
        now: &NavInputs,
        params: &Params,
        dt: f64,
    ) -> Option<(AbortReason, Guard)> {
        let progress = self.progress.get_or_insert_with(|| Progress::new(distance_m));
        let [stalled, away] = progress.follow(distance_m, dt);
        let turns = matches!(params.yaw_mode, YawMode::Velocity | YawMode::Bearing | YawMode::Hybrid);
        let angles = Angles {
            heading_rad: now.heading_rad,
            course_rad: crate::math::atan2(now.vel_ne.y, now.vel_ne.x),
            bearing_rad,
        };
        let angles = (turns && !is_turning).then_some(&angles);
        let wrong = self.heading.follow(angles, now.vel_ne.norm(), dt);
        let guard = |name, Margin { value, limit }| Guard::new(name, value, GuardOp::Above, limit);
        let checks = [
            (AbortReason::Stalled, guard(GuardName::NoProgress, stalled)),
            (AbortReason::Flyaway, guard(GuardName::Flyaway, away)),
            (AbortReason::MagFault, guard(GuardName::WrongHeading, wrong)),
        ];
        checks.into_iter().find(|(_, guard)| guard.value > guard.limit)
    }

    fn arrive(&mut self, end: &End, gate_m: f64, now: &NavInputs, params: &Params, dt: f64) -> Option<Order> {
        let distance_m = (end.ne - now.pos_ne).norm();
        let guard = Guard::new(GuardName::Arrival, distance_m, GuardOp::AtMost, gate_m);
        let waits = self.route.hold_s().is_some_and(|seconds| seconds > 0.0);
        // Master itself goes on in the same update. Scenarios and displays wait for the arrival.
        self.enter(NavState::Arrived, TransitionReason::Arrival, Some(guard), now);
        match end.kind {
            WaypointType::Hold if self.rescue.is_some() && !now.heading_valid => {
                self.searched_s = Some(0.0);
                self.search_heading(now, params, dt)
            }
            WaypointType::Land if !waits => {
                self.begin_descent(end.ne, TransitionReason::Land, None, now);
                self.land(now, params, dt)
            }
            WaypointType::Hold | WaypointType::Land | WaypointType::Takeoff if waits => {
                (self.pattern, self.held_s) = (Pattern::default(), 0.0);
                self.enter(NavState::Holding, TransitionReason::Hold, None, now);
                self.hold(now, params, dt)
            }
            _ => self.advance(TransitionReason::Advance, None, now, params, dt),
        }
    }

    fn hold(&mut self, now: &NavInputs, params: &Params, dt: f64) -> Option<Order> {
        let waypoint = *self.route.current()?;
        let end = self.route.end(now)?;
        self.held_s += dt;
        let wanted_s = self.route.hold_s().unwrap_or_default();
        if self.held_s >= wanted_s {
            let guard = Guard::new(GuardName::HoldTime, self.held_s, GuardOp::AtLeast, wanted_s);
            if waypoint.kind == WaypointType::Land {
                self.begin_descent(end.ne, TransitionReason::HoldTime, Some(guard), now);
                return self.land(now, params, dt);
            }
            return self.advance(TransitionReason::HoldTime, Some(guard), now, params, dt);
        }
        let cruise_mps = self.route.cruise_mps(params, dt);
        let pattern = if waypoint.kind == WaypointType::Hold { waypoint.pattern } else { HoldPattern::None };
        let speed_mps = now.vel_ne.norm();
        let offset = self.pattern.follow(pattern, now.pos_ne - end.ne, speed_mps, cruise_mps, params, dt);
        let state = match (offset, pattern) {
            (Some(_), HoldPattern::Orbit) => NavState::Orbiting,
            (Some(_), HoldPattern::Figure8) => NavState::Figure8,
            _ => NavState::Holding,
        };
        if state != self.state {
            self.enter(state, TransitionReason::Pattern, None, now);
        }
        let ne = end.ne + offset.unwrap_or_default();
        let target = Target::towards(now, ne, end.altitude_m, cruise_mps, offset.is_none());
        let way = ne - now.pos_ne;
        Some(Order::Fly(Course {
            target,
            heading_rad: None,
            bearing_rad: (way.norm() > params.hold_radius_m()).then(|| bearing_rad(way)),
            yaw_cap_dps: self.route.yaw_cap_dps(),
            holds: offset.is_none(),
        }))
    }

    fn land(&mut self, now: &NavInputs, params: &Params, dt: f64) -> Option<Order> {
        let rate_mps = self.rescue.map_or_else(|| params.descent_rate_mps(), |rescue| rescue.descend_mps);
        let (target, is_down) = self.descent.as_mut()?.follow(now, rate_mps, params, dt);
        if is_down {
            let held_s = self.descent.as_ref().map_or(0.0, Descent::grounded_s);
            let wanted_s = 0.1 * f64::from(params.landing_detection_time);
            let guard = Guard::new(GuardName::TouchdownTime, held_s, GuardOp::AtLeast, wanted_s);
            self.enter(NavState::Complete, TransitionReason::Touchdown, Some(guard), now);
            self.push(NavEvent::Disarm);
            return None;
        }
        let yaw_cap_dps = self.route.yaw_cap_dps();
        Some(Order::Fly(Course { target, heading_rad: None, bearing_rad: None, yaw_cap_dps, holds: false }))
    }

    /// Goes on to the next positional waypoint, or completes the mission.
    fn advance(
        &mut self,
        reason: TransitionReason,
        guard: Option<Guard>,
        now: &NavInputs,
        params: &Params,
        dt: f64,
    ) -> Option<Order> {
        if let (Some(Leg::Line(_)), Some(end)) = (&self.leg, self.route.end(now)) {
            // The carrot has run to the end of its leg, and goes on from there.
            self.commanded_ne = Some(end.ne);
        }
        let next = self.route.index().saturating_add(1);
        if self.route.go_to(next, now, params) {
            self.begin_leg(reason, guard, now);
            return self.fly_leg(now, params, dt);
        }
        self.enter(NavState::Complete, reason, guard, now);
        None
    }

    fn begin_leg(&mut self, reason: TransitionReason, guard: Option<Guard>, now: &NavInputs) {
        // A carrot that ran before runs on.
        let carrot_mps = self.flown.filter(|_| self.commanded_ne.is_some()).and_then(|flown| flown.line);
        let carrot_mps = carrot_mps.map_or(0.0, |(_, line)| line.speed_mps);
        let from = self.commanded_ne.unwrap_or(now.pos_ne);
        self.leg = self.route.end(now).map(|end| Leg::new(&end, from, carrot_mps, now));
        self.progress = None;
        self.descent = None;
        self.enter(NavState::Approaching, reason, guard, now);
    }

    fn begin_descent(
        &mut self,
        ne: Vector2<f64>,
        reason: TransitionReason,
        guard: Option<Guard>,
        now: &NavInputs,
    ) {
        self.descent = Some(Descent::new(ne, now));
        self.enter(NavState::Landing, reason, guard, now);
    }

    /// Gives the mission up.
    pub(super) fn abort(&mut self, why: AbortReason, guard: Option<Guard>, now: &NavInputs) {
        self.aborted = Some(why);
        self.enter(NavState::Idle, TransitionReason::GivenUp(why), guard, now);
    }

    /// Ends a mission outside the fence: lands here, or flies home.
    fn watch_fence(&mut self, now: &NavInputs, home: Return, params: &Params) {
        let home_ne = now.home.map(|home| local_offset(now.origin, home));
        let facts = FenceFacts {
            limit_m: params.fence_m(),
            distance_m: home_ne.map(|home| (home - now.pos_ne).norm()),
            state: self.state,
            source: self.route.source(),
            action: params.geofence_action,
        };
        let Some(guard) = fence::guard(&facts).filter(|guard| guard.value > guard.limit) else { return };
        let (distance_m, limit_m, action) = (guard.value, guard.limit, facts.action);
        self.push(NavEvent::Geofence { distance_m, limit_m, action });
        match action {
            FenceAction::Land => {
                self.begin_descent(now.pos_ne, TransitionReason::Fence, Some(guard), now);
            }
            FenceAction::Rth => self.fly_home(home, TransitionReason::Fence, Some(guard), now, params),
        }
    }

    fn enter(&mut self, to: NavState, reason: TransitionReason, guard: Option<Guard>, now: &NavInputs) {
        let end = self.route.end(now);
        let event = NavEvent::State {
            from: self.state,
            to,
            wp: self.route.index(),
            kind: self.route.current().map(|waypoint| waypoint.kind),
            reason,
            guard,
            target: offset_to_latlon(now.origin, end.map_or(now.pos_ne, |end| end.ne)),
            target_alt_m: end.map_or(now.alt_m, |end| end.altitude_m),
        };
        (self.state, self.reason) = (to, Some(reason));
        self.push(event);
    }

    fn push(&mut self, event: NavEvent) {
        // The state itself is never lost.
        _ = self.events.try_push(event);
    }
}
