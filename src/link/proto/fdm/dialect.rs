//! The meaning of the eighteen numbers in the three dialects.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::{FIELDS, Packet, SIZE, pressure_pa};
use crate::geo::GRAVITY;
use crate::link::conventions::Dialect;

/// The treatment of gravity in the acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Gravity {
    /// The acceleration contains the reaction to gravity: an accelerometer's reading, 1 g at rest.
    Included,
    /// The acceleration lacks it: the change of velocity, 0 at rest.
    Missing,
}

/// The state of the craft that a packet describes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// The sender's clock, s.
    pub stamp_s: f64,
    /// Body rates, FLU, rad/s.
    pub rate_flu: Vector3<f64>,
    /// Specific force, FLU, m/s².
    pub specific_force_flu: Vector3<f64>,
    /// Attitude, body FLU → world ENU.
    pub attitude: UnitQuaternion<f64>,
    /// Velocity, ENU, m/s.
    pub vel_enu: Vector3<f64>,
    /// Longitude, degrees, as on the wire. It may be mirrored, see [`Dialect::mirrors`].
    pub lon_deg: f64,
    /// Latitude, degrees, as on the wire.
    pub lat_deg: f64,
    /// Altitude above the datum of home, m.
    pub alt_m: f64,
    /// Static pressure, Pa.
    pub pressure_pa: f64,
}

/// Returns the mirror image of a coordinate about `centre`. Turns a mirrored coordinate into the true one and
/// back.
pub fn mirrored(centre_deg: f64, value_deg: f64) -> f64 {
    2.0 * centre_deg - value_deg
}

impl Dialect {
    /// Returns the dialect that the size of a datagram suggests.
    pub fn from_size(size: usize) -> Self {
        if size == super::GZ_PLUGIN_SIZE { Self::GzPlugin } else { Self::SitlGz }
    }

    /// Returns `true` if positions on the wire are mirrored about the craft's first one.
    pub fn mirrors(self) -> bool {
        self != Self::Legacy
    }

    /// Returns the usual treatment of gravity in the dialect. The packets may show otherwise.
    pub fn usual_gravity(self) -> Gravity {
        if self == Self::GzPlugin { Gravity::Missing } else { Gravity::Included }
    }

    /// Decodes a packet.
    pub fn decode(self, packet: &Packet, gravity: Gravity) -> State {
        let [
            stamp_s,
            r1,
            r2,
            r3,
            a1,
            a2,
            a3,
            q1,
            q2,
            q3,
            q4,
            east,
            north,
            up,
            lon_deg,
            lat_deg,
            alt_m,
            pressure,
        ] = packet.fields;
        let attitude = self.attitude_from_wire([q1, q2, q3, q4]);
        let rate_flu = match self {
            Self::SitlGz => Vector3::new(r1, -r2, r3),
            Self::GzPlugin | Self::Legacy => Vector3::new(r1, -r2, -r3),
        };
        let acceleration = match self {
            Self::SitlGz | Self::Legacy => -Vector3::new(a1, a2, a3),
            Self::GzPlugin => Vector3::new(a1, -a2, -a3),
        };
        let reaction = match gravity {
            Gravity::Included => Vector3::zeros(),
            Gravity::Missing => attitude.inverse_transform_vector(&Vector3::new(0.0, 0.0, GRAVITY)),
        };
        let has_pressure = self == Self::Legacy && pressure.is_finite() && pressure > 0.0;
        State {
            stamp_s,
            rate_flu,
            specific_force_flu: acceleration + reaction,
            attitude,
            vel_enu: Vector3::new(east, north, up),
            lon_deg,
            lat_deg,
            alt_m,
            pressure_pa: if has_pressure { pressure } else { pressure_pa(alt_m) },
        }
    }

    /// Encodes a state, with the acceleration that is usual in the dialect.
    pub fn encode(self, state: &State) -> Packet {
        let rate = state.rate_flu;
        let force = state.specific_force_flu;
        let rate = match self {
            Self::SitlGz => [rate.x, -rate.y, rate.z],
            Self::GzPlugin | Self::Legacy => [rate.x, -rate.y, -rate.z],
        };
        let acceleration = match self {
            Self::SitlGz | Self::Legacy => [-force.x, -force.y, -force.z],
            Self::GzPlugin => {
                let reaction = state.attitude.inverse_transform_vector(&Vector3::new(0.0, 0.0, GRAVITY));
                let kinematic = force - reaction;
                [kinematic.x, -kinematic.y, -kinematic.z]
            }
        };
        let pressure = if self == Self::GzPlugin { 0.0 } else { state.pressure_pa };
        let mut fields = [0.0; FIELDS];
        fields[0] = state.stamp_s;
        fields[1..4].copy_from_slice(&rate);
        fields[4..7].copy_from_slice(&acceleration);
        fields[7..11].copy_from_slice(&self.attitude_to_wire(state.attitude));
        fields[11..14].copy_from_slice(state.vel_enu.as_slice());
        fields[14..].copy_from_slice(&[state.lon_deg, state.lat_deg, state.alt_m, pressure]);
        Packet { fields, size: SIZE }
    }

    fn attitude_from_wire(self, [q1, q2, q3, q4]: [f64; 4]) -> UnitQuaternion<f64> {
        let quaternion = match self {
            Self::SitlGz => Quaternion::new(q4, q3, q2, q1),
            Self::GzPlugin => Quaternion::new(q1, q2, -q3, -q4),
            Self::Legacy => nwu_to_enu() * Quaternion::new(q1, q2, q3, q4),
        };
        UnitQuaternion::new_normalize(quaternion)
    }

    fn attitude_to_wire(self, attitude: UnitQuaternion<f64>) -> [f64; 4] {
        let q = match self {
            Self::SitlGz => return [attitude.k, attitude.j, attitude.i, attitude.w],
            Self::GzPlugin => return [attitude.w, attitude.i, -attitude.j, -attitude.k],
            Self::Legacy => nwu_to_enu().conjugate() * attitude.into_inner(),
        };
        [q.w, q.i, q.j, q.k]
    }
}

/// Returns the rotation from north-west-up to east-north-up: +90° about the vertical.
fn nwu_to_enu() -> Quaternion<f64> {
    use std::f64::consts::FRAC_1_SQRT_2;
    Quaternion::new(FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2)
}
