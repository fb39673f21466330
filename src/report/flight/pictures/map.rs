//! The map of a flight.

use super::Figure;
use crate::geo::LocalFrame;
use crate::plan::feature::{Feature, Shape, Vertex, Zone};
use crate::report::flight::{Detail, FlightReport, look};
use crate::report::plot::{Colour, Ground, GroundKind, Map, MapTrack, Picture, Point};
use crate::report::record::FlightRecord;
use crate::text::printable;

/// Width of the track, px.
const WIDTH: f64 = 2.0;

/// A part of the track: its colour, the name of its state or mode, its places.
type Part = (Colour, &'static str, Vec<Point>);

/// Returns the map; `None` if no place is known.
pub(super) fn figure(report: &FlightReport, id: &str, detail: Detail) -> Option<Figure> {
    let record = &report.record;
    let parts = parts(record, detail.points);
    let first = parts.first().and_then(|(.., points)| points.first());
    if first.is_none() && report.route.is_none() {
        return None;
    }
    let mut map = Map { most_points: detail.points, ..Map::default() };
    if let Some(route) = &report.route {
        map.legs = start(record).or(first.copied()).into_iter().chain(route.legs()).collect();
        map.marks = route.marks();
        map.rings = route.rings();
    }
    map.rings.extend(report.fence_m.map(|fence_m| ((0.0, 0.0), fence_m)));
    map.ground = report.frame.map_or_else(Vec::new, |frame| ground(&report.backdrop, &frame));
    for (colour, name, points) in parts {
        if !map.legend.iter().any(|(known, ..)| *known == colour) {
            map.legend.push((colour, WIDTH, name.to_owned()));
        }
        map.tracks.push(MapTrack { points, colour, width: WIDTH });
    }
    if !map.legs.is_empty() {
        map.legend.push((Colour::Plan, 1.0, "plan".to_owned()));
    }
    let down = record.touchdown_at.and_then(|at| record.samples.iter().rfind(|sample| sample.time <= at));
    let down = down.and_then(|sample| record.place(sample)).map(|[north, east]| ((east, north), Colour::Ink));
    map.touchdowns = down.into_iter().collect();
    let coloured = super::coloured(record);
    let description = format!(
        "The track of the craft, north up{coloured}, with {} waypoints. The craft was up to {:.0} m from home.",
        map.marks.len(),
        map.tracks.iter().flat_map(|track| &track.points).map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max)
    );
    let picture = Picture::new(&format!("{id}-map"), "Map of the flight", &description);
    let caption = match down.is_some() {
        true => format!("The true track{coloured}. The cross is the touchdown."),
        false => format!("The track{coloured}."),
    };
    Some(Figure { svg: map.svg(&picture), title: "Map.".to_owned(), caption, is_wide: false })
}

/// Returns the parts of the track with the same look. Each ends with the first place of the next one, so that the line has
/// no gap. A track of more than `most` parts is one part.
fn parts(record: &FlightRecord, most: usize) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for sample in &record.samples {
        let Some([north, east]) = record.place(sample) else { continue };
        let place = (east, north);
        let look = look::of_sample(sample);
        match parts.last_mut() {
            Some((colour, name, points)) if (*colour, *name) == look => points.push(place),
            last => {
                if let Some((.., points)) = last {
                    points.push(place);
                }
                parts.push((look.0, look.1, vec![place]));
            }
        }
    }
    if parts.len() > most {
        let points = parts.into_iter().flat_map(|(.., points)| points).collect();
        return vec![(Colour::First, "track", points)];
    }
    parts
}

/// Returns the place of the engagement.
fn start(record: &FlightRecord) -> Option<Point> {
    let engaged_at = record.engaged_at?;
    let sample = record.samples.iter().find(|sample| sample.time >= engaged_at)?;
    record.place(sample).map(|[north, east]| (east, north))
}

/// Returns the shapes of a map in metres.
pub(in crate::report) fn ground(features: &[Feature], frame: &LocalFrame) -> Vec<Ground> {
    let place = |vertex: &Vertex| {
        let (lat_deg, lon_deg) = (vertex.position.lat_deg(), vertex.position.lon_deg());
        let enu = frame.to_enu(lat_deg, lon_deg, frame.alt_amsl_m);
        (enu.x, enu.y)
    };
    let line = |vertices: &[Vertex]| vertices.iter().map(place).collect::<Vec<Point>>();
    let closed = |ring: &Vec<Vertex>| {
        let mut ring = line(ring);
        ring.extend(ring.first().copied());
        ring
    };
    features
        .iter()
        .map(|feature| {
            let (lines, is_area) = match &feature.shape {
                Shape::Point(vertex) => (vec![vec![place(vertex)]], false),
                Shape::Line(vertices) => (vec![line(vertices)], false),
                Shape::Area(rings) => (rings.iter().map(closed).collect(), true),
            };
            let kind = match feature.zone {
                None => GroundKind::Plain,
                Some(Zone::Exclusion) => GroundKind::Exclusion,
                Some(Zone::Inclusion) => GroundKind::Inclusion,
            };
            Ground { kind, lines, is_area, name: printable::name(feature.name.trim()) }
        })
        .collect()
}
