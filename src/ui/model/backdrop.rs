//! The backdrop of the map: points, lines and areas from files, under plan and track.
//!
//! A layer is the content of one file, prepared once for drawing at any scale. Positions stay positions, because the
//! origin of the map follows the craft.

mod detail;

use std::path::PathBuf;
use std::sync::Arc;

use crate::geo::LatLon;
use crate::plan::feature::{Feature, Shape, Vertex, Zone};
use crate::text::printable;
pub(in crate::ui) use detail::{Detail, Window};

/// The most vertices of a backdrop.
pub const MAX_VERTICES: usize = 200_000;

/// The extensions of files that may be maps.
const MAP_EXTENSIONS: [&str; 6] = ["geojson", "json", "kml", "kmz", "gpx", "plan"];

/// The shapes of one file.
#[derive(Debug, Clone)]
pub struct BackdropLayer {
    /// The file, as the user named it.
    pub path: PathBuf,
    vertices: usize,
    shapes: Arc<Shapes>,
}

#[derive(Debug)]
struct Shapes {
    lines: Detail,
    zone_lines: Detail,
    names: Vec<PlacedName>,
    zones: Vec<Feature>,
}

/// A name and its place.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct PlacedName {
    pub(in crate::ui) text: String,
    pub(in crate::ui) position: LatLon,
    pub(in crate::ui) zone: Option<Zone>,
    /// `true` for the name of a point.
    pub(in crate::ui) is_point: bool,
}

impl BackdropLayer {
    /// Prepares the shapes of a file for drawing.
    pub fn new(path: PathBuf, features: Vec<Feature>) -> Self {
        let vertices = features.iter().map(|feature| feature.vertices().count()).sum();
        let lines_of = |is_zone: bool| {
            let wanted = features.iter().filter(move |feature| feature.zone.is_some() == is_zone);
            Detail::new(wanted.flat_map(|feature| lines(&feature.shape)))
        };
        let (lines, zone_lines) = (lines_of(false), lines_of(true));
        let names = features.iter().filter_map(placed_name).collect();
        let zones = features.into_iter().filter(|feature| feature.zone.is_some()).collect();
        Self { path, vertices, shapes: Arc::new(Shapes { lines, zone_lines, names, zones }) }
    }

    /// Returns `true` if files of this name may be maps.
    pub fn is_map_name(name: &str) -> bool {
        let extension = name.rsplit_once('.').map(|(_, extension)| extension.to_ascii_lowercase());
        extension.is_some_and(|extension| MAP_EXTENSIONS.contains(&extension.as_str()))
    }

    /// Returns the number of vertices in the file.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Returns the lines of zones, or all others.
    pub(in crate::ui) fn lines(&self, of_zones: bool) -> &Detail {
        if of_zones { &self.shapes.zone_lines } else { &self.shapes.lines }
    }

    pub(in crate::ui) fn names(&self) -> &[PlacedName] {
        &self.shapes.names
    }

    /// Returns the no-fly zones and the zones around the flight.
    pub(in crate::ui) fn zones(&self) -> &[Feature] {
        &self.shapes.zones
    }
}

/// Returns the lines of a shape. Rings are closed; a point is a line of one vertex.
fn lines(shape: &Shape) -> Vec<Vec<LatLon>> {
    let positions = |vertices: &[Vertex]| vertices.iter().map(|vertex| vertex.position).collect::<Vec<_>>();
    match shape {
        Shape::Point(vertex) => vec![vec![vertex.position]],
        Shape::Line(line) => vec![positions(line)],
        Shape::Area(rings) => {
            let closed = |ring: &Vec<Vertex>| {
                let mut ring = positions(ring);
                ring.extend(ring.first().copied());
                ring
            };
            rings.iter().map(closed).collect()
        }
    }
}

/// Returns the name of a shape at a point on it, or in the middle of an area.
fn placed_name(feature: &Feature) -> Option<PlacedName> {
    let name = printable::name(feature.name.trim());
    let text = match (feature.zone, name.is_empty()) {
        (Some(Zone::Exclusion), true) => "no-fly zone".to_owned(),
        (Some(Zone::Exclusion), false) => format!("✗ {name}"),
        (_, true) => return None,
        (_, false) => name,
    };
    let position = match &feature.shape {
        Shape::Point(vertex) => vertex.position,
        Shape::Line(line) => line.get(line.len() / 2)?.position,
        Shape::Area(rings) => middle(rings.first()?)?,
    };
    let is_point = matches!(feature.shape, Shape::Point(_));
    Some(PlacedName { text, position, zone: feature.zone, is_point })
}

/// Returns the middle of the rectangle around a ring.
fn middle(ring: &[Vertex]) -> Option<LatLon> {
    let first = ring.first()?.position;
    let turn = 3_600_000_000_i64;
    let east = |position: LatLon| {
        (i64::from(position.lon_e7) - i64::from(first.lon_e7) + turn / 2).rem_euclid(turn) - turn / 2
    };
    let (mut low, mut high) = ((first.lat_e7, 0), (first.lat_e7, 0));
    for position in ring.iter().map(|vertex| vertex.position) {
        low = (low.0.min(position.lat_e7), low.1.min(east(position)));
        high = (high.0.max(position.lat_e7), high.1.max(east(position)));
    }
    let lon = i64::from(first.lon_e7) + (low.1 + high.1) / 2;
    let lon = (lon + turn / 2).rem_euclid(turn) - turn / 2;
    let lat = (i64::from(low.0) + i64::from(high.0)) / 2;
    Some(LatLon::new(i32::try_from(lat).ok()?, i32::try_from(lon).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(corners: &[(i32, i32)]) -> Vec<Vertex> {
        let vertex =
            |&(lat, lon): &(i32, i32)| Vertex { position: LatLon::new(lat, lon), altitude_m: f32::NAN };
        corners.iter().map(vertex).collect()
    }

    #[test]
    fn the_middle_of_an_area_across_the_antimeridian_is_there() {
        let east = 1_799_990_000;
        let corners = ring(&[(0, east), (20_000, east), (20_000, -1_799_970_000), (0, -1_799_970_000)]);
        assert_eq!(middle(&corners), Some(LatLon::new(10_000, -1_799_990_000)));
        assert_eq!(middle(&[]), None);
    }

    #[test]
    fn a_zone_without_a_name_is_labelled_and_a_line_without_one_is_not() {
        let area = |zone, name: &str| Feature {
            name: name.to_owned(),
            shape: Shape::Area(vec![ring(&[(0, 0), (9, 0), (9, 9)])]),
            zone,
        };
        let features = vec![
            area(Some(Zone::Exclusion), ""),
            area(Some(Zone::Exclusion), "Prison\u{7}"),
            area(None, " "),
        ];
        let layer = BackdropLayer::new("zones.kml".into(), features);
        let names: Vec<&str> = layer.names().iter().map(|name| name.text.as_str()).collect();
        assert_eq!(names, ["no-fly zone", "✗ Prison?"]);
        assert_eq!((layer.vertices(), layer.zones().len()), (9, 2));
    }
}
