//! The state datagram that a simulator sends to the flight controller ("FDM", flight dynamics model).
//!
//! ```text
//! field  0      timestamp, s                    7…10   quaternion w x y z
//!        1…3    body rates, rad/s               11…13  velocity east, north, up, m/s
//!        4…6    acceleration, m/s²              14, 15 longitude, latitude, degrees
//!        16     altitude, m                     17     pressure, Pa
//! ```
//!
//! Eighteen little-endian doubles, 144 bytes. The same numbers mean different things depending on who wrote the
//! sender: [`Dialect`](crate::signals::fdm::Dialect). Inside, everything is body FLU, world ENU, SI.

mod dialect;

pub use dialect::{Gravity, State, mirrored};

/// Doubles that are looked at.
pub const FIELDS: usize = 18;

/// Size of the datagram. A shorter one is refused, a longer one is cut.
pub const SIZE: usize = 8 * FIELDS;

/// Size of the datagram of the public Gazebo plugin, which appends values of the motors.
pub const GZ_PLUGIN_SIZE: usize = 296;

/// Greatest rate that is believed, rad/s.
const MAX_RATE: f64 = 200.0;

/// Greatest acceleration that is believed, m/s².
const MAX_ACCELERATION: f64 = 2000.0;

/// Greatest velocity that is believed, m/s.
const MAX_VELOCITY: f64 = 10_000.0;

/// Greatest distance from sea level that is believed, m.
const MAX_ALTITUDE: f64 = 100_000.0;

/// Norms of a quaternion that are close enough to 1 to be repaired.
const QUATERNION_NORM: std::ops::RangeInclusive<f64> = 0.9..=1.1;

/// Why a datagram was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
pub enum PacketError {
    /// Fewer than [`SIZE`] bytes.
    #[strum(to_string = "too short")]
    TooShort,
    /// A number that is infinite or not a number.
    #[strum(to_string = "a value is not a number")]
    NotFinite,
    /// A quaternion that is far from a rotation.
    #[strum(to_string = "the quaternion is no rotation")]
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

/// The numbers of one datagram, before anybody decided what they mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Packet {
    /// The fields, in wire order.
    pub fields: [f64; FIELDS],
    /// Size of the datagram they came in.
    pub size: usize,
}

impl Packet {
    /// The numbers of a datagram, checked for sense. The pressure is not: some senders leave it uninitialised.
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

    /// The 144 bytes of the datagram.
    pub fn to_bytes(&self) -> [u8; SIZE] {
        let mut bytes = [0; SIZE];
        for (bytes, field) in bytes.as_chunks_mut::<8>().0.iter_mut().zip(self.fields) {
            *bytes = field.to_le_bytes();
        }
        bytes
    }

    /// Whether another datagram has the same size and the same numbers, bit by bit.
    pub fn is_same(&self, other: &Self) -> bool {
        let bits = |packet: &Self| packet.fields.map(f64::to_bits);
        self.size == other.size && bits(self) == bits(other)
    }

    /// The sender's clock, s.
    pub fn stamp_s(&self) -> f64 {
        self.fields[0]
    }
}

fn norm(fields: &[f64]) -> f64 {
    fields.iter().map(|field| field * field).sum::<f64>().sqrt()
}

/// Pressure (Pa) of the standard atmosphere at a height (m) in the troposphere.
pub fn pressure_pa(altitude_m: f64) -> f64 {
    101_325.0 * (1.0 - 2.255_77e-5 * altitude_m).max(0.0).powf(5.255_88)
}
