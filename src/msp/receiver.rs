//! Channels and motors.

use super::wire::{Reader, Writer};
use crate::signals::{MOTORS, PerMotor, RC_CHANNELS};

/// The value of a channel that the flight controller does not have, µs.
const ABSENT_US: u16 = 1500;
/// The pulses of a motor at rest and at full output, µs.
const MOTOR_RANGE_US: (f64, f64) = (1000.0, 2000.0);
/// The number of motors that a message has room for.
const MOTOR_SLOTS: usize = 8;

/// `RC`: the channels, µs, roll, pitch, **yaw, throttle**, AUX1 ….
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Channels(pub [u16; RC_CHANNELS]);

impl Channels {
    /// Decodes the message. Channels that the flight controller does not have are centred.
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let mut channels = [ABSENT_US; RC_CHANNELS];
        for stick in &mut channels[..4] {
            *stick = reader.u16()?;
        }
        for channel in &mut channels[4..] {
            *channel = reader.u16().unwrap_or(ABSENT_US);
        }
        Some(Self(channels))
    }

    pub fn encode(&self, writer: &mut Writer) {
        for channel in self.0 {
            writer.u16(channel);
        }
    }

    /// Returns the channels in the order of a transmitter: roll, pitch, throttle, yaw, AUX1 ….
    pub fn of_transmitter(&self) -> [u16; RC_CHANNELS] {
        let mut channels = self.0;
        channels.swap(2, 3);
        channels
    }
}

/// `MOTOR`: the pulses M1…M4, µs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Motors(pub PerMotor<u16>);

impl Motors {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let mut motors = [0; MOTORS];
        for motor in &mut motors {
            *motor = reader.u16()?;
        }
        Some(Self(motors))
    }

    pub fn encode(&self, writer: &mut Writer) {
        for pulse in self.0 {
            writer.u16(pulse);
        }
        writer.zeros(2 * (MOTOR_SLOTS - self.0.len()));
    }

    /// Returns the outputs, 0…1.
    pub fn outputs(&self) -> PerMotor {
        let (rest, full) = MOTOR_RANGE_US;
        self.0.map(|pulse| ((f64::from(pulse) - rest) / (full - rest)).clamp(0.0, 1.0))
    }
}
