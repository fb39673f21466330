//! The conditions that switch modes on.

use super::wire::{Reader, Writer};

/// The pulse at step 0 of a range, µs.
const RANGE_START_US: u16 = 900;
/// The pulse difference per step of a range, µs.
const RANGE_STEP_US: u16 = 25;
/// The highest step of a range.
const RANGE_STEPS: u8 = 48;

/// One condition of `MODE_RANGES`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ModeSlot {
    pub box_id: u8,
    /// The channel, counted from AUX1 = 0.
    pub aux_channel: u8,
    pub start_us: u16,
    pub end_us: u16,
}

impl ModeSlot {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let (box_id, aux_channel) = (reader.u8()?, reader.u8()?);
        Some(Self { box_id, aux_channel, start_us: range_us(reader.u8()?), end_us: range_us(reader.u8()?) })
    }

    /// Decodes the conditions of a message.
    pub fn decode_all(payload: &[u8]) -> impl Iterator<Item = Self> {
        let mut reader = Reader::new(payload);
        std::iter::from_fn(move || Self::read(&mut reader))
    }

    pub fn encode(&self, writer: &mut Writer) {
        writer.u8(self.box_id);
        writer.u8(self.aux_channel);
        writer.u8(range_step(self.start_us));
        writer.u8(range_step(self.end_us));
    }
}

/// One condition of `MODE_RANGES_EXTRA`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ModeLink {
    pub box_id: u8,
    /// The combination with the other conditions of the mode.
    pub logic: u8,
    /// The box of the mode that it is linked to; 0 = none.
    pub linked: u8,
}

impl ModeLink {
    /// Decodes the conditions of a message.
    pub fn decode_all(payload: &[u8]) -> impl Iterator<Item = Self> {
        let mut reader = Reader::new(payload.get(1..).unwrap_or_default());
        std::iter::from_fn(move || {
            Some(Self { box_id: reader.u8()?, logic: reader.u8()?, linked: reader.u8()? })
        })
    }

    /// Encodes the conditions after their number.
    pub fn encode_all(links: impl ExactSizeIterator<Item = Self>, writer: &mut Writer) {
        writer.u8(links.len() as i64);
        for Self { box_id, logic, linked } in links {
            writer.bytes(&[box_id, logic, linked]);
        }
    }
}

/// Returns the pulse at a step of a range, µs.
pub fn range_us(step: u8) -> u16 {
    RANGE_START_US + RANGE_STEP_US * u16::from(step.min(RANGE_STEPS))
}

/// Returns the step of a pulse.
pub fn range_step(pulse_us: u16) -> u16 {
    pulse_us.saturating_sub(RANGE_START_US) / RANGE_STEP_US
}
