//! Attitude, altitude, position.

use super::reader::Reader;
use crate::geo::LatLon;

/// A dilution up to this value (in 0.01) means that the receiver does not report any.
const UNREPORTED_DOP: u16 = 10;

/// `ATTITUDE`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Roll, degrees, right positive.
    pub roll_deg: f64,
    /// Pitch, degrees, nose **up** positive.
    pub pitch_deg: f64,
    /// Heading, degrees clockwise from north, 0…360.
    pub heading_deg: f64,
}

impl Attitude {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        Some(Self {
            roll_deg: f64::from(reader.i16()?) / 10.0,
            // Nose down is positive on the wire.
            pitch_deg: -f64::from(reader.i16()?) / 10.0,
            heading_deg: f64::from(reader.i16()?).rem_euclid(360.0),
        })
    }
}

/// `ALTITUDE`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Altitude {
    /// The altitude above the arming point, m. A flight controller that was never armed may use another
    /// reference.
    pub alt_m: f64,
    /// Climb rate, m/s.
    pub climb_mps: Option<f64>,
}

impl Altitude {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let alt_m = f64::from(reader.i32()?) / 100.0;
        Some(Self { alt_m, climb_mps: reader.i16().map(|climb| f64::from(climb) / 100.0) })
    }
}

/// `RAW_GPS`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RawGps {
    /// A 3-D fix.
    pub fix: bool,
    pub sats: u8,
    /// The position; outdated without a fix.
    pub position: LatLon,
    /// The altitude above mean sea level, m, in whole metres, not below 0.
    pub alt_amsl_m: f64,
    /// Speed over ground, m/s.
    pub ground_speed_mps: f64,
    /// Course over ground, degrees clockwise from north.
    pub course_deg: f64,
    /// The dilution of precision, if reported.
    pub dop: Option<f64>,
}

impl RawGps {
    /// Decodes the message. Returns `None` also for a position that is not on the globe.
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let gps = Self {
            fix: reader.u8()? != 0,
            sats: reader.u8()?,
            position: LatLon::new(reader.i32()?, reader.i32()?),
            alt_amsl_m: f64::from(reader.u16()?),
            ground_speed_mps: f64::from(reader.u16()?) / 100.0,
            course_deg: f64::from(reader.u16()?) / 10.0,
            dop: reader.u16().filter(|dop| *dop > UNREPORTED_DOP).map(|dop| f64::from(dop) / 100.0),
        };
        gps.position.is_on_globe().then_some(gps)
    }
}

/// `COMP_GPS`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HomeVector {
    /// Distance to home, m, in whole metres.
    pub distance_m: f64,
    /// Direction to home, degrees clockwise from north, 0…360.
    pub bearing_deg: f64,
}

impl HomeVector {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let distance_m = f64::from(reader.u16()?);
        Some(Self { distance_m, bearing_deg: f64::from(reader.i16()?).rem_euclid(360.0) })
    }
}
