//! The reader of GPX: waypoints, routes and tracks.

use super::collector::{Altitudes, Collector, Detail, Kind, MapFeature, Piece, Properties, push};
use super::coordinates::number;
use crate::plan::feature::{Shape, Vertex};
use crate::plan::format::loss::Place;
use crate::plan::format::xml::{Element, Part, Parts};

/// The hint for a point that cannot be read.
const HINT: &str = "write lat=\"40.4635\" lon=\"-79.5182\" with decimal points";

/// Reads a text.
pub(super) fn read(text: &str, collector: &mut Collector<'_, '_>) {
    GpxReader { parts: Parts::new(text), collector }.document();
}

struct GpxReader<'t, 'r, 'c, 'a> {
    parts: Parts<'t>,
    collector: &'r mut Collector<'c, 'a>,
}

impl GpxReader<'_, '_, '_, '_> {
    fn document(&mut self) {
        while let Some(part) = self.next() {
            let Part::Start(element) = part else { continue };
            match element.name.as_str() {
                "gpx" => {}
                // The metadata of GPX 1.0 have no element of their own.
                "metadata" => {
                    while let Some(element) = self.child() {
                        self.metadata(&element);
                    }
                }
                "wpt" => self.waypoint(&element),
                "rte" => self.path(&element, Kind::Line),
                "trk" => self.path(&element, Kind::Track),
                _ => self.metadata(&element),
            }
        }
    }

    fn next(&mut self) -> Option<Part> {
        if self.collector.is_over() { None } else { self.parts.next(self.collector.problems) }
    }

    /// Returns the next element inside the present one.
    fn child(&mut self) -> Option<Element> {
        loop {
            match self.next()? {
                Part::Start(element) => return Some(element),
                Part::Text(_) => {}
                Part::End => return None,
            }
        }
    }

    fn text(&mut self) -> String {
        self.parts.text(self.collector.problems)
    }

    fn skip(&mut self) {
        self.parts.skip(self.collector.problems);
    }

    fn metadata(&mut self, element: &Element) {
        match element.name.as_str() {
            "name" => self.collector.name = self.text(),
            "desc" => self.collector.description = self.text(),
            "extensions" => {
                let mut properties = std::mem::take(&mut self.collector.properties);
                self.extensions(&mut properties);
                self.collector.properties = properties;
            }
            _ => self.skip(),
        }
    }

    /// Reads the elements inside the present one as properties, those that only hold others, too.
    fn extensions(&mut self, properties: &mut Properties) {
        let mut open: Vec<(String, String)> = Vec::new();
        loop {
            match self.next() {
                Some(Part::Start(element)) => open.push((element.name, String::new())),
                Some(Part::Text(text)) => {
                    if let Some((_, value)) = open.last_mut() {
                        value.push_str(&text);
                    }
                }
                Some(Part::End) => match open.pop() {
                    Some((key, value)) => properties.add(&key, value.trim().to_owned()),
                    None => return,
                },
                None => return,
            }
        }
    }

    fn feature_at(&self, element: &Element) -> MapFeature {
        let at = element.span.start;
        let line = self.collector.problems.line_at(at);
        MapFeature { place: Some(Place::Line { line }), at, ..MapFeature::default() }
    }

    fn give(&mut self, element: &Element, feature: MapFeature) {
        if let Err(message) = self.collector.feature(feature) {
            self.collector.give_up(element.span.clone(), message, "the file is too large");
        }
    }

    fn waypoint(&mut self, element: &Element) {
        let mut feature = self.feature_at(element);
        let mut detail = Detail::default();
        let vertex = self.point(element, Some(&mut detail));
        let altitudes = Altitudes::AboveSeaLevel;
        feature.pieces.extend(vertex.map(|vertex| Piece {
            kind: Kind::Point,
            altitudes,
            shape: Shape::Point(vertex),
        }));
        (feature.name, feature.properties) = (detail.name, detail.properties);
        self.give(element, feature);
    }

    /// Reads a route or a track.
    fn path(&mut self, path: &Element, kind: Kind) {
        let mut feature = self.feature_at(path);
        let mut vertices = Vec::new();
        let with_details = self.collector.limits.is_plan && kind == Kind::Line;
        while let Some(element) = self.child() {
            match element.name.as_str() {
                "name" => feature.name = self.text(),
                "rtept" if with_details => {
                    let mut detail = Detail { at: element.span.start, ..Detail::default() };
                    if let Some(vertex) = self.point(&element, Some(&mut detail)) {
                        vertices.push(vertex);
                        feature.details.push(detail);
                    }
                }
                "rtept" => {
                    let vertex = self.point(&element, None);
                    vertex.into_iter().for_each(|vertex| push(&mut vertices, vertex));
                }
                "trkseg" => {
                    let mut segment = Vec::new();
                    while let Some(element) = self.child() {
                        if element.name == "trkpt" {
                            let vertex = self.point(&element, None);
                            vertex.into_iter().for_each(|vertex| push(&mut segment, vertex));
                        } else {
                            self.skip();
                        }
                    }
                    feature.pieces.extend(line(kind, segment));
                }
                "extensions" => self.extensions(&mut feature.properties),
                _ => self.skip(),
            }
        }
        if with_details {
            // A route of one point is a plan, too.
            let altitudes = Altitudes::AboveSeaLevel;
            feature.pieces.push(Piece { kind, altitudes, shape: Shape::Line(vertices) });
        } else {
            feature.pieces.extend(line(kind, vertices));
        }
        self.give(path, feature);
    }

    fn point(&mut self, element: &Element, mut detail: Option<&mut Detail>) -> Option<Vertex> {
        let mut altitude = Ok(None);
        while let Some(child) = self.child() {
            match (child.name.as_str(), &mut detail) {
                ("ele", _) => {
                    let text = self.text();
                    altitude = if text.is_empty() { Ok(None) } else { number("altitude", &text).map(Some) };
                }
                ("name", Some(detail)) => detail.name = self.text(),
                ("type", Some(detail)) => {
                    let text = self.text();
                    detail.properties.add("type", text);
                }
                ("extensions", Some(detail)) => self.extensions(&mut detail.properties),
                _ => self.skip(),
            }
        }
        let degrees = |what, name| match element.attribute(name) {
            Some(text) => number(what, text),
            None => Err(format!("the {what} is missing: <{}> has no {name}", element.name)),
        };
        let vertex = degrees("latitude", "lat").and_then(|lat| {
            let lon = degrees("longitude", "lon")?;
            self.collector.counter.vertex(lat, lon, altitude?)
        });
        vertex.map_err(|message| self.collector.problems.add(element.span.clone(), message, HINT)).ok()
    }
}

fn line(kind: Kind, vertices: Vec<Vertex>) -> Option<Piece> {
    let altitudes = Altitudes::AboveSeaLevel;
    (vertices.len() > 1).then_some(Piece { kind, altitudes, shape: Shape::Line(vertices) })
}
