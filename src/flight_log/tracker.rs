//! The state of the craft while the frames of a log pass.

use nalgebra::{UnitQuaternion, Vector2, Vector3};

use super::attitude;
use super::boxes::{BoxFlags, BoxOrder};
use super::failsafe_phase::FailsafePhase;
use super::fields::{Fields, Place, read_three};
use super::place::LogHome;
use super::sample::LogSample;
use super::scale::Scales;
use crate::blackbox::FrameKind;
use crate::blackbox::decode::{FirmwareName, Frame, Header};
use crate::geo::{LatLon, LocalFrame};
use crate::signals::SimTime;

/// The ground speed from which on the course gives the heading once, m/s.
const HEADING_MPS: f64 = 3.0;
/// The longest time between two main frames over which the current is integrated, s.
const MAX_STEP_S: f64 = 1.0;
/// The bit of the state flags for a fix.
const STATE_FIX: i64 = 1 << 1;

/// The values that outlast a frame and are not frames themselves.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct TrackerState {
    /// The integrated attitude, body to the firmware's earth frame.
    attitude: Option<UnitQuaternion<f64>>,
    /// `true` once the heading was taken from a course.
    is_oriented: bool,
    /// The last sample; its values are empty.
    pub(super) sample: LogSample,
    pub(super) home: Option<LogHome>,
    /// Charge drawn, mAh.
    pub(super) drawn_mah: f64,
    pub(super) has_slow: bool,
    pub(super) has_gps: bool,
}

/// Follows the frames of one log.
#[derive(Debug, Clone)]
pub(super) struct Tracker {
    fields: Fields,
    order: BoxOrder,
    pub(super) state: TrackerState,
}

impl Tracker {
    /// Returns the tracker for a log.
    pub(super) fn from_header(header: &Header) -> Self {
        let order = match header.firmware {
            FirmwareName::Betaflight => BoxOrder::from_betaflight(header.version),
            _ => BoxOrder::UNKNOWN,
        };
        Self::new(Fields::of(header, &Scales::of(header)), order)
    }

    pub(super) fn new(fields: Fields, order: BoxOrder) -> Self {
        Self { fields, order, state: TrackerState::default() }
    }

    /// Takes a frame.
    pub(super) fn take(&mut self, frame: &Frame<'_>) {
        match frame.kind {
            FrameKind::Intra | FrameKind::Inter => self.take_main(frame),
            FrameKind::Slow => self.take_slow(frame.values),
            FrameKind::GpsHome => self.take_home(frame.values),
            FrameKind::Gps => self.take_gps(frame),
            FrameKind::Event => {}
        }
    }

    /// Takes the flags of the event that reports a change of the boxes.
    pub(super) fn take_flags(&mut self, bits: u32) {
        self.state.sample.boxes = Some(BoxFlags { bits, order: self.order });
    }

    fn take_main(&mut self, frame: &Frame<'_>) {
        let (fields, values, sample) = (&self.fields, frame.values, &mut self.state.sample);
        let read = |place: &Option<Place>| place.as_ref().and_then(|place| place.read(values));
        let step_s = SimTime(frame.time_us).seconds_since(sample.time);
        let is_first = sample.time == SimTime::ZERO;
        sample.time = SimTime(frame.time_us);
        sample.iteration = fields.iteration.and_then(|place| place.raw(values)).unwrap_or_default() as u32;
        sample.gyro_dps = read_three(fields.gyro.as_ref(), values).map(Vector3::from);
        sample.accel_mps2 = read_three(fields.accel.as_ref(), values).map(Vector3::from);
        sample.rc_command = read_three(fields.rc_command.as_ref(), values);
        sample.rc_throttle_us = read(&fields.rc_throttle);
        sample.setpoint_dps = read_three(fields.setpoint.as_ref(), values);
        sample.setpoint_throttle = read(&fields.setpoint_throttle).map(|percent| percent / 100.0);
        sample.motors = fields
            .motors
            .iter()
            .filter_map(|place| place.read(values))
            .map(|percent| percent / 100.0)
            .collect();
        sample.battery_v = read(&fields.voltage);
        sample.battery_a = read(&fields.current);
        if let Some(current_a) = sample.battery_a
            && !is_first
            && step_s <= MAX_STEP_S
        {
            self.state.drawn_mah += current_a * step_s / 3.6;
        }
        if let Some(alt_m) = read(&fields.baro_alt) {
            sample.alt = Some(alt_m);
        }
        self.take_attitude(values, if is_first { f64::INFINITY } else { step_s });
    }

    fn take_attitude(&mut self, values: &[i32], step_s: f64) {
        let TrackerState { attitude: state, sample, .. } = &mut self.state;
        let logged = read_three(self.fields.attitude.as_ref(), values);
        sample.attitude = if let Some(parts) = read_three(self.fields.quaternion.as_ref(), values) {
            Some(attitude::angles(&attitude::from_parts(parts)))
        } else if let Some([roll_deg, nose_down_deg, heading_deg]) = logged {
            let heading_deg = attitude::heading(heading_deg);
            Some(super::LogAttitude { roll_deg, pitch_deg: -nose_down_deg, heading_deg })
        } else if let Some(gyro_dps) = sample.gyro_dps {
            let after = attitude::integrated(state.as_ref(), step_s, gyro_dps, sample.accel_mps2);
            *state = Some(after);
            Some(attitude::angles(&after))
        } else {
            None
        };
    }

    fn take_slow(&mut self, values: &[i32]) {
        self.state.has_slow = true;
        let (fields, sample) = (&self.fields, &mut self.state.sample);
        let raw = |place: &Option<Place>| place.as_ref().and_then(|place| place.raw(values));
        if let Some(bits) = raw(&fields.flags) {
            sample.boxes = Some(BoxFlags { bits: bits as u32, order: self.order });
        }
        sample.gps_fix = raw(&fields.state).map(|state| state & STATE_FIX != 0);
        sample.failsafe_phase =
            raw(&fields.failsafe).and_then(|phase| FailsafePhase::from_repr(u8::try_from(phase).ok()?));
        sample.rx_signal = raw(&fields.rx_signal).map(|signal| signal != 0);
        sample.rx_channels_valid = raw(&fields.rx_valid).map(|valid| valid != 0);
    }

    fn take_home(&mut self, values: &[i32]) {
        let Some(position) = self.fields.home.and_then(|places| position(&places, values)) else { return };
        let logged = self.fields.home_alt.and_then(|place| place.read(values));
        let known = self.state.home.filter(|home| home.position == position).and_then(|home| home.alt_amsl_m);
        self.state.home = Some(LogHome { position, alt_amsl_m: logged.or(known) });
    }

    fn take_gps(&mut self, frame: &Frame<'_>) {
        self.state.has_gps = true;
        let (fields, values) = (&self.fields.gps, frame.values);
        let read = |place: &Option<Place>| place.as_ref().and_then(|place| place.read(values));
        let (has_fix, has_barometer) =
            (self.state.sample.gps_fix != Some(false), self.fields.baro_alt.is_some());
        self.state.sample.sats = read(&fields.sats).and_then(|sats| u8::try_from(sats as i64).ok());
        let is_placed = has_fix && (frame.has_home || !fields.is_relative);
        let place = fields.coordinates.filter(|_| is_placed).and_then(|places| position(&places, values));
        // The speed of a fix needs no home.
        if place.is_some() || has_fix && !is_placed {
            let sample = &mut self.state.sample;
            sample.ground_speed_mps = read(&fields.speed);
            sample.course_deg = read(&fields.course).map(attitude::heading);
            sample.climb_mps = read(&fields.sinking).map(|sinking| -sinking);
        }
        let Some(place) = place else { return };
        let alt_amsl_m = read(&fields.altitude);
        // Without a home in the log, or without its altitude, the first fix counts.
        let home = self.state.home.get_or_insert(LogHome { position: place, alt_amsl_m });
        home.alt_amsl_m = home.alt_amsl_m.or(alt_amsl_m);
        let home = *home;
        let sample = &mut self.state.sample;
        let ne = north_east(&home, place);
        (sample.position, sample.n, sample.e) = (Some(place), Some(ne.x), Some(ne.y));
        sample.alt_amsl_m = alt_amsl_m;
        if !has_barometer {
            sample.alt = alt_amsl_m.zip(home.alt_amsl_m).map(|(alt, home)| alt - home);
        }
        self.orient();
    }

    /// Turns an integrated attitude to the course, once.
    fn orient(&mut self) {
        let sample = &self.state.sample;
        let is_fast = sample.ground_speed_mps.is_some_and(|speed| speed >= HEADING_MPS);
        let (Some(attitude), Some(course_deg), true, false) =
            (&self.state.attitude, sample.course_deg, is_fast, self.state.is_oriented)
        else {
            return;
        };
        let turn_deg = course_deg - attitude::angles(attitude).heading_deg;
        self.state.attitude = Some(attitude::turned_right(attitude, turn_deg));
        self.state.is_oriented = true;
    }
}

/// Returns the place in a frame if it is on the globe and not the one of receivers without a fix.
fn position(places: &[Place; 2], values: &[i32]) -> Option<LatLon> {
    let [lat, lon] = places.each_ref().map(|place| place.raw(values));
    let position = LatLon::new(i32::try_from(lat?).ok()?, i32::try_from(lon?).ok()?);
    (position.is_on_globe() && position != LatLon::default()).then_some(position)
}

/// Returns the place north and east of home, m.
fn north_east(home: &LogHome, place: LatLon) -> Vector2<f64> {
    let frame = LocalFrame::new(
        home.position.lat_deg(),
        home.position.lon_deg(),
        home.alt_amsl_m.unwrap_or_default(),
    );
    let enu = frame.to_enu(place.lat_deg(), place.lon_deg(), 0.0);
    Vector2::new(enu.y, enu.x)
}
