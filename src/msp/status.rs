//! The active modes and the arming disable flags.

use strum::{EnumCount as _, IntoEnumIterator as _};

use super::wire::{Reader, Writer};
use crate::telemetry::{ArmingFlag, ArmingFlags, Mode, ModeBox, ModeFlags};

/// The number of boxes in the fixed part of a status.
const FIXED_BOXES: u32 = 32;
/// The maximum number of boxes whose state is kept.
const MAX_BOXES: u32 = 128;
/// The low bits of the byte that gives the number of further bytes with mode bits.
const COUNT_BITS: u8 = 0x0f;

/// `STATUS_EX`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Status {
    /// Period of the control loop, µs.
    pub cycle_time_us: u16,
    /// The sensors that are present, one bit for each.
    pub sensors: u16,
    /// The active PID profile and the number of PID profiles.
    pub profile: u8,
    pub profiles: u8,
    /// The active rate profile and the number of rate profiles.
    pub rate_profile: u8,
    pub rate_profiles: u8,
    /// The active battery profile and the number of battery profiles.
    pub battery_profile: u8,
    pub battery_profiles: u8,
    /// Processor load, percent.
    pub load_percent: u16,
    /// Bit i is the state of the i-th box of `BOXIDS`.
    pub mode_bits: u128,
    pub arming_blocked_by: Option<ArmingFlags>,
    /// `true` if a changed setting takes effect only after a restart.
    pub reboot_required: Option<bool>,
}

impl Status {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let cycle_time_us = reader.u16()?;
        reader.u16()?; // I2C errors
        let sensors = reader.u16()?;
        let mut mode_bits = u128::from(reader.u32()?);
        let profile = reader.u8()?;
        let load_percent = reader.u16().unwrap_or_default();
        let (profiles, rate_profile) = (reader.u8().unwrap_or_default(), reader.u8().unwrap_or_default());
        let more = usize::from(reader.u8().unwrap_or_default() & COUNT_BITS);
        for (at, byte) in reader.bytes(more).unwrap_or_default().iter().enumerate() {
            let shift = FIXED_BOXES + 8 * at as u32;
            if shift < MAX_BOXES {
                mode_bits |= u128::from(*byte) << shift;
            }
        }
        let arming_blocked_by = match (reader.u8(), reader.u32()) {
            (Some(count), Some(bits)) => Some(arming_flags(count, bits)),
            _ => None,
        };
        let reboot_required = reader.u8().map(|flags| flags & 1 != 0);
        reader.u16(); // temperature
        let [rate_profiles, battery_profiles, battery_profile] =
            [(); 3].map(|()| reader.u8().unwrap_or_default());
        Some(Self {
            cycle_time_us,
            sensors,
            profile,
            profiles,
            rate_profile,
            rate_profiles,
            battery_profile,
            battery_profiles,
            load_percent,
            mode_bits,
            arming_blocked_by,
            reboot_required,
        })
    }

    /// Encodes the message; `STATUS` instead of `STATUS_EX` if not `extended`.
    pub fn encode(&self, extended: bool, writer: &mut Writer) {
        writer.u16(self.cycle_time_us);
        writer.u16(0); // I2C errors
        writer.u16(self.sensors);
        writer.u32(self.mode_bits as u32);
        writer.u8(self.profile);
        writer.u16(self.load_percent);
        writer.bytes(&if extended { [self.profiles, self.rate_profile] } else { [0, 0] });
        let more = (self.mode_bits >> FIXED_BOXES).to_le_bytes();
        let used = more.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
        writer.u8(used as i64);
        writer.bytes(&more[..used]);
        writer.u8(ArmingFlag::COUNT as i64);
        writer.u32(self.arming_blocked_by.unwrap_or(ArmingFlags::NONE).bits());
        writer.u8(u8::from(self.reboot_required == Some(true)));
        writer.u16(0); // temperature unknown
        writer.bytes(&[self.rate_profiles, self.battery_profiles, self.battery_profile]);
    }

    /// Returns `true` if a box is on. Modes are on while they are active, other boxes while they are switched
    /// on. `box_ids` gives the order of the bits. Returns `None` if the flight controller has no such box.
    pub fn is_on(&self, wanted: ModeBox, box_ids: &[u8]) -> Option<bool> {
        let at = box_ids.iter().position(|id| *id == wanted as u8)?;
        Some(at < MAX_BOXES as usize && self.mode_bits >> at & 1 == 1)
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
