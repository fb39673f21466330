//! The command line.
//!
//! The [`Interpreter`] turns one line into text and a list of actions. It does not matter where the line comes from: a
//! console, a file, a message, or the bytes of a serial link.
//!
//! ```text
//! line ──▶ Interpreter::run(line, CliContext) ──▶ CliReply { text, actions }
//!               │ edits                                   │
//!          Configuration                 saved, restarted, … by the owner
//! ```

mod advice;
mod apply;
mod bench;
mod command_table;
mod complete;
mod craft;
mod dump;
mod foreign;
mod get_set;
mod interpreter;
mod leave;
mod modes;
mod names;
mod observation;
mod profiles;
mod receiver;
mod serial;
mod session;
mod state;
mod status;
mod waypoint;

pub use advice::advice;
pub use apply::{ApplyReport, FailedLine, apply_lines, provision};
pub use command_table::{COMMANDS, Command};
pub use complete::{Completion, complete, hint};
pub use observation::{
    BatteryFacts, BuildInfo, CliFacts, GpsFacts, GpsSolutionFacts, LoopFacts, NavFacts, SmoothingFacts,
    StorageFacts, TaskFacts,
};
pub use state::{CliMode, Interpreter};

use super::config::Configuration;
use crate::telemetry::FirmwareNotice;

/// The most characters in a line; the rest is dropped.
pub const MAX_LINE: usize = 255;

/// The data that a command may see and change.
#[derive(Debug)]
#[doc(hidden)]
pub struct CliContext<'a> {
    /// The configuration in memory.
    pub configuration: &'a mut Configuration,
    /// Figures of the running firmware.
    pub facts: &'a CliFacts,
}

/// The answer to one line.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CliReply {
    /// The text as it goes over the link, without echo and prompt.
    pub text: String,
    /// The actions for the owner of the firmware, in order.
    pub actions: Vec<CliAction>,
    /// `true` if the line was refused.
    pub failed: bool,
    /// Notices for the pilot, in addition to the text.
    pub notices: Vec<FirmwareNotice>,
    /// The position in the text at which the program around the firmware may report about itself.
    pub host_lines_at: Option<usize>,
}

impl CliReply {
    /// Adds a line about the program around the firmware, if the reply has a place for it.
    pub fn add_host_line(&mut self, line: &str) {
        if let Some(at) = &mut self.host_lines_at {
            let line = format!("{line}\r\n");
            self.text.insert_str(*at, &line);
            *at += line.len();
        }
    }

    /// Turns a reply that announced a save into a refusal with this reason. Nothing restarts, so the configuration in
    /// memory stays.
    pub fn refuse_save(&mut self, why: &str) {
        self.text = format!("###ERROR IN save: {why}###\r\n");
        self.actions.retain(|action| !matches!(action, CliAction::Save | CliAction::Restart { .. }));
        self.failed = true;
    }
}

/// A line that was refused, with its reply.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the craft refused `{line}`: {reply}")]
pub struct RefusedLine {
    /// The line, as it was given.
    pub line: String,
    /// The reply of the command line.
    pub reply: String,
}

/// An action that a command requests from the owner of the firmware.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CliAction {
    /// Stores the configuration.
    Save,
    /// Restarts from the stored configuration; unsaved changes are lost.
    Restart {
        /// `true` if the serial clients are closed, as in a real restart.
        close_links: bool,
    },
    /// Leaves the command line; the session is back in MSP.
    Leave,
    /// Runs a motor on the bench until the session ends.
    MotorTest {
        /// The index of the motor; `None` = all motors.
        motor: Option<u8>,
        /// The output, µs, 1000…2000.
        output_us: u16,
    },
    /// The stored flight plan was changed.
    PlanChanged,
}
