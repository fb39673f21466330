//! Everything that a flight controller has reported, combined.

use super::mode_ranges;
use crate::geo::{LatLon, local_offset, offset_to_latlon};
use crate::math;
use crate::msp::{Altitude, Attitude, BatteryReading, Channels, HomeVector, Motors, RawGps, Status, code};
use crate::signals::{PerMotor, RC_CHANNELS};
use crate::telemetry::snapshot::{CraftView, EstimateView, GpsView, ModeRange};
use crate::telemetry::{ArmingFlag, ArmingFlags, Mode};

/// The reference point of the display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    pub position: LatLon,
    /// The altitude above mean sea level, m.
    pub alt_amsl_m: f64,
}

/// The vertical speed below which an altitude at rest is steady, m/s.
const STEADY_MPS: f64 = 1.0;
/// The number of steady reports in a row after which the estimate of the altitude has settled.
const STEADY_REPORTS: u8 = 10;

/// The difference from the altitude of the GPS from which an altitude at rest is wrong, m.
const CONTRADICTION_M: f64 = 10.0;

/// The newest values of every message.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Observation {
    box_ids: Vec<u8>,
    ranges: Option<Vec<u8>>,
    range_links: Option<Vec<u8>>,
    status: Option<Status>,
    attitude: Option<Attitude>,
    altitude: Option<Altitude>,
    /// The number of steady reports of the altitude in a row, up to [`STEADY_REPORTS`], which is then kept.
    steady_reports: u8,
    gps: Option<RawGps>,
    home_vector: Option<HomeVector>,
    home: Option<LatLon>,
    battery: Option<BatteryReading>,
    channels: Option<[u16; RC_CHANNELS]>,
    motors: Option<PerMotor>,
}

impl Observation {
    /// Takes a reply and returns `true` if it was readable. An unreadable reply changes nothing.
    pub fn take(&mut self, code: u16, payload: &[u8]) -> bool {
        match code {
            code::BOXIDS => keep(&mut self.box_ids, Some(payload.to_vec())),
            code::MODE_RANGES => keep(&mut self.ranges, Some(Some(payload.to_vec()))),
            code::MODE_RANGES_EXTRA => keep(&mut self.range_links, Some(Some(payload.to_vec()))),
            code::STATUS_EX => self.take_status(Status::decode(payload)),
            code::ATTITUDE => keep(&mut self.attitude, Attitude::decode(payload).map(Some)),
            code::ALTITUDE => self.take_altitude(Altitude::decode(payload)),
            code::RAW_GPS => keep(&mut self.gps, RawGps::decode(payload).map(Some)),
            code::COMP_GPS => keep(&mut self.home_vector, HomeVector::decode(payload).map(Some)),
            code::BATTERY_STATE => keep(&mut self.battery, BatteryReading::decode(payload).map(Some)),
            code::RC => keep(
                &mut self.channels,
                Channels::decode(payload).map(|channels| Some(channels.of_transmitter())),
            ),
            code::MOTOR => {
                keep(&mut self.motors, Motors::decode(payload).map(|motors| Some(motors.outputs())))
            }
            _ => false,
        }
    }

    fn take_altitude(&mut self, altitude: Option<Altitude>) -> bool {
        let is_steady = altitude
            .as_ref()
            .is_some_and(|altitude| altitude.climb_mps.is_none_or(|climb| climb.abs() < STEADY_MPS));
        if !self.altitude_has_settled() {
            self.steady_reports = if is_steady { self.steady_reports + 1 } else { 0 };
        }
        keep(&mut self.altitude, altitude.map(Some))
    }

    /// Returns `true` once the altitude is more than the start of an estimate: it was steady for some time, or the craft was
    /// armed. The estimator of a simulated craft begins at sea level, and climbs to the altitude of the GPS at more than
    /// 200 m/s.
    pub fn altitude_has_settled(&self) -> bool {
        self.steady_reports >= STEADY_REPORTS
    }

    /// Takes a status. Home is the position at which the craft is armed. For a craft that already flew, it is
    /// the point that the flight controller's home vector gives.
    fn take_status(&mut self, status: Option<Status>) -> bool {
        let before = self.armed();
        let is_read = keep(&mut self.status, status.map(Some));
        if self.armed() == Some(true) {
            self.steady_reports = STEADY_REPORTS;
        }
        if before == Some(false) && self.armed() == Some(true) {
            self.home = self.gps.filter(|gps| gps.fix).map(|gps| gps.position);
        }
        if self.home.is_none() && self.armed() == Some(true) {
            self.home = self.gps.zip(self.home_vector).filter(|(gps, _)| gps.fix).map(|(gps, vector)| {
                let (sin, cos) = math::sin_cos(vector.bearing_deg.to_radians());
                offset_to_latlon(gps.position, vector.distance_m * nalgebra::Vector2::new(cos, sin))
            });
        }
        is_read
    }

    /// Returns `true` if the craft is armed; `None` if that is unknown.
    pub fn armed(&self) -> Option<bool> {
        self.status.and_then(|status| status.is_armed(&self.box_ids))
    }

    /// Returns `true` if a mode is known to be active.
    pub fn is_active(&self, mode: Mode) -> bool {
        self.status.is_some_and(|status| status.modes(&self.box_ids).has(mode))
    }

    /// Returns `true` once the channels are known.
    pub fn has_channels(&self) -> bool {
        self.channels.is_some()
    }

    /// Returns the newest GPS data.
    pub fn gps(&self) -> Option<&RawGps> {
        self.gps.as_ref()
    }

    /// Returns the conditions of the modes.
    pub fn mode_ranges(&self) -> Option<Vec<ModeRange>> {
        self.ranges.as_deref().map(|ranges| mode_ranges(ranges, self.range_links.as_deref()))
    }

    /// Returns the state of the craft as far as the flight controller has reported it: modes, arming, GPS, home,
    /// receiver, motors and battery.
    pub fn craft_view(&self) -> CraftView {
        let armed = self.armed();
        let flags = self.status.and_then(|status| status.arming_blocked_by);
        let has_rx_loss = flags.map(|flags| flags.has(ArmingFlag::RxLoss));
        let in_failsafe = self.is_active(Mode::Failsafe);
        let battery = self.battery.filter(BatteryReading::is_present);
        CraftView {
            armed,
            modes: self.status.map(|status| status.modes(&self.box_ids)),
            arming_blocked_by: if armed == Some(true) { flags.and(Some(ArmingFlags::NONE)) } else { flags },
            gps_fix: self.gps.map(|gps| gps.fix),
            gps: self.gps.filter(|gps| gps.fix || gps.position != LatLon::default()).map(gps_view),
            sats: self.gps.map(|gps| gps.sats),
            home: self.home,
            battery_v: battery.map(|battery| battery.voltage_v).filter(|voltage_v| *voltage_v > 0.0),
            battery_a: battery.map(|battery| battery.current_a),
            battery_mah: battery.map(|battery| battery.drawn_mah),
            battery_cells: battery.and_then(|battery| battery.cells),
            motors: self.motors,
            channels: self.channels,
            rc_link: has_rx_loss.map(|is_lost| !is_lost && !in_failsafe),
            failsafe_stage: has_rx_loss.map(|is_lost| match (in_failsafe, is_lost && armed == Some(true)) {
                (true, _) => 2,
                (false, true) => 1,
                (false, false) => 0,
            }),
            mode_ranges: self.mode_ranges(),
            ..CraftView::default()
        }
    }

    /// Returns the distance from home, m; `None` before the first arming, which sets home.
    pub fn home_distance_m(&self) -> Option<f64> {
        self.home_vector.filter(|_| self.home.is_some()).map(|vector| vector.distance_m)
    }

    /// Returns the position of the craft.
    pub fn position(&self) -> Option<LatLon> {
        self.gps.filter(|gps| gps.fix).map(|gps| gps.position)
    }

    /// Returns the flight controller's estimate of the craft's motion. Positions are relative to `origin` and
    /// unknown without it.
    pub fn estimate_view(&self, origin: Option<Origin>) -> EstimateView {
        let fix = self.gps.filter(|gps| gps.fix);
        let offset = fix.zip(origin).map(|(gps, origin)| local_offset(origin.position, gps.position));
        EstimateView {
            n: offset.map(|offset| offset.x),
            e: offset.map(|offset| offset.y),
            alt: self.altitude.map(|altitude| self.above_origin(altitude.alt_m, origin)),
            ground_speed_mps: fix.map(|gps| gps.ground_speed_mps),
            climb_mps: self.altitude.and_then(|altitude| altitude.climb_mps),
            roll_deg: self.attitude.map(|attitude| attitude.roll_deg),
            pitch_deg: self.attitude.map(|attitude| attitude.pitch_deg),
            heading_deg: self.attitude.map(|attitude| attitude.heading_deg),
            ..EstimateView::default()
        }
    }

    /// Returns `false` if the altitude of a disarmed craft contradicts that of its GPS. A flight controller that is disarmed in
    /// the air may begin to count there.
    pub fn altitude_agrees_with_gps(&self, origin: Option<Origin>) -> bool {
        let (Some(altitude), Some(gps), Some(origin)) = (&self.altitude, self.gps, origin) else {
            return true;
        };
        let of_gps_m = gps.alt_amsl_m - origin.alt_amsl_m;
        let differs = (self.above_origin(altitude.alt_m, Some(origin)) - of_gps_m).abs() > CONTRADICTION_M;
        !(gps.fix && self.armed() == Some(false) && differs)
    }

    /// Returns an altitude above the origin. Before its first arming a flight controller reports the altitude
    /// above sea level; the reference that agrees better with the GPS altitude is used.
    fn above_origin(&self, alt_m: f64, origin: Option<Origin>) -> f64 {
        let (Some(gps), Some(origin)) = (self.gps.filter(|gps| gps.fix), origin) else { return alt_m };
        let from_sea_level = (alt_m - gps.alt_amsl_m).abs();
        let from_origin = (alt_m - (gps.alt_amsl_m - origin.alt_amsl_m)).abs();
        let is_amsl = self.armed() != Some(true) && from_sea_level < from_origin;
        if is_amsl { alt_m - origin.alt_amsl_m } else { alt_m }
    }
}

/// Stores a value that was read. Returns `false` if there was none.
fn keep<T>(place: &mut T, read: Option<T>) -> bool {
    read.is_some_and(|read| {
        *place = read;
        true
    })
}

fn gps_view(gps: RawGps) -> GpsView {
    GpsView { position: gps.position, alt_amsl_m: gps.alt_amsl_m, ground_speed_mps: gps.ground_speed_mps }
}
