//! The state of an interpreter from line to line.

use super::super::settings::Scope;

/// The kind of client that uses the interpreter. It changes a few answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum CliMode {
    /// A person or a script at a prompt.
    #[default]
    Interactive,
    /// One line between STX and ETX on a serial link. Unknown commands get another error text, and a restart closes no
    /// links.
    Framed,
    /// One line in an MSP message. Like `Framed`, but nothing restarts, and lines that end the link are refused.
    Message,
    /// The lines of a file. Commands of other builds are kept.
    File,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Batch {
    #[default]
    Closed,
    Open,
    Failed,
}

/// The interpreter of one session.
#[derive(Debug, Clone, PartialEq)]
#[doc(hidden)]
pub struct Interpreter {
    pub(super) mode: CliMode,
    pub(super) batch: Batch,
    /// The section of the lines that are kept: master, or the last selected profile.
    pub(super) section: (Scope, u8),
    lenient: bool,
}

impl Default for Interpreter {
    fn default() -> Self {
        Self::new(CliMode::default())
    }
}

impl Interpreter {
    pub fn new(mode: CliMode) -> Self {
        Self { mode, batch: Batch::Closed, section: (Scope::Master, 0), lenient: false }
    }

    /// With `true`, errors do not stop a batch from being saved.
    pub fn lenient(mut self, lenient: bool) -> Self {
        self.lenient = lenient;
        self
    }

    /// Returns `true` if a line was refused in the open batch.
    pub fn batch_failed(&self) -> bool {
        self.batch == Batch::Failed
    }

    pub(super) fn note_failure(&mut self) {
        if self.batch == Batch::Open && !self.lenient {
            self.batch = Batch::Failed;
        }
    }
}
