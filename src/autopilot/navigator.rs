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
mod station;
mod steer;
mod transit;

use arrayvec::ArrayVec;
use nalgebra::Vector2;

use super::control::{FlightControllers, YawController};
use super::io::NavInputs;
use super::params::Params;
use crate::plan::FlightPlan;
use crate::telemetry::{NavEvent, NavOutput, NavState, NavTelemetry, PlanSource, TransitionReason};
use altitude_wait::AltitudeWait;
use climb::Climb;
use cursor::PlanCursor;
use descent::Descent;
use engagement::{ArmingEdge, Engagement};
use hold::Hold;
use inputs::InputFilter;
use leg::Leg;
use progress::ProgressMonitor;
use station::StationMonitor;

pub use entry::Rescue;

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
    cursor: PlanCursor,
    leg: Leg,
    climb: Climb,
    progress: ProgressMonitor,
    altitude_wait: AltitudeWait,
    hold: Hold,
    station: StationMonitor,
    descent: Descent,
    rescue: Option<Rescue>,
    /// Yaw rate cap of a YAW_RATE waypoint, deg/s.
    yaw_cap_dps: Option<f64>,
    /// Position at the previous update, north and east, m.
    previous: Option<Vector2<f64>>,
    target_ne: Vector2<f64>,
    target_alt_m: f64,
    /// `true` if the craft was taken over since the last update and the controllers are not engaged yet.
    takes_over: bool,
    yaw: YawController,
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
        self.state != NavState::Idle && !self.engagement.has_landed()
    }

    /// Returns the plan that is flown, empty while nothing is flown.
    pub fn active_plan(&self) -> &FlightPlan {
        self.cursor.plan()
    }

    /// Returns the source of the active plan.
    pub fn source(&self) -> PlanSource {
        self.cursor.source()
    }

    /// Returns the index of the current waypoint in the active plan.
    pub fn index(&self) -> u8 {
        self.cursor.index()
    }

    /// Returns the state of the last update for displays, logs and samples.
    pub fn telemetry(&self) -> &NavTelemetry {
        &self.telemetry
    }

    /// Takes the events since the last call, oldest first.
    pub fn drain_events(&mut self) -> arrayvec::Drain<'_, NavEvent, EVENT_CAPACITY> {
        self.events.drain(..)
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
        let seen = self.observe(&now, params);
        let undecided = if self.is_flying() {
            self.cursor.follow_clearing(stored);
            self.engage_controllers(&now, params, controllers);
            self.prepare(&now, params, &seen, controllers.position.speed_setpoint_mps());
            self.end_old_descent(controllers);
            controllers.land.follow_altitude(now.alt_m);
            let mut facts = self.facts(&now, params, &seen, controllers);
            facts.touchdown_held_us = controllers.land.time_touchdown(facts.touchdown.all_hold(), now.time);
            (!self.step(&facts, &now, params)).then_some((facts, seen))
        } else {
            self.check_fence_after_abort(&now, params, &seen);
            None
        };
        self.previous = Some(now.pos_ne);
        if !self.is_flying() {
            self.watch_station(&now, params, &seen, controllers);
            self.report(&now, params, &seen, controllers, None);
            return NavOutput::default();
        }
        // A transition leads to another leg. After an abort it takes over the craft.
        self.engage_controllers(&now, params, controllers);
        self.end_old_descent(controllers);
        let (facts, seen) = undecided.unwrap_or_else(|| {
            let seen = self.observe(&now, params);
            (self.facts(&now, params, &seen, controllers), seen)
        });
        let flown = self.fly(&now, params, &seen, controllers);
        self.watch_station(&now, params, &seen, controllers);
        self.report(&now, params, &seen, controllers, Some((&facts, flown)));
        flown.output
    }

    /// Makes the land detector forget a descent that is no longer flown.
    fn end_old_descent(&self, controllers: &mut FlightControllers) {
        if self.state != NavState::Landing || !self.descent.has_begun() {
            controllers.land.end_descent();
        }
    }

    /// Engages the controllers once after taking over the craft.
    fn engage_controllers(&mut self, now: &NavInputs, params: &Params, controllers: &mut FlightControllers) {
        if std::mem::take(&mut self.takes_over) {
            controllers.engage(now, params);
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
