//! The active modes and the arming disable flags.

use strum::IntoEnumIterator as _;

use super::reader::Reader;
use crate::telemetry::{ArmingFlag, ArmingFlags, Mode, ModeBox, ModeFlags};

/// The number of boxes in the fixed part of a status.
const FIXED_BOXES: u32 = 32;
/// The maximum number of boxes whose state is kept.
const MOST_BOXES: u32 = 128;
/// The low bits of the byte that gives the number of further bytes with mode bits.
const COUNT_BITS: u8 = 0x0f;

/// `STATUS_EX`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Status {
    /// Period of the control loop, µs.
    pub cycle_time_us: u16,
    /// Processor load, percent.
    pub load_percent: u16,
    /// Bit i is the state of the i-th box of `BOX_IDS`.
    mode_bits: u128,
    pub arming_blocked_by: Option<ArmingFlags>,
    /// `true` if a changed setting takes effect only after a restart.
    pub reboot_required: Option<bool>,
}

impl Status {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let cycle_time_us = reader.u16()?;
        reader.bytes(4)?; // I2C errors, sensors
        let mut mode_bits = u128::from(reader.u32()?);
        reader.u8()?; // PID profile
        let load_percent = reader.u16().unwrap_or_default();
        reader.bytes(2); // profiles
        let more = usize::from(reader.u8().unwrap_or_default() & COUNT_BITS);
        for (at, byte) in reader.bytes(more).unwrap_or_default().iter().enumerate() {
            let shift = FIXED_BOXES + 8 * at as u32;
            if shift < MOST_BOXES {
                mode_bits |= u128::from(*byte) << shift;
            }
        }
        let arming_blocked_by = match (reader.u8(), reader.u32()) {
            (Some(count), Some(bits)) => Some(arming_flags(count, bits)),
            _ => None,
        };
        let reboot_required = reader.u8().map(|flags| flags & 1 != 0);
        Some(Self { cycle_time_us, load_percent, mode_bits, arming_blocked_by, reboot_required })
    }

    /// Returns `true` if a box is on. Modes are on while they are active, other boxes while they are switched
    /// on. `box_ids` gives the order of the bits. Returns `None` if the flight controller has no such box.
    pub fn is_on(&self, wanted: ModeBox, box_ids: &[u8]) -> Option<bool> {
        let at = box_ids.iter().position(|id| *id == wanted as u8)?;
        Some(at < MOST_BOXES as usize && self.mode_bits >> at & 1 == 1)
    }

    /// Returns `true` if the craft is armed; `None` if the flight controller has no ARM box.
    pub fn is_armed(&self, box_ids: &[u8]) -> Option<bool> {
        self.is_on(ModeBox::Arm, box_ids)
    }

    pub fn modes(&self, box_ids: &[u8]) -> ModeFlags {
        let mut modes = ModeFlags::NONE;
        for mode in Mode::iter() {
            modes.set(mode, self.is_on(mode.into(), box_ids) == Some(true));
        }
        modes
    }
}

/// Decodes the flags. The highest flag of a flight controller is that of the ARM switch, regardless of how
/// many there are below it.
fn arming_flags(count: u8, bits: u32) -> ArmingFlags {
    let is_set = |bit: u32| bit < u32::BITS && bits >> bit & 1 == 1;
    let last = u32::from(count.saturating_sub(1));
    let below = ArmingFlag::iter().filter(|flag| (*flag as u32) < last && is_set(*flag as u32));
    below.chain(is_set(last).then_some(ArmingFlag::ArmSwitch)).collect()
}
