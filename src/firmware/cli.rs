//! The command line.
//!
//! The [`Interpreter`] turns one line into text and a list of things to do. Where lines come from (a console, a file, a
//! message, the bytes of a serial link) is not its concern.
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
mod status;
mod waypoint;

pub use advice::advice;
pub use apply::{ApplyReport, FailedLine, apply_lines, provision};
pub use command_table::{COMMANDS, Command};
pub use complete::{Completion, complete, hint};
pub use interpreter::{CliMode, Interpreter};
pub use observation::{
    BatteryFacts, BuildInfo, CliFacts, GpsFacts, GpsSolutionFacts, LoopFacts, NavFacts, SmoothingFacts,
    StorageFacts, TaskFacts,
};

use super::config::Configuration;
use crate::telemetry::FirmwareNotice;

/// The most characters of a line; the rest is dropped.
pub const MAX_LINE: usize = 255;

/// What a command may see and change.
#[derive(Debug)]
pub struct CliContext<'a> {
    /// The configuration in memory.
    pub configuration: &'a mut Configuration,
    /// Figures of the running firmware.
    pub facts: &'a CliFacts,
}

/// The answer to one line.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CliReply {
    /// Text as it goes over the link, without echo and prompt.
    pub text: String,
    /// What the owner of the firmware has to do, in order.
    pub actions: Vec<CliAction>,
    /// Whether the line was refused.
    pub failed: bool,
    /// What the pilot should read about it, beside the text.
    pub notices: Vec<FirmwareNotice>,
}

impl CliReply {
    /// Turns an answer that announced a save into a refusal: it could not be done, for this reason, and nothing
    /// restarts, so that what is in memory stays.
    pub fn refuse_save(&mut self, why: &str) {
        self.text = format!("###ERROR IN save: {why}###\r\n");
        self.actions.retain(|action| !matches!(action, CliAction::Save | CliAction::Restart { .. }));
        self.failed = true;
    }
}

/// Something a command asks the owner of the firmware to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CliAction {
    Save,
    /// Restart from the stored configuration; what is not stored is lost.
    Restart {
        /// Whether the serial clients are closed, as a real restart does.
        close_links: bool,
    },
    /// The session leaves the command line and speaks MSP again.
    Leave,
    /// Run a motor on the bench until the session ends.
    MotorTest {
        /// Which motor, or all.
        motor: Option<u8>,
        /// Output, µs, 1000…2000.
        output_us: u16,
    },
    /// The stored flight plan was changed.
    PlanChanged,
}
