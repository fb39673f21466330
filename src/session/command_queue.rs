//! The commands of the user interface, in their order.

use std::task::{Context, Poll};

use tokio::sync::mpsc;

use super::command::{Command, Seek};

/// The commands that wait, and the number of those that were taken.
#[derive(Debug)]
pub(super) struct CommandQueue {
    commands: mpsc::Receiver<Command>,
    /// A command that was looked at and is taken next.
    held_back: Option<Command>,
    taken: u64,
    /// `true` if all commands were taken, so that the next one wakes the thread.
    is_idle: bool,
    has_ended: bool,
}

impl CommandQueue {
    pub(super) fn new(commands: mpsc::Receiver<Command>) -> Self {
        Self { commands, held_back: None, taken: 0, is_idle: false, has_ended: false }
    }

    /// Takes the next command. A held key repeats faster than an instant is found: consecutive seeks in one direction are
    /// one command.
    pub(super) fn take(&mut self, context: &mut Context<'_>) -> Option<Command> {
        let mut command = self.next(context)?;
        while let Command::Seek(Seek::Seconds(way)) = &mut command {
            match self.next(context) {
                Some(Command::Seek(Seek::Seconds(more))) if more.signum() == way.signum() => *way += more,
                Some(other) => {
                    self.taken -= 1;
                    self.held_back = Some(other);
                    break;
                }
                None => break,
            }
        }
        Some(command)
    }

    fn next(&mut self, context: &mut Context<'_>) -> Option<Command> {
        let next = self.held_back.take().or_else(|| {
            let received = self.commands.poll_recv(context);
            self.is_idle = received.is_pending();
            self.has_ended |= matches!(received, Poll::Ready(None));
            match received {
                Poll::Ready(next) => next,
                Poll::Pending => None,
            }
        });
        self.taken += u64::from(next.is_some());
        next
    }

    /// Returns `true` if the thread may sleep: the next command wakes it. It may not while a command is on its way.
    pub(super) fn is_idle(&self) -> bool {
        self.is_idle
    }

    /// Returns `true` if the thread may sleep, also because there will be no more commands.
    pub(super) fn is_silent(&self) -> bool {
        self.is_idle || self.has_ended
    }

    /// Returns the number of commands that were taken.
    pub(super) fn taken(&self) -> u64 {
        self.taken
    }

    /// Returns `true` if all senders are gone and no command is left.
    pub(super) fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// Returns `true` if all senders are gone.
    pub(super) fn is_closed(&self) -> bool {
        self.commands.is_closed()
    }
}
