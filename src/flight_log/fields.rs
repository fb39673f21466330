//! The places of known fields in the frames of a log.

use crate::blackbox::decode::Header;
use crate::blackbox::{Field, FrameKind};

use super::sample::MAX_MOTORS;
use super::scale::{Scale, Scales};

/// A field: its place in the frame, and its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) at: usize,
    pub(super) signed: bool,
    pub(super) scale: Scale,
}

impl Place {
    /// Returns the number in a frame.
    pub(super) fn raw(&self, values: &[i32]) -> Option<i64> {
        let bits = *values.get(self.at)?;
        Some(if self.signed { bits.into() } else { (bits as u32).into() })
    }

    /// Returns the value in a frame, in its unit.
    pub(super) fn read(&self, values: &[i32]) -> Option<f64> {
        self.raw(values).map(|raw| self.scale.apply(raw as f64))
    }
}

/// Reads three fields.
pub(super) fn read_three(places: Option<&[Place; 3]>, values: &[i32]) -> Option<[f64; 3]> {
    let [x, y, z] = places?.each_ref().map(|place| place.read(values));
    Some([x?, y?, z?])
}

/// The known fields of a log.
#[derive(Debug, Clone)]
pub(super) struct Fields {
    pub(super) iteration: Option<Place>,
    pub(super) gyro: Option<[Place; 3]>,
    pub(super) accel: Option<[Place; 3]>,
    /// x, y, z of the attitude's quaternion.
    pub(super) quaternion: Option<[Place; 3]>,
    /// Roll, pitch and heading as INAV logs them.
    pub(super) attitude: Option<[Place; 3]>,
    pub(super) rc_command: Option<[Place; 3]>,
    pub(super) rc_throttle: Option<Place>,
    pub(super) setpoint: Option<[Place; 3]>,
    pub(super) setpoint_throttle: Option<Place>,
    pub(super) motors: Vec<Place>,
    pub(super) voltage: Option<Place>,
    pub(super) current: Option<Place>,
    pub(super) baro_alt: Option<Place>,
    pub(super) flags: Option<Place>,
    pub(super) state: Option<Place>,
    pub(super) failsafe: Option<Place>,
    pub(super) rx_signal: Option<Place>,
    pub(super) rx_valid: Option<Place>,
    pub(super) gps: GpsFields,
    pub(super) home: Option<[Place; 2]>,
    pub(super) home_alt: Option<Place>,
}

/// The known fields of GPS frames.
#[derive(Debug, Clone)]
pub(super) struct GpsFields {
    pub(super) sats: Option<Place>,
    pub(super) coordinates: Option<[Place; 2]>,
    /// `true` if the coordinates are relative to home.
    pub(super) is_relative: bool,
    pub(super) altitude: Option<Place>,
    pub(super) speed: Option<Place>,
    pub(super) course: Option<Place>,
    /// Speed to the ground.
    pub(super) sinking: Option<Place>,
}

/// Finds fields of one kind of frame.
struct Finder<'a> {
    fields: &'a [Field],
    scales: &'a Scales,
}

impl Finder<'_> {
    fn one(&self, name: &str) -> Option<Place> {
        let at = self.fields.iter().position(|field| field.name == name)?;
        let field = &self.fields[at];
        Some(Place { at, signed: field.signed, scale: self.scales.scale(field).unwrap_or(Scale::RAW) })
    }

    fn several<const N: usize>(&self, name: &str) -> Option<[Place; N]> {
        let all: Vec<Place> = (0..N).map_while(|index| self.one(&format!("{name}[{index}]"))).collect();
        all.try_into().ok()
    }

    /// Returns three fields if their unit is known.
    fn measured(&self, name: &str) -> Option<[Place; 3]> {
        self.several(name).filter(|places: &[Place; 3]| !places[0].scale.unit.is_empty())
    }
}

impl Fields {
    pub(super) fn of(header: &Header, scales: &Scales) -> Self {
        let finder = |kind| Finder { fields: header.fields(kind), scales };
        let (main, slow, gps, home) = (
            finder(FrameKind::Intra),
            finder(FrameKind::Slow),
            finder(FrameKind::Gps),
            finder(FrameKind::GpsHome),
        );
        Self {
            iteration: main.one("loopIteration"),
            gyro: main.several("gyroADC"),
            accel: main.measured("accSmooth"),
            quaternion: main.several("imuQuaternion"),
            attitude: main.several("attitude"),
            rc_command: main.several("rcCommand"),
            rc_throttle: main.one("rcCommand[3]"),
            setpoint: main.several("setpoint"),
            setpoint_throttle: main.one("setpoint[3]"),
            motors: (0..MAX_MOTORS).map_while(|index| main.one(&format!("motor[{index}]"))).collect(),
            voltage: main.one("vbatLatest").or_else(|| main.one("vbat")),
            current: main.one("amperageLatest").or_else(|| main.one("amperage")),
            baro_alt: main.one("baroAlt").or_else(|| main.one("BaroAlt")),
            flags: slow.one("flightModeFlags"),
            state: slow.one("stateFlags"),
            failsafe: slow.one("failsafePhase"),
            rx_signal: slow.one("rxSignalReceived"),
            rx_valid: slow.one("rxFlightChannelsValid"),
            gps: GpsFields {
                sats: gps.one("GPS_numSat"),
                coordinates: gps.several("GPS_coord"),
                is_relative: header.fields(FrameKind::Gps).iter().any(is_relative),
                altitude: gps.one("GPS_altitude"),
                speed: gps.one("GPS_speed"),
                course: gps.one("GPS_ground_course"),
                sinking: gps.one("GPS_velned[2]"),
            },
            home: home.several("GPS_home"),
            home_alt: home.one("GPS_home[2]"),
        }
    }
}

fn is_relative(field: &Field) -> bool {
    field.predictor == crate::blackbox::Predictor::HomeCoordinate
}
