//! A flight controller in this program, with its inputs since the last step.

use std::collections::BTreeMap;

use crate::firmware::Firmware;
use crate::firmware::cli::{CliReply, Interpreter};
use crate::firmware::config::Configuration;
use crate::vehicle::input_log::InputLog;
use crate::vehicle::{CliLine, CliSession, Message, Reply, VehicleCommand, VehicleRefusal};

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

    /// Carries out a command to the firmware. Commands to the transmitter and the world have no effect here.
    pub(super) fn apply(&mut self, command: &VehicleCommand) -> Reply {
        match command {
            VehicleCommand::Rc(frame, source) => self.firmware.receive_rc(frame, *source),
            VehicleCommand::SticksFirst(first) => self.firmware.take_over_sticks(*first),
            VehicleCommand::BeginCli(session, mode) => {
                self.cli_sessions.insert(*session, Interpreter::new(*mode));
            }
            VehicleCommand::EndCli(session) => {
                return Reply::done(self.cli_sessions.remove(session).is_some());
            }
            VehicleCommand::EndAllCli => {
                return Reply::done(!std::mem::take(&mut self.cli_sessions).is_empty());
            }
            VehicleCommand::Line(line) => return Reply::Line(self.run_cli(line)),
            VehicleCommand::Upload(upload) => {
                let stored = self.firmware.upload(&upload.plan, &upload.settings);
                return stored.map_err(VehicleRefusal::Upload).map_or_else(Reply::Refused, Reply::Uploaded);
            }
            VehicleCommand::Message(message) => {
                let Message { code, payload, clock } = &**message;
                return Reply::Message(self.firmware.run_msp(*code, payload, *clock));
            }
            VehicleCommand::CliOpened => self.firmware.cli_opened(),
            VehicleCommand::CliClosed => self.firmware.cli_closed(),
            VehicleCommand::Restart(configuration) => {
                self.firmware.restart(Configuration::clone(configuration));
            }
            VehicleCommand::ReturnHome => {
                return self.firmware.return_to_home().map_err(VehicleRefusal::ReturnHome).into();
            }
            VehicleCommand::InFlight(command) => {
                return self.firmware.command(*command).map_err(VehicleRefusal::InFlight).into();
            }
            VehicleCommand::CancelReturn => self.firmware.cancel_command(),
            VehicleCommand::Sticks(_)
            | VehicleCommand::CutRc(_)
            | VehicleCommand::HoldChannel(_)
            | VehicleCommand::ReleaseChannel(_)
            | VehicleCommand::StartPilot(_)
            | VehicleCommand::StopPilot
            | VehicleCommand::World(_)
            | VehicleCommand::ResetCraft => return Reply::Unchanged,
        }
        Reply::Done
    }

    fn run_cli(&mut self, CliLine { session, line }: &CliLine) -> CliReply {
        match session {
            CliSession::Single(mode) => self.firmware.run_cli(&mut Interpreter::new(*mode), line),
            CliSession::Console | CliSession::Client(_) => {
                self.firmware.run_cli(self.cli_sessions.entry(*session).or_default(), line)
            }
        }
    }
}
