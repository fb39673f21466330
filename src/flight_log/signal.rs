//! The named numbers of a log.

use super::fields::Place;
use super::sample::LogSample;
use super::scale::{Scale, Scales};
use super::tracker::TrackerState;
use crate::blackbox::FrameKind;
use crate::blackbox::decode::Header;
use crate::math;

/// A number of a log that changes in flight.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogSignal {
    /// The written name: of a derived signal that of `telemetry`'s signals or a similar one, of a field that of the header,
    /// for example `gyroADC[0]`.
    pub name: String,
    /// The unit, for example `°/s`; empty for a number without a unit, and for a field with an unknown one.
    pub unit: &'static str,
    /// The digits after the point that the log resolves; of a derived signal those that make sense.
    pub decimals: u8,
    /// The frame that has the field; `None` if the value is derived.
    pub frame: Option<SignalFrame>,
    /// `true` if the values rest on something that the header lacks, so that it is assumed.
    pub is_assumed: bool,
}

/// The digits after the point of derived signals.
const DERIVED_DECIMALS: u8 = 3;

/// The kinds of frames with fields that change in flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignalFrame {
    Main,
    Slow,
    Gps,
}

/// The smallest and the greatest value in a part of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    pub min: f64,
    pub max: f64,
}

impl Extent {
    /// Contains no value.
    pub(super) const NONE: Self = Self { min: f64::INFINITY, max: f64::NEG_INFINITY };

    /// Widens the extent to a value; NaN changes nothing.
    pub(super) fn include(&mut self, value: f64) {
        self.min = self.min.min(value);
        self.max = self.max.max(value);
    }

    /// Widens the extent to another one.
    pub(super) fn merge(&mut self, other: Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// Returns the extent if it contains a value.
    pub(super) fn known(self) -> Option<Self> {
        (self.min <= self.max).then_some(self)
    }
}

/// Reads a derived value; it is given the charge drawn, mAh.
type Derived = fn(&LogSample, f64) -> Option<f64>;

/// The fields that give the attitude.
const ATTITUDE: &[&str] = &["imuQuaternion", "attitude", "gyroADC"];

/// The derived signals: name, unit, the fields of which the first one that a log has is their source, and how to read them.
const DERIVED: &[(&str, &str, &[&str], Derived)] = &[
    ("roll", "°", ATTITUDE, |sample, _| sample.attitude.map(|attitude| attitude.roll_deg)),
    ("pitch", "°", ATTITUDE, |sample, _| sample.attitude.map(|attitude| attitude.pitch_deg)),
    ("heading", "°", ATTITUDE, |sample, _| sample.attitude.map(|attitude| attitude.heading_deg)),
    ("north", "m", &["GPS_coord"], |sample, _| sample.n),
    ("east", "m", &["GPS_coord"], |sample, _| sample.e),
    ("altitude", "m", &["baroAlt", "BaroAlt", "GPS_altitude"], |sample, _| sample.alt),
    ("home_distance", "m", &["GPS_coord"], |sample, _| Some(math::hypot(sample.n?, sample.e?))),
    ("speed", "m/s", &["GPS_speed"], |sample, _| sample.ground_speed_mps),
    ("climb", "m/s", &["GPS_velned"], |sample, _| sample.climb_mps),
    ("course", "°", &["GPS_ground_course"], |sample, _| sample.course_deg),
    ("satellites", "", &["GPS_numSat"], |sample, _| sample.sats.map(f64::from)),
    ("battery", "V", &["vbat"], |sample, _| sample.battery_v),
    ("current", "A", &["amperage"], |sample, _| sample.battery_a),
    ("charge", "mAh", &["amperage"], |sample, drawn_mah| sample.battery_a.map(|_| drawn_mah)),
];

/// The source of a signal.
#[derive(Debug, Clone, Copy)]
enum Source {
    Derived(Derived),
    Field(FrameKind, Place),
}

impl Source {
    /// Returns the value, if it is known.
    fn read(&self, newest: &Newest<'_>) -> Option<f64> {
        match self {
            Self::Derived(read) => read(&newest.state.sample, newest.state.drawn_mah),
            Self::Field(FrameKind::Slow, place) => place.read(newest.slow).filter(|_| newest.state.has_slow),
            Self::Field(FrameKind::Gps, place) => place.read(newest.gps).filter(|_| newest.state.has_gps),
            Self::Field(_, place) => place.read(newest.main),
        }
    }
}

/// The newest values of a log.
#[derive(Debug, Clone, Copy)]
pub(super) struct Newest<'a> {
    pub(super) main: &'a [i32],
    pub(super) slow: &'a [i32],
    pub(super) gps: &'a [i32],
    pub(super) state: &'a TrackerState,
}

/// The signals of a log, and how to read them.
#[derive(Debug, Clone)]
pub(super) struct SignalTable {
    pub(super) signals: Vec<LogSignal>,
    sources: Vec<Source>,
}

impl SignalTable {
    pub(super) fn of(header: &Header, scales: &Scales) -> Self {
        let mut table = Self { signals: Vec::new(), sources: Vec::new() };
        for (name, unit, _, read) in DERIVED {
            let (name, decimals) = ((*name).to_owned(), DERIVED_DECIMALS);
            table.signals.push(LogSignal { name, unit, decimals, frame: None, is_assumed: false });
            table.sources.push(Source::Derived(*read));
        }
        let kinds = [
            (FrameKind::Intra, SignalFrame::Main),
            (FrameKind::Slow, SignalFrame::Slow),
            (FrameKind::Gps, SignalFrame::Gps),
        ];
        for (kind, frame) in kinds {
            for (at, field) in header.fields(kind).iter().enumerate() {
                let scale = scales.scale(field).unwrap_or(Scale::RAW);
                // The main frames have a time, too.
                let name = match (frame, field.name.as_str()) {
                    (SignalFrame::Gps, "time") => "GPS_time",
                    (_, name) => name,
                };
                table.signals.push(LogSignal {
                    name: name.to_owned(),
                    unit: scale.unit,
                    decimals: scale.decimals(),
                    frame: Some(frame),
                    is_assumed: scales.is_assumed(kind, field),
                });
                table.sources.push(Source::Field(kind, Place { at, signed: field.signed, scale }));
            }
        }
        let (derived, fields) = table.signals.split_at_mut(DERIVED.len());
        for (signal, (_, _, sources, _)) in derived.iter_mut().zip(DERIVED) {
            let source = |prefix: &&str| fields.iter().find(|field| field.name.starts_with(*prefix));
            signal.is_assumed = sources.iter().find_map(source).is_some_and(|field| field.is_assumed);
        }
        table
    }

    /// Returns the place of the signal with this name.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.signals.iter().position(|signal| signal.name == name)
    }

    /// Returns the value of a signal, if it is known.
    pub(super) fn read(&self, signal: usize, newest: &Newest<'_>) -> Option<f64> {
        self.sources.get(signal)?.read(newest)
    }

    /// Returns the values of all signals; NaN for an unknown one.
    pub(super) fn values(&self, newest: Newest<'_>) -> impl Iterator<Item = f64> {
        self.sources.iter().map(move |source| source.read(&newest).unwrap_or(f64::NAN))
    }

    /// Widens the extents of the signals that change with a frame of this kind.
    pub(super) fn widen(&self, kind: FrameKind, newest: &Newest<'_>, extents: &mut [Extent]) {
        let is_main = matches!(kind, FrameKind::Intra | FrameKind::Inter);
        for (signal, (source, extent)) in self.sources.iter().zip(extents).enumerate() {
            let changes = match source {
                Source::Derived(_) => true,
                Source::Field(FrameKind::Intra, _) => is_main,
                Source::Field(of, _) => *of == kind,
            };
            if changes && let Some(value) = self.read(signal, newest) {
                extent.include(value);
            }
        }
    }
}
