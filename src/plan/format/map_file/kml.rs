//! The reader of KML. Names of elements count without their namespace. Nothing that a file refers to is fetched.

use super::collector::{Altitudes, Collector, Kind, MapFeature, Piece, push};
use super::coordinates::{HINT, Tuples, gx_coord};
use crate::plan::feature::{Shape, Vertex};
use crate::plan::format::loss::Place;
use crate::plan::format::xml::{Element, Part, Parts};

/// Elements that hold others.
const CONTAINERS: &[&str] = &["kml", "Document", "Folder"];

/// Elements that show something without a place of its own, or that refer to another file.
const SKIPPED: &[&str] =
    &["NetworkLink", "GroundOverlay", "ScreenOverlay", "PhotoOverlay", "Model", "Tour", "NetworkLinkControl"];

/// Reads a text.
pub(super) fn read(text: &str, collector: &mut Collector<'_, '_>) {
    KmlReader { parts: Parts::new(text), collector }.document();
}

struct KmlReader<'t, 'r, 'c, 'a> {
    parts: Parts<'t>,
    collector: &'r mut Collector<'c, 'a>,
}

impl KmlReader<'_, '_, '_, '_> {
    fn document(&mut self) {
        let mut open: Vec<String> = Vec::new();
        while let Some(part) = self.next() {
            let element = match part {
                Part::Start(element) => element,
                Part::End => {
                    open.pop();
                    continue;
                }
                Part::Text(_) => continue,
            };
            let is_document = open.last().is_some_and(|name| name == "Document");
            match element.name.as_str() {
                name if CONTAINERS.contains(&name) => open.push(element.name),
                "Placemark" => self.placemark(&element),
                "name" if is_document && self.collector.name.is_empty() => {
                    self.collector.name = self.text();
                }
                "description" if is_document && self.collector.description.is_empty() => {
                    self.collector.description = self.text();
                }
                "ExtendedData" if is_document => {
                    let mut properties = std::mem::take(&mut self.collector.properties);
                    self.extended_data(&mut |key, value| properties.add(key, value));
                    self.collector.properties = properties;
                }
                _ => self.skip(&element),
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

    fn skip(&mut self, element: &Element) {
        if let Some(name) = SKIPPED.iter().find(|name| **name == element.name) {
            self.collector.skip(name, element.span.start);
        }
        self.parts.skip(self.collector.problems);
    }

    fn placemark(&mut self, placemark: &Element) {
        let at = placemark.span.start;
        let line = self.collector.problems.line_at(at);
        let mut feature = MapFeature { place: Some(Place::Line { line }), at, ..MapFeature::default() };
        while let Some(element) = self.child() {
            match element.name.as_str() {
                "name" => feature.name = self.text(),
                "ExtendedData" => {
                    self.extended_data(&mut |key, value| feature.properties.add(key, value));
                }
                _ => self.geometry(&element, &mut feature.pieces),
            }
        }
        if let Err(message) = self.collector.feature(feature) {
            self.collector.give_up(placemark.span.clone(), message, "the file is too large to be drawn");
        }
    }

    /// Reads `Data` and `SimpleData`.
    fn extended_data(&mut self, take: &mut dyn FnMut(&str, String)) {
        while let Some(element) = self.child() {
            let key = element.attribute("name").unwrap_or_default().to_owned();
            match element.name.as_str() {
                "Data" => {
                    while let Some(element) = self.child() {
                        match element.name.as_str() {
                            "value" => take(&key, self.text()),
                            _ => self.skip(&element),
                        }
                    }
                }
                "SchemaData" => self.extended_data(take),
                "SimpleData" => take(&key, self.text()),
                _ => self.skip(&element),
            }
        }
    }

    fn geometry(&mut self, element: &Element, pieces: &mut Vec<Piece>) {
        match element.name.as_str() {
            "Point" => self.simple(Kind::Point, pieces),
            "LineString" | "LinearRing" => self.simple(Kind::Line, pieces),
            "Polygon" => self.polygon(pieces),
            "MultiGeometry" | "MultiTrack" => {
                // The altitude mode of a track may follow after all of them.
                let before = pieces.len();
                let mut mode = None;
                while let Some(element) = self.child() {
                    if element.name == "altitudeMode" {
                        mode = self.altitudes();
                    } else {
                        self.geometry(&element, pieces);
                    }
                }
                if let Some(mode) = mode {
                    pieces[before..].iter_mut().for_each(|piece| piece.altitudes = mode);
                }
            }
            "Track" => self.track(pieces),
            _ => self.skip(element),
        }
    }

    fn altitudes(&mut self) -> Option<Altitudes> {
        Altitudes::from_mode(&self.text())
    }

    fn simple(&mut self, kind: Kind, pieces: &mut Vec<Piece>) {
        let mut altitudes = Altitudes::Clamped;
        let mut vertices = Vec::new();
        while let Some(element) = self.child() {
            match element.name.as_str() {
                "coordinates" => vertices = self.coordinates(&element),
                "altitudeMode" => altitudes = self.altitudes().unwrap_or(altitudes),
                _ => self.skip(&element),
            }
        }
        let shape = match kind {
            Kind::Point => vertices.first().copied().map(Shape::Point),
            _ => (vertices.len() > 1).then_some(Shape::Line(vertices)),
        };
        pieces.extend(shape.map(|shape| Piece { kind, altitudes, shape }));
    }

    fn polygon(&mut self, pieces: &mut Vec<Piece>) {
        let mut altitudes = Altitudes::Clamped;
        let mut rings: Vec<Vec<Vertex>> = Vec::new();
        let mut has_outer = false;
        while let Some(element) = self.child() {
            let is_outer = element.name == "outerBoundaryIs";
            match element.name.as_str() {
                "outerBoundaryIs" | "innerBoundaryIs" => {
                    while let Some(element) = self.child() {
                        if element.name != "LinearRing" {
                            self.skip(&element);
                            continue;
                        }
                        while let Some(element) = self.child() {
                            if element.name != "coordinates" {
                                self.skip(&element);
                            } else if let Some(ring) = ring(self.coordinates(&element)) {
                                // The outer ring is the first one in a shape.
                                let place = if is_outer && !has_outer { 0 } else { rings.len() };
                                has_outer |= is_outer;
                                rings.insert(place, ring);
                            }
                        }
                    }
                }
                "altitudeMode" => altitudes = self.altitudes().unwrap_or(altitudes),
                _ => self.skip(&element),
            }
        }
        if has_outer {
            pieces.push(Piece { kind: Kind::Area, altitudes, shape: Shape::Area(rings) });
        }
    }

    fn track(&mut self, pieces: &mut Vec<Piece>) {
        let mut altitudes = Altitudes::Clamped;
        let mut vertices = Vec::new();
        while let Some(element) = self.child() {
            match element.name.as_str() {
                "coord" => {
                    let text = self.text();
                    // An empty one stands for a moment without a position.
                    if !text.is_empty() {
                        match gx_coord(&text, &mut self.collector.counter) {
                            Ok(vertex) => push(&mut vertices, vertex),
                            Err(message) => self.fault(&element, message),
                        }
                    }
                }
                "altitudeMode" => altitudes = self.altitudes().unwrap_or(altitudes),
                _ => self.skip(&element),
            }
        }
        if vertices.len() > 1 {
            pieces.push(Piece { kind: Kind::Track, altitudes, shape: Shape::Line(vertices) });
        }
    }

    fn coordinates(&mut self, element: &Element) -> Vec<Vertex> {
        let Collector { problems, counter, .. } = &mut *self.collector;
        let mut tuples = Tuples::default();
        let mut fault: Option<(usize, String)> = None;
        self.parts.texts(problems, |text, at| {
            if fault.is_none() {
                fault = tuples.take(text, counter).err().map(|(offset, message)| (at + offset, message));
            }
        });
        let fault = match fault {
            Some(fault) => fault,
            None => match tuples.end(counter) {
                Ok(vertices) => return vertices,
                Err(message) => (element.span.end, message),
            },
        };
        problems.add(fault.0..fault.0 + 1, fault.1, HINT);
        Vec::new()
    }

    fn fault(&mut self, element: &Element, message: String) {
        self.collector.problems.add(element.span.end..element.span.end + 1, message, HINT);
    }
}

/// Returns a ring without its closing vertex, or `None` if it encloses nothing.
pub(super) fn ring(mut vertices: Vec<Vertex>) -> Option<Vec<Vertex>> {
    if vertices.len() > 1 && vertices.first().map(|v| v.position) == vertices.last().map(|v| v.position) {
        vertices.pop();
    }
    (vertices.len() > 2).then_some(vertices)
}
