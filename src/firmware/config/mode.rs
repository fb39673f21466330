//! Mode conditions and in-flight adjustments.

/// The pulse step of mode ranges, µs.
const STEP_US: u16 = 25;
/// The lowest pulse of a mode range, µs.
const LOWEST_US: u16 = 900;
/// The highest pulse of a mode range, µs.
const HIGHEST_US: u16 = 2100;

/// The logic that combines several conditions of one mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::FromRepr)]
#[repr(u8)]
pub enum ModeLogic {
    /// The mode is active if this condition or another one of the mode holds.
    #[default]
    Or = 0,
    /// All of these conditions must hold.
    And = 1,
}

/// One rule that binds a mode to a switch or to another mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ModeCondition {
    /// The permanent id of the mode.
    pub box_id: u8,
    /// The switch channel: 0 = AUX1 = fifth receiver channel, up to 13.
    pub aux_channel: u8,
    /// The lowest pulse, µs, 900…2100 in steps of 25.
    pub start_us: u16,
    /// The first pulse above the range, µs.
    pub end_us: u16,
    /// The logic that combines it with the other conditions of its mode.
    pub logic: ModeLogic,
    /// The permanent id of the mode that it follows instead of a channel; 0 = none.
    pub linked: u8,
}

impl Default for ModeCondition {
    fn default() -> Self {
        Self { box_id: 0, aux_channel: 0, start_us: 900, end_us: 900, logic: ModeLogic::Or, linked: 0 }
    }
}

impl ModeCondition {
    /// The highest auxiliary channel, counted from 0.
    pub const MAX_AUX: u8 = 13;

    /// Limits a pulse to the range of conditions and rounds it down to their step.
    pub fn snap(pulse_us: i64) -> u16 {
        let clipped = pulse_us.clamp(i64::from(LOWEST_US), i64::from(HIGHEST_US)) as u16;
        clipped - (clipped - LOWEST_US) % STEP_US
    }

    /// Returns `true` if it can ever turn its mode on.
    pub fn is_usable(&self) -> bool {
        self.start_us < self.end_us || self.linked != 0
    }

    /// Returns `true` if a pulse is in the range. Pulses beyond the ends count as the ends.
    pub fn contains(&self, pulse_us: f64) -> bool {
        let pulse = pulse_us.max(f64::from(LOWEST_US)).min(f64::from(HIGHEST_US - 1));
        f64::from(self.start_us) <= pulse && pulse < f64::from(self.end_us)
    }
}

/// One in-flight adjustment. It is kept, not executed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct AdjustmentRange {
    /// The channel whose range enables it, 0 = AUX1.
    pub aux_channel: u8,
    /// The lowest pulse, µs.
    pub start_us: u16,
    /// The first pulse above the range, µs.
    pub end_us: u16,
    /// The number of the value to adjust.
    pub function: u8,
    /// The channel that adjusts the value, 0 = AUX1.
    pub select_channel: u8,
    /// The centre of an absolute adjustment.
    pub center: u16,
    /// The scale of an absolute adjustment.
    pub scale: u16,
}

impl Default for AdjustmentRange {
    fn default() -> Self {
        Self {
            aux_channel: 0,
            start_us: 900,
            end_us: 900,
            function: 0,
            select_channel: 0,
            center: 0,
            scale: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_half_open_and_end_pulses_count_as_inside() {
        let range = ModeCondition { start_us: 1700, end_us: 2100, ..ModeCondition::default() };
        let inside = [1699.9, 1700.0, 2099.0, 2100.0, 2500.0, f64::NAN].map(|pulse| range.contains(pulse));
        assert_eq!(inside, [false, true, true, true, true, false]);
        let low = ModeCondition { start_us: 900, end_us: 1300, ..ModeCondition::default() };
        assert_eq!([0.0, 1299.9, 1300.0].map(|pulse| low.contains(pulse)), [true, true, false]);
        assert!(!ModeCondition::default().contains(900.0));
    }

    #[test]
    fn pulses_are_stored_in_steps() {
        assert_eq!([i64::MIN, 912, 1724, i64::MAX].map(ModeCondition::snap), [900, 900, 1700, 2100]);
    }
}
