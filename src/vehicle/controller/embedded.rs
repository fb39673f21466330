//! A flight controller in this program, with its inputs since the last step.

use crate::firmware::Firmware;
use crate::firmware::cli::{CliReply, Interpreter};
use crate::firmware::config::Configuration;
use crate::firmware::msp::{MESSAGES, MspAction, Outcome, UtcTime};
use crate::msp::Access;
use crate::signals::{RcFrame, RcSource};
use crate::telemetry::{InFlightCommand, InFlightRefusal, Refusal};
use crate::vehicle::input_log::InputLog;
use crate::vehicle::{Message, VehicleCommand};

/// The firmware and the inputs since the last step.
#[derive(Debug, Clone)]
pub struct EmbeddedController {
    pub(super) firmware: Firmware,
    pub(super) inputs: InputLog,
}

impl EmbeddedController {
    pub(super) fn new(firmware: Firmware) -> Self {
        Self { firmware, inputs: InputLog::default() }
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

    /// Lines that only ask are inputs too, since each makes the parameters follow the settings again.
    pub(super) fn run_cli(&mut self, session: &mut Interpreter, line: &str) -> CliReply {
        self.inputs.note(|| VehicleCommand::Line(Box::new((session.clone(), line.to_owned()))));
        self.firmware.run_cli(session, line)
    }

    pub(super) fn run_msp(&mut self, code: u16, payload: &[u8], clock: Option<UtcTime>) -> Outcome {
        let outcome = self.firmware.run_msp(code, payload, clock);
        match outcome.action {
            Some(MspAction::RawRc(frame)) => self.inputs.note(|| VehicleCommand::Rc(frame, RcSource::Msp)),
            _ if writes(code) => {
                let message = || Message { code, payload: payload.to_vec(), clock };
                self.inputs.note(|| VehicleCommand::Message(Box::new(message())));
            }
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
