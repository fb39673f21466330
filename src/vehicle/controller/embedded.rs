//! A flight controller in this program, with its inputs since the last step.

use std::collections::BTreeMap;

use crate::firmware::Firmware;
use crate::firmware::cli::{CliMode, CliReply, Interpreter, RefusedLine};
use crate::firmware::config::Configuration;
use crate::firmware::msp::{MESSAGES, MspAction, Outcome};
use crate::msp::Access;
use crate::signals::{RcFrame, RcSource};
use crate::telemetry::{InFlightCommand, InFlightRefusal, Refusal};
use crate::vehicle::input_log::InputLog;
use crate::vehicle::{CliLine, CliSession, Message, PlanUpload, VehicleCommand};

/// The firmware, the sessions of its command line, and the inputs since the last step.
#[derive(Debug, Clone)]
pub struct EmbeddedController {
    pub(super) firmware: Firmware,
    cli_sessions: BTreeMap<CliSession, Interpreter>,
    pub(super) inputs: InputLog,
}

impl EmbeddedController {
    pub(super) fn new(firmware: Firmware) -> Self {
        Self { firmware, cli_sessions: BTreeMap::new(), inputs: InputLog::default() }
    }

    pub(super) fn receive_rc(&mut self, frame: &RcFrame, source: RcSource) {
        // The frames of the virtual sticks follow from the transmitter.
        if source != RcSource::Sticks {
            self.inputs.note(|| VehicleCommand::Rc(*frame, source));
        }
        self.firmware.receive_rc(frame, source);
    }

    pub(super) fn take_over_sticks(&mut self, sticks_first: bool) {
        self.inputs.note(|| VehicleCommand::SticksFirst(sticks_first));
        self.firmware.take_over_sticks(sticks_first);
    }

    pub(super) fn begin_cli(&mut self, session: CliSession, mode: CliMode) {
        self.inputs.note(|| VehicleCommand::BeginCli(session, mode));
        self.cli_sessions.insert(session, Interpreter::new(mode));
    }

    pub(super) fn end_cli(&mut self, session: CliSession) {
        if self.cli_sessions.remove(&session).is_some() {
            self.inputs.note(|| VehicleCommand::EndCli(session));
        }
    }

    pub(super) fn end_all_cli(&mut self) {
        if !std::mem::take(&mut self.cli_sessions).is_empty() {
            self.inputs.note(|| VehicleCommand::EndAllCli);
        }
    }

    /// Lines that only ask are inputs too, since each makes the parameters follow the settings again.
    pub(super) fn run_cli(&mut self, command: &CliLine) -> CliReply {
        self.inputs.note(|| VehicleCommand::Line(Box::new(command.clone())));
        let CliLine { session, line } = command;
        match session {
            CliSession::Single(mode) => self.firmware.run_cli(&mut Interpreter::new(*mode), line),
            CliSession::Console | CliSession::Client(_) => {
                self.firmware.run_cli(self.cli_sessions.entry(*session).or_default(), line)
            }
        }
    }

    pub(super) fn upload(&mut self, upload: &PlanUpload) -> Result<Vec<String>, RefusedLine> {
        self.inputs.note(|| VehicleCommand::Upload(Box::new(upload.clone())));
        self.firmware.upload(&upload.plan, &upload.settings)
    }

    pub(super) fn run_msp(&mut self, message: &Message) -> Outcome {
        let Message { code, payload, clock } = message;
        let outcome = self.firmware.run_msp(*code, payload, *clock);
        match outcome.action {
            Some(MspAction::RawRc(frame)) => self.inputs.note(|| VehicleCommand::Rc(frame, RcSource::Msp)),
            _ if writes(*code) => self.inputs.note(|| VehicleCommand::Message(Box::new(message.clone()))),
            _ => {}
        }
        outcome
    }

    pub(super) fn cli_opened(&mut self) {
        self.inputs.note(|| VehicleCommand::CliOpened);
        self.firmware.cli_opened();
    }

    pub(super) fn cli_closed(&mut self) {
        self.inputs.note(|| VehicleCommand::CliClosed);
        self.firmware.cli_closed();
    }

    pub(super) fn restart(&mut self, configuration: Configuration) {
        self.inputs.note(|| VehicleCommand::Restart(Box::new(configuration.clone())));
        self.firmware.restart(configuration);
    }

    pub(super) fn return_to_home(&mut self) -> Result<(), Refusal> {
        self.inputs.note(|| VehicleCommand::ReturnHome);
        self.firmware.return_to_home()
    }

    pub(super) fn command(&mut self, command: InFlightCommand) -> Result<(), InFlightRefusal> {
        self.inputs.note(|| VehicleCommand::InFlight(command));
        self.firmware.command(command)
    }

    pub(super) fn cancel_command(&mut self) {
        self.inputs.note(|| VehicleCommand::CancelReturn);
        self.firmware.cancel_command();
    }
}

/// Returns `true` if a message can change anything.
fn writes(code: u16) -> bool {
    let found = MESSAGES.binary_search_by_key(&code, |message| message.kind.code);
    found
        .ok()
        .and_then(|index| MESSAGES.get(index))
        .is_some_and(|message| message.kind.access == Access::Write)
}
