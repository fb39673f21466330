//! The requests to a craft, and the answers that ground stations wait for.

use super::super::mission::MissionItem;
use super::super::state::GeoPosition;
use super::super::value::{CommandResult, MissionKind, MissionResult};
use super::modes::FlightMode;
use super::peer::PeerId;

/// The number of requests that wait for an answer of the host. Further ones are refused.
const MAX_PENDING: usize = 64;

/// The number of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ticket(u32);

/// A request that the host carries out and answers.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The number for the answer.
    pub ticket: Ticket,
    /// The sender.
    pub peer: PeerId,
    /// The request itself.
    pub kind: RequestKind,
}

/// The kinds of requests.
#[derive(Debug, Clone, PartialEq)]
pub enum RequestKind {
    /// Arm, if the checks pass.
    Arm,
    /// Disarm.
    Disarm,
    /// Take off.
    TakeOff {
        /// The altitude above home, m; `None` if the craft chooses it.
        altitude: Option<f64>,
    },
    /// Land here.
    Land,
    /// Return home.
    ReturnHome,
    /// Fly the mission.
    StartMission,
    /// Interrupt the mission, and hold the position.
    Pause,
    /// Continue the mission.
    Continue,
    /// Change the mode.
    SetMode(FlightMode),
    /// Continue with this mission item. Items count from 0, without a home item.
    SetCurrent(u16),
    /// Set home; `None` is the present position.
    SetHome(Option<GeoPosition>),
    /// Restart the flight controller.
    Reboot,
    /// Replace the mission. No items delete it.
    Mission {
        /// The items without a home item.
        items: Vec<MissionItem>,
        /// The home item that the ground station sent before them. It is not flown.
        home: Option<MissionItem>,
    },
    /// Replace the fences. No items delete them.
    Fence(Vec<MissionItem>),
    /// Set a parameter.
    SetParameter {
        /// The name in the table of parameters.
        name: String,
        /// The value, a finite number.
        value: f32,
    },
}

/// The answer to a request.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Answer {
    /// To a command, a mode or a mission item that was set.
    Command(CommandResult),
    /// To a mission or fences.
    Mission(MissionResult),
    /// To a parameter: the value now in force, which is the old one if the new one was refused.
    Parameter(f32),
}

impl Answer {
    pub(super) fn command(self) -> CommandResult {
        match self {
            Self::Command(result) => result,
            Self::Mission(MissionResult::Accepted) | Self::Parameter(_) => CommandResult::Accepted,
            Self::Mission(_) => CommandResult::Failed,
        }
    }

    pub(super) fn mission(self) -> MissionResult {
        match self {
            Self::Mission(result) => result,
            Self::Command(CommandResult::Accepted) | Self::Parameter(_) => MissionResult::Accepted,
            Self::Command(_) => MissionResult::Error,
        }
    }
}

/// A component of a ground station.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Sender {
    pub(super) peer: PeerId,
    pub(super) system: u8,
    pub(super) component: u8,
}

/// The message that follows the answer of the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reply {
    /// The acknowledgement of a command, with the bits of its parameters to recognise a repetition.
    Command(u16, [u32; 7]),
    /// The acknowledgement of a mission or of fences.
    Mission(MissionKind),
    /// The mission item that is flown to.
    Current,
    /// The parameter with this index.
    Parameter(usize),
    /// Nothing.
    Silence,
}

/// A request without an answer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pending {
    ticket: Ticket,
    pub(super) from: Sender,
    pub(super) reply: Reply,
}

/// The requests without an answer.
#[derive(Debug, Clone, Default)]
pub(super) struct PendingRequests {
    all: Vec<Pending>,
    next: u32,
}

impl PendingRequests {
    /// Returns a ticket, or `None` if too many requests wait.
    pub(super) fn add(&mut self, from: Sender, reply: Reply) -> Option<Ticket> {
        let ticket = Ticket(self.next);
        if self.all.len() >= MAX_PENDING {
            return None;
        }
        self.next = self.next.wrapping_add(1);
        self.all.push(Pending { ticket, from, reply });
        Some(ticket)
    }

    pub(super) fn take(&mut self, ticket: Ticket) -> Option<Pending> {
        let at = self.all.iter().position(|pending| pending.ticket == ticket)?;
        Some(self.all.remove(at))
    }

    /// Returns `true` if a component already waits for this.
    pub(super) fn contains(&self, from: Sender, reply: Reply) -> bool {
        self.all.iter().any(|pending| pending.from == from && pending.reply == reply)
    }

    pub(super) fn forget(&mut self, peer: PeerId) {
        self.all.retain(|pending| pending.from.peer != peer);
    }
}
