//! The state datagram that a simulator sends to the flight controller ("FDM", flight dynamics model).
//!
//! ```text
//! field  0      timestamp, s                    7…10   quaternion w x y z
//!        1…3    body rates, rad/s               11…13  velocity east, north, up, m/s
//!        4…6    acceleration, m/s²              14, 15 longitude, latitude, degrees
//!        16     altitude, m                     17     pressure, Pa
//! ```
//!
//! Eighteen little-endian doubles, 144 bytes. The meaning of the numbers depends on the sender:
//! [`Dialect`](crate::link::conventions::Dialect). The program itself uses body FLU, world ENU, SI.

use crate::math;

mod dialect;

pub use dialect::{Gravity, State, mirrored};

/// The number of doubles that are read.
pub const FIELDS: usize = 18;

/// The size of the datagram. A shorter one is refused, a longer one is truncated.
pub const SIZE: usize = 8 * FIELDS;

/// The size of the datagram of the public Gazebo plugin, which appends values of the motors.
pub const GZ_PLUGIN_SIZE: usize = 296;

/// The greatest plausible rate, rad/s.
const MAX_RATE: f64 = 200.0;

/// The greatest plausible acceleration, m/s².
const MAX_ACCELERATION: f64 = 2000.0;

/// The greatest plausible velocity, m/s.
const MAX_VELOCITY: f64 = 10_000.0;

/// The greatest plausible distance from sea level, m.
const MAX_ALTITUDE: f64 = 100_000.0;

/// The norms of a quaternion that are close enough to 1 for normalisation.
const QUATERNION_NORM: std::ops::RangeInclusive<f64> = 0.9..=1.1;

/// The reason why a datagram was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
pub enum PacketError {
    /// Fewer than [`SIZE`] bytes.
    #[strum(to_string = "too short")]
    TooShort,
    /// A number that is infinite or not a number.
    #[strum(to_string = "a value is not a number")]
    NotFinite,
    /// A quaternion that is far from a rotation.
    #[strum(to_string = "the quaternion is not a rotation")]
    Quaternion,
    /// A body rate above 200 rad/s.
    #[strum(to_string = "a body rate above 200 rad/s")]
    Rate,
    /// An acceleration above 2000 m/s².
    #[strum(to_string = "an acceleration above 2000 m/s²")]
    Acceleration,
    /// A velocity above 10 km/s or an altitude above 100 km.
    #[strum(to_string = "a velocity above 10 km/s or an altitude above 100 km")]
    OutOfThisWorld,
}

/// The numbers of one datagram, not yet interpreted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Packet {
    /// The fields, in wire order.
    pub fields: [f64; FIELDS],
    /// The size of the datagram.
    pub size: usize,
}

impl Packet {
    /// Parses a datagram and checks its numbers for plausibility. The pressure is not checked: some senders
    /// leave it uninitialised.
    pub fn parse(datagram: &[u8]) -> Result<Self, PacketError> {
        let mut fields = [0.0; FIELDS];
        let bytes = datagram.get(..SIZE).ok_or(PacketError::TooShort)?;
        for (field, bytes) in fields.iter_mut().zip(bytes.as_chunks::<8>().0) {
            *field = f64::from_le_bytes(*bytes);
        }
        let packet = Self { fields, size: datagram.len() };
        if fields[..FIELDS - 1].iter().any(|field| !field.is_finite()) {
            return Err(PacketError::NotFinite);
        }
        if !QUATERNION_NORM.contains(&norm(&fields[7..11])) {
            return Err(PacketError::Quaternion);
        }
        if norm(&fields[1..4]) > MAX_RATE {
            return Err(PacketError::Rate);
        }
        if norm(&fields[4..7]) > MAX_ACCELERATION {
            return Err(PacketError::Acceleration);
        }
        if norm(&fields[11..14]) > MAX_VELOCITY || fields[16].abs() > MAX_ALTITUDE {
            return Err(PacketError::OutOfThisWorld);
        }
        Ok(packet)
    }

    /// Returns the 144 bytes of the datagram.
    pub fn to_bytes(&self) -> [u8; SIZE] {
        let mut bytes = [0; SIZE];
        for (bytes, field) in bytes.as_chunks_mut::<8>().0.iter_mut().zip(self.fields) {
            *bytes = field.to_le_bytes();
        }
        bytes
    }

    /// Returns `true` if another datagram has the same size and the same numbers, bit by bit.
    pub fn is_same(&self, other: &Self) -> bool {
        let bits = |packet: &Self| packet.fields.map(f64::to_bits);
        self.size == other.size && bits(self) == bits(other)
    }

    /// Returns the sender's clock, s.
    pub fn stamp_s(&self) -> f64 {
        self.fields[0]
    }
}

fn norm(fields: &[f64]) -> f64 {
    fields.iter().map(|field| field * field).sum::<f64>().sqrt()
}

/// Returns the pressure (Pa) of the standard atmosphere at a height (m) in the troposphere.
pub fn pressure_pa(altitude_m: f64) -> f64 {
    101_325.0 * math::powf((1.0 - 2.255_77e-5 * altitude_m).max(0.0), 5.255_88)
}
