//! The life of the connection to a flight controller.

use std::time::Duration;

use super::RemoteState;
use super::client::{Answer, Unanswered};
use super::identify::Identification;
use super::refresh::Refresh;

/// The number of unanswered requests in a row after which it counts as silent. Each waits for at least two
/// seconds.
const MAX_UNANSWERED: u32 = 2;

/// The phase of the life, with the data that only this phase has.
#[derive(Debug, Clone, Default)]
pub(super) enum Life {
    /// Its program is starting, or no connection was made yet.
    #[default]
    Connecting,
    /// Its identity and settings are being read, and it is configured.
    Identifying { connection: Connection, identification: Identification },
    /// It answers, and telemetry arrives.
    Ready { connection: Connection },
    /// The connection is open, but nothing answers over it any more.
    Silent { connection: Connection },
    /// The connection is lost. Another one is made automatically.
    Lost { connection: Connection },
    /// It cannot be used, with the reason as a sentence. A real one is still asked for its API version, and is
    /// identified again once it answers.
    Unusable { why: String, connection: Option<Connection>, identification: Identification },
}

/// The newest connection.
#[derive(Debug, Clone, Default)]
pub(super) struct Connection {
    /// The time of its beginning, until the notice that nothing answers.
    pub(super) since: Option<Duration>,
    /// `true` once data has arrived.
    pub(super) heard: bool,
    /// The last reported reason for a loss; `None` once data has arrived since.
    pub(super) reported_loss: Option<String>,
    /// The number of requests without an answer since the last answer.
    unanswered: u32,
    pub(super) refresh: Refresh,
}

impl Life {
    /// Returns the state for the display.
    pub(super) fn state(&self) -> RemoteState {
        match self {
            Self::Connecting => RemoteState::Connecting,
            Self::Identifying { .. } => RemoteState::Identifying,
            Self::Ready { .. } => RemoteState::Ready,
            Self::Silent { .. } | Self::Lost { .. } => RemoteState::Lost,
            Self::Unusable { why, .. } => RemoteState::Unusable(why.clone()),
        }
    }

    /// Returns the newest connection, which may be lost; `None` before the first.
    pub(super) fn connection(&self) -> Option<&Connection> {
        match self {
            Self::Connecting => None,
            Self::Identifying { connection, .. }
            | Self::Ready { connection }
            | Self::Silent { connection }
            | Self::Lost { connection } => Some(connection),
            Self::Unusable { connection, .. } => connection.as_ref(),
        }
    }

    pub(super) fn connection_mut(&mut self) -> Option<&mut Connection> {
        match self {
            Self::Connecting => None,
            Self::Identifying { connection, .. }
            | Self::Ready { connection }
            | Self::Silent { connection }
            | Self::Lost { connection } => Some(connection),
            Self::Unusable { connection, .. } => connection.as_mut(),
        }
    }

    /// Returns the newest connection and ends this phase.
    pub(super) fn end(&mut self) -> Option<Connection> {
        match std::mem::take(self) {
            Self::Connecting => None,
            Self::Identifying { connection, .. }
            | Self::Ready { connection }
            | Self::Silent { connection }
            | Self::Lost { connection } => Some(connection),
            Self::Unusable { connection, .. } => connection,
        }
    }

    /// Returns the phase that asks for the identity over a connection.
    pub(super) fn identifying(connection: Connection) -> Self {
        Self::Identifying { connection, identification: Identification::default() }
    }

    /// Returns the progress of the questions, if there may be answers to them.
    pub(super) fn identification_mut(&mut self) -> Option<&mut Identification> {
        match self {
            Self::Identifying { identification, .. } | Self::Unusable { identification, .. } => {
                Some(identification)
            }
            Self::Connecting | Self::Ready { .. } | Self::Silent { .. } | Self::Lost { .. } => None,
        }
    }
}

impl Connection {
    /// Returns a new connection after `before`.
    pub(super) fn after(before: Option<Self>, now: Duration) -> Self {
        let reported_loss = before.and_then(|before| before.reported_loss);
        Self { since: Some(now), reported_loss, ..Self::default() }
    }

    /// Returns the same connection for another flight controller at its end.
    pub(super) fn for_another(self) -> Self {
        Self { unanswered: 0, refresh: Refresh::default(), ..self }
    }

    /// Returns the connection after its loss.
    pub(super) fn closed(self) -> Self {
        Self { since: None, unanswered: 0, ..self }
    }

    /// Records that data has arrived.
    pub(super) fn heard(&mut self) {
        self.heard = true;
        self.reported_loss = None;
    }

    /// Counts the requests that are not answered.
    pub(super) fn note(&mut self, answer: &Answer) {
        match answer {
            Answer::NotAnswered(Unanswered::Silent) => self.unanswered += 1,
            Answer::NotAnswered(_) => {}
            Answer::Msp(_) | Answer::Line { .. } => self.unanswered = 0,
        }
    }

    /// Returns `true` if it has been silent for some requests.
    pub(super) fn is_silent(&self) -> bool {
        self.unanswered >= MAX_UNANSWERED
    }

    /// Returns `true` if the newest request was answered.
    pub(super) fn is_answered(&self) -> bool {
        self.unanswered == 0
    }
}
