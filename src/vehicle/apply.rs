//! Carries out commands, and records those that the flight depends on.

use super::{Answer, Reply, Vehicle, VehicleCommand, VehicleRefusal};
use crate::pilot::Pilot;
use crate::signals::RcFrame;
use crate::telemetry::VehicleNotice;

impl Vehicle {
    /// Carries out a command, and records it if inputs are kept. A remote flight controller answers lines and messages
    /// later.
    pub fn apply(&mut self, command: &VehicleCommand) -> Answer<Reply> {
        let answer = match self.apply_here(command) {
            Some(reply) => Answer::Now(reply),
            None => self.controller.apply(command),
        };
        if let (Answer::Now(reply), Some(log)) = (&answer, self.controller.input_log_mut()) {
            log.note(command, reply);
        }
        answer
    }

    /// Carries out a command to the transmitter, the world or the whole craft; `None` for the other commands.
    fn apply_here(&mut self, command: &VehicleCommand) -> Option<Reply> {
        match command {
            VehicleCommand::Sticks(frame) => *self.transmitter.sticks_mut() = *frame,
            VehicleCommand::CutRc(cut) => self.transmitter.set_cut(*cut),
            VehicleCommand::HoldChannel(input) => self.transmitter.inputs_mut().push(*input),
            VehicleCommand::ReleaseChannel(channel) => {
                self.transmitter.inputs_mut().retain(|input| input.channel != *channel);
            }
            VehicleCommand::StartPilot(takeoff_m) => {
                let pilot = Pilot::new(*takeoff_m, &self.controller.mode_ranges());
                let started = pilot.map(|pilot| self.transmitter.start_pilot(pilot));
                return Some(started.map_err(VehicleRefusal::Pilot).into());
            }
            VehicleCommand::StopPilot => {
                return Some(Reply::done(self.transmitter.stop_pilot()));
            }
            VehicleCommand::World(change) => {
                let changed = self.physics.apply(change.as_ref().clone());
                return Some(changed.map_err(VehicleRefusal::World).into());
            }
            VehicleCommand::ResetCraft => self.reset_craft(),
            _ => return None,
        }
        Some(Reply::Done)
    }

    /// Puts the craft back home, undamaged and disarmed. Plan, settings, air and faults stay. Faults and inputs that
    /// count from the engagement wait for the next one. A craft that an external simulator moves is only disarmed,
    /// and starts where it is seen next.
    fn reset_craft(&mut self) {
        self.engaged_at = None;
        self.transmitter.stop_pilot();
        *self.transmitter.sticks_mut() = RcFrame::SAFE;
        self.controller.restart_in_place();
        self.physics.reset();
        if self.truth().is_some() {
            self.notice(VehicleNotice::BackHome);
        }
    }

    /// Records the inputs from now on for [`Self::take_inputs`], or ends that. Only an embedded flight controller in
    /// the simulated world can be flown again, so other vehicles record none. Returns `true` if inputs are recorded.
    pub fn keep_inputs(&mut self, wanted: bool) -> bool {
        let wanted = wanted && self.truth().is_some();
        self.controller.input_log_mut().is_some_and(|log| {
            log.set_wanted(wanted);
            wanted
        })
    }

    /// Returns `true` if there were inputs since the last call of [`Self::take_inputs`].
    pub fn has_inputs(&self) -> bool {
        self.controller.input_log().is_some_and(|log| !log.is_empty())
    }

    /// Returns the approximate memory of the inputs since the last call of [`Self::take_inputs`], bytes.
    pub fn input_bytes(&self) -> usize {
        self.controller.input_log().map_or(0, |log| log.bytes)
    }

    /// Moves the inputs since the last call into `sink`, oldest first. Applying them again before the same tick gives
    /// the same vehicle.
    pub fn take_inputs(&mut self, sink: impl FnMut(VehicleCommand)) {
        if let Some(log) = self.controller.input_log_mut() {
            log.drain().for_each(sink);
        }
    }
}
