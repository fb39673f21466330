//! Converts wire pulses to the channel values of the firmware: map, ranges, validity, hold and substitution.
//!
//! Inside the firmware the order is roll, pitch, yaw, throttle, AUX1 … AUX12.

use super::super::config::{ChannelMap, RX_FAIL_CHANNELS, RX_RANGES, RxFail, RxFailMode, RxRange};
use crate::signals::{RC_CHANNELS, RcFrame, SimTime};

/// The index of the roll channel.
pub const ROLL: usize = 0;
/// The index of the pitch channel.
pub const PITCH: usize = 1;
/// The index of the yaw channel.
pub const YAW: usize = 2;
/// The index of the throttle channel.
pub const THROTTLE: usize = 3;
/// The index of AUX1.
pub const AUX1: usize = 4;

/// The time for which a channel keeps its last valid pulse, s.
const HOLD_S: f64 = 0.3;

/// The pulse limits after `rxrange`, µs.
const RANGED_MIN_US: f64 = 750.0;
const RANGED_MAX_US: f64 = 2250.0;

/// The conversion of pulses to channel values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelConfig {
    /// The wire position of each of the first eight internal channels (roll, pitch, yaw, throttle, AUX1…4).
    pub map: ChannelMap,
    /// The number of AUX channels in use. The others read `mid_us`.
    pub max_aux: u8,
    /// The lowest valid pulse, µs.
    pub min_us: u16,
    /// The highest valid pulse, µs.
    pub max_us: u16,
    /// The stick centre, µs.
    pub mid_us: u16,
    /// The range of each stick channel that is stretched to 1000…2000, µs.
    pub ranges: [RxRange; RX_RANGES],
    /// The fallback of each channel.
    pub fail: [RxFail; RX_FAIL_CHANNELS],
    /// The throttle while a failsafe procedure runs, µs.
    pub failsafe_throttle_us: u16,
}

impl Default for ChannelConfig {
    fn default() -> Self {
        Self {
            map: ChannelMap::default(),
            max_aux: 6,
            min_us: 885,
            max_us: 2115,
            mid_us: 1500,
            ranges: [RxRange::default(); RX_RANGES],
            fail: std::array::from_fn(RxFail::default_for),
            failsafe_throttle_us: 1000,
        }
    }
}

impl ChannelConfig {
    fn is_valid(&self, pulse: u16) -> bool {
        (self.min_us..=self.max_us).contains(&pulse)
    }

    /// Returns the wire pulse of internal channel `index`, mapped and stretched.
    fn pulse(&self, frame: &RcFrame, index: usize) -> u16 {
        let wire = self.map.0.get(index).map_or(index, |&position| usize::from(position));
        let raw = frame.channels.get(wire).copied().unwrap_or(0);
        match self.ranges.get(index) {
            Some(&RxRange { min_us, max_us }) if raw != 0 && max_us > min_us => {
                let stretched =
                    1000.0 + (f64::from(raw) - f64::from(min_us)) * 1000.0 / f64::from(max_us - min_us);
                stretched.round().clamp(RANGED_MIN_US, RANGED_MAX_US) as u16
            }
            _ => raw,
        }
    }
}

/// The channels: the last valid pulses and the values in use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Channels {
    last_valid: [u16; RC_CHANNELS],
    valid_at: [SimTime; RC_CHANNELS],
    seen: [bool; RC_CHANNELS],
    values: [u16; RC_CHANNELS],
}

impl Channels {
    /// Creates the channels before the first frame: sticks centred, throttle at the bottom, AUX centred.
    pub fn new(config: &ChannelConfig) -> Self {
        let mut values = [config.mid_us; RC_CHANNELS];
        values[THROTTLE] = config.min_us;
        Self {
            last_valid: values,
            valid_at: [SimTime::ZERO; RC_CHANNELS],
            seen: [false; RC_CHANNELS],
            values,
        }
    }

    /// Takes the valid pulses of a frame.
    pub fn receive(&mut self, config: &ChannelConfig, frame: &RcFrame, now: SimTime) {
        for index in 0..RC_CHANNELS {
            let pulse = config.pulse(frame, index);
            if config.is_valid(pulse) {
                self.last_valid[index] = pulse;
                self.valid_at[index] = now;
                self.seen[index] = true;
            }
        }
    }

    /// Returns `true` if all four flight channels had a valid pulse within the hold time.
    pub fn flight_channels_valid(&self, now: SimTime) -> bool {
        (0..AUX1).all(|index| self.is_held(index, now))
    }

    fn is_held(&self, index: usize, now: SimTime) -> bool {
        self.seen[index] && now.seconds_since(self.valid_at[index]) <= HOLD_S
    }

    /// Computes the values again. `procedure` means that a failsafe procedure controls the sticks.
    pub fn update(&mut self, config: &ChannelConfig, now: SimTime, procedure: bool) {
        let live = AUX1 + usize::from(config.max_aux);
        for index in 0..RC_CHANNELS {
            self.values[index] = if index >= live {
                config.mid_us
            } else if procedure && index == THROTTLE {
                config.failsafe_throttle_us
            } else if procedure && index < AUX1 {
                config.mid_us
            } else if self.is_held(index, now) {
                self.last_valid[index]
            } else {
                self.fallback(config, index)
            };
        }
    }

    fn fallback(&self, config: &ChannelConfig, index: usize) -> u16 {
        let rule = config.fail[index];
        match rule.mode {
            RxFailMode::Auto if index == THROTTLE => config.min_us,
            RxFailMode::Auto => config.mid_us,
            RxFailMode::Hold => self.last_valid[index],
            RxFailMode::Set => rule.value_us,
        }
    }

    /// Returns the channel values in use, µs: roll, pitch, yaw, throttle, AUX1….
    pub fn values(&self) -> &[u16; RC_CHANNELS] {
        &self.values
    }

    /// Returns the last valid pulses as received, µs, before any failsafe substitution.
    pub fn received(&self) -> &[u16; RC_CHANNELS] {
        &self.last_valid
    }

    /// Returns the values of the AUX channels in use, µs.
    pub fn aux(&self, config: &ChannelConfig) -> &[u16] {
        let live = (AUX1 + usize::from(config.max_aux)).min(RC_CHANNELS);
        &self.values[AUX1..live]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime(ms * 1000)
    }

    fn after(config: &ChannelConfig, frame: &RcFrame, ms: u64, procedure: bool) -> [u16; RC_CHANNELS] {
        let mut channels = Channels::new(config);
        channels.receive(config, frame, at(0));
        channels.update(config, at(ms), procedure);
        *channels.values()
    }

    fn frame(first: [u16; 6]) -> RcFrame {
        let mut frame = RcFrame::SAFE;
        frame.channels[..6].copy_from_slice(&first);
        frame
    }

    #[test]
    fn wire_aetr_becomes_roll_pitch_yaw_throttle() {
        let values = after(&ChannelConfig::default(), &frame([1100, 1200, 1300, 1400, 1700, 1800]), 0, false);
        assert_eq!(values[..6], [1100, 1200, 1400, 1300, 1700, 1800]);
    }

    #[test]
    fn channels_beyond_max_aux_read_centre() {
        let mut wire = RcFrame::SAFE;
        wire.channels = [2000; RC_CHANNELS];
        let values = after(&ChannelConfig::default(), &wire, 0, false);
        assert_eq!(values[9], 2000);
        assert_eq!(values[10..], [1500; 6]);
    }

    #[test]
    fn range_is_stretched_and_clamped() {
        let config = ChannelConfig {
            ranges: [RxRange { min_us: 1100, max_us: 1900 }; RX_RANGES],
            ..ChannelConfig::default()
        };
        for (raw, expected) in [(1100, 1000), (1500, 1500), (1900, 2000)] {
            assert_eq!(after(&config, &frame([raw, 1500, 1100, 1500, 1000, 1000]), 0, false)[ROLL], expected);
        }
    }

    #[test]
    fn lost_channel_is_held_then_substituted() {
        let mut config = ChannelConfig::default();
        config.fail[AUX1] = RxFail::set_to(1234);
        let wire = frame([1700, 1300, 1600, 1400, 1900, 1800]);
        assert_eq!(after(&config, &wire, 300, false)[..6], [1700, 1300, 1400, 1600, 1900, 1800]);
        assert_eq!(after(&config, &wire, 301, false)[..6], [1500, 1500, 1500, 885, 1225, 1800]);
    }

    #[test]
    fn procedure_owns_the_sticks_but_not_the_switches() {
        let config = ChannelConfig { failsafe_throttle_us: 1111, ..ChannelConfig::default() };
        let values = after(&config, &frame([1700, 1300, 1600, 1400, 1900, 1800]), 0, true);
        assert_eq!(values[..6], [1500, 1500, 1500, 1111, 1900, 1800]);
    }

    #[test]
    fn invalid_pulse_counts_as_missing() {
        let config = ChannelConfig::default();
        let mut channels = Channels::new(&config);
        channels.receive(&config, &frame([1700, 1500, 1600, 1500, 1900, 1800]), at(0));
        channels.receive(&config, &frame([2116, 1500, 1600, 1500, 884, 1800]), at(200));
        channels.update(&config, at(250), false);
        assert_eq!((channels.values()[ROLL], channels.values()[AUX1]), (1700, 1900));
        assert!(channels.flight_channels_valid(at(300)));
        assert!(!channels.flight_channels_valid(at(301)));
    }
}
