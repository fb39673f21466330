//! The record of the commands to a vehicle since its last tick. With them a flight can be flown again to the last bit.
//!
//! Frames of the virtual sticks and losses by faults are not recorded, since they follow from the transmitter and the
//! world. Reports about the rest of the program (storage, links) are not recorded either, since they do not affect the
//! flight.

use super::{Reply, VehicleCommand, VehicleRefusal};
use crate::firmware::msp::{MESSAGES, MspAction};
use crate::msp::Access;
use crate::signals::RcSource;

/// The inputs since the last tick, if they are recorded.
#[derive(Debug, Clone, Default)]
pub(super) struct InputLog {
    inputs: Option<Vec<VehicleCommand>>,
    /// The approximate memory of the inputs, bytes.
    pub(super) bytes: usize,
}

impl InputLog {
    pub(super) fn set_wanted(&mut self, wanted: bool) {
        *self = Self { inputs: wanted.then(Vec::new), bytes: 0 };
    }

    pub(super) fn is_empty(&self) -> bool {
        self.inputs.as_ref().is_none_or(Vec::is_empty)
    }

    /// Records a command with this reply, if it is an input.
    pub(super) fn note(&mut self, command: &VehicleCommand, reply: &Reply) {
        let Some(inputs) = &mut self.inputs else { return };
        let Some(input) = input(command, reply) else { return };
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

/// Returns the input that a command with this reply was, if it was one. Lines that only ask are inputs, since each makes
/// the parameters follow the settings again. A refused return home is one, since the refusal is an event, and a refused
/// upload, since the lines before the refused one keep their effect.
fn input(command: &VehicleCommand, reply: &Reply) -> Option<VehicleCommand> {
    match (command, reply) {
        (_, Reply::Unchanged | Reply::Refused(VehicleRefusal::World(_) | VehicleRefusal::Pilot(_)))
        // The frames of the virtual sticks follow from the transmitter.
        | (VehicleCommand::Rc(_, RcSource::Sticks), _) => None,
        (VehicleCommand::Message(message), Reply::Message(outcome)) => match outcome.action {
            Some(MspAction::RawRc(frame)) => Some(VehicleCommand::Rc(frame, RcSource::Msp)),
            _ => writes(message.code).then(|| command.clone()),
        },
        _ => Some(command.clone()),
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
