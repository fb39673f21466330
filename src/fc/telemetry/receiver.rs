//! Channels and motors.

use super::reader::Reader;
use crate::signals::{MOTORS, PerMotor, RC_CHANNELS};

/// The value of a channel that the flight controller does not have, µs.
const ABSENT_US: u16 = 1500;
/// The pulses of a motor at rest and at full output, µs.
const MOTOR_RANGE_US: (f64, f64) = (1000.0, 2000.0);

/// Decodes `RC`. Returns the channels, µs, in wire order (roll, pitch, throttle, yaw, AUX1 …). Channels that
/// the flight controller does not have are centred.
pub fn channels(payload: &[u8]) -> Option<[u16; RC_CHANNELS]> {
    let mut reader = Reader::new(payload);
    let mut channels = [ABSENT_US; RC_CHANNELS];
    // The message has yaw before throttle.
    for place in [0, 1, 3, 2] {
        channels[place] = reader.u16()?;
    }
    for channel in &mut channels[4..] {
        *channel = reader.u16().unwrap_or(ABSENT_US);
    }
    Some(channels)
}

/// Decodes `MOTOR`. Returns the outputs M1…M4, 0…1.
pub fn motors(payload: &[u8]) -> Option<PerMotor> {
    let (rest, full) = MOTOR_RANGE_US;
    let mut reader = Reader::new(payload);
    let mut motors = [0.0; MOTORS];
    for motor in &mut motors {
        *motor = ((f64::from(reader.u16()?) - rest) / (full - rest)).clamp(0.0, 1.0);
    }
    Some(motors)
}
