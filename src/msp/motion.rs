//! Attitude, altitude, position.

use super::wire::{Reader, Writer, steps};
use crate::geo::LatLon;

/// A dilution up to this value (in 0.01) means that the receiver does not report any.
const UNREPORTED_DOP: u16 = 10;
/// The code for a fix.
const FIX: u8 = 2;

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

    pub fn encode(&self, writer: &mut Writer) {
        writer.i16(steps(self.roll_deg, 10.0));
        writer.i16(steps(-self.pitch_deg, 10.0));
        writer.i16(steps(self.heading_deg, 1.0).rem_euclid(360));
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

    pub fn encode(&self, writer: &mut Writer) {
        writer.i32(steps(self.alt_m, 100.0));
        writer.i16(steps(self.climb_mps.unwrap_or_default(), 100.0));
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

    pub fn encode(&self, writer: &mut Writer) {
        writer.u8(if self.fix { FIX } else { 0 });
        writer.u8(self.sats);
        writer.i32(self.position.lat_e7);
        writer.i32(self.position.lon_e7);
        writer.u16(steps(self.alt_amsl_m, 1.0));
        writer.u16(steps(self.ground_speed_mps, 100.0));
        writer.u16(steps(self.course_deg, 10.0).rem_euclid(3600));
        writer.u16(self.dop.map_or(i64::from(UNREPORTED_DOP), |dop| steps(dop, 100.0)));
    }
}

/// `COMP_GPS`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HomeVector {
    /// Distance to home, m, in whole metres.
    pub distance_m: f64,
    /// Direction to home, degrees clockwise from north, 0…360.
    pub bearing_deg: f64,
    /// A bit that changes with every message of the receiver.
    pub toggle: bool,
}

impl HomeVector {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let distance_m = f64::from(reader.u16()?);
        let bearing_deg = f64::from(reader.i16()?).rem_euclid(360.0);
        Some(Self { distance_m, bearing_deg, toggle: reader.u8().is_some_and(|update| update & 1 == 1) })
    }

    pub fn encode(&self, writer: &mut Writer) {
        writer.u16(steps(self.distance_m, 1.0));
        writer.i16(steps(self.bearing_deg, 1.0));
        writer.u8(u8::from(self.toggle));
    }
}
