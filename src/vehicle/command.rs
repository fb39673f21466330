//! The commands to a vehicle, as data: everything that changes it between two ticks.

use crate::firmware::cli::{CliMode, CliReply, RefusedLine};
use crate::firmware::config::Configuration;
use crate::firmware::msp::{Outcome, UtcTime};
use crate::pilot::StickInput;
use crate::plan::FlightPlan;
use crate::signals::{RcFrame, RcSource};
use crate::sim::{WorldCommand, WorldError};
use crate::telemetry::{InFlightCommand, InFlightRefusal, Mode, Refusal};

/// A command to a vehicle. [`Vehicle::apply`](super::Vehicle::apply) carries it out.
#[derive(Debug, Clone, PartialEq)]
pub enum VehicleCommand {
    /// An RC frame from a link.
    Rc(RcFrame, RcSource),
    /// `true` gives the virtual sticks precedence over the other sources of RC, `false` ends that.
    SticksFirst(bool),
    /// Begin a session of the command line, or begin it again.
    BeginCli(CliSession, CliMode),
    /// End a session of the command line.
    EndCli(CliSession),
    /// End all sessions of the command line.
    EndAllCli,
    /// A CLI line.
    Line(Box<CliLine>),
    /// Store a plan in an embedded flight controller. A remote one gets it as lines.
    Upload(Box<PlanUpload>),
    /// An MSP message.
    Message(Box<Message>),
    /// A person opened a command line.
    CliOpened,
    /// A command line that turned motors was left.
    CliClosed,
    /// A restart on this configuration.
    Restart(Box<Configuration>),
    /// Fly home and land.
    ReturnHome,
    /// Go to a waypoint, hold the position or continue.
    InFlight(InFlightCommand),
    /// Cancel [`Self::ReturnHome`]. The AUTOPILOT switch decides again.
    CancelReturn,
    /// Set the virtual sticks, which are sent 50 times per simulated second until replaced.
    Sticks(RcFrame),
    /// Cut (`true`) or restore the RC link of the virtual sticks.
    CutRc(bool),
    /// Hold a channel of the transmitter at a value.
    HoldChannel(StickInput),
    /// Give a channel, from 0, back to the virtual sticks.
    ReleaseChannel(u8),
    /// Start the scripted pilot, which climbs to this altitude in metres and engages the autopilot.
    StartPilot(f64),
    /// Take the sticks from the scripted pilot.
    StopPilot,
    /// Change air, noise or faults.
    World(Box<WorldCommand>),
    /// Put the craft back home, disarmed. Plan and settings are kept.
    ResetCraft,
}

/// The subject of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CommandKind {
    /// The transmitter, and the RC of other programs.
    Rc,
    /// The start of the scripted pilot.
    Pilot,
    /// The return home.
    Return,
    /// The navigator that flies a plan.
    Order,
    /// The sessions of the command line. No setting changes.
    Session,
    /// The configuration: a line, a message, an upload, a restart.
    Configuration,
    /// Air, noise and faults.
    World,
    /// The whole craft, which is put back home.
    Reset,
}

/// The session of the command line that runs a line. A session that was not begun is at a prompt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CliSession {
    /// The session of the screen, or of a scenario.
    Console,
    /// The session of the client with this number.
    Client(u64),
    /// The line is a session of its own.
    Single(CliMode),
}

/// A CLI line and its session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CliLine {
    /// The session that runs it.
    pub session: CliSession,
    /// The line, without its end.
    pub line: String,
}

/// A plan and the settings that are stored before it.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanUpload {
    /// The plan.
    pub plan: FlightPlan,
    /// Settings as `name = value`.
    pub settings: Vec<String>,
}

/// An MSP message with the data for its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// The code of the message.
    pub code: u16,
    /// The payload of the request.
    pub payload: Vec<u8>,
    /// Time of day for messages that ask for it.
    pub clock: Option<UtcTime>,
}

impl Message {
    /// Returns a message that needs no time of day.
    pub fn of(code: u16, payload: Vec<u8>) -> Self {
        Self { code, payload, clock: None }
    }
}

impl From<WorldCommand> for VehicleCommand {
    fn from(change: WorldCommand) -> Self {
        Self::World(Box::new(change))
    }
}

impl From<Message> for VehicleCommand {
    fn from(message: Message) -> Self {
        Self::Message(Box::new(message))
    }
}

/// The answer to a command.
#[derive(Debug)]
pub enum Reply {
    /// Carried out. There is nothing to report.
    Done,
    /// There was nothing to do, for example the end of a session that has ended.
    Unchanged,
    /// Not carried out. The lines of an upload before the refused one keep their effect.
    Refused(VehicleRefusal),
    /// The answer to a CLI line.
    Line(CliReply),
    /// The answer to an MSP message.
    Message(Outcome),
    /// The plan is stored. These are the answers to the lines of the upload.
    Uploaded(Vec<String>),
}

/// The reason why a vehicle does not carry out a command.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VehicleRefusal {
    /// The world refuses a value.
    #[error("{0}")]
    World(WorldError),
    /// The craft cannot fly home.
    #[error("{}", .0.sentence())]
    ReturnHome(Refusal),
    /// The navigator refuses the command.
    #[error("{}", .0.sentence())]
    InFlight(InFlightRefusal),
    /// No channel switches the mode that the scripted pilot needs.
    #[error("no channel switches {0}")]
    Pilot(Mode),
    /// The lines before this one keep their effect.
    #[error(transparent)]
    Upload(RefusedLine),
    /// A remote flight controller gets a plan as lines.
    #[error("a remote flight controller accepts a plan only in a session")]
    UploadToRemote,
}

impl VehicleRefusal {
    /// Returns the reason for a notice, for most refusals with the way out.
    pub fn sentence(&self) -> String {
        match self {
            Self::ReturnHome(refusal) => format!("No return home: {}", refusal.sentence()),
            Self::Pilot(mode) => {
                format!("The scripted pilot needs a switch for {mode}: assign one with the CLI command aux.")
            }
            Self::Upload(RefusedLine { line, reply }) => format!("The craft refuses `{line}`: {reply}"),
            Self::World(_) | Self::InFlight(_) | Self::UploadToRemote => self.to_string(),
        }
    }
}

impl Reply {
    /// Returns the reply of a command that had something to do, or had not.
    pub(super) fn done(is_done: bool) -> Self {
        if is_done { Self::Done } else { Self::Unchanged }
    }
}

impl From<Result<(), VehicleRefusal>> for Reply {
    fn from(result: Result<(), VehicleRefusal>) -> Self {
        result.map_or_else(Self::Refused, |()| Self::Done)
    }
}

impl VehicleCommand {
    /// Returns the command that runs a CLI line.
    pub fn line(session: CliSession, line: impl Into<String>) -> Self {
        Self::Line(Box::new(CliLine { session, line: line.into() }))
    }

    /// Returns the command that runs a CLI line in a session of its own at a prompt.
    pub fn single_line(line: impl Into<String>) -> Self {
        Self::line(CliSession::Single(CliMode::Interactive), line)
    }

    /// Returns the command that stores a plan after its settings (`name = value`).
    pub fn upload(plan: FlightPlan, settings: Vec<String>) -> Self {
        Self::Upload(Box::new(PlanUpload { plan, settings }))
    }

    /// Returns the subject of the command. The rules about permissions, remote craft and scenarios
    /// follow from it.
    pub fn kind(&self) -> CommandKind {
        match self {
            Self::Rc(..)
            | Self::SticksFirst(_)
            | Self::Sticks(_)
            | Self::CutRc(_)
            | Self::HoldChannel(_)
            | Self::ReleaseChannel(_)
            | Self::StopPilot => CommandKind::Rc,
            Self::StartPilot(_) => CommandKind::Pilot,
            Self::ReturnHome | Self::CancelReturn => CommandKind::Return,
            Self::InFlight(_) => CommandKind::Order,
            Self::BeginCli(..) | Self::EndCli(_) | Self::EndAllCli | Self::CliOpened | Self::CliClosed => {
                CommandKind::Session
            }
            Self::Line(_) | Self::Message(_) | Self::Upload(_) | Self::Restart(_) => {
                CommandKind::Configuration
            }
            Self::World(_) => CommandKind::World,
            Self::ResetCraft => CommandKind::Reset,
        }
    }

    /// Returns the approximate memory of the command, bytes.
    pub fn bytes(&self) -> usize {
        let heap = match self {
            Self::Line(line) => size_of_val(&**line) + line.line.len(),
            Self::Upload(upload) => {
                let of_text = |text: &String| size_of::<String>() + text.len();
                size_of_val(&**upload) + upload.settings.iter().map(of_text).sum::<usize>()
            }
            Self::Message(message) => size_of::<Message>() + message.payload.len(),
            // Its tables are on the heap.
            Self::Restart(configuration) => 4 * size_of_val(&**configuration),
            Self::World(command) => size_of_val(&**command),
            _ => 0,
        };
        size_of::<Self>() + heap
    }
}
