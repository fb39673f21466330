//! Carries out the commands of the user interface.

use std::task::Context;
use std::time::Duration;

use super::Session;
use super::interface::UploadTo;
use super::limits::refuse_command;
use crate::fc::Access;
use crate::flight::forecast::SETTINGS_UNKNOWN;
use crate::lookahead::VehicleCopy;
use crate::session::command::Command;
use crate::session::flight_feed::FlightPart;
use crate::session::policy::{self, Facts, Intent, RemoteFacts};
use crate::session::simulator::Simulator;
use crate::timeline::Timeline;
use crate::vehicle::{Answer, Reply, VehicleCommand};

impl Session {
    pub(super) fn take_commands(&mut self, now: Duration, context: &mut Context<'_>) {
        while let Some(command) = self.commands.take(context) {
            self.changed = true;
            let seeks = matches!(command, Command::Seek(_));
            self.carry_out(command, now);
            if seeks {
                // Its view is shown before the next seek.
                return;
            }
        }
        while let Some(command) = self.orders.take(context) {
            self.changed = true;
            self.carry_out(command, now);
        }
        self.quit |= self.commands.has_ended();
    }

    fn carry_out(&mut self, command: Command, now: Duration) {
        if let Err(refusal) = policy::check(&self.facts(), Intent::of(&command)) {
            return self.notices(refuse_command(command, refusal));
        }
        match command {
            Command::Pause(paused) => {
                self.run_on = None;
                self.runner.pacer.set_paused(paused, now);
            }
            Command::Step(ticks) => self.step(ticks, now),
            Command::Seek(seek) => self.seek(seek, now),
            Command::FlyOn => self.fly_on(now),
            Command::Speed(speed) => self.runner.pacer.set_speed(speed, now),
            Command::Vehicle(command) => self.command_vehicle(&command),
            Command::StartPilot => self.apply(&VehicleCommand::StartPilot(self.takeoff_m)),
            Command::Cli { line, reply } if self.is_rewound() => reply.send(self.read_shown(&line)),
            Command::Cli { line, reply } => {
                let handler = self.endpoints.as_mut().map(|endpoints| &mut endpoints.handler);
                let (vehicle, persistence) = (&mut self.vehicle, &mut self.persistence);
                let outcome = self.interface.run_line(line, reply, vehicle, persistence, handler);
                self.report(outcome);
            }
            Command::Upload { name, plan, settings, reply } => {
                if let Some(feed) = &self.feed {
                    feed.sender().send(FlightPart::Plan(name, plan.clone()));
                }
                let is_simulated = !self.access().is_limited();
                let craft = &mut UploadTo { vehicle: &mut self.vehicle, takeoff_m: self.takeoff_m };
                let outcome = self.interface.upload(&plan, settings, is_simulated, reply, craft);
                self.report(outcome);
            }
            Command::Download { reply } => self.interface.download(reply, &mut self.vehicle),
            Command::ReadSettings { reply } if self.is_rewound() => reply.send(self.settings_of_shown()),
            Command::ReadSettings { reply } => {
                self.interface.read_settings(reply, &mut self.vehicle, &self.persistence);
            }
            Command::Save { reply } => {
                let is_real = self.access().is_limited();
                self.interface.save(is_real, reply, &mut self.vehicle, &mut self.persistence);
            }
            Command::PermitChanges(connection) => {
                if let Some(remote) = &mut self.runner.link {
                    remote.protocol_mut().permit_changes(connection);
                }
                // Permission for an earlier connection has no effect.
                if self.access() != Access::Reading {
                    self.notice("Changes are permitted until the connection ends.");
                }
            }
            Command::World { change, reply } => {
                let changed = self.vehicle.apply(&VehicleCommand::World(change)).accepted();
                reply.send(changed.map_err(|refusal| refusal.to_string()));
            }
            Command::CopyVehicle { continues, reply } => {
                let copy = if continues { self.copy_for_forecast() } else { self.copy_for_estimate() };
                reply.send(copy);
            }
            Command::RecordedFlight(reply) => reply.send(self.recorded_flight()),
            Command::CopyRecording(reply) => self.copy_recording(reply),
            // The policy refuses another flight.
            Command::ShowFlight(_) => {}
            Command::Curves { reply, .. } => reply.send(Err(policy::NO_FILE.to_owned())),
            Command::Quit => self.quit = true,
        }
    }

    /// Returns a copy of the vehicle for flights from home. A remote firmware is replaced by the embedded one with its
    /// settings.
    ///
    /// # Errors
    /// Returns the reason as a sentence if there is none.
    fn copy_for_estimate(&mut self) -> Result<VehicleCopy, String> {
        if self.vehicle.embedded().is_some() {
            return self.copy_for_forecast();
        }
        let twin = self.vehicle.twin().map_err(|error| error.to_string())?;
        let twin = Box::new(twin.ok_or(SETTINGS_UNKNOWN)?);
        let profile = twin.controller().settings_view().unwrap_or_default().profile;
        if self.reported_twin.replace(profile) != Some(profile) {
            self.notice(format!(
                "Estimates and checks of the plan fly the embedded firmware in the profile {profile}, with the settings of \
                 the craft's autopilot and with starter modes."
            ));
        }
        Ok(VehicleCopy { vehicle: twin, takeoff_m: self.takeoff_m, again: None })
    }

    /// Returns the facts on which the policy depends.
    fn facts(&self) -> Facts {
        let is_pictures = self.timeline.as_ref().is_some_and(Timeline::is_pictures);
        Facts {
            access: self.access(),
            remote: self.runner.link.as_ref().map(|link| RemoteFacts::from(&link.protocol().view())),
            simulator: self.simulator.as_ref().map(Simulator::state),
            upload: self.interface.upload_under_way(),
            is_piloted: self.vehicle.transmitter().pilot().is_some(),
            is_recorded: self.timeline.is_some(),
            cannot_continue: is_pictures && !self.can_fly_again(),
            has_ended: is_pictures && self.runner.link.is_none(),
            is_rewound: self.is_rewound(),
            is_replay: false,
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
        self.notice(refusal.sentence());
    }

    fn reset_craft(&mut self) {
        self.vehicle.apply(&VehicleCommand::ResetCraft);
        if self.simulator.is_some() {
            self.notice("The firmware restarted, disarmed; the simulator places the craft.");
        }
        if let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.after_restart(false, &mut self.vehicle);
        }
    }
}
