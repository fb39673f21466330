//! What the doors ask of the session. Requests are data; an answer goes back through a channel of one, so a client
//! that went away costs nothing.

use std::net::SocketAddr;
use std::time::Instant;

use tokio::sync::oneshot;

use super::proto::command_line::{Completion, LineReply, LineSource};
use crate::signals::RcFrame;

/// A client of the TCP or the websocket door, by a number that is never used twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ClientId(pub u64);

/// A request to the session. The session carries requests out between two ticks, in the order they came, and answers
/// before it acts on what the answer announced (a restart, for one).
#[derive(Debug)]
pub enum Request {
    Msp {
        client: ClientId,
        /// The message's code.
        code: u16,
        payload: Vec<u8>,
        /// Gets the reply's payload, or `None` for the protocol's error.
        reply: oneshot::Sender<Option<Vec<u8>>>,
    },
    /// A client wants the command line.
    EnterCli {
        client: ClientId,
        /// For a person: from now until the next restart, the craft does not arm.
        interactive: bool,
        /// Gets whether it opens; it does not while armed.
        reply: oneshot::Sender<bool>,
    },
    /// A line of the command line.
    Cli {
        client: ClientId,
        /// The line, without its end.
        line: String,
        /// What kind of session it comes from: the one that the client entered, or a message, which is its own.
        source: LineSource,
        reply: oneshot::Sender<LineReply>,
    },
    /// How a line being typed may go on.
    Complete {
        /// The line so far.
        line: String,
        reply: oneshot::Sender<Completion>,
    },
    /// A client left the command line, or went away inside it: what lasts for a session (a motor on the bench) ends.
    LeftCli { client: ClientId },
    /// A client sent lines of text while its command line was closed; they were ignored. Comes once for lines of one paste.
    Ignored {
        client: ClientId,
        /// The first word of the first line.
        word: String,
    },
    /// A client wants the firmware to start anew, losing what was not saved, and the links to close.
    Restart { client: ClientId },
    /// An RC frame from a script.
    Rc {
        /// The script's clock, s; nothing depends on it.
        stamp_s: f64,
        frame: RcFrame,
        from: SocketAddr,
        at: Instant,
    },
    /// A datagram from a simulator.
    Fdm {
        /// Its bytes, the surplus cut.
        datagram: Vec<u8>,
        from: SocketAddr,
        at: Instant,
    },
    /// Something the user should read, as a sentence.
    Notice(String),
}
