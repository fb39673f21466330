//! Carries out commands.

use super::{Answer, Reply, Vehicle, VehicleCommand, VehicleRefusal};
use crate::firmware::config::Configuration;
use crate::sim::WorldCommand;

impl Vehicle {
    /// Carries out a command, and records it if inputs are kept. A remote flight controller answers lines and messages
    /// later.
    pub fn apply(&mut self, command: &VehicleCommand) -> Answer<Reply> {
        match command {
            VehicleCommand::Rc(frame, source) => self.controller.receive_rc(frame, *source),
            VehicleCommand::SticksFirst(first) => self.controller.take_over_sticks(*first),
            VehicleCommand::BeginCli(session, mode) => self.controller.begin_cli(*session, *mode),
            VehicleCommand::EndCli(session) => self.controller.end_cli(*session),
            VehicleCommand::EndAllCli => self.controller.end_all_cli(),
            VehicleCommand::Line(line) => return self.controller.run_cli(line).map(Reply::Line),
            VehicleCommand::Message(message) => {
                return self.controller.run_msp(message).map(Reply::Message);
            }
            VehicleCommand::Upload(upload) => {
                return Answer::Now(
                    self.controller.upload(upload).map_or_else(Reply::Refused, Reply::Uploaded),
                );
            }
            VehicleCommand::CliOpened => self.controller.cli_opened(),
            VehicleCommand::CliClosed => self.controller.cli_closed(),
            VehicleCommand::Restart(configuration) => {
                self.controller.restart(|| Configuration::clone(configuration));
            }
            VehicleCommand::ReturnHome => {
                let done = self.controller.return_to_home().map_err(VehicleRefusal::ReturnHome);
                return Answer::Now(done.into());
            }
            VehicleCommand::InFlight(command) => {
                let done = self.controller.command(*command).map_err(VehicleRefusal::InFlight);
                return Answer::Now(done.into());
            }
            VehicleCommand::CancelReturn => self.controller.cancel_command(),
            VehicleCommand::Sticks(frame) => {
                *self.transmitter.sticks_mut() = *frame;
                self.note_input(|| command.clone());
            }
            VehicleCommand::CutRc(cut) => {
                self.transmitter.set_cut(*cut);
                self.note_input(|| command.clone());
            }
            VehicleCommand::HoldChannel(input) => {
                self.transmitter.inputs_mut().push(*input);
                self.note_input(|| command.clone());
            }
            VehicleCommand::ReleaseChannel(channel) => {
                self.transmitter.inputs_mut().retain(|input| input.channel != *channel);
                self.note_input(|| command.clone());
            }
            VehicleCommand::StartPilot(takeoff_m) => {
                let done = self.start_pilot(*takeoff_m).map_err(VehicleRefusal::Pilot);
                return Answer::Now(done.into());
            }
            VehicleCommand::StopPilot => {
                if self.transmitter.stop_pilot() {
                    self.note_input(|| VehicleCommand::StopPilot);
                }
            }
            VehicleCommand::World(command) => {
                let done = self.change_world(WorldCommand::clone(command)).map_err(VehicleRefusal::World);
                return Answer::Now(done.into());
            }
            VehicleCommand::ResetCraft => self.reset_craft(),
        }
        Answer::Now(Reply::Done)
    }
}
