//! The public executable's reading of a state packet. It is written from the description of the receiver alone, without
//! the encoder that it judges.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// The size of a state packet in bytes. Longer datagrams are cut.
pub(crate) const SIZE: usize = 144;
/// Counts of the accelerometer for 1 g.
const COUNTS_PER_G: f64 = 256.0;
const STANDARD_GRAVITY: f64 = 9.80665;
/// Counts of the gyro for 1 °/s.
const COUNTS_PER_DPS: f64 = 16.4;
const DEG_PER_RAD: f64 = 57.29578;
/// The earth's magnetic field of the virtual compass, north-west-up, counts.
const FIELD_NWU: [f64; 3] = [2046.8, -71.5, -3547.2];

/// The numbers of a packet, in their order on the wire.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Packet {
    fields: [f64; 18],
}

/// The readings of the virtual sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sensors {
    /// Forward-left-up, 256 for 1 g.
    pub(crate) acc: [i32; 3],
    /// Roll to the right, nose down, anticlockwise; 16.4 for 1 °/s.
    pub(crate) gyro: [i32; 3],
    /// North-west-up field on body axes.
    pub(crate) mag: [i32; 3],
    /// Air pressure, Pa.
    pub(crate) baro_pa: i32,
    /// Body → north-west-up.
    pub(crate) attitude: UnitQuaternion<f64>,
    /// `None` if the position is off the globe.
    pub(crate) gps: Option<Gps>,
}

/// A solution of the virtual GPS.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Gps {
    /// Degrees × 10⁷.
    pub(crate) lat: i32,
    pub(crate) lon: i32,
    pub(crate) alt_cm: i32,
    pub(crate) speed_cms: i32,
    pub(crate) course_decideg: i32,
}

impl Packet {
    /// Reads a datagram. Returns `None` if it is too short.
    pub(crate) fn read(datagram: &[u8]) -> Option<Self> {
        let bytes = datagram.get(..SIZE)?;
        let mut fields = [0.0; 18];
        for (field, bytes) in fields.iter_mut().zip(bytes.chunks_exact(8)) {
            *field = f64::from_le_bytes(bytes.try_into().ok()?);
        }
        Some(Self { fields })
    }

    pub(crate) fn stamp_s(&self) -> f64 {
        self.fields[0]
    }

    /// Returns the latitude and longitude as they are on the wire, degrees.
    pub(crate) fn position(&self) -> (f64, f64) {
        (self.fields[15], self.fields[14])
    }

    /// Returns the readings of the sensors, with the position mirrored about `centre`.
    pub(crate) fn sensors(&self, centre: (f64, f64)) -> Sensors {
        let p = &self.fields;
        let acc = [p[4], p[5], p[6]].map(|value| {
            let counts = (-value * COUNTS_PER_G / STANDARD_GRAVITY).trunc();
            counts.clamp(-32767.0, 32767.0) as i32
        });
        let gyro = [p[1], -p[2], p[3]].map(|value| (value * DEG_PER_RAD * COUNTS_PER_DPS).trunc() as i32);
        let sent = Quaternion::new(p[7], p[8], -p[9], -p[10]);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
        let attitude = UnitQuaternion::from_quaternion(turn.quaternion() * sent);
        let field = attitude.inverse() * Vector3::from(FIELD_NWU);
        Sensors {
            acc,
            gyro,
            mag: [field.x, field.y, field.z].map(|value| value.round() as i32),
            baro_pa: (101_325.0 * (1.0 - 2.25577e-5 * p[16]).powf(5.25588)).trunc() as i32,
            attitude,
            gps: self.gps(centre),
        }
    }

    fn gps(&self, (lat0, lon0): (f64, f64)) -> Option<Gps> {
        let (lat, lon) = self.position();
        if lat.abs() > 90.0 || lon.abs() > 180.0 {
            return None;
        }
        let (east, north) = (self.fields[11], self.fields[12]);
        let course = (10.0 * east.atan2(north).to_degrees()).round() as i32;
        Some(Gps {
            lat: ((2.0 * lat0 - lat) * 1e7).trunc() as i32,
            lon: ((2.0 * lon0 - lon) * 1e7).trunc() as i32,
            alt_cm: (self.fields[16] * 100.0).trunc() as i32,
            speed_cms: (east.hypot(north) * 100.0).trunc() as i32,
            course_decideg: course.rem_euclid(3600),
        })
    }
}
