//! The requests of the doors to the session. Requests are data. An answer returns through a channel for one
//! value, so a disconnected client costs nothing.

use std::net::SocketAddr;
use std::time::Instant;

use tokio::sync::oneshot;

use super::proto::command_line::{Completion, LineReply, LineSource};
use crate::signals::RcFrame;

/// A client of the TCP or the websocket door, identified by a number that is never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ClientId(pub u64);

/// A request to the session. The session handles requests between two ticks in the order of arrival. It
/// answers before it acts on the announced effect, such as a restart.
#[derive(Debug)]
pub enum Request {
    Msp {
        /// The code of the message.
        code: u16,
        payload: Vec<u8>,
        /// Receives the payload of the reply, or `None` for the protocol's error.
        reply: oneshot::Sender<Option<Vec<u8>>>,
    },
    /// A client requests the command line.
    EnterCli {
        client: ClientId,
        /// `true` for a person: the craft does not arm from now until the next restart.
        interactive: bool,
        /// Receives `true` if the command line opens. It does not open while the craft is armed.
        reply: oneshot::Sender<bool>,
    },
    /// A line of the command line.
    Cli {
        client: ClientId,
        /// The line, without its end.
        line: String,
        /// The kind of session that the line comes from: the one that the client entered, or a message, which
        /// is a session of its own.
        source: LineSource,
        reply: oneshot::Sender<LineReply>,
    },
    /// A client requests the completion of a line being typed.
    Complete {
        /// The line so far.
        line: String,
        reply: oneshot::Sender<Completion>,
    },
    /// A client closed the command line, or disconnected while it was open. Effects that last for a session
    /// (a motor on the bench) end.
    LeftCli { client: ClientId },
    /// A client sent lines of text while its command line was closed; they were ignored. Sent once per paste
    /// of several lines.
    Ignored {
        /// The first word of the first line.
        word: String,
    },
    /// A client requests a restart of the firmware, which loses unsaved settings and closes the links.
    Restart,
    /// An RC frame from a script.
    Rc {
        /// The script's clock, s; unused.
        stamp_s: f64,
        frame: RcFrame,
        at: Instant,
    },
    /// A datagram from a simulator.
    Fdm {
        /// The bytes, without the surplus.
        datagram: Vec<u8>,
        from: SocketAddr,
        at: Instant,
    },
    /// A message to the user, as a sentence.
    Notice(String),
}
