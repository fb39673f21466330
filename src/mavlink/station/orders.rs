//! Commands to a craft: one at a time, repeated until the craft answers.

use std::collections::VecDeque;
use std::time::Duration;

use super::super::message::CommandLong;
use super::super::value::CommandResult;

/// The time after which a command is repeated.
const PATIENCE: Duration = Duration::from_secs(1);
/// The time that a craft has for a command that it has begun.
const LONG_PATIENCE: Duration = Duration::from_secs(20);
/// The number of times that a command is sent.
const MAX_TRIES: u8 = 4;
/// The number of commands that wait.
const MAX_WAITING: usize = 64;

/// The number of an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct OrderId(u32);

/// The end of an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OrderEnd {
    /// The craft answered.
    Answered(CommandResult),
    /// The craft did not answer.
    Silence,
    /// The link was lost, or the craft changed.
    Lost,
}

/// A command that was sent.
#[derive(Debug, Clone, Copy)]
struct Sent {
    due: Duration,
    tries: u8,
}

/// Commands that wait for their turn. The first one may have been sent.
#[derive(Debug, Clone, Default)]
pub(super) struct Orders {
    waiting: VecDeque<(OrderId, CommandLong)>,
    sent: Option<Sent>,
    next: u32,
}

impl Orders {
    /// Returns the number of the new order, or `None` if too many wait.
    pub(super) fn add(&mut self, command: CommandLong) -> Option<OrderId> {
        let id = OrderId(self.next);
        if self.waiting.len() >= MAX_WAITING {
            return None;
        }
        self.next = self.next.wrapping_add(1);
        self.waiting.push_back((id, command));
        Some(id)
    }

    /// Returns the command to send now, and the order that ends without an answer.
    pub(super) fn advance(&mut self, now: Duration) -> (Option<CommandLong>, Option<OrderId>) {
        let tries = match self.sent {
            Some(sent) if now < sent.due => return (None, None),
            Some(sent) if sent.tries >= MAX_TRIES => return (None, self.drop_first()),
            Some(sent) => sent.tries,
            None => 0,
        };
        let Some((_, command)) = self.waiting.front() else { return (None, None) };
        let command = CommandLong { confirmation: tries, ..*command };
        self.sent = Some(Sent { due: now.saturating_add(PATIENCE), tries: tries + 1 });
        (Some(command), None)
    }

    /// Takes the answer to a command. Returns the order that ends with it.
    pub(super) fn answer(
        &mut self,
        now: Duration,
        command: u16,
        result: u8,
    ) -> Option<(OrderId, CommandResult)> {
        let is_meant =
            self.sent.is_some() && self.waiting.front().is_some_and(|(_, first)| first.command == command);
        if !is_meant {
            return None;
        }
        let result = CommandResult::from_code(result).unwrap_or(CommandResult::Failed);
        if result == CommandResult::InProgress {
            self.sent = Some(Sent { due: now.saturating_add(LONG_PATIENCE), tries: MAX_TRIES });
            return None;
        }
        self.drop_first().map(|id| (id, result))
    }

    /// Drops all orders and returns them.
    pub(super) fn clear(&mut self) -> Vec<OrderId> {
        self.sent = None;
        self.waiting.drain(..).map(|(id, _)| id).collect()
    }

    fn drop_first(&mut self) -> Option<OrderId> {
        self.sent = None;
        self.waiting.pop_front().map(|(id, _)| id)
    }
}
