//! The requests that are not answered yet, and their purposes.

use std::collections::BTreeMap;

use super::client::AskId;
use super::identify::Question;
use super::polling::Poll;
use crate::vehicle::Ticket;

/// The purpose of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// A line from another part of this program. `true` if it may change something.
    Line(Ticket, bool),
    /// A line at the prompt, from a client of the doors. `true` if it may change something.
    Typed(Ticket, bool),
    /// The line that shows the plan, from another part of this program.
    Plan(Ticket),
    /// An MSP message from another part of this program. `true` if it may change something.
    Message(Ticket, bool),
    /// A question about its identity.
    Identity(Question),
    Provision,
    /// A poll for the display.
    Polled(Poll),
    /// A question about its current settings.
    Refreshed(Question),
    /// No purpose; the effect is observed elsewhere.
    Nothing,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Asked {
    waiting: BTreeMap<AskId, Purpose>,
    next: u64,
}

impl Asked {
    /// Registers a request. Returns its name.
    pub(super) fn register(&mut self, purpose: Purpose) -> AskId {
        let id = AskId(self.next);
        self.next += 1;
        self.waiting.insert(id, purpose);
        id
    }

    /// Returns the purpose of a request that was answered.
    pub(super) fn answered(&mut self, id: AskId) -> Option<Purpose> {
        self.waiting.remove(&id)
    }
}
