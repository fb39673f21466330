//! The flight controller of a vehicle: embedded in this program, or remote.

mod embedded;
mod remote;

pub use embedded::EmbeddedController;
pub use remote::{FrameOut, RemoteController, RemoteRequest, RemoteTelemetry};

use super::input_log::InputLog;
use super::{Reply, VehicleCommand, VehicleRefusal};
use crate::firmware::Firmware;
use crate::firmware::cli::CliReply;
use crate::firmware::config::Configuration;
use crate::pilot::PilotFacts;
use crate::plan::{AltitudeReference, FlightPlan};
use crate::signals::{MotorCommand, RcFrame, RcSource, SensorFrame, SimTime};
use crate::telemetry::snapshot::{CraftView, EstimateView, ModeRange, SettingsView};
use crate::telemetry::{DisarmReason, FirmwareEvent, FirmwareProfile, Mode, ModeFlags, NavTelemetry};

/// The identity of a request to a remote flight controller until its answer comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ticket(u64);

/// The answer of the flight controller.
#[derive(Debug)]
pub enum Answer<T> {
    /// The answer.
    Now(T),
    /// The answer comes later with this ticket from [`Vehicle::take_answer`](super::Vehicle::take_answer).
    Later(Ticket),
}

impl Answer<Reply> {
    /// Checks that the command was not refused. A remote controller may still refuse it later.
    ///
    /// # Errors
    /// Fails with the reason of the refusal.
    pub fn accepted(self) -> Result<(), VehicleRefusal> {
        match self {
            Self::Now(Reply::Refused(refusal)) => Err(refusal),
            Self::Now(_) | Self::Later(_) => Ok(()),
        }
    }

    /// Returns the reply to a CLI line, if the command was one and the reply is here.
    pub fn line(self) -> Option<CliReply> {
        match self {
            Self::Now(Reply::Line(reply)) => Some(reply),
            _ => None,
        }
    }
}

/// An answer that came later.
#[derive(Debug, Clone, PartialEq)]
pub enum LateAnswer {
    /// Answer to a CLI line. The remote flight controller has carried out its actions.
    Cli(CliReply),
    /// Payload of the reply to an MSP message; `None` if the message is unknown or refused.
    Msp(Option<Vec<u8>>),
}

/// The flight controller of the craft. A clone continues identically.
#[derive(Debug, Clone)]
pub enum FlightController {
    /// In this program: answers at once and reports everything.
    Embedded(Box<EmbeddedController>),
    /// Remote: answers later and reports only part of its state.
    Remote(Box<RemoteController>),
}

impl From<Firmware> for FlightController {
    fn from(firmware: Firmware) -> Self {
        Self::Embedded(Box::new(EmbeddedController::new(firmware)))
    }
}

impl FlightController {
    /// Makes one step: takes one frame of the sensors and returns the motor command in force.
    pub(super) fn step(&mut self, frame: &SensorFrame) -> MotorCommand {
        match self {
            Self::Embedded(embedded) => embedded.firmware.step(frame),
            Self::Remote(remote) => remote.step(frame),
        }
    }

    /// Takes an RC frame for the next step. Only the newest frame of each source counts.
    pub(super) fn receive_rc(&mut self, frame: &RcFrame, source: RcSource) {
        match self {
            Self::Embedded(embedded) => embedded.firmware.receive_rc(frame, source),
            Self::Remote(remote) => remote.receive_rc(frame, source),
        }
    }

    /// Drops the RC frames since the last step, as if they had never arrived.
    pub(super) fn lose_rc(&mut self) {
        match self {
            Self::Embedded(embedded) => embedded.firmware.lose_rc(),
            Self::Remote(remote) => remote.lose_rc(),
        }
    }

    /// Returns a configuration with the settings that a remote flight controller has reported.
    pub(super) fn reported_configuration(&self) -> Option<&Configuration> {
        match self {
            Self::Embedded(_) => None,
            Self::Remote(remote) => remote.telemetry().configuration.as_deref(),
        }
    }

    /// Returns `true` if the virtual sticks take precedence over the other sources of RC.
    pub fn sticks_taken_over(&self) -> bool {
        match self {
            Self::Embedded(embedded) => embedded.firmware.receiver().sources(),
            Self::Remote(remote) => remote.sources(),
        }
        .taken_over()
    }

    /// Returns the source of RC that is in use, or `None` before the first frame.
    pub fn rc_source(&self) -> Option<RcSource> {
        match self {
            Self::Embedded(embedded) => embedded.firmware.receiver().sources().in_charge(),
            Self::Remote(remote) => remote.rc_source(),
        }
    }

    /// Carries out a command to the flight controller.
    pub(super) fn apply(&mut self, command: &VehicleCommand) -> Answer<Reply> {
        match self {
            Self::Embedded(embedded) => Answer::Now(embedded.apply(command)),
            Self::Remote(remote) => remote.apply(command),
        }
    }

    /// Takes the oldest late answer that was not taken yet.
    pub(super) fn take_answer(&mut self) -> Option<(Ticket, LateAnswer)> {
        match self {
            Self::Embedded(_) => None,
            Self::Remote(remote) => remote.take_answer(),
        }
    }

    /// Returns the configuration in the memory of an embedded controller, for its owner to store. A remote one stores
    /// its own.
    pub fn configuration(&self) -> Option<&Configuration> {
        self.embedded().map(Firmware::configuration)
    }

    /// Restarts with the configuration in memory, stored or not.
    pub(super) fn restart_in_place(&mut self) {
        match self {
            Self::Embedded(embedded) => embedded.firmware.restart_in_place(),
            Self::Remote(remote) => remote.restart(),
        }
    }

    pub(super) fn take_event(&mut self) -> Option<FirmwareEvent> {
        match self {
            Self::Embedded(embedded) => embedded.firmware.take_event(),
            Self::Remote(remote) => remote.take_event(),
        }
    }

    pub(super) fn take_events_lost(&mut self) -> u32 {
        match self {
            Self::Embedded(embedded) => embedded.firmware.take_events_lost(),
            Self::Remote(_) => 0,
        }
    }

    /// Returns the embedded firmware, if it flies the craft.
    pub fn embedded(&self) -> Option<&Firmware> {
        match self {
            Self::Embedded(embedded) => Some(&embedded.firmware),
            Self::Remote(_) => None,
        }
    }

    /// Does the same as [`Self::embedded`], for changes.
    pub(super) fn embedded_mut(&mut self) -> Option<&mut Firmware> {
        match self {
            Self::Embedded(embedded) => Some(&mut embedded.firmware),
            Self::Remote(_) => None,
        }
    }

    pub(super) fn input_log(&self) -> Option<&InputLog> {
        match self {
            Self::Embedded(embedded) => Some(&embedded.inputs),
            Self::Remote(_) => None,
        }
    }

    pub(super) fn input_log_mut(&mut self) -> Option<&mut InputLog> {
        match self {
            Self::Embedded(embedded) => Some(&mut embedded.inputs),
            Self::Remote(_) => None,
        }
    }

    /// Returns the mailbox of a remote controller, for the code that communicates with it.
    pub(super) fn remote_mut(&mut self) -> Option<&mut RemoteController> {
        match self {
            Self::Embedded(_) => None,
            Self::Remote(remote) => Some(remote),
        }
    }

    /// Returns `true` if the craft is armed, or `None` if a remote controller does not report it.
    pub fn armed(&self) -> Option<bool> {
        match self {
            Self::Embedded(embedded) => Some(embedded.firmware.is_armed()),
            Self::Remote(remote) => remote.telemetry().craft.armed,
        }
    }

    /// Returns `true` if the craft is known to be armed.
    pub fn is_armed(&self) -> bool {
        self.armed() == Some(true)
    }

    /// Returns the modes that are known to be active.
    pub fn modes(&self) -> ModeFlags {
        match self {
            Self::Embedded(embedded) => embedded.firmware.modes(),
            Self::Remote(remote) => remote.telemetry().craft.modes.unwrap_or_default(),
        }
    }

    /// Returns the reason of the last disarm.
    pub fn last_disarm(&self) -> Option<DisarmReason> {
        match self {
            Self::Embedded(embedded) => embedded.firmware.last_disarm(),
            Self::Remote(remote) => remote.telemetry().last_disarm,
        }
    }

    /// Returns the telemetry of the navigator.
    pub fn nav(&self) -> Option<&NavTelemetry> {
        match self {
            Self::Embedded(embedded) => Some(embedded.firmware.nav()),
            Self::Remote(remote) => remote.telemetry().nav.as_ref(),
        }
    }

    /// Returns the plan in the memory of the craft.
    pub fn stored_plan(&self) -> Option<&FlightPlan> {
        match self {
            Self::Embedded(embedded) => Some(embedded.firmware.stored_plan()),
            Self::Remote(remote) => remote.telemetry().stored_plan.as_ref(),
        }
    }

    /// Returns the reference of the waypoint altitudes in that plan.
    pub fn altitude_reference(&self) -> AltitudeReference {
        match self {
            Self::Embedded(_) => AltitudeReference::Home,
            Self::Remote(remote) => remote.telemetry().altitude_reference,
        }
    }

    /// Returns the profile of an embedded firmware, or the kind of a remote one; `None` if it has not reported its
    /// settings. The reference of its altitudes tells the kinds apart.
    pub fn profile(&self) -> Option<FirmwareProfile> {
        match (self, self.altitude_reference()) {
            (Self::Embedded(embedded), _) => Some(embedded.firmware.parameters().nav.profile),
            (_, AltitudeReference::Unreported) => None,
            (_, AltitudeReference::Home) => Some(FirmwareProfile::Guide),
            (_, AltitudeReference::SeaLevel { .. }) => Some(FirmwareProfile::Master),
        }
    }

    /// Returns the motor command in force.
    pub fn motors(&self) -> MotorCommand {
        match self {
            Self::Embedded(embedded) => embedded.firmware.control().motors,
            Self::Remote(remote) => remote.motors(),
        }
    }

    /// Returns modes, arming, receiver and battery. Those of an embedded controller come without the mode ranges, which
    /// need memory from the heap: see [`Self::mode_ranges`].
    pub fn craft_view(&self) -> CraftView {
        match self {
            Self::Embedded(embedded) => embedded.firmware.craft_view(),
            Self::Remote(remote) => remote.craft_view(),
        }
    }

    pub(super) fn estimate_view(&self) -> EstimateView {
        match self {
            Self::Embedded(embedded) => embedded.firmware.estimate_view(),
            Self::Remote(remote) => remote.telemetry().estimate,
        }
    }

    /// Returns the settings that displays and checks need, as far as they are known.
    pub fn settings_view(&self) -> Option<SettingsView> {
        match self {
            Self::Embedded(embedded) => Some(embedded.firmware.settings_view()),
            Self::Remote(remote) => remote.telemetry().settings,
        }
    }

    /// Returns the mode conditions in force.
    pub fn mode_ranges(&self) -> Vec<ModeRange> {
        match self {
            Self::Embedded(embedded) => embedded.firmware.mode_ranges(),
            Self::Remote(remote) => remote.telemetry().craft.mode_ranges().to_vec(),
        }
    }

    /// Returns the facts that a pilot sees.
    pub(super) fn pilot_facts(&self, time: SimTime) -> PilotFacts {
        match self {
            Self::Embedded(embedded) => PilotFacts {
                time,
                fix: embedded.firmware.gps_fix(),
                arming_blocked: !embedded.firmware.arming_flags().is_empty(),
                armed: embedded.firmware.is_armed(),
                engaged: embedded.firmware.modes().has(Mode::Autopilot),
                heading_known: embedded.firmware.estimate().heading_valid,
                forward_stick_us: embedded.firmware.forward_stick_us(),
                alt_m: embedded.firmware.altitude_m(),
                climb_mps: embedded.firmware.climb_mps(),
                hover_stick_us: embedded.firmware.hover_stick_us(),
                raised_stick_us: embedded.firmware.raised_stick_us(),
            },
            Self::Remote(remote) => remote.pilot_facts(time),
        }
    }
}
