//! The inputs of a vehicle between two ticks, as data. With its inputs a flight can be flown again to the last bit.
//!
//! Frames of the virtual sticks and losses by faults are not inputs, since they follow from the transmitter and the
//! world. Reports of commands about the rest of the program (storage, links) are not inputs either, since they do not
//! affect the flight.

use super::Vehicle;
use crate::firmware::cli::Interpreter;
use crate::firmware::config::Configuration;
use crate::firmware::msp::UtcTime;
use crate::pilot::RcTransmitter;
use crate::signals::{RcFrame, RcSource};
use crate::sim::WorldCommand;
use crate::telemetry::InFlightCommand;

/// An input between two ticks.
#[derive(Debug, Clone)]
pub enum Input {
    /// An RC frame from a link.
    Rc(RcFrame, RcSource),
    /// `true` gives the virtual sticks precedence over the other sources of RC, `false` ends that.
    SticksFirst(bool),
    /// A CLI line, with the session that ran it in its state before.
    Line(Box<(Interpreter, String)>),
    /// An MSP message that changes something.
    Message(Box<Message>),
    /// A person opened a command line.
    CliOpened,
    /// A command line that turned motors was left.
    CliClosed,
    /// A restart on this configuration.
    Restart(Box<Configuration>),
    /// The command to fly home and land.
    ReturnHome,
    /// A command to the navigator that flies the stored plan.
    InFlight(InFlightCommand),
    /// The cancellation of the command to fly home.
    CancelReturn,
    /// The transmitter after a change: sticks, link, pilot.
    Transmitter(Box<RcTransmitter>),
    /// A change of air, noise or faults.
    World(Box<WorldCommand>),
    /// The craft was put back home.
    ResetCraft,
}

/// An MSP message with the data for its answer.
#[derive(Debug, Clone)]
pub struct Message {
    pub(super) code: u16,
    pub(super) payload: Vec<u8>,
    pub(super) clock: Option<UtcTime>,
}

impl Input {
    /// Returns the approximate memory of the input, bytes.
    pub fn bytes(&self) -> usize {
        let heap = match self {
            Self::Line(line) => size_of_val(&**line) + line.1.len(),
            Self::Message(message) => size_of::<Message>() + message.payload.len(),
            // Its tables are on the heap.
            Self::Restart(configuration) => 4 * size_of_val(&**configuration),
            Self::Transmitter(transmitter) => size_of_val(&**transmitter),
            Self::World(command) => size_of_val(&**command),
            Self::Rc(..)
            | Self::SticksFirst(_)
            | Self::CliOpened
            | Self::CliClosed
            | Self::ReturnHome
            | Self::InFlight(_)
            | Self::CancelReturn
            | Self::ResetCraft => 0,
        };
        size_of::<Self>() + heap
    }
}

/// The inputs since the last tick, if they are recorded.
#[derive(Debug, Clone, Default)]
pub(super) struct InputLog {
    inputs: Option<Vec<Input>>,
    bytes: usize,
}

impl InputLog {
    pub(super) fn set_wanted(&mut self, wanted: bool) {
        *self = Self { inputs: wanted.then(Vec::new), bytes: 0 };
    }

    pub(super) fn is_wanted(&self) -> bool {
        self.inputs.is_some()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.inputs.as_ref().is_none_or(Vec::is_empty)
    }

    /// Records an input that has been carried out.
    pub(super) fn note(&mut self, input: impl FnOnce() -> Input) {
        let Some(inputs) = &mut self.inputs else { return };
        let input = input();
        // Only the newest frame of a source counts. A script continues to send while time is stopped.
        if let Input::Rc(frame, source) = input
            && let Some(Input::Rc(earlier, _)) =
                inputs.iter_mut().find(|earlier| matches!(earlier, Input::Rc(_, of) if *of == source))
        {
            *earlier = frame;
        } else {
            self.bytes += input.bytes();
            inputs.push(input);
        }
    }

    pub(super) fn drain(&mut self) -> impl Iterator<Item = Input> {
        self.bytes = 0;
        self.inputs.iter_mut().flat_map(|inputs| inputs.drain(..))
    }
}

impl Vehicle {
    /// Records the inputs from now on for [`Self::take_inputs`], or ends that. Only an embedded flight controller in
    /// the simulated world can be flown again, so other vehicles record none. Returns `true` if inputs are recorded.
    pub fn keep_inputs(&mut self, wanted: bool) -> bool {
        let wanted = wanted && self.truth().is_some();
        self.transmitter_set = false;
        self.controller.input_log_mut().is_some_and(|log| {
            log.set_wanted(wanted);
            wanted
        })
    }

    /// Returns `true` if there were inputs since the last call of [`Self::take_inputs`].
    pub fn has_inputs(&self) -> bool {
        self.transmitter_set || self.controller.input_log().is_some_and(|log| !log.is_empty())
    }

    /// Returns the approximate memory of the inputs since the last call of [`Self::take_inputs`], bytes.
    pub fn input_bytes(&self) -> usize {
        self.controller.input_log().map_or(0, |log| log.bytes)
    }

    /// Moves the inputs since the last call into `sink`, oldest first. Applying them again before the same tick gives
    /// the same vehicle.
    pub fn take_inputs(&mut self, mut sink: impl FnMut(Input)) {
        let set = std::mem::take(&mut self.transmitter_set);
        let Some(log) = self.controller.input_log_mut().filter(|log| log.is_wanted()) else { return };
        log.drain().for_each(&mut sink);
        if set {
            sink(Input::Transmitter(Box::new(self.transmitter.clone())));
        }
    }

    /// Carries out an input of an earlier flight.
    pub fn apply(&mut self, input: &Input) {
        // The answers were reported when the inputs came.
        match input {
            Input::Rc(frame, source) => self.controller.receive_rc(frame, *source),
            Input::SticksFirst(first) => self.controller.take_over_sticks(*first),
            Input::Line(line) => {
                let (session, line) = &**line;
                let _reported = self.controller.run_cli(&mut session.clone(), line);
            }
            Input::Message(message) => {
                let _reported = self.controller.run_msp(message.code, &message.payload, message.clock);
            }
            Input::CliOpened => self.controller.cli_opened(),
            Input::CliClosed => self.controller.cli_closed(),
            Input::Restart(configuration) => self.controller.restart(|| Configuration::clone(configuration)),
            Input::ReturnHome => {
                let _reported = self.controller.return_to_home();
            }
            Input::InFlight(command) => {
                let _reported = self.controller.command(*command);
            }
            Input::CancelReturn => self.controller.cancel_command(),
            Input::Transmitter(transmitter) => self.transmitter.clone_from(transmitter),
            Input::World(command) => {
                let _reported = self.change_world(WorldCommand::clone(command));
            }
            Input::ResetCraft => self.reset_craft(),
        }
    }
}
