//! The motor datagrams that the flight controller sends to a simulator.
//!
//! ```text
//! servo, 16 bytes      0  f32 × 4   motors M1 … M4, 0…1 in steps of 0.001
//! raw,   68 bytes      0  u16       number of motors
//!                      2  –         two bytes of padding
//!                      4  f32 × 16  pulses, µs: the motors, then the servos, unused 0
//! ```

use crate::link::conventions::MotorOrder;
use crate::signals::{MOTORS, MotorCommand, PerMotor};

/// The size of the normalised datagram. Receivers refuse a shorter one and ignore the surplus of a longer
/// one.
pub const SIZE: usize = 16;

/// The size of the raw datagram.
pub const RAW_SIZE: usize = 68;

impl MotorOrder {
    /// Arranges the values of M1 … M4 in the order of the packet.
    pub fn arrange<T>(self, [m1, m2, m3, m4]: PerMotor<T>) -> PerMotor<T> {
        match self {
            Self::Native => [m1, m2, m3, m4],
            Self::Legacy => [m2, m3, m4, m1],
        }
    }

    /// Arranges the values of a packet in the order M1 … M4.
    pub fn in_native_order<T>(self, [first, second, third, fourth]: PerMotor<T>) -> PerMotor<T> {
        match self {
            Self::Native => [first, second, third, fourth],
            Self::Legacy => [fourth, first, second, third],
        }
    }
}

/// Returns the motor pulses in µs, 1000 at rest, 2000 at full power.
pub fn pulses_us(motors: &MotorCommand) -> PerMotor<f32> {
    motors
        .0
        .map(|motor| (1000.0 + 1000.0 * if motor.is_finite() { motor.clamp(0.0, 1.0) } else { 0.0 }) as f32)
}

/// Returns the normalised value of a pulse: its whole microseconds above 1000 in thousandths, rounded down.
pub fn normalised(pulse_us: f32) -> f32 {
    (pulse_us.trunc() - 1000.0) / 1000.0
}

/// Returns the normalised datagram of four motor pulses, µs.
pub fn encode(pulses_us: PerMotor<f32>) -> [u8; SIZE] {
    let mut datagram = [0; SIZE];
    for (field, pulse) in datagram.as_chunks_mut::<4>().0.iter_mut().zip(pulses_us) {
        *field = normalised(pulse).to_le_bytes();
    }
    datagram
}

/// Returns the four normalised motor values of a datagram; `None` if it is too short or a value is not a
/// number.
pub fn decode(datagram: &[u8]) -> Option<PerMotor<f32>> {
    let mut motors = [0.0; MOTORS];
    for (motor, field) in motors.iter_mut().zip(datagram.get(..SIZE)?.as_chunks::<4>().0) {
        *motor = f32::from_le_bytes(*field);
        if !motor.is_finite() {
            return None;
        }
    }
    Some(motors)
}

/// Returns the raw datagram: the number of motors and the pulses in µs, motors first. Missing pulses are 0.
pub fn encode_raw(motor_count: u16, pulses_us: &[f32]) -> [u8; RAW_SIZE] {
    let mut datagram = [0; RAW_SIZE];
    datagram[..2].copy_from_slice(&motor_count.to_le_bytes());
    for (field, pulse) in datagram[4..].as_chunks_mut::<4>().0.iter_mut().zip(pulses_us) {
        *field = pulse.to_le_bytes();
    }
    datagram
}
