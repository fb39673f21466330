//! The navigator with the laws of master: missions, holds, and the control laws that both share.

use nalgebra::Vector2;

use super::altitude::{AltitudeLaw, Height};
use super::hold::Stop;
use super::mission::{Course, Mission, Order, Return};
use super::position::{Point, PositionLaw, Task};
use super::report;
use super::yaw::{YawFacts, YawLaw};
use crate::autopilot::control::throttle_share;
use crate::autopilot::engage::{self, EngageFacts};
use crate::autopilot::io::{NavInputs, NavOutput};
use crate::autopilot::navigator::{EVENT_CAPACITY, Rescue};
use crate::autopilot::params::Params;
use crate::math;
use crate::plan::FlightPlan;
use crate::telemetry::{
    AbortReason, InFlightCommand, InFlightRefusal, NavEvent, NavState, NavTelemetry, PlanSource, Refusal,
    TransitionReason,
};

/// The time without a fix after which a mission is given up, s, and after which it may begin again, s.
const GIVE_UP_S: f64 = 2.0;
const FORGET_S: f64 = 5.0;
/// The tilt in search of a heading, degrees.
const SEARCH_DEG: f64 = 35.0;

/// The demands of the holds; `None` leaves control to the pilot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Held {
    /// The tilt (forward, right), rad.
    pub tilt: Option<Vector2<f64>>,
    /// The throttle, 0…1.
    pub throttle: Option<f64>,
}

/// The orders to the holds in an update.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HoldOrders {
    /// Holds the altitude, or climbs at this rate, m/s; `None` while the altitude is the pilot's.
    pub climb_mps: Option<f64>,
    /// `true` if the position is held.
    pub position: bool,
    /// The tilt (forward, right, rad) that the roll and pitch sticks ask for; `None` while both rest.
    pub sticks: Option<Vector2<f64>>,
}

/// The laws of altitude, position and yaw, whichever of mission and holds uses them.
#[derive(Debug, Clone, Default)]
pub(super) struct Controls {
    altitude: AltitudeLaw,
    position: PositionLaw,
    yaw: YawLaw,
    /// The height that is held, m; `None` while the altitude is the pilot's.
    held_m: Option<f64>,
    stop: Option<Stop>,
    /// The demands of the last update.
    pub(super) output: NavOutput,
}

/// The navigator; see the module's description.
#[derive(Debug, Clone, Default)]
pub struct MasterNavigator {
    mission: Mission,
    controls: Controls,
    refused: Option<Refusal>,
    was_armed: bool,
    /// `true` after a touchdown with disarming. The state reads COMPLETE until the next arming.
    has_landed: bool,
    without_fix_s: f64,
    telemetry: NavTelemetry,
    refusals: arrayvec::ArrayVec<NavEvent, EVENT_CAPACITY>,
}

impl MasterNavigator {
    /// Returns the state of the mission. A mission that was given up is IDLE.
    pub fn state(&self) -> NavState {
        self.mission.state()
    }

    /// Returns `true` while a mission is flown or its last place is held.
    pub fn is_flying(&self) -> bool {
        self.state() != NavState::Idle && !self.has_landed
    }

    /// Returns the plan that is flown.
    pub fn active_plan(&self) -> &FlightPlan {
        self.mission.route().plan()
    }

    /// Returns the state of the last update for displays, logs and samples.
    pub fn telemetry(&self) -> &NavTelemetry {
        &self.telemetry
    }

    /// Takes the oldest event that was not taken yet.
    pub fn take_event(&mut self) -> Option<NavEvent> {
        self.mission.take_event().or_else(|| self.refusals.pop_at(0))
    }

    /// Returns the reason for which the last mission was given up, until its switch goes off.
    pub fn given_up(&self) -> Option<AbortReason> {
        self.mission.aborted()
    }

    /// Returns `true` while a rescue flies, or was given up.
    pub fn is_rescue(&self) -> bool {
        self.mission.rescue().is_some()
    }

    /// Returns the hover throttle in use, µs.
    pub fn hover_us(&self, params: &Params) -> f64 {
        self.controls.hover_us(params)
    }

    /// Forgets the reason for which the mission was given up.
    pub fn forget_given_up(&mut self) {
        self.mission.forget_abort();
    }

    /// Starts the stored plan at its first waypoint. Called in each cycle while its switch is on and nothing is flown.
    ///
    /// # Errors
    /// Fails with the first precondition that does not hold.
    pub fn engage(&mut self, now: &NavInputs, params: &Params, stored: &FlightPlan) -> Result<(), Refusal> {
        if self.is_flying() {
            return Ok(());
        }
        let (plan, _) = EngageFacts::plan_facts(stored, now.home, params);
        let facts = EngageFacts { plan, failsafe: now.failsafe, ..self.craft_facts(now) };
        if let Err(refusal) = engage::check(&facts) {
            self.refuse(refusal);
            return Err(refusal);
        }
        self.refused = None;
        // Altitudes count from sea level: from that of the receiver now, which the SITL target takes from the barometer, to
        // the estimated one.
        let added_m = now.pressure_alt_m.map_or(0.0, |pressure_m| now.alt_m - pressure_m);
        self.mission.start((stored, PlanSource::Stored, added_m), TransitionReason::Reset, None, now, params);
        Ok(())
    }

    fn craft_facts(&self, now: &NavInputs) -> EngageFacts {
        EngageFacts {
            armed: now.armed && !self.has_landed,
            throttle_raised: now.throttle_raised || self.is_flying(),
            fix: now.fix,
            altitude_valid: now.altitude_valid,
            aborted: self.mission.aborted(),
            ..EngageFacts::READY
        }
    }

    /// Reports why nothing is flown although it was requested. Each cause gives one event.
    pub fn refuse(&mut self, refusal: Refusal) {
        if self.refused.replace(refusal) != Some(refusal) {
            // The refusal itself is in the telemetry.
            _ = self.refusals.try_push(NavEvent::Refused(refusal));
        }
        self.telemetry.refusal = Some(refusal);
    }

    /// Ends the mission, because its switch went off.
    pub fn disengage(&mut self, now: &NavInputs) {
        self.mission.stop(TransitionReason::Disengage, now);
        self.refused = None;
        self.telemetry.refusal = None;
    }

    /// Flies home and lands, as a rescue if one is given. Without a known home it lands here.
    ///
    /// # Errors
    /// Fails if the craft is not armed or has no fix or no altitude.
    pub fn return_to_home(
        &mut self,
        now: &NavInputs,
        params: &Params,
        rescue: Option<Rescue>,
    ) -> Result<(), Refusal> {
        engage::check_craft(&EngageFacts { aborted: None, ..self.craft_facts(now) })?;
        match rescue {
            _ if now.home.is_none() => self.mission.land_here(now, params),
            Some(rescue) => self.mission.fly_rescue(rescue, now, params),
            None => {
                let home = Return { altitude_m: now.alt_m, speed_mps: params.max_velocity_mps() };
                self.mission.fly_home(home, TransitionReason::ReturnHome, None, now, params);
            }
        }
        self.refused = None;
        Ok(())
    }

    /// Carries out a command between two updates. Only a jump to a waypoint is possible.
    ///
    /// # Errors
    /// Fails with the reason. Nothing has changed then.
    pub fn command(
        &mut self,
        command: InFlightCommand,
        now: &NavInputs,
        params: &Params,
    ) -> Result<(), InFlightRefusal> {
        if !self.is_flying() {
            return Err(InFlightRefusal::NotFlying);
        }
        if now.failsafe {
            return Err(InFlightRefusal::Failsafe);
        }
        let source = self.mission.route().source();
        if source != PlanSource::Stored {
            return Err(InFlightRefusal::Injected(source));
        }
        let InFlightCommand::GoTo(wp) = command else { return Err(InFlightRefusal::NotInProfile) };
        // A plan has at most 30 waypoints.
        let count = self.active_plan().waypoints.len() as u8;
        self.mission.go_to(wp, now, params).then_some(()).ok_or(InFlightRefusal::NoWaypoint { wp, count })
    }

    /// Runs one update of the mission (100 Hz). Returns its demands; `None` while the holds or the pilot fly. `home` is the
    /// return of a fence.
    pub fn update(&mut self, now: &NavInputs, home: Return, params: &Params) -> Option<NavOutput> {
        self.follow_arming(now);
        self.follow_fix(now);
        let order = if self.is_flying() { self.mission.update(now, home, params, now.dt) } else { None };
        let touched_down = self.mission.state() == NavState::Complete
            && self.mission.reason() == Some(TransitionReason::Touchdown);
        self.has_landed |= touched_down;
        let output = order.map(|order| self.fly(&order, now, params));
        self.telemetry = report::report(&self.mission, &self.controls, order.as_ref(), now, params);
        self.telemetry.engaged = self.is_flying();
        self.telemetry.refusal = self.refused.filter(|_| !self.is_flying());
        output
    }

    fn follow_arming(&mut self, now: &NavInputs) {
        let was_armed = std::mem::replace(&mut self.was_armed, now.armed);
        if was_armed && !now.armed {
            self.mission.forget_abort();
            if !self.has_landed {
                self.mission.stop(TransitionReason::Disarm, now);
            }
        }
        if !was_armed && now.armed && std::mem::take(&mut self.has_landed) {
            self.mission.rest();
        }
    }

    /// Gives a mission up after a loss of the fix. After a longer one it may begin again, as if its switch had just gone on.
    fn follow_fix(&mut self, now: &NavInputs) {
        self.without_fix_s = if now.fix { 0.0 } else { self.without_fix_s + now.dt };
        if self.without_fix_s > GIVE_UP_S && self.is_flying() && self.mission.has_target() {
            self.mission.abort(AbortReason::GpsLost, None, now);
        }
        if self.without_fix_s > FORGET_S && self.given_up() == Some(AbortReason::GpsLost) {
            self.mission.forget_abort();
        }
    }

    /// Flies an order of the mission.
    fn fly(&mut self, order: &Order, now: &NavInputs, params: &Params) -> NavOutput {
        let (tilt, height, yaw_rate_rps) = match order {
            Order::Fly(course) => {
                let yaw = self.yaw_rps(course, now, params);
                let tilt = match course.holds {
                    true => self.controls.hold_position(now, params),
                    false => {
                        self.controls.stop = None;
                        self.controls.tilt(&course.target.point, Task::Navigate, now, params)
                    }
                };
                // A target that is reached has no vertical speed.
                let climb_mps = if course.holds { 0.0 } else { course.target.height.climb_mps };
                (tilt, Height { climb_mps, ..course.target.height }, yaw)
            }
            Order::SearchHeading => {
                let height = Height { altitude_m: self.controls.held_m.unwrap_or(now.alt_m), climb_mps: 0.0 };
                self.controls.stop = None;
                (Vector2::new(SEARCH_DEG.to_radians(), 0.0), height, Some(0.0))
            }
        };
        let most = params.climb_rate_mps();
        let [sink, climb] =
            self.mission.rescue().map_or([most, most], |rescue| [rescue.descend_mps, rescue.climb_mps]);
        let height = Height { climb_mps: height.climb_mps.clamp(-sink, climb), ..height };
        let throttle_us = self.controls.throttle_us(height, now, params);
        self.controls.held_m = Some(height.altitude_m);
        let output = NavOutput {
            pitch_down_rad: tilt.x,
            roll_rad: tilt.y,
            yaw_rate_rps,
            throttle: throttle_share(throttle_us, params),
            throttle_us,
        };
        self.controls.output = output;
        output
    }

    fn yaw_rps(&mut self, course: &Course, now: &NavInputs, params: &Params) -> Option<f64> {
        let facts = YawFacts {
            heading_rad: now.heading_rad,
            yaw_rate_rps: now.yaw_rate_rps,
            course_rad: math::atan2(now.vel_ne.y, now.vel_ne.x),
            ground_speed_mps: now.vel_ne.norm(),
            bearing_rad: course.bearing_rad,
            commanded_rad: course.heading_rad,
        };
        self.controls.yaw.rate_rps(&facts, course.yaw_cap_dps, params, now.dt)
    }

    /// Runs one update of the holds, while the mission has no target.
    pub fn hold(&mut self, orders: HoldOrders, now: &NavInputs, params: &Params) -> Held {
        self.controls.yaw.reset();
        let throttle = match orders.climb_mps {
            Some(climb_mps) => Some(self.controls.hold_altitude(climb_mps, now, params)),
            None => {
                self.controls.held_m = None;
                None
            }
        };
        let tilt = match orders {
            HoldOrders { position: true, sticks: None, .. } => Some(self.controls.hold_position(now, params)),
            HoldOrders { position: true, sticks: Some(sticks), .. } => {
                self.controls.stop = None;
                let here = Point { ne: now.pos_ne, vel_ne: Vector2::zeros() };
                Some(self.controls.position.tilt(now, &here, Task::Sticks, sticks, params, now.dt))
            }
            HoldOrders { position: false, .. } => {
                self.controls.stop = None;
                self.controls.position.reset();
                None
            }
        };
        Held { tilt, throttle }
    }
}

impl Controls {
    pub(super) fn hover_us(&self, params: &Params) -> f64 {
        self.altitude.hover_us(params)
    }

    fn tilt(&mut self, point: &Point, task: Task, now: &NavInputs, params: &Params) -> Vector2<f64> {
        self.position.tilt(now, point, task, Vector2::zeros(), params, now.dt)
    }

    /// Returns the throttle, µs. Takes over first if the altitude was the pilot's.
    fn throttle_us(&mut self, height: Height, now: &NavInputs, params: &Params) -> f64 {
        if self.held_m.is_none() {
            self.altitude.engage(now.throttle_us);
        }
        self.altitude.throttle_us(&now.into(), height, params, now.dt)
    }

    /// Holds the altitude, or moves it at a rate. The held height leads the craft by at most the climb of a second.
    fn hold_altitude(&mut self, climb_mps: f64, now: &NavInputs, params: &Params) -> f64 {
        let held_m = self.held_m.unwrap_or(now.alt_m);
        let has_room = (held_m - now.alt_m).abs() < params.climb_rate_mps();
        let altitude_m = if has_room { held_m + climb_mps * now.dt } else { held_m };
        let throttle_us = self.throttle_us(Height { altitude_m, climb_mps }, now, params);
        self.held_m = Some(altitude_m);
        throttle_share(throttle_us, params)
    }

    fn hold_position(&mut self, now: &NavInputs, params: &Params) -> Vector2<f64> {
        let stop = self.stop.get_or_insert_with(|| Stop::new(now.pos_ne, now.vel_ne));
        let (ne, is_braking) = stop.follow(now.pos_ne, now.vel_ne, params, now.dt);
        let task = if is_braking { Task::Brake } else { Task::Hold };
        self.tilt(&Point { ne, vel_ne: Vector2::zeros() }, task, now, params)
    }
}
