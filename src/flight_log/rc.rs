//! The sticks and switches of a log, to fly them again.

use std::io;

use super::flight::LogFlight;
use super::sample::LogSample;
use crate::blackbox::decode::LogSource;
use crate::signals::{RcFrame, SimTime};
use crate::telemetry::{Mode, ModeBox};

/// The interval of RC frames, µs.
const FRAME_US: u64 = 20_000;
/// The longest part of a log that is flown again, µs.
const MAX_US: u64 = 7_200_000_000;
/// The modes that get a switch, in the order of the channels from AUX1. FAILSAFE is a consequence.
const SWITCHES: [Mode; 9] = [
    Mode::Arm,
    Mode::Angle,
    Mode::Horizon,
    Mode::Mag,
    Mode::AltHold,
    Mode::HeadFree,
    Mode::PosHold,
    Mode::GpsRescue,
    Mode::Autopilot,
];
/// The index of AUX1.
const FIRST_AUX: usize = 4;
/// The pulses of a switch, and the range in which its mode is on, µs.
const OFF_US: u16 = 1000;
const ON_US: u16 = 2000;
const ON_RANGE_US: (u16, u16) = (1700, 2100);
/// The pulse of a stick in the middle, and the pulses of a transmitter, µs.
const MIDDLE_US: f64 = 1500.0;
const PULSES_US: (f64, f64) = (900.0, 2100.0);

/// The sticks at an instant of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StickFrame {
    /// The time since the first frame of the log, µs.
    pub since_us: u64,
    /// The frame of the transmitter; `None` while the craft received no signal.
    pub frame: Option<RcFrame>,
}

/// The sticks and switches of a log, fifty frames a second.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LogSticks(pub Vec<StickFrame>);

impl LogSticks {
    /// Reads the sticks of a log, at most those of its first two hours. Returns `None` if it does not have them.
    ///
    /// The sticks are the logged commands, which have lost the deadband. The switches are the logged modes.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn of<S: LogSource>(flight: &LogFlight, source: S) -> io::Result<Option<Self>> {
        let Some(mut cursor) = flight.cursor(source, flight.first())? else { return Ok(None) };
        let mut frames = Vec::new();
        let mut due_us = 0;
        loop {
            let since_us = cursor.time().0.saturating_sub(flight.first().0);
            if since_us >= due_us {
                let sample = cursor.latest();
                let Some(frame) = frame(sample) else { return Ok(None) };
                let is_received = sample.rx_signal != Some(false);
                frames.push(StickFrame { since_us, frame: is_received.then_some(frame) });
                due_us = (since_us / FRAME_US + 1) * FRAME_US;
            }
            if since_us > MAX_US || !cursor.advance()? {
                break;
            }
        }
        Ok(Some(Self(frames)))
    }

    /// Returns the lines of the firmware's command line that give each mode its switch.
    pub fn switch_lines() -> impl Iterator<Item = String> {
        let (start, end) = ON_RANGE_US;
        // The firmware reads six of them by default, and those of the log may be fewer.
        let channels = std::iter::once("set max_aux_channels = 14".to_owned());
        channels.chain(SWITCHES.iter().enumerate().map(move |(aux, mode)| {
            format!("aux {aux} {} {aux} {start} {end} 0 0", ModeBox::from(*mode) as u8)
        }))
    }

    /// Returns the frame in force so long after the first frame of the log.
    pub fn at(&self, since_us: u64) -> Option<&StickFrame> {
        let after = self.0.partition_point(|frame| frame.since_us <= since_us);
        self.0.get(after.checked_sub(1)?)
    }

    /// Returns the length of the log, µs.
    pub fn length(&self) -> SimTime {
        SimTime(self.0.last().map_or(0, |last| last.since_us))
    }
}

/// Returns the frame with the sticks of a sample; `None` if the log does not have them.
fn frame(sample: &LogSample) -> Option<RcFrame> {
    let [roll, pitch, yaw] = sample.rc_command?;
    let pulse = |us: f64| us.clamp(PULSES_US.0, PULSES_US.1).round() as u16;
    let mut frame = RcFrame::SAFE;
    let sticks = [MIDDLE_US + roll, MIDDLE_US + pitch, sample.rc_throttle_us?, MIDDLE_US - yaw];
    for (channel, us) in frame.channels.iter_mut().zip(sticks) {
        *channel = pulse(us);
    }
    let modes = sample.boxes.map(|boxes| boxes.modes()).unwrap_or_default();
    for (channel, mode) in frame.channels.iter_mut().skip(FIRST_AUX).zip(SWITCHES) {
        *channel = if modes.has(mode) { ON_US } else { OFF_US };
    }
    Some(frame)
}
