//! Carries out the commands of the user interface.
#![allow(clippy::disallowed_methods, reason = "a late answer is awaited in wall time")]

use std::task::{Context, Poll};
use std::time::{Duration, Instant};

use super::Session;
use super::late::WaitingInterface;
use crate::fc::replace_falling_gains;
use crate::fc::{LIST, Upload, plan_above_home};
use crate::firmware::cli::Interpreter;
use crate::flight::forecast;
use crate::msp::code;
use crate::plan::AltitudeReference;
use crate::session::ReplyTo;
use crate::session::command::{
    Command, PLACE_IS_EXTERNAL, Seek, TIME_IS_EXTERNAL, TIME_IS_THE_FIRMWARES, UPLOADING, VehicleCopy,
};
use crate::sim::WorldCommand;
use crate::telemetry::LinkState;
use crate::vehicle::{Answer, Reply, VehicleCommand, VehicleRefusal};

impl Session {
    pub(super) fn take_commands(&mut self, now: Duration, context: &mut Context<'_>) {
        while let Some(mut command) = self.next_command(context) {
            // A held key repeats faster than an instant is found. Consecutive seeks in one direction are
            // combined.
            while let Command::Seek(Seek::Seconds(way)) = &mut command {
                match self.next_command(context) {
                    Some(Command::Seek(Seek::Seconds(more))) if more.signum() == way.signum() => *way += more,
                    other => {
                        self.held_back = other;
                        break;
                    }
                }
            }
            self.changed = true;
            let seeks = matches!(command, Command::Seek(_));
            self.carry_out(command, now);
            if seeks {
                // Its view is shown before the next seek.
                return;
            }
        }
    }

    fn next_command(&mut self, context: &mut Context<'_>) -> Option<Command> {
        if let Some(command) = self.held_back.take() {
            return Some(command);
        }
        match self.commands.poll_recv(context) {
            Poll::Ready(Some(command)) => Some(command),
            Poll::Ready(None) => {
                self.quit = true;
                None
            }
            Poll::Pending => None,
        }
    }

    /// Returns `true` if a command is waiting.
    pub(super) fn has_commands(&self) -> bool {
        self.held_back.is_some() || !self.commands.is_empty()
    }

    fn carry_out(&mut self, command: Command, now: Duration) {
        let Some(command) = self.refuse_while_rewound(command) else { return };
        let Some(command) = self.refuse_to_real_craft(command) else { return };
        match command {
            Command::Pause(_) | Command::Step(_) | Command::Speed(_) | Command::Seek(_) | Command::FlyOn
                if self.simulator.is_some() =>
            {
                self.notice(TIME_IS_EXTERNAL);
            }
            Command::Pause(_) | Command::Step(_) | Command::Speed(_) if self.remote.is_some() => {
                self.notice(TIME_IS_THE_FIRMWARES);
            }
            Command::Pause(paused) => {
                self.run_on = None;
                self.pacer.set_paused(paused, now);
            }
            Command::Step(ticks) => self.step(ticks, now),
            Command::Seek(seek) => self.seek(seek, now),
            Command::FlyOn => self.fly_on(now),
            Command::Speed(speed) => self.pacer.set_speed(speed, now),
            Command::Vehicle(command) => self.command_vehicle(&command),
            Command::StartPilot => self.apply(&VehicleCommand::StartPilot(self.takeoff_m)),
            Command::Cli { line, reply } => self.run_cli(line, reply),
            // The lines of two uploads would mix.
            Command::Upload { reply, .. } if self.upload_under_way().is_some() => {
                reply.send(Err(UPLOADING.to_owned()));
            }
            Command::Upload { plan, mut settings, reply } => {
                let reference = self.vehicle.controller().altitude_reference();
                // The gains were found for the simulated craft. A real one never gets gains that the user did
                // not request.
                let is_simulated = !self.access().is_limited();
                let landing_gains = match reference {
                    AltitudeReference::SeaLevel { .. } if is_simulated => {
                        replace_falling_gains(&mut settings)
                    }
                    _ => Vec::new(),
                };
                match Upload::new(&plan, &settings, reference) {
                    Ok(mut upload) => {
                        upload.report_landing_gains(landing_gains);
                        let progress = upload.send_lines(self.vehicle.controller_mut());
                        self.report_upload(Box::new(upload), progress, reply, Instant::now());
                    }
                    Err(unknown) => reply.send(Err(unknown.to_string())),
                }
            }
            Command::Download { reply } => {
                let controller = self.vehicle.controller_mut();
                let reference = controller.altitude_reference();
                match controller.run_cli(&mut Interpreter::default(), LIST) {
                    Answer::Now(answer) => {
                        reply.send(plan_above_home(&answer, reference).map(Box::new));
                    }
                    Answer::Later(ticket) => {
                        let waiting = WaitingInterface::Download { reply };
                        self.late_answers.expect(ticket, waiting, Instant::now());
                    }
                }
            }
            Command::Save { reply } => self.save(reply),
            Command::PermitChanges(connection) => {
                if let Some(remote) = &mut self.remote {
                    remote.remote_mut().permit_changes(connection);
                }
            }
            Command::World { line, reply } => {
                let changed = self.change_world(&line);
                reply.send(changed);
            }
            Command::CopyVehicle(reply) => {
                let copy = forecast::check_possible(&self.vehicle).map(|()| VehicleCopy {
                    vehicle: Box::new(self.copy_of_shown()),
                    takeoff_m: self.takeoff_m,
                });
                reply.send(copy);
            }
            Command::RecordedFlight(reply) => reply.send(self.recorded_flight()),
            Command::Quit => self.quit = true,
        }
    }

    fn command_vehicle(&mut self, command: &VehicleCommand) {
        match command {
            VehicleCommand::ResetCraft => return self.reset_craft(),
            VehicleCommand::Sticks(_) if self.vehicle.transmitter().pilot().is_some() => {
                self.apply(&VehicleCommand::StopPilot);
                self.notice("The sticks were moved: the scripted pilot let go.");
            }
            // Taking the sticks back overrides a script that still sends.
            VehicleCommand::CutRc(cut) => self.apply(&VehicleCommand::SticksFirst(!cut)),
            _ => {}
        }
        self.apply(command);
    }

    /// Applies a command to the vehicle. A refusal is a notice.
    fn apply(&mut self, command: &VehicleCommand) {
        let Answer::Now(Reply::Refused(refusal)) = self.vehicle.apply(command) else { return };
        self.notice(match refusal {
            VehicleRefusal::ReturnHome(refusal) => format!("No return home: {}", refusal.sentence()),
            VehicleRefusal::Pilot(mode) => {
                format!("The scripted pilot needs a switch for {mode}: assign one with the CLI command aux.")
            }
            VehicleRefusal::World(_) | VehicleRefusal::InFlight(_) => refusal.to_string(),
        });
    }

    fn reset_craft(&mut self) {
        match &self.simulator {
            Some(simulator) if simulator.state() == LinkState::Flowing => {
                self.notice(PLACE_IS_EXTERNAL);
                return;
            }
            Some(_) => {
                self.vehicle.reset_craft();
                self.notice("The firmware restarted, disarmed; the simulator places the craft.");
            }
            None => self.vehicle.reset_craft(),
        }
        if let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.after_restart(false, self.vehicle.controller_mut());
        }
    }

    /// Saves as a ground station does over MSP, without a restart. A remote flight controller stores
    /// its configuration itself.
    fn save(&mut self, reply: ReplyTo<Result<(), String>>) {
        let is_real = self.access().is_limited();
        let controller = self.vehicle.controller_mut();
        if controller.is_armed() {
            let way = if is_real { "its transmitter disarms it" } else { "`a` disarms it" };
            reply.send(Err(format!("Not saved while the craft is armed: {way} on the ground.")));
        } else if controller.configuration().is_some() {
            reply.send(self.persistence.save(controller));
        } else if let Answer::Later(ticket) = controller.run_msp(code::EEPROM_WRITE, &[], None) {
            self.late_answers.expect(ticket, WaitingInterface::Save { reply }, Instant::now());
        }
    }

    fn change_world(&mut self, line: &str) -> Result<(), String> {
        let command = WorldCommand::parse(line).map_err(|error| error.to_string())?;
        self.vehicle.change_world(command).map_err(|error| error.to_string())
    }
}
