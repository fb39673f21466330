//! The demands that replace the pilot's, from failsafe, navigator and holds. Runs a hundred times a second.

use nalgebra::{Vector2, Vector3};

use crate::autopilot::Autopilot;
use crate::autopilot::control::{AltitudeController, FlightControllers};
use crate::autopilot::io::{NavInputs, NavOutput};
use crate::autopilot::land_detector::{GroundMeasurement, ImpactFacts};
use crate::autopilot::master::{HoldOrders, MasterNavigator, Return};
use crate::firmware::control::hold::{DescentRate, HoldModes, HoldOutput, Holds};
use crate::firmware::control::{ControlState, TiltDemand};
use crate::firmware::estimate::Estimate;
use crate::firmware::failsafe::{Failsafe, FailsafeAction, FailsafeFacts, Procedure, Response};
use crate::firmware::modes::{AfterAbort, ModeFacts, boxes};
use crate::firmware::orders::{OrderFacts, Orders, failsafe_response};
use crate::firmware::outbox::Outbox;
use crate::firmware::parameters::{Parameters, RescueCause};
use crate::firmware::throttle_takeover::ThrottleTakeover;
use crate::plan::FlightPlan;
use crate::signals::SimTime;
use crate::telemetry::{
    FirmwareEvent, FirmwareNotice, FirmwareProfile, InFlightCommand, InFlightRefusal, Mode, ModeFlags,
    NavEvent, NavState, Refusal,
};

use super::flight_control::Demand;
use super::{RcInput, Safety, Sensing};

/// A request of the failsafe to arming.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::firmware) enum FailsafeRequest {
    Disarm,
    /// Blocks arming until the ARM switch has been off.
    RequireSwitchOff,
}

/// The results of the holds and the navigator in one update.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::firmware) struct Flown {
    /// The demands that replace the pilot's.
    pub demand: Demand,
    /// `true` once the failsafe's descent has reached the ground. The motors must be stopped then.
    pub touchdown: bool,
}

/// Failsafe, orders, navigator and holds, and their view of the craft.
#[derive(Debug, Clone)]
pub(in crate::firmware) struct Navigation {
    pub failsafe: Failsafe,
    pub orders: Orders,
    pub navigator: Autopilot,
    holds: Holds,
    throttle_takeover: ThrottleTakeover,
    /// The controllers, used by the navigator or by the holds, whichever flies.
    controllers: FlightControllers,
    inputs: NavInputs,
    /// The navigator's demands while it flies.
    pub output: Option<NavOutput>,
    updated_at: SimTime,
    /// The reason why the autopilot did not engage. It remains until the autopilot engages or the craft is armed again.
    pub last_refusal: Option<Refusal>,
    /// The reported reason why position hold only levels the craft.
    only_levelled: Option<FirmwareNotice>,
}

/// Runs the holds with the laws of master.
fn hold_by_master(
    navigator: &mut MasterNavigator,
    modes: HoldModes,
    now: &NavInputs,
    stick_us: Option<f64>,
    parameters: &Parameters,
) -> HoldOutput {
    let (params, tuning) = (&parameters.nav, &parameters.hold);
    let climb_mps = match (modes.descend, stick_us) {
        // Its failsafe descends at the climb rate of ALTHOLD, down to the ground.
        (Some(DescentRate::Failsafe), _) => -params.climb_rate_mps(),
        (Some(rate), _) => -rate.at(now.alt_m, params),
        (None, Some(stick_us)) => {
            let neutral_us = tuning.stick_of_throttle_us(navigator.hover_us(params));
            tuning.climb_mps(stick_us, neutral_us, params)
        }
        (None, None) => 0.0,
    };
    let position = modes.position && now.fix && tuning.uses_gps;
    let stick_tilt = || {
        let [roll, pitch] = parameters.control.stick_angles_deg([now.stick_roll, now.stick_pitch]);
        Vector2::new(pitch, roll).map(f64::to_radians)
    };
    let orders = HoldOrders {
        climb_mps: (now.altitude_valid && (modes.altitude || modes.descend.is_some())).then_some(climb_mps),
        position,
        sticks: tuning.moves_sticks(now).then(stick_tilt),
    };
    let held = navigator.hold(orders, now, params);
    HoldOutput {
        tilt: held.tilt.map(|tilt| TiltDemand { pitch_down_rad: tilt.x, roll_rad: tilt.y }),
        throttle: held.throttle,
        no_position: modes.position && !position,
        touchdown: false,
    }
}

impl Navigation {
    /// Creates the state in which nothing flies the craft. The first update counts from `now`.
    pub(in crate::firmware) fn new(now: SimTime) -> Self {
        Self {
            failsafe: Failsafe::default(),
            orders: Orders::default(),
            navigator: FirmwareProfile::default().into(),
            holds: Holds::default(),
            throttle_takeover: ThrottleTakeover::default(),
            controllers: FlightControllers::default(),
            inputs: NavInputs::unknown(),
            output: None,
            updated_at: now,
            last_refusal: None,
            only_levelled: None,
        }
    }

    /// Begins an update: records the state of the craft.
    pub(in crate::firmware) fn observe(
        &mut self,
        now: SimTime,
        parameters: &Parameters,
        sensing: &Sensing,
        safety: &Safety,
        rc: &RcInput,
        control: &ControlState,
    ) {
        let dt = now.seconds_since(std::mem::replace(&mut self.updated_at, now));
        let profile = parameters.nav.profile;
        if profile != self.navigator.profile() && !safety.arming.armed() {
            self.navigator = profile.into();
        }
        if safety.arming.armed() && !self.inputs.armed {
            self.last_refusal = None;
        }
        let estimate = sensing.estimate();
        let receiver = &rc.receiver;
        let stick = |value: f64| if receiver.signal() { value } else { 0.0 };
        let sticks = receiver.sticks();
        self.inputs = NavInputs {
            armed: safety.arming.armed(),
            fix: sensing.fix && estimate.position_valid,
            throttle_raised: safety.arming.raised(),
            failsafe: self.failsafe.active(),
            battery_low: sensing.battery.is_low(),
            home: safety.home,
            pressure_alt_m: sensing.pressure_alt_m(),
            throttle_us: control.throttle_us,
            hover_us: self.controllers.altitude.learned_hover_us(),
            stick_roll: stick(sticks.roll),
            stick_pitch: stick(sticks.pitch),
            stick_yaw: stick(sticks.yaw),
            ..estimate.nav_inputs(now, dt)
        };
        let rates = estimate.rates;
        let rate_rps = Vector3::new(rates.roll, rates.pitch_down, rates.yaw).norm();
        let ground = GroundMeasurement::new(&self.inputs, estimate.force_flu, rate_rps, &control.motors);
        let FlightControllers { altitude, land, .. } = &mut self.controllers;
        land.observe(&ground, self.inputs.armed, dt);
        altitude.set_on_ground(land.awaits_lift_off(), land.load());
    }

    /// Runs one update of the failsafe; `uptime` counts from boot.
    pub(in crate::firmware) fn update_failsafe(
        &mut self,
        parameters: &Parameters,
        uptime: SimTime,
        rc: &RcInput,
        modes: ModeFlags,
        outbox: &mut Outbox,
    ) -> Option<FailsafeRequest> {
        let inputs = &self.inputs;
        let held = [Mode::Autopilot, Mode::AltHold, Mode::PosHold].into_iter().any(|mode| modes.has(mode));
        let received = rc.receiver.received_sticks(&parameters.rx);
        let facts = FailsafeFacts {
            now: uptime,
            armed: inputs.armed,
            switch: rc.boxes.has(boxes::FAILSAFE),
            link_up: rc.link.up(),
            signal: rc.receiver.signal(),
            throttle_low: received.throttle_us < parameters.arming.min_check_us,
            held,
            stick_percent: received.deflection_percent(),
            fix: inputs.fix,
            home: inputs.home.is_some(),
            mission: self.orders.status(&self.navigator),
            response: self.failsafe_response(parameters),
        };
        let policy = parameters.nav.rx_loss_policy;
        let mut report = |stage, response: Response| {
            outbox.push(FirmwareEvent::Failsafe { policy, stage, procedure: response.procedure() });
        };
        match self.failsafe.update(&parameters.failsafe, &facts)? {
            FailsafeAction::Stage1 => {
                report(1, facts.response);
                None
            }
            FailsafeAction::Stage2(response) | FailsafeAction::Switch(response) => {
                report(2, response);
                self.respond(response, parameters, outbox)
            }
            FailsafeAction::Disarm => Some(FailsafeRequest::Disarm),
            FailsafeAction::Recovered => {
                rc.boxes.has(boxes::ARM).then_some(FailsafeRequest::RequireSwitchOff)
            }
        }
    }

    /// Carries out the response of stage 2.
    fn respond(
        &mut self,
        response: Response,
        parameters: &Parameters,
        outbox: &mut Outbox,
    ) -> Option<FailsafeRequest> {
        let nav = &parameters.nav;
        let started = match response {
            Response::Procedure(Procedure::Drop) => return Some(FailsafeRequest::Disarm),
            Response::Procedure(Procedure::GpsRescue) => {
                let rescue =
                    self.orders.rescue_flight(&parameters.rescue, &self.inputs, RescueCause::Failsafe);
                self.navigator.return_to_home(&self.inputs, nav, Some(rescue))
            }
            Response::EmergencyLand => self.navigator.emergency_land(&self.inputs),
            Response::Procedure(Procedure::AutoLand) | Response::Continue | Response::KeepLanding => Ok(()),
        };
        if let Err(refusal) = started {
            // The failsafe notices the missing mission and starts the descent.
            outbox.push(FirmwareEvent::Nav(NavEvent::Refused(refusal)));
        }
        None
    }

    /// Runs one update of orders and navigator. Returns `true` if the navigator has landed the craft.
    pub(in crate::firmware) fn navigate(
        &mut self,
        parameters: &Parameters,
        stored: &FlightPlan,
        rc: &RcInput,
        armed: bool,
        outbox: &mut Outbox,
    ) -> bool {
        self.inputs.armed = armed;
        self.inputs.failsafe = self.failsafe.active();
        let inputs = &self.inputs;
        let facts = OrderFacts {
            autopilot_switch: rc.boxes.has(boxes::AUTOPILOT),
            rescue_switch: rc.boxes.has(boxes::GPS_RESCUE) && parameters.arming.rescue_configured,
            signal: rc.receiver.signal(),
            failsafe_active: self.failsafe.active(),
            failsafe_mission: self.failsafe.mission(),
        };
        let (nav, rescue) = (&parameters.nav, &parameters.rescue);
        self.orders.update(&mut self.navigator, inputs, nav, rescue, stored, &facts);
        let home = Return { altitude_m: rescue.return_alt_m, speed_mps: rescue.ground_speed_mps };
        self.output = self.navigator.update(inputs, home, nav, stored, &mut self.controllers);
        self.report_events(outbox)
    }

    fn report_events(&mut self, outbox: &mut Outbox) -> bool {
        let mut touched_down = false;
        while let Some(event) = self.navigator.take_event() {
            touched_down |= event == NavEvent::Disarm;
            outbox.push(FirmwareEvent::Nav(event));
        }
        touched_down
    }

    /// Returns `true` if the impact of a landing ends the flight of an armed craft.
    pub(in crate::firmware) fn is_impact(
        &self,
        parameters: &Parameters,
        rc: &RcInput,
        safety: &Safety,
        alt_hold: bool,
    ) -> bool {
        let facts = ImpactFacts {
            raised: safety.arming.raised(),
            stick_percent: rc.receiver.sticks().deflection_percent(),
            throttle_percent: rc.throttle_percent(),
            alt_hold,
            near_ground: self.inputs.alt_m < f64::from(parameters.nav.landing_altitude_m),
        };
        safety.arming.armed() && self.controllers.land.is_impact(parameters.landing_disarm_threshold, &facts)
    }

    /// Returns the inputs of the flight mode rules.
    pub(in crate::firmware) fn mode_facts(
        &self,
        rc: &RcInput,
        safety: &Safety,
        estimate: &Estimate,
    ) -> ModeFacts {
        let under_failsafe =
            matches!(self.failsafe.mission(), Some(Response::EmergencyLand | Response::KeepLanding));
        ModeFacts {
            switches: rc.boxes,
            armed: safety.arming.armed(),
            raised: safety.arming.raised(),
            altitude_valid: estimate.altitude_valid,
            failsafe_shown: self.failsafe.shown(),
            failsafe_active: self.failsafe.active(),
            autopilot: self.navigator.is_flying() && !under_failsafe,
            rescue: self.orders.is_rescue_by_switch(),
            after_abort: self.orders.after_abort(&self.navigator),
        }
    }

    /// Ends an update: returns the demands of the navigator or of the holds. Without demands, the pilot flies.
    pub(in crate::firmware) fn demand(
        &mut self,
        parameters: &Parameters,
        modes: ModeFlags,
        armed: bool,
        throttle_stick_us: f64,
        outbox: &mut Outbox,
    ) -> Flown {
        self.note_refusal();
        let held = if self.output.is_some() {
            self.holds.release();
            HoldOutput::default()
        } else {
            let (nav, tuning) = (&parameters.nav, &parameters.hold);
            let after_abort = self.orders.after_abort(&self.navigator);
            let stick_us = self.throttle_takeover.update(after_abort, throttle_stick_us, nav);
            let descend = if self.failsafe.auto_landing() {
                Some(DescentRate::Failsafe)
            } else {
                let rate = match self.orders.is_rescue_by_switch() {
                    true => DescentRate::Rescue(parameters.rescue.descend_mps),
                    false => DescentRate::Landing,
                };
                (after_abort == AfterAbort::Descent && stick_us.is_none()).then_some(rate)
            };
            let hold = HoldModes {
                altitude: armed && modes.has(Mode::AltHold),
                position: armed && modes.has(Mode::PosHold) && self.inputs.heading_valid,
                descend: descend.filter(|_| armed),
            };
            match &mut self.navigator {
                Autopilot::Guide(_) => {
                    self.holds.update(hold, &self.inputs, stick_us, nav, tuning, &mut self.controllers)
                }
                Autopilot::Master(navigator) => {
                    hold_by_master(navigator, hold, &self.inputs, stick_us, parameters)
                }
            }
        };
        let no_heading = armed && modes.has(Mode::PosHold) && !self.inputs.heading_valid;
        let only_levelled = match (no_heading, held.no_position) {
            (true, _) => Some(FirmwareNotice::NoHeading),
            (false, true) => Some(FirmwareNotice::NoPosition),
            (false, false) => None,
        };
        if let Some(notice) = only_levelled.filter(|_| only_levelled != self.only_levelled) {
            outbox.push(FirmwareEvent::Notice(notice));
        }
        self.only_levelled = only_levelled;
        let demand = match self.output {
            Some(output) => Demand::from(output),
            None => Demand { tilt: held.tilt, throttle: held.throttle, ..Demand::default() },
        };
        if self.navigator.profile() == FirmwareProfile::Master {
            // Its holds know no ground. The sticks tilt the craft in a HOLD of its missions, and have no effect on a leg.
            let holds = matches!(
                self.navigator.telemetry().state,
                NavState::Holding | NavState::Orbiting | NavState::Figure8
            );
            let by_stick = parameters.hold.stick_tilt(&self.inputs, parameters.nav.max_tilt_rad());
            let tilt = by_stick.filter(|_| self.output.is_some() && holds).or(demand.tilt);
            return Flown { demand: Demand { tilt, ..demand }, touchdown: false };
        }
        let land = &self.controllers.land;
        let share = land.tilt_share();
        let tilt = demand.tilt.map(|tilt| TiltDemand {
            roll_rad: share * tilt.roll_rad,
            pitch_down_rad: share * tilt.pitch_down_rad,
        });
        let demand = Demand { tilt, stands: land.stands(), ..demand };
        Flown { demand, touchdown: held.touchdown }
    }

    /// Releases the holds and forgets what the controllers tracked on the ground, which carries the craft. Called when
    /// the craft was armed or disarmed.
    pub(in crate::firmware) fn reset_control(&mut self) {
        self.holds.release();
        if !self.navigator.is_flying() {
            self.controllers = FlightControllers::default();
        }
    }

    /// Flies home and lands, by command.
    pub(in crate::firmware) fn return_to_home(&mut self, parameters: &Parameters) -> Result<(), Refusal> {
        self.orders.return_to_home(&mut self.navigator, &self.inputs, &parameters.nav, None)
    }

    /// Passes a command to the navigator that flies the stored plan.
    pub(in crate::firmware) fn command(
        &mut self,
        command: InFlightCommand,
        parameters: &Parameters,
        stored: &FlightPlan,
    ) -> Result<(), InFlightRefusal> {
        self.navigator.command(command, &self.inputs, &parameters.nav, stored)
    }

    /// Cancels the command to fly home.
    pub(in crate::firmware) fn cancel_command(&mut self) {
        self.orders.take_back(&mut self.navigator, &self.inputs);
    }

    /// Returns `true` if full throttle does not lift the craft off the ground.
    pub(in crate::firmware) fn is_too_heavy(&self) -> bool {
        self.controllers.land.awaits_lift_off() && self.controllers.altitude.is_at_full_throttle()
    }

    /// Returns the response of stage 2 of the failsafe in the present situation.
    pub(in crate::firmware) fn failsafe_response(&self, parameters: &Parameters) -> Response {
        failsafe_response(&self.navigator, &parameters.nav, parameters.failsafe.procedure, self.inputs.fix)
    }

    fn note_refusal(&mut self) {
        let refusal = self.navigator.telemetry().refusal;
        if self.navigator.is_flying() {
            self.last_refusal = None;
        } else if refusal != Some(Refusal::NotArmed) || self.last_refusal.is_none() {
            self.last_refusal = refusal.or(self.last_refusal);
        }
    }

    /// Returns the neutral position of the throttle stick in ALTHOLD, µs.
    pub(in crate::firmware) fn hover_stick_us(&self, parameters: &Parameters) -> f64 {
        match &self.navigator {
            Autopilot::Guide(_) => {
                self.controllers.altitude.hover_stick_us(&parameters.nav, parameters.hold.mid_us)
            }
            Autopilot::Master(navigator) => {
                parameters.hold.stick_of_throttle_us(navigator.hover_us(&parameters.nav))
            }
        }
    }

    /// Returns the controller of navigator and holds that keeps the altitude.
    pub(in crate::firmware) fn altitude_controller(&self) -> &AltitudeController {
        &self.controllers.altitude
    }

    /// Returns the plan being flown, if any.
    pub(in crate::firmware) fn active_plan(&self) -> Option<&FlightPlan> {
        self.navigator.is_flying().then(|| self.navigator.active_plan())
    }
}
