//! The RC transmitter: fifty frames per simulated second from the virtual sticks or the scripted pilot.

use super::{Pilot, PilotFacts, StickInput};
use crate::signals::{RC_CHANNELS, RcFrame, SimTime};

/// The interval of RC frames, µs.
pub const FRAME_US: u64 = 20_000;

/// The transmitter, with the source of its sticks and the state of its link.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RcTransmitter {
    /// The virtual sticks. They also keep the last frame of the pilot.
    sticks: RcFrame,
    /// `true` if the link is cut and no frames are sent.
    cut: bool,
    /// Scripted pilot while it flies.
    pilot: Option<Pilot>,
    inputs: Vec<StickInput>,
    /// The newest frame, sent or not.
    newest: RcFrame,
}

impl RcTransmitter {
    /// Returns the frame of the virtual sticks.
    pub fn sticks(&self) -> RcFrame {
        self.sticks
    }

    /// Returns the virtual sticks, to move them.
    pub fn sticks_mut(&mut self) -> &mut RcFrame {
        &mut self.sticks
    }

    /// Returns the newest frame: the sticks with the channels that are forced to values. While the link is cut it is not
    /// sent.
    pub fn newest(&self) -> RcFrame {
        self.newest
    }

    /// Returns `true` if the link is cut.
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// Cuts the link (`true`) or restores it.
    pub fn set_cut(&mut self, cut: bool) {
        self.cut = cut;
    }

    /// Returns the channels that are forced to values, to change them.
    pub fn inputs_mut(&mut self) -> &mut Vec<StickInput> {
        &mut self.inputs
    }

    /// Passes the sticks to the scripted pilot.
    pub fn start_pilot(&mut self, pilot: Pilot) {
        self.pilot = Some(pilot);
    }

    /// Stops the scripted pilot. Returns `true` if it was flying.
    pub fn stop_pilot(&mut self) -> bool {
        let pilot = self.pilot.take();
        if let Some(pilot) = &pilot {
            self.sticks = pilot.released();
        }
        pilot.is_some()
    }

    /// Returns the scripted pilot while it flies.
    pub fn pilot(&self) -> Option<&Pilot> {
        self.pilot.as_ref()
    }

    /// Returns the present action of the scripted pilot in a word or two, while it flies.
    pub fn pilot_doing(&self) -> Option<&'static str> {
        self.pilot.as_ref().map(Pilot::doing)
    }

    /// Returns the frame to send now, or `None` while the link is cut. Call it every [`FRAME_US`].
    pub fn frame(&mut self, facts: &PilotFacts, engaged_at: Option<SimTime>) -> Option<RcFrame> {
        if let Some(pilot) = &mut self.pilot {
            self.sticks = pilot.fly(facts);
            if pilot.is_done() {
                self.pilot = None;
            }
        }
        let mut frame = self.sticks;
        for input in &self.inputs {
            let channel = usize::from(input.channel);
            if channel < RC_CHANNELS && input.is_active(facts.time, engaged_at) {
                frame.channels[channel] = input.value_us;
            }
        }
        self.newest = frame;
        (!self.cut).then_some(frame)
    }
}
