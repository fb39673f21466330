//! The record of the commands to a vehicle since its last tick. With them a flight can be flown again to the last bit.
//!
//! Frames of the virtual sticks and losses by faults are not recorded, since they follow from the transmitter and the
//! world. Reports of commands about the rest of the program (storage, links) are not recorded either, since they do not
//! affect the flight.

use super::{Vehicle, VehicleCommand};

/// The inputs since the last tick, if they are recorded.
#[derive(Debug, Clone, Default)]
pub(super) struct InputLog {
    inputs: Option<Vec<VehicleCommand>>,
    bytes: usize,
}

impl InputLog {
    pub(super) fn set_wanted(&mut self, wanted: bool) {
        *self = Self { inputs: wanted.then(Vec::new), bytes: 0 };
    }

    pub(super) fn is_empty(&self) -> bool {
        self.inputs.as_ref().is_none_or(Vec::is_empty)
    }

    /// Records an input that has been carried out.
    pub(super) fn note(&mut self, input: impl FnOnce() -> VehicleCommand) {
        let Some(inputs) = &mut self.inputs else { return };
        let input = input();
        // Only the newest frame of a source counts. A script continues to send while time is stopped.
        if let VehicleCommand::Rc(frame, source) = input
            && let Some(VehicleCommand::Rc(earlier, _)) = inputs
                .iter_mut()
                .find(|earlier| matches!(earlier, VehicleCommand::Rc(_, of) if *of == source))
        {
            *earlier = frame;
        } else if let (VehicleCommand::Sticks(frame), Some(VehicleCommand::Sticks(earlier))) =
            (&input, inputs.last_mut())
        {
            *earlier = *frame;
        } else {
            self.bytes += input.bytes();
            inputs.push(input);
        }
    }

    pub(super) fn drain(&mut self) -> impl Iterator<Item = VehicleCommand> {
        self.bytes = 0;
        self.inputs.iter_mut().flat_map(|inputs| inputs.drain(..))
    }
}

impl Vehicle {
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
