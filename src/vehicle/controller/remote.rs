//! A remote flight controller as a mailbox: plain data in and out, without I/O.
//!
//! The vehicle puts frames and requests into it. The code that communicates with the remote flight controller takes
//! them out and delivers motor commands, telemetry, events and answers.

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use strum::{EnumCount as _, IntoEnumIterator as _};

use super::{Answer, LateAnswer, Ticket};
use crate::firmware::cli::CliMode;
use crate::firmware::config::Configuration;
use crate::firmware::rx::Sources;
use crate::pilot::PilotFacts;
use crate::plan::{AltitudeReference, FlightPlan};
use crate::signals::{MotorCommand, RcFrame, RcSource, SensorFrame, SimTime};
use crate::telemetry::snapshot::{CraftView, EstimateView, SettingsView};
use crate::telemetry::{DisarmReason, FirmwareEvent, InFlightRefusal, Mode, NavTelemetry};
use crate::vehicle::{CliLine, CliSession, Reply, VehicleCommand, VehicleRefusal};

/// The maximum number of waiting frames. Beyond it the oldest frame is dropped, since old measurements are of no use.
const MAX_FRAMES: usize = 1024;
/// The middle of a stick, µs.
const MID_US: u16 = 1500;

/// A frame on its way to the flight controller.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "most frames are of the sensors")]
pub enum FrameOut {
    /// Measurements of the sensors.
    Sensors(SensorFrame),
    /// Frame of the RC transmitter.
    Rc(RcFrame, RcSource),
}

/// A request to the flight controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RemoteRequest {
    /// Run a CLI line; answered by [`LateAnswer::Cli`].
    Cli(String),
    /// Run a CLI line at its prompt, as it is typed by a person; answered by [`LateAnswer::Cli`].
    Typed(String),
    /// Leave the prompt, if it is open.
    LeavePrompt,
    /// An MSP message; answered by [`LateAnswer::Msp`].
    Msp {
        /// The code of the message.
        code: u16,
        /// The payload of the request.
        payload: Vec<u8>,
    },
    /// Restart on its own stored configuration.
    Restart,
    /// Fly home and land.
    ReturnHome,
    /// Cancel the return home.
    CancelReturn,
}

/// The reports of a remote flight controller about itself. Anything that it has not reported is unknown.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RemoteTelemetry {
    /// Estimate of the motion of the craft.
    pub estimate: EstimateView,
    /// Modes, arming, receiver and battery.
    pub craft: CraftView,
    /// State of the navigator.
    pub nav: Option<NavTelemetry>,
    /// Settings that displays and checks need.
    pub settings: Option<SettingsView>,
    /// The configuration of an embedded firmware with the settings that were read, for flights ahead of time.
    pub configuration: Option<Arc<Configuration>>,
    /// Stored plan, with altitudes above home.
    pub stored_plan: Option<FlightPlan>,
    /// Its own reference of waypoint altitudes.
    pub altitude_reference: AltitudeReference,
    /// Reason of the last disarm, as far as known.
    pub last_disarm: Option<DisarmReason>,
    /// `true` if it gets its RC from this program. A real craft has a transmitter of its own.
    pub takes_rc: bool,
}

/// The mailbox of a remote flight controller: sensor frames and requests to it, telemetry and answers from it.
#[derive(Debug, Clone)]
pub struct RemoteController {
    frames: VecDeque<FrameOut>,
    requests: VecDeque<(Ticket, RemoteRequest)>,
    next_ticket: u64,
    /// The sessions of persons at a prompt.
    prompts: BTreeSet<CliSession>,
    rc: [Option<RcFrame>; RcSource::COUNT],
    /// Selects the source whose frames are sent. The flight controller sees only one transmitter.
    sources: Sources,
    /// The time of the newest frame that was sent.
    rc_sent: Option<SimTime>,
    /// The time of the newest step.
    now: SimTime,
    /// `None` until the first delivery.
    motors: Option<MotorCommand>,
    telemetry: RemoteTelemetry,
    events: VecDeque<FirmwareEvent>,
    answers: VecDeque<(Ticket, LateAnswer)>,
}

impl Default for RemoteController {
    fn default() -> Self {
        Self {
            frames: VecDeque::with_capacity(MAX_FRAMES),
            requests: VecDeque::new(),
            next_ticket: 0,
            prompts: BTreeSet::new(),
            rc: [None; RcSource::COUNT],
            sources: Sources::default(),
            rc_sent: None,
            now: SimTime::default(),
            motors: None,
            telemetry: RemoteTelemetry::default(),
            events: VecDeque::new(),
            answers: VecDeque::new(),
        }
    }
}

impl RemoteController {
    /// Takes the oldest frame.
    pub fn take_frame(&mut self) -> Option<FrameOut> {
        self.frames.pop_front()
    }

    /// Takes the oldest request.
    pub fn take_request(&mut self) -> Option<(Ticket, RemoteRequest)> {
        self.requests.pop_front()
    }

    /// Delivers a motor command, which stays in force until the next one.
    pub fn deliver_motors(&mut self, motors: MotorCommand) {
        self.motors = Some(motors);
    }

    /// Delivers telemetry. It replaces all earlier telemetry.
    pub fn deliver_telemetry(&mut self, telemetry: RemoteTelemetry) {
        self.telemetry = telemetry;
    }

    /// Delivers an event.
    pub fn deliver_event(&mut self, event: FirmwareEvent) {
        self.events.push_back(event);
    }

    /// Delivers the answer to a request.
    pub fn deliver_answer(&mut self, ticket: Ticket, answer: LateAnswer) {
        self.answers.push_back((ticket, answer));
    }

    pub(super) fn step(&mut self, frame: &SensorFrame) -> MotorCommand {
        self.now = frame.time;
        for source in RcSource::iter() {
            if let Some(rc) = self.rc[source as usize].take()
                && let Some(rc) = self.sources.receive(rc, source, self.now)
            {
                self.rc_sent = Some(self.now);
                self.put(FrameOut::Rc(rc, source));
            }
        }
        self.put(FrameOut::Sensors(*frame));
        self.motors()
    }

    fn put(&mut self, frame: FrameOut) {
        if self.frames.len() == MAX_FRAMES {
            self.frames.pop_front();
        }
        self.frames.push_back(frame);
    }

    /// Carries out a command: the mailbox gets the request. It has its own rules for persons at its command line and
    /// for the configuration of a restart. Commands to the transmitter and the world have no effect here.
    pub(super) fn apply(&mut self, command: &VehicleCommand) -> Answer<Reply> {
        match command {
            VehicleCommand::Rc(frame, source) => self.receive_rc(frame, *source),
            VehicleCommand::SticksFirst(first) => self.sources.take_over(*first),
            // The prompt opens with the first line.
            VehicleCommand::BeginCli(session, CliMode::Interactive) => {
                self.prompts.insert(*session);
            }
            VehicleCommand::EndCli(session) => {
                if self.prompts.remove(session) && self.prompts.is_empty() {
                    self.ask(RemoteRequest::LeavePrompt);
                }
            }
            // A restart closes the prompt.
            VehicleCommand::EndAllCli => self.prompts.clear(),
            VehicleCommand::Line(line) => return Answer::Later(self.run_cli(line)),
            VehicleCommand::Message(message) => {
                let (code, payload) = (message.code, message.payload.clone());
                return Answer::Later(self.ask(RemoteRequest::Msp { code, payload }));
            }
            VehicleCommand::Upload(_) => return Answer::Now(Reply::Refused(VehicleRefusal::UploadToRemote)),
            VehicleCommand::InFlight(_) => {
                let refusal = VehicleRefusal::InFlight(InFlightRefusal::Remote);
                return Answer::Now(Reply::Refused(refusal));
            }
            VehicleCommand::Restart(_) => self.restart(),
            VehicleCommand::ReturnHome => {
                self.ask(RemoteRequest::ReturnHome);
            }
            VehicleCommand::CancelReturn => {
                self.ask(RemoteRequest::CancelReturn);
            }
            VehicleCommand::BeginCli(..)
            | VehicleCommand::CliOpened
            | VehicleCommand::CliClosed
            | VehicleCommand::Sticks(_)
            | VehicleCommand::CutRc(_)
            | VehicleCommand::HoldChannel(_)
            | VehicleCommand::ReleaseChannel(_)
            | VehicleCommand::StartPilot(_)
            | VehicleCommand::StopPilot
            | VehicleCommand::World(_)
            | VehicleCommand::ResetCraft => return Answer::Now(Reply::Unchanged),
        }
        Answer::Now(Reply::Done)
    }

    pub(super) fn receive_rc(&mut self, frame: &RcFrame, source: RcSource) {
        self.rc[source as usize] = Some(*frame);
    }

    pub(super) fn lose_rc(&mut self) {
        self.rc.fill(None);
    }

    pub(super) fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Returns the source of its RC, if that is this program.
    pub(super) fn rc_source(&self) -> Option<RcSource> {
        self.sources.in_charge().filter(|_| self.telemetry.takes_rc)
    }

    /// Returns the age of the newest RC frame from this program, s.
    fn rc_age_s(&self) -> Option<f64> {
        self.rc_sent.filter(|_| self.telemetry.takes_rc).map(|sent| self.now.seconds_since(sent))
    }

    /// Returns modes, arming, receiver and battery as reported, with the motors and the RC that this program exchanges
    /// with it.
    pub(super) fn craft_view(&self) -> CraftView {
        let reported = &self.telemetry.craft;
        CraftView {
            motors: self.motors.map(|command| command.0).or(reported.motors),
            rc_source: self.rc_source(),
            rc_age_s: self.rc_age_s(),
            ..reported.clone()
        }
    }

    fn ask(&mut self, request: RemoteRequest) -> Ticket {
        let ticket = Ticket(self.next_ticket);
        self.next_ticket += 1;
        self.requests.push_back((ticket, request));
        ticket
    }

    fn run_cli(&mut self, line: &CliLine) -> Ticket {
        let is_at_prompt = self.prompts.contains(&line.session);
        let line = line.line.clone();
        self.ask(if is_at_prompt { RemoteRequest::Typed(line) } else { RemoteRequest::Cli(line) })
    }

    /// Requests a restart.
    pub(super) fn restart(&mut self) {
        self.ask(RemoteRequest::Restart);
        self.restarted();
    }

    /// Reports a restart of the flight controller. Earlier telemetry is void, and its motors stop.
    pub(in crate::vehicle) fn restarted(&mut self) {
        self.motors = None;
        self.telemetry = RemoteTelemetry::default();
    }

    pub(super) fn take_event(&mut self) -> Option<FirmwareEvent> {
        self.events.pop_front()
    }

    pub(super) fn take_answer(&mut self) -> Option<(Ticket, LateAnswer)> {
        self.answers.pop_front()
    }

    pub(super) fn telemetry(&self) -> &RemoteTelemetry {
        &self.telemetry
    }

    /// Returns the motor command in force.
    pub(super) fn motors(&self) -> MotorCommand {
        self.motors.unwrap_or_default()
    }

    /// Returns the facts that a pilot sees. Without telemetry there is no fix, so that a scripted pilot waits.
    pub(super) fn pilot_facts(&self, time: SimTime) -> PilotFacts {
        let RemoteTelemetry { estimate, craft, settings, .. } = &self.telemetry;
        PilotFacts {
            time,
            fix: craft.has_fix(),
            arming_blocked: craft.arming_blocked_by.as_ref().is_none_or(|flags| !flags.is_empty()),
            armed: craft.is_armed(),
            engaged: craft.is_active(Mode::Autopilot),
            // A remote flight controller does not report the state of its heading, so the heading counts as known.
            heading_known: true,
            forward_stick_us: MID_US,
            alt_m: estimate.alt.unwrap_or_default(),
            climb_mps: estimate.climb_mps.unwrap_or_default(),
            hover_stick_us: settings.map_or(MID_US, |settings| settings.hover_stick_us),
            raised_stick_us: settings.map_or(MID_US, |settings| settings.raised_stick_us),
        }
    }
}
