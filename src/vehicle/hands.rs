//! The hands on the sticks: fifty RC frames a simulated second from the virtual sticks or the scripted pilot.

use crate::pilot::{Pilot, PilotFacts};
use crate::signals::{RC_CHANNELS, RcFrame, SimTime};

/// Interval of RC frames, µs.
pub(super) const FRAME_US: u64 = 20_000;

/// A channel forced to a value for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickInput {
    /// Channel index, 0…15.
    pub channel: u8,
    /// Value, µs.
    pub value_us: u16,
    /// When it begins, counted from `from_boot` or from the engagement.
    pub at_s: f64,
    /// How long it lasts, s; `None` = to the end.
    pub for_s: Option<f64>,
    /// `at_s` counts from boot instead of from the engagement.
    pub from_boot: bool,
}

impl StickInput {
    fn is_active(&self, now: SimTime, engaged_at: Option<SimTime>) -> bool {
        let origin = if self.from_boot { Some(SimTime::ZERO) } else { engaged_at };
        origin.is_some_and(|origin| {
            let t = now.as_secs_f64() - origin.as_secs_f64();
            t >= self.at_s && self.for_s.is_none_or(|length| t < self.at_s + length)
        })
    }
}

/// Who moves the sticks, and what is done to them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hands {
    /// The virtual sticks; also what the pilot sent last.
    pub sticks: RcFrame,
    /// The link is cut: no frames are sent.
    pub cut: bool,
    /// The scripted pilot, while it flies.
    pub pilot: Option<Pilot>,
    /// Forced channels.
    pub inputs: Vec<StickInput>,
}

impl Hands {
    /// The frame to send now, `None` while the link is cut. To be called every [`FRAME_US`].
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
        (!self.cut).then_some(frame)
    }
}
