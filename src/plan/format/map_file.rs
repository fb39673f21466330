//! Files of maps: KML, KMZ, GPX and GeoJSON. Their readers pass each feature on as soon as it is read, so a file of
//! 64 MiB takes little more memory than its vertices. Plans and backdrops are made from the same features.

mod collector;
mod coordinates;
mod geojson;
mod gpx;
mod kml;
pub(super) mod kmz;
mod positions;

use super::bounds::MAX_ITEMS;
use super::encoding;
use super::{PlanError, Problems};
use crate::plan::feature::{Feature, Shape, Zone};

pub(super) use collector::{Altitudes, Collector, Kind, Limits, MapFeature, Piece, Properties, Skipped};
pub(super) use geojson::is_geojson;

/// The largest text of a backdrop in a KMZ, bytes.
const MAX_UNPACKED: usize = 64 << 20;
/// The largest text of a plan in a KMZ, bytes.
const MAX_PLAN: usize = 8 << 20;

/// The most problems of a map that are listed. A map of 64 MiB with a fault in each vertex has one fault for people.
const MAX_PROBLEMS: usize = 10;

/// The most characters of a name that are shown on a map. Each shape of a feature has a copy of its name.
const MAX_NAME: usize = 60;

/// The limits of a plan.
pub(super) const PLAN: Limits =
    Limits { features: MAX_ITEMS, vertices: 1_000_000, problems: usize::MAX, is_plan: true };

/// The limits of a backdrop.
const BACKDROP: Limits =
    Limits { features: 100_000, vertices: 5_000_000, problems: MAX_PROBLEMS, is_plan: false };

/// The kind of a map file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MapKind {
    Kml,
    Gpx,
    GeoJson,
}

impl MapKind {
    /// Returns the kind of a text by its first element or its first key.
    pub(super) fn from_text(text: &str) -> Option<Self> {
        let text = text.trim_start();
        if text.starts_with('{') {
            return Some(Self::GeoJson);
        }
        match root_element(text)? {
            "kml" => Some(Self::Kml),
            "gpx" => Some(Self::Gpx),
            _ => None,
        }
    }

    /// Reads a text and passes its features to the collector.
    pub(super) fn read(self, text: &str, collector: &mut Collector<'_, '_>) {
        match self {
            Self::Kml => kml::read(text, collector),
            Self::Gpx => gpx::read(text, collector),
            Self::GeoJson => geojson::read(text, collector),
        }
    }
}

/// Returns the contents of a file of a plan: those of the document if it is an archive.
///
/// # Errors
///
/// Returns the reason why the archive cannot be read.
pub(super) fn unpacked_plan(contents: &[u8]) -> Result<Vec<u8>, String> {
    kmz::unpacked(contents, MAX_PLAN)
}

/// Returns the local name of the first element of an XML text, or that in its document type. Does not read further.
pub(super) fn root_element(text: &str) -> Option<&str> {
    let mut rest = text.trim_start();
    loop {
        let inside = rest.strip_prefix('<')?;
        let end = match inside.as_bytes().first()? {
            b'?' => "?>",
            b'!' if inside.starts_with("!--") => "-->",
            b'!' => return inside.strip_prefix("!DOCTYPE")?.split_whitespace().next(),
            _ => {
                let name = inside.split(|c: char| c.is_whitespace() || matches!(c, '>' | '/')).next()?;
                return Some(name.rsplit(':').next().unwrap_or(name));
            }
        };
        rest = inside[inside.find(end)? + end.len()..].trim_start();
    }
}

/// Reads the shapes of a GeoJSON, KML, KMZ or GPX file for the backdrop of a map. Its contents give the format; `name`
/// begins the messages.
///
/// # Errors
///
/// Returns the problems of the file, in the order of their places.
pub fn read_features(name: &str, contents: &[u8]) -> Result<Vec<Feature>, Vec<PlanError>> {
    let refused = |message: String, hint: &str| {
        let mut problems = Problems::new(name, "");
        problems.add(0..0, message, hint);
        problems.into_errors()
    };
    let archived;
    let contents = if kmz::is_archive(contents) {
        archived = kmz::unpacked(contents, MAX_UNPACKED)
            .map_err(|message| refused(message, "this KMZ cannot be read"))?;
        archived.as_slice()
    } else {
        contents
    };
    let text = encoding::decode(contents).map_err(|message| refused(message, "a map is a text file"))?;
    if super::qgc_plan::is_plan(&text) {
        return Ok(super::qgc_fences(&text));
    }
    let Some(kind) = MapKind::from_text(&text) else {
        let message = "this is none of GeoJSON, KML, KMZ and GPX";
        return Err(refused(message.to_owned(), "a map is a file of one of these formats"));
    };
    let mut problems = Problems::new(name, &text);
    let mut features = Vec::new();
    let mut take = |feature: MapFeature| add_shapes(feature, &mut features);
    kind.read(&text, &mut Collector::new(&mut problems, BACKDROP, &mut take));
    let errors = problems.into_errors();
    if errors.is_empty() { Ok(features) } else { Err(errors) }
}

/// Adds the shapes of a feature of a file.
fn add_shapes(feature: MapFeature, features: &mut Vec<Feature>) {
    let zone = zone(&feature.properties);
    let name: String = feature.name.chars().take(MAX_NAME).collect();
    for piece in feature.pieces {
        let shape = match piece.shape {
            Shape::Line(mut line) if zone.is_some() && is_closed(&line) => {
                line.pop();
                Shape::Area(vec![line])
            }
            shape => shape,
        };
        let zone = zone.filter(|_| matches!(shape, Shape::Area(_)));
        features.push(Feature { name: name.clone(), shape, zone });
    }
}

fn is_closed(line: &[crate::plan::feature::Vertex]) -> bool {
    line.len() > 3 && line.first().map(|vertex| vertex.position) == line.last().map(|vertex| vertex.position)
}

/// Returns the meaning that the properties give an area.
pub(super) fn zone(properties: &Properties) -> Option<Zone> {
    let is = |key: &str, value: &str| {
        properties.get(key).is_some_and(|text| text.trim().eq_ignore_ascii_case(value))
    };
    if is("zone", "exclusion") {
        Some(Zone::Exclusion)
    } else if is("zone", "inclusion") {
        Some(Zone::Inclusion)
    } else if is("featureType", "geofence") {
        Some(if is("inclusion", "false") { Zone::Exclusion } else { Zone::Inclusion })
    } else {
        None
    }
}

#[cfg(test)]
mod tests;
