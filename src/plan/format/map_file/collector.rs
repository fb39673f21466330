//! The place where the readers of maps deliver: features, notes and problems, within limits.

use std::ops::Range;

use crate::plan::feature::{Shape, Vertex};
use crate::plan::format::Problems;
use crate::plan::format::bounds::{self, altitude_m};
use crate::plan::format::loss::Place;
use crate::text::did_you_mean;

/// The keys of properties that are kept.
const KEYS: &[&str] = &[
    "type",
    "lat_deg",
    "lon_deg",
    "alt_m",
    "alt_amsl_m",
    "speed_mps",
    "yaw_rate_dps",
    "duration_s",
    "pattern",
    "betadeck",
    "setting",
    "description",
    "featureType",
    "sequenceNumber",
    "altitudeRelative",
    "altitudeMode",
    "command",
    "zone",
    "inclusion",
];

/// The words for `zone`: a no-fly zone, and one that must not be left.
const ZONES: [&str; 2] = ["exclusion", "inclusion"];

/// Limits for a file.
#[derive(Debug, Clone, Copy)]
pub(in crate::plan::format) struct Limits {
    pub(in crate::plan::format) features: usize,
    pub(in crate::plan::format) vertices: usize,
    pub(in crate::plan::format) problems: usize,
    /// The properties of single route points are needed.
    pub(in crate::plan::format) is_plan: bool,
}

/// The reference of the altitudes of a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::plan::format) enum Altitudes {
    /// On the ground: the numbers have no meaning.
    Clamped,
    AboveGround,
    AboveSeaLevel,
}

impl Altitudes {
    /// Returns the reference of an altitude mode of KML.
    pub(super) fn from_mode(mode: &str) -> Option<Self> {
        match mode {
            "absolute" => Some(Self::AboveSeaLevel),
            "relativeToGround" | "relativeToSeaFloor" => Some(Self::AboveGround),
            "clampToGround" | "clampToSeaFloor" => Some(Self::Clamped),
            _ => None,
        }
    }
}

/// The kind of a piece in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::plan::format) enum Kind {
    Point,
    /// A line, or a route.
    Line,
    /// A recorded flight.
    Track,
    Area,
}

/// The known properties of a feature or of a point of a route.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(in crate::plan::format) struct Properties(Vec<(String, String)>);

impl Properties {
    /// Adds a property if its key is a known one.
    pub(in crate::plan::format) fn add(&mut self, key: &str, value: String) {
        if KEYS.contains(&key) {
            self.0.push((key.to_owned(), value));
        }
    }

    /// Returns the first value of a key.
    pub(in crate::plan::format) fn get(&self, key: &str) -> Option<&str> {
        self.all(key).next()
    }

    /// Returns all values of a key.
    pub(in crate::plan::format) fn all<'s>(&'s self, key: &str) -> impl Iterator<Item = &'s str> {
        self.0.iter().filter(move |(known, _)| known == key).map(|(_, value)| value.as_str())
    }
}

/// Name and properties of a point of a route.
#[derive(Debug, Clone, Default)]
pub(in crate::plan::format) struct Detail {
    pub(in crate::plan::format) name: String,
    pub(in crate::plan::format) properties: Properties,
    pub(in crate::plan::format) at: usize,
}

/// A shape of a feature.
#[derive(Debug, Clone)]
pub(in crate::plan::format) struct Piece {
    pub(in crate::plan::format) kind: Kind,
    pub(in crate::plan::format) altitudes: Altitudes,
    pub(in crate::plan::format) shape: Shape,
}

/// A feature of a file.
#[derive(Debug, Clone, Default)]
pub(in crate::plan::format) struct MapFeature {
    pub(in crate::plan::format) name: String,
    pub(in crate::plan::format) properties: Properties,
    pub(in crate::plan::format) pieces: Vec<Piece>,
    /// The points of a route of a plan; empty for any other feature.
    pub(in crate::plan::format) details: Vec<Detail>,
    pub(in crate::plan::format) place: Option<Place>,
    /// The first byte in the text; 0 in JSON.
    pub(in crate::plan::format) at: usize,
    /// A longitude beyond ±180° was wrapped.
    pub(in crate::plan::format) is_wrapped: bool,
}

/// A part of a file that is no feature and not read, such as a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::plan::format) struct Skipped {
    pub(in crate::plan::format) name: &'static str,
    pub(in crate::plan::format) count: usize,
    /// The first byte of the first.
    pub(in crate::plan::format) at: usize,
}

/// Collects what a reader finds.
pub(in crate::plan::format) struct Collector<'c, 'a> {
    pub(super) problems: &'c mut Problems<'a>,
    pub(super) limits: Limits,
    take: &'c mut dyn FnMut(MapFeature),
    features: usize,
    pub(super) counter: Counter,
    /// A limit was reached: nothing is read any more.
    is_over: bool,
    /// The name of the document.
    pub(in crate::plan::format) name: String,
    /// The description of the document.
    pub(in crate::plan::format) description: String,
    /// The properties of the document.
    pub(in crate::plan::format) properties: Properties,
    pub(in crate::plan::format) skipped: Vec<Skipped>,
}

impl<'c, 'a> Collector<'c, 'a> {
    /// Creates a collector that passes each feature to `take`.
    pub(in crate::plan::format) fn new(
        problems: &'c mut Problems<'a>,
        limits: Limits,
        take: &'c mut dyn FnMut(MapFeature),
    ) -> Self {
        Self {
            problems,
            limits,
            take,
            features: 0,
            counter: Counter { left: limits.vertices + 1, most: limits.vertices, is_wrapped: false },
            is_over: false,
            name: String::new(),
            description: String::new(),
            properties: Properties::default(),
            skipped: Vec::new(),
        }
    }

    /// Returns `true` if nothing is read any more.
    pub(super) fn is_over(&self) -> bool {
        self.is_over
            || self.counter.left == 0
            || self.problems.is_full()
            || self.problems.len() >= self.limits.problems
    }

    /// Adds a problem and ends the reading.
    pub(super) fn give_up(&mut self, span: Range<usize>, message: String, hint: &str) {
        if !std::mem::replace(&mut self.is_over, true) {
            self.problems.add(span, message, hint);
        }
    }

    /// Counts a part that is not read.
    pub(super) fn skip(&mut self, name: &'static str, at: usize) {
        match self.skipped.iter_mut().find(|skipped| skipped.name == name) {
            Some(skipped) => skipped.count += 1,
            None => self.skipped.push(Skipped { name, count: 1, at }),
        }
    }

    /// Passes a feature on. Its shapes count as one feature each.
    ///
    /// # Errors
    ///
    /// Returns the message if there are too many.
    pub(super) fn feature(&mut self, mut feature: MapFeature) -> Result<(), String> {
        self.features += feature.pieces.len().max(1);
        if self.features > self.limits.features {
            return Err(format!("the file has more than {} shapes", self.limits.features));
        }
        feature.is_wrapped = std::mem::take(&mut self.counter.is_wrapped);
        if !self.limits.is_plan {
            self.check_zone(&feature);
        }
        (self.take)(feature);
        Ok(())
    }

    /// Reports a slip in the word for a zone: the area would be an outline that nothing keeps out of. Other words are
    /// the data of other programs.
    fn check_zone(&mut self, feature: &MapFeature) {
        let Some(word) = feature.properties.get("zone").map(str::trim) else { return };
        let is_known = ZONES.iter().any(|zone| zone.eq_ignore_ascii_case(word));
        if is_known || did_you_mean::closest(word, ZONES).is_none() {
            return;
        }
        let unknown = format!("zone {word} is not known{}", did_you_mean::suffix(word, ZONES));
        let message = match &feature.place {
            Some(Place::Pointer { pointer }) => format!("{pointer}: {unknown}"),
            _ => unknown,
        };
        self.problems.add(feature.at..feature.at + 1, message, format!("allowed: {}", ZONES.join(", ")));
    }
}

/// Counts and checks vertices.
#[derive(Debug)]
pub(super) struct Counter {
    left: usize,
    most: usize,
    /// A longitude of the present feature was wrapped.
    is_wrapped: bool,
}

impl Counter {
    /// Returns the number of vertices that may still come.
    pub(super) fn left(&self) -> usize {
        self.left
    }

    /// Checks the numbers of a vertex and counts it. An altitude of `None` is not given.
    ///
    /// # Errors
    ///
    /// Returns the message for a number out of range, and for one vertex too many.
    pub(super) fn vertex(
        &mut self,
        lat_deg: f64,
        lon_deg: f64,
        altitude: Option<f64>,
    ) -> Result<Vertex, String> {
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            return Err(format!("the file has more than {} points", self.most));
        }
        let (position, is_wrapped) = bounds::position(lat_deg, lon_deg)?;
        self.is_wrapped |= is_wrapped;
        let altitude_m = altitude.map(altitude_m).transpose()?.map_or(f32::NAN, |metres| metres as f32);
        Ok(Vertex { position, altitude_m })
    }
}

/// Adds to a list that may become long. It grows by a quarter, because doubling could take more than the limit.
pub(super) fn push<T>(list: &mut Vec<T>, item: T) {
    if list.len() == list.capacity() {
        list.reserve_exact((list.len() / 4).max(4));
    }
    list.push(item);
}
