//! The receiver: sources, channels, sticks, and the check of the signal.
//!
//! ```text
//! frames ─► Sources (by rank)    ─► Channels (map, range, hold, substitution) ─► Sticks
//!                                        └► Signal (lost after 150 ms)
//! ```
//!
//! Ages count in the firmware's own time, which each call passes in.

pub mod channels;
pub mod source;
pub mod sticks;

pub use channels::{ChannelConfig, Channels};
pub use source::Sources;
pub use sticks::{StickConfig, Sticks};

use crate::signals::{RC_CHANNELS, RcFrame, RcSource, SimTime};

/// The age of the newest frame above which the signal is lost, s.
const SIGNAL_LOSS_S: f64 = 0.15;
/// The signal strength of a full signal.
const RSSI_MAX: u16 = 1023;
/// The interval of receiver passes without frames, s.
const LOOK_EVERY_S: f64 = 0.05;

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RxConfig {
    /// The conversion of pulses to channel values.
    pub channels: ChannelConfig,
    /// The conversion of channel values to stick positions.
    pub sticks: StickConfig,
    /// The channel that carries the signal strength, from 0.
    pub rssi_channel: Option<u8>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Receiver {
    sources: Sources,
    channels: Channels,
    sticks: Sticks,
    pending: bool,
    last_frame: Option<SimTime>,
    last_pass: SimTime,
    signal: bool,
    has_valid_channels: bool,
}

impl Receiver {
    /// Creates a receiver that has not received anything yet.
    pub fn new(config: &RxConfig) -> Self {
        let channels = Channels::new(&config.channels);
        Self {
            sources: Sources::default(),
            sticks: Sticks::from_channels(&config.sticks, channels.values()),
            channels,
            pending: false,
            last_frame: None,
            last_pass: SimTime::ZERO,
            signal: false,
            has_valid_channels: false,
        }
    }

    pub fn receive(&mut self, config: &RxConfig, frame: RcFrame, source: RcSource, now: SimTime) {
        if let Some(frame) = self.sources.receive(frame, source, now) {
            self.channels.receive(&config.channels, &frame, now);
            self.last_frame = Some(now);
            self.pending = true;
        }
    }

    /// Returns `true` if a pass is due: after a new frame, or 50 ms after the last pass.
    pub fn is_due(&self, now: SimTime) -> bool {
        self.pending || now.seconds_since(self.last_pass) >= LOOK_EVERY_S
    }

    /// Runs one pass: judges the signal and computes channels and sticks. `switched_off` counts as signal loss (the
    /// FAILSAFE switch in its first mode). `procedure` means that a failsafe procedure controls the sticks. Returns
    /// `true` if a new frame was used.
    pub fn update(&mut self, config: &RxConfig, now: SimTime, switched_off: bool, procedure: bool) -> bool {
        let fresh = self.last_frame.is_some_and(|last| now.seconds_since(last) <= SIGNAL_LOSS_S);
        self.has_valid_channels = self.channels.flight_channels_valid(now);
        self.signal = fresh && self.has_valid_channels && !switched_off;
        self.channels.update(&config.channels, now, procedure);
        self.sticks = Sticks::from_channels(&config.sticks, self.channels.values());
        self.last_pass = now;
        std::mem::take(&mut self.pending)
    }

    /// Returns `true` while there is a signal: a frame within 150 ms with valid flight channels.
    pub fn signal(&self) -> bool {
        self.signal
    }

    /// Returns `true` while the pulses of the flight channels are valid.
    pub fn has_valid_channels(&self) -> bool {
        self.has_valid_channels
    }

    /// Returns the signal strength, 0…1023: the position of the channel that carries it; without one, full strength while
    /// there is a signal.
    pub fn rssi(&self, config: &RxConfig) -> u16 {
        let strength = config.rssi_channel.and_then(|channel| self.channels().get(usize::from(channel)));
        match strength {
            Some(pulse) => (u32::from((*pulse).clamp(1000, 2000) - 1000) * u32::from(RSSI_MAX) / 1000) as u16,
            None if self.signal => RSSI_MAX,
            None => 0,
        }
    }

    /// Returns `true` if any frame was ever used.
    pub fn has_heard(&self) -> bool {
        self.last_frame.is_some()
    }

    /// Returns the time of the newest frame that was used.
    pub fn last_frame(&self) -> Option<SimTime> {
        self.last_frame
    }

    /// Returns the channel values in use, µs: roll, pitch, yaw, throttle, AUX1….
    pub fn channels(&self) -> &[u16; RC_CHANNELS] {
        self.channels.values()
    }

    /// Returns the live AUX channels in use, µs.
    pub fn aux(&self, config: &RxConfig) -> &[u16] {
        self.channels.aux(&config.channels)
    }

    /// Returns the stick positions in use.
    pub fn sticks(&self) -> &Sticks {
        &self.sticks
    }

    /// Returns the stick positions as received, before any failsafe substitution.
    pub fn received_sticks(&self, config: &RxConfig) -> Sticks {
        Sticks::from_channels(&config.sticks, self.channels.received())
    }

    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Gives the virtual sticks priority over the other sources, or ends that.
    pub fn take_over(&mut self, sticks_first: bool) {
        self.sources.take_over(sticks_first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime(ms * 1000)
    }

    /// Runs the passes of a receiver that gets frames every 20 ms up to `stop_ms`. Returns the time of the signal loss.
    fn lost_after(stop_ms: u64) -> Option<u64> {
        let config = RxConfig::default();
        let mut rx = Receiver::new(&config);
        for ms in 0..stop_ms + 1000 {
            if ms <= stop_ms && ms % 20 == 0 {
                rx.receive(&config, RcFrame::SAFE, RcSource::Sticks, at(ms));
            }
            if rx.is_due(at(ms)) {
                rx.update(&config, at(ms), false, false);
                if ms > 0 && !rx.signal() {
                    return Some(ms);
                }
            }
        }
        None
    }

    #[test]
    fn signal_is_lost_between_150_and_210_ms_after_the_last_frame() {
        let lost = lost_after(1000).unwrap();
        assert!((1150..=1210).contains(&lost), "{lost}");
    }

    #[test]
    fn a_gap_of_150_ms_is_no_loss() {
        let config = RxConfig::default();
        let mut rx = Receiver::new(&config);
        for ms in 0..=150 {
            if ms == 0 || ms == 150 {
                rx.receive(&config, RcFrame::SAFE, RcSource::Udp, at(ms));
            }
            if rx.is_due(at(ms)) {
                rx.update(&config, at(ms), false, false);
                assert!(rx.signal(), "{ms}");
            }
        }
    }

    #[test]
    fn switch_counts_as_loss_at_once() {
        let config = RxConfig::default();
        let mut rx = Receiver::new(&config);
        rx.receive(&config, RcFrame::SAFE, RcSource::Udp, at(0));
        rx.update(&config, at(0), true, false);
        assert!(!rx.signal());
    }

    #[test]
    fn invalid_throttle_counts_as_loss_after_300_ms() {
        let config = RxConfig::default();
        let mut rx = Receiver::new(&config);
        let mut bad = RcFrame::SAFE;
        bad.channels[2] = 0;
        for ms in (0..=320).step_by(20) {
            let frame = if ms == 0 { RcFrame::SAFE } else { bad };
            rx.receive(&config, frame, RcSource::Udp, at(ms));
            rx.update(&config, at(ms), false, false);
            assert_eq!(rx.signal(), ms <= 300, "{ms}");
        }
    }
}
