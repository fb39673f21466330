//! The navigator: keeps the active plan and the state, lets the machine decide, and flies the result.
//!
//! One update, in this order: facts (fix, plan, fence, distances, progress, hold and touchdown clocks) → at most one
//! transition → target and aim of the state → position, altitude and yaw control → demands. The altitude and position
//! controllers are lent to it. It engages them when it takes over, and does not touch them while it flies nothing.

mod altitude_wait;
mod climb;
mod cursor;
mod descent;
mod engagement;
mod entry;
mod facts;
mod fly;
mod hold;
mod in_flight;
mod inputs;
mod leg;
mod observed;
mod progress;
mod report;
mod rescue;
mod station;
mod steer;
mod task;
mod transit;

use arrayvec::ArrayVec;
use nalgebra::Vector2;

use super::control::FlightControllers;
use super::io::{NavInputs, NavOutput};
use super::machine::Facts;
use super::params::Params;
use crate::plan::FlightPlan;
use crate::telemetry::{NavEvent, NavState, NavTelemetry, TransitionReason};
use engagement::{ArmingEdge, Engagement};
use fly::{Flown, Steering};
use inputs::InputFilter;
use observed::Observed;
use station::{Station, StationMonitor};
use task::Task;

pub use rescue::Rescue;

/// The maximum number of events between two drains. Further events are dropped; the state itself is never lost.
pub const EVENT_CAPACITY: usize = 16;

/// The navigator; see the module's description.
#[derive(Debug, Clone, Default)]
pub struct Navigator {
    state: NavState,
    /// Cause of the last transition.
    reason: Option<TransitionReason>,
    inputs: InputFilter,
    engagement: Engagement,
    task: Task,
    steering: Steering,
    station: StationMonitor,
    /// Position at the previous update, north and east, m.
    previous: Option<Vector2<f64>>,
    telemetry: NavTelemetry,
    events: ArrayVec<NavEvent, EVENT_CAPACITY>,
}

impl Navigator {
    /// Returns a navigator that flies nothing.
    pub fn new() -> Self {
        Self { telemetry: NavTelemetry::idle(), ..Self::default() }
    }

    /// Returns the state of the machine.
    pub fn state(&self) -> NavState {
        self.state
    }

    /// Returns `true` while a mission, a return home or a landing is flown (COMPLETE in the air counts).
    pub fn is_flying(&self) -> bool {
        self.state != NavState::Idle && !self.engagement.landed
    }

    /// Returns the plan that is flown, empty while nothing is flown.
    pub fn active_plan(&self) -> &FlightPlan {
        self.task.cursor.plan()
    }

    /// Returns the state of the last update for displays, logs and samples.
    pub fn telemetry(&self) -> &NavTelemetry {
        &self.telemetry
    }

    /// Takes the oldest event that was not taken yet.
    pub fn take_event(&mut self) -> Option<NavEvent> {
        self.events.pop_at(0)
    }

    /// Runs one update (100 Hz): at most one transition, then the demands. `stored` is the plan in the craft's
    /// memory; only its clearing matters here. While nothing is flown, something else uses the `controllers`.
    pub fn update(
        &mut self,
        inputs: &NavInputs,
        params: &Params,
        stored: &FlightPlan,
        controllers: &mut FlightControllers,
    ) -> NavOutput {
        let now = self.inputs.apply(inputs);
        self.follow_arming(&now);
        let seen = Observed::new(&now, params, &self.task.cursor, &self.task.leg);
        let undecided = if self.is_flying() {
            self.task.cursor.follow_clearing(stored);
            self.steering.engage(&now, params, controllers);
            if self.task.prepare(self.state, &seen, controllers.position.speed_setpoint_mps()) {
                self.push(NavEvent::Climbing(true));
            }
            self.end_old_descent(controllers);
            controllers.land.follow_altitude(now.alt_m);
            let mut facts = self.task.facts(self.state, self.previous, &seen, controllers);
            facts.touchdown_held_us = controllers.land.time_touchdown(facts.touchdown.all_hold(), now.time);
            (!self.step(&facts, &now, params)).then_some((facts, seen))
        } else {
            self.check_fence_after_abort(&seen);
            None
        };
        self.previous = Some(now.pos_ne);
        if !self.is_flying() {
            self.finish_update(None, &seen, controllers);
            return NavOutput::default();
        }
        // A transition leads to another leg. After an abort it takes over the craft.
        self.steering.engage(&now, params, controllers);
        self.end_old_descent(controllers);
        let (facts, seen) = undecided.unwrap_or_else(|| {
            let seen = Observed::new(&now, params, &self.task.cursor, &self.task.leg);
            (self.task.facts(self.state, self.previous, &seen, controllers), seen)
        });
        let flown = self.steering.fly(self.state, &mut self.task, &seen, controllers);
        if let Some(tilt_rad) = flown.limited_tilt_rad {
            self.push(NavEvent::Limited { tilt_rad });
        }
        self.finish_update(Some((&facts, flown)), &seen, controllers);
        flown.output
    }

    /// Watches the station and reports the update. `flown` has the facts of the decision and the result of flying it,
    /// if anything was flown.
    fn finish_update(
        &mut self,
        flown: Option<(&Facts, Flown)>,
        seen: &Observed,
        controllers: &FlightControllers,
    ) {
        let station = Station::of(self.state, self.steering.target_ne, &self.task.leg, seen, controllers);
        let station = station.filter(|_| flown.is_some());
        if let Some(event) = self.station.update(station.as_ref(), seen.now.dt) {
            self.push(event);
        }
        let cannot_hold = self.station.reported;
        self.telemetry =
            report::report(self.state, &self.task, &self.steering, cannot_hold, seen, controllers, flown);
        self.report_status();
    }

    /// Reports state, plan and refusal, also between two updates.
    fn report_status(&mut self) {
        let is_flying = self.is_flying();
        let (telemetry, cursor) = (&mut self.telemetry, &self.task.cursor);
        telemetry.state = self.state;
        telemetry.engaged = is_flying;
        telemetry.climbing = self.task.climb.is_on();
        telemetry.refusal = self.engagement.refused.filter(|_| !is_flying);
        telemetry.reason = self.reason;
        telemetry.wp = cursor.index();
        telemetry.next_wp = cursor.next_index();
        telemetry.count = cursor.count();
        telemetry.source = cursor.source();
        telemetry.kind = cursor.current().map(|waypoint| waypoint.kind);
    }

    /// Makes the land detector forget a descent that is no longer flown.
    fn end_old_descent(&self, controllers: &mut FlightControllers) {
        if self.state != NavState::Landing || !self.task.leg.descent.has_begun() {
            controllers.land.end_descent();
        }
    }

    fn follow_arming(&mut self, now: &NavInputs) {
        match self.engagement.update(now) {
            Some(ArmingEdge::Disarmed) => self.on_disarm(),
            Some(ArmingEdge::Armed) if self.state == NavState::Complete => self.state = NavState::Idle,
            Some(ArmingEdge::Armed) | None => {}
        }
    }
}
