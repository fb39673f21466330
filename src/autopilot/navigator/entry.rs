//! The ways into and out of a mission.

use super::Navigator;
use super::climb::Climb;
use super::leg::Leg;
use super::rescue::Rescue;
use super::transit::Cause;
use crate::autopilot::engage::{self, EngageFacts};
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::{LatLon, local_offset};
use crate::plan::{Altitude, FlightPlan, LegSpeed, Waypoint, WaypointType};
use crate::telemetry::{AbortReason, NavEvent, NavState, PlanSource, Refusal, TransitionReason};

/// A landing ends at its planned place if the fix comes back this near to it, m.
const SAME_LANDING_M: f64 = 20.0;

impl Navigator {
    /// Engages while the mode switch is on: checks the preconditions and resumes the mission, or starts it. Call it
    /// in each cycle while nothing is flown. It reports a refusal once per cause.
    ///
    /// # Errors
    /// Fails with the first precondition that does not hold.
    pub fn engage(
        &mut self,
        inputs: &NavInputs,
        params: &Params,
        stored: &FlightPlan,
    ) -> Result<(), Refusal> {
        if self.is_flying() {
            return Ok(());
        }
        let inputs = &self.inputs.apply(inputs);
        let facts = self.engage_facts(inputs, params, stored);
        let landing_at = self.engagement.landing_at;
        let lost = self.engagement.waits_for_fix(inputs);
        let verdict = if facts.armed && facts.throttle_raised && lost {
            Err(Refusal::Aborted(AbortReason::GpsLost))
        } else if landing_at.is_some() {
            engage::check_craft(&facts)
        } else {
            engage::check(&facts)
        };
        if let Err(refusal) = verdict {
            self.refuse(refusal);
            return Err(refusal);
        }
        match landing_at {
            Some(land_at) => self.resume_landing(land_at, inputs),
            None => self.resume(inputs, params, stored),
        }
        Ok(())
    }

    /// Returns `true` if a landing that lost its fix waits for it.
    pub fn has_landing_to_resume(&self) -> bool {
        self.engagement.landing_at.is_some()
    }

    /// Returns the reason why the last mission was given up, until something takes its place.
    pub fn given_up(&self) -> Option<AbortReason> {
        self.engagement.given_up
    }

    /// Returns `true` if there has been a fix for long enough to fly by it again.
    pub fn has_fix_back(&self, inputs: &NavInputs) -> bool {
        self.engagement.has_fix_back(inputs)
    }

    /// Forgets the mission that was given up, so that nothing waits for it.
    pub fn forget_given_up(&mut self) {
        self.engagement.forget_mission();
        if !self.is_flying() {
            self.task.cursor.unload();
        }
    }

    /// Continues the landing that lost its fix, from the present altitude: at its planned place if that is near, else
    /// here.
    fn resume_landing(&mut self, land_at: LatLon, inputs: &NavInputs) {
        self.take_over(inputs);
        let distance_m = (local_offset(inputs.origin, land_at) - inputs.pos_ne).norm();
        let waypoint = if distance_m <= SAME_LANDING_M { land_at } else { inputs.here() };
        self.task.leg = Leg::here(inputs);
        self.task.leg.waypoint = waypoint;
        self.enter(NavState::Landing, TransitionReason::Resume);
    }

    fn engage_facts(&self, inputs: &NavInputs, params: &Params, stored: &FlightPlan) -> EngageFacts {
        let (plan, fence) = EngageFacts::plan_facts(stored, inputs.home, params);
        EngageFacts {
            armed: inputs.armed && !self.engagement.landed,
            throttle_raised: inputs.throttle_raised,
            fix: inputs.fix,
            altitude_valid: inputs.altitude_valid,
            heading_valid: inputs.heading_valid,
            plan,
            fence,
            floor: engage::check_floor(params.throttle_min, inputs.hover_us),
            failsafe: inputs.failsafe,
            aborted: self.engagement.aborted(),
        }
    }

    /// Reports why nothing is flown although it was requested. Each cause gives one event.
    pub fn refuse(&mut self, refusal: Refusal) {
        if self.engagement.refuse(refusal) {
            self.push(NavEvent::Refused(refusal));
        }
        self.report_status();
    }

    /// Resumes the mission that began since arming if the stored plan is still the same. Otherwise starts the mission
    /// from its first waypoint.
    fn resume(&mut self, inputs: &NavInputs, params: &Params, stored: &FlightPlan) {
        match self.task.cursor.resume_index(stored) {
            Some(index) => {
                self.begin(inputs, stored);
                self.begin_first_leg(index, true, TransitionReason::Resume, inputs, params);
            }
            None => self.start(inputs, params, stored),
        }
    }

    /// Starts the mission from its first waypoint, whatever was flown before.
    ///
    /// # Errors
    /// Fails if the plan cannot be flown, the fence forbids it or there is no fix. The navigator is IDLE then.
    pub fn reset(&mut self, inputs: &NavInputs, params: &Params, stored: &FlightPlan) -> Result<(), Refusal> {
        let inputs = &self.inputs.apply(inputs);
        let (plan, fence) = EngageFacts::plan_facts(stored, inputs.home, params);
        let facts = EngageFacts {
            fix: inputs.fix,
            plan,
            fence,
            floor: engage::check_floor(params.throttle_min, inputs.hover_us),
            // The other preconditions are those of the switch, not of the plan.
            ..EngageFacts::READY
        };
        // The plan is checked before the fix here, so that a missing plan is reported first.
        let plan = engage::check(&EngageFacts { fix: true, fence: Ok(()), ..facts });
        if let Err(refusal) = plan.and_then(|()| engage::check(&facts)) {
            if self.state != NavState::Idle {
                self.go_idle(TransitionReason::Refused(refusal));
            }
            self.refuse(refusal);
            return Err(refusal);
        }
        self.start(inputs, params, stored);
        Ok(())
    }

    fn start(&mut self, inputs: &NavInputs, params: &Params, stored: &FlightPlan) {
        self.begin(inputs, stored);
        let from = self.task.cursor.begin_mission(stored);
        match self.task.cursor.positional_from(from) {
            Some(index) => self.begin_first_leg(index, false, TransitionReason::Reset, inputs, params),
            None => {
                self.task.cursor.rewind();
                self.task.leg = Leg::here(inputs);
                self.complete(TransitionReason::Reset);
            }
        }
    }

    /// Makes the stored plan the active one and takes over the craft.
    fn begin(&mut self, inputs: &NavInputs, stored: &FlightPlan) {
        self.task.cursor.load(stored);
        self.take_over(inputs);
        self.announce_plan();
    }

    /// Resets the state that belongs to one engagement. The next update engages the controllers, unless they already
    /// fly.
    fn take_over(&mut self, inputs: &NavInputs) {
        self.steering.take_over(inputs, self.state == NavState::Idle);
        self.finish_climb();
        self.task.climb = Climb::default();
        self.task.yaw_cap_dps = None;
        self.task.rescue = None;
        self.engagement.clear();
        self.previous = Some(inputs.pos_ne);
    }

    /// Ends the flight when the mode switch goes off: IDLE, the active plan dropped. The mission can be resumed until
    /// disarming, and a mission that was given up may start again.
    pub fn disengage(&mut self) {
        self.engagement.clear();
        if self.is_flying() {
            self.go_idle(TransitionReason::Disengage);
        } else {
            self.task.cursor.unload();
            self.report_status();
        }
    }

    /// Ends the flight and forgets the mission. After a touchdown the state reads COMPLETE until the next arming.
    pub fn on_disarm(&mut self) {
        self.task.cursor.forget_flight();
        self.engagement.forget_mission();
        if self.engagement.landed {
            return;
        }
        if self.state == NavState::Idle {
            self.task.cursor.unload();
        } else {
            self.go_idle(TransitionReason::Disarm);
        }
    }

    /// Jumps to waypoint `index` of the stored plan. Before a mission, makes it the first one. Returns `true` if the
    /// command was accepted: `index` is in range and no injected plan is flown.
    ///
    /// Neither the command line nor MSP has a message for this. It is for programs that drive a navigator themselves.
    pub fn set_current(
        &mut self,
        index: u8,
        inputs: &NavInputs,
        params: &Params,
        stored: &FlightPlan,
    ) -> bool {
        let inputs = &self.inputs.apply(inputs);
        if !self.is_flying() {
            return self.task.cursor.start_next_at(index, stored);
        }
        if self.task.cursor.source() != PlanSource::Stored || index >= self.task.cursor.count() {
            return false;
        }
        let Some(positional) = self.task.cursor.positional_from(index) else { return false };
        self.task.yaw_cap_dps = None;
        self.task.begin_leg(positional, index, inputs.here(), inputs, params);
        self.enter(NavState::Approaching, TransitionReason::SetCurrent);
        true
    }

    /// Lands here, now: the active plan becomes one LAND at the craft. A repeated call starts again at the new place.
    ///
    /// # Errors
    /// Fails if the craft is not armed or has no fix or no altitude.
    pub fn emergency_land(&mut self, inputs: &NavInputs) -> Result<(), Refusal> {
        let inputs = &self.inputs.apply(inputs);
        self.check_command(inputs)?;
        self.land_here(TransitionReason::Emergency.into(), inputs);
        Ok(())
    }

    /// Returns home: the active plan becomes FLYOVER and LAND at home, at the altitude of the craft or that of
    /// `rescue`, whichever is higher. Without a known home it lands here.
    ///
    /// # Errors
    /// Fails if the craft is not armed or has no fix or no altitude.
    pub fn return_to_home(
        &mut self,
        inputs: &NavInputs,
        params: &Params,
        rescue: Option<Rescue>,
    ) -> Result<(), Refusal> {
        let inputs = &self.inputs.apply(inputs);
        self.check_command(inputs)?;
        self.fly_home(TransitionReason::ReturnHome.into(), rescue, inputs, params);
        Ok(())
    }

    fn check_command(&self, inputs: &NavInputs) -> Result<(), Refusal> {
        let facts = EngageFacts {
            armed: inputs.armed && !self.engagement.landed,
            throttle_raised: inputs.throttle_raised || self.is_flying(),
            fix: inputs.fix,
            altitude_valid: inputs.altitude_valid,
            heading_valid: inputs.heading_valid,
            ..EngageFacts::READY
        };
        engage::check_craft(&facts)
    }

    pub(super) fn land_here(&mut self, cause: Cause, inputs: &NavInputs) {
        let land = injected(WaypointType::Land, inputs.here(), inputs.alt_m, 0.0);
        self.task.cursor.inject(PlanSource::Emergency, &[land]);
        self.take_over(inputs);
        self.announce_plan();
        self.task.cursor.move_to(0);
        self.task.leg = Leg::here(inputs);
        self.enter(NavState::Landing, cause);
    }

    pub(super) fn fly_home(
        &mut self,
        cause: Cause,
        rescue: Option<Rescue>,
        inputs: &NavInputs,
        params: &Params,
    ) {
        let Some(home) = inputs.home else {
            self.land_here(cause, inputs);
            return;
        };
        let altitude = inputs
            .alt_m
            .max(f64::from(params.min_nav_altitude_m))
            .max(rescue.map_or(f64::NEG_INFINITY, |rescue| rescue.altitude_m));
        let speed = rescue.map_or(0.0, |rescue| rescue.speed_mps);
        let records =
            [WaypointType::Flyover, WaypointType::Land].map(|kind| injected(kind, home, altitude, speed));
        self.task.cursor.inject(PlanSource::Rth, &records);
        self.take_over(inputs);
        self.task.rescue = rescue;
        self.announce_plan();
        self.begin_first_leg(0, false, cause, inputs, params);
    }

    /// Begins the first leg of an engagement; see [`Task::begin_first_leg`](super::task::Task::begin_first_leg).
    pub(super) fn begin_first_leg(
        &mut self,
        index: u8,
        resumed: bool,
        cause: impl Into<Cause>,
        inputs: &NavInputs,
        params: &Params,
    ) {
        self.task.begin_first_leg(index, resumed, inputs, params);
        self.enter(NavState::Approaching, cause);
    }

    pub(super) fn announce_plan(&mut self) {
        self.push(NavEvent::Plan {
            source: self.task.cursor.source(),
            plan: Box::new(self.task.cursor.plan().clone()),
        });
    }
}

fn injected(kind: WaypointType, position: LatLon, altitude_m: f64, speed_mps: f64) -> Waypoint {
    Waypoint {
        position,
        altitude: Altitude::above_home(altitude_m),
        speed: LegSpeed::from_mps(speed_mps),
        kind,
        ..Waypoint::default()
    }
}
