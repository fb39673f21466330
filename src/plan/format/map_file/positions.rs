//! The coordinates of GeoJSON, read straight into vertices. Their depth is unknown before they are read, because the
//! type of a geometry may follow after them.

use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, SeqAccess, Visitor};

use super::collector::{Altitudes, Counter, Kind, Piece, push};
use super::kml::ring;
use crate::plan::feature::{Shape, Vertex};

/// The deepest nesting of coordinates: those of a MultiPolygon.
const DEEPEST: usize = 4;

/// Coordinates by their depth.
#[derive(Debug)]
pub(super) enum Positions {
    Empty,
    One(Vertex),
    Line(Vec<Vertex>),
    Lines(Vec<Vec<Vertex>>),
    Areas(Vec<Vec<Vec<Vertex>>>),
}

impl Positions {
    /// Returns the shapes of a geometry of this type, at most `most`.
    ///
    /// # Errors
    ///
    /// Returns the message if the coordinates do not fit the type, or if they are too many points.
    pub(super) fn pieces(self, of_type: &str, most: usize) -> Result<Vec<Piece>, String> {
        let piece = |kind, shape| Piece { kind, altitudes: Altitudes::AboveSeaLevel, shape };
        let point = |vertex| piece(Kind::Point, Shape::Point(vertex));
        let line = |line: Vec<Vertex>| (line.len() > 1).then(|| piece(Kind::Line, Shape::Line(line)));
        let area = |rings: Vec<Vec<Vertex>>| {
            let mut rings = rings.into_iter().map(ring);
            let mut kept = vec![rings.next()??];
            kept.extend(rings.flatten());
            Some(piece(Kind::Area, Shape::Area(kept)))
        };
        Ok(match (of_type, self) {
            (_, Self::Empty) => Vec::new(),
            ("Point", Self::One(vertex)) => vec![point(vertex)],
            ("MultiPoint", Self::Line(points)) if points.len() > most => {
                return Err(format!("the file has more than {most} shapes"));
            }
            ("MultiPoint", Self::Line(points)) => points.into_iter().map(point).collect(),
            ("LineString", Self::Line(vertices)) => line(vertices).into_iter().collect(),
            ("MultiLineString", Self::Lines(lines)) => lines.into_iter().filter_map(line).collect(),
            ("Polygon", Self::Lines(rings)) => area(rings).into_iter().collect(),
            ("MultiPolygon", Self::Areas(areas)) => areas.into_iter().filter_map(area).collect(),
            (of_type, _) => return Err(format!("these are not the coordinates of a {of_type}")),
        })
    }

    /// Adds an element of the list.
    fn add(&mut self, element: Self) -> Result<(), &'static str> {
        match (&mut *self, element) {
            (_, Self::Empty) => {}
            (Self::Empty, Self::One(vertex)) => *self = Self::Line(vec![vertex]),
            (Self::Empty, Self::Line(line)) => *self = Self::Lines(vec![line]),
            (Self::Empty, Self::Lines(lines)) => *self = Self::Areas(vec![lines]),
            (Self::Line(line), Self::One(vertex)) => push(line, vertex),
            (Self::Lines(lines), Self::Line(line)) => push(lines, line),
            (Self::Areas(areas), Self::Lines(lines)) => push(areas, lines),
            _ => return Err("the coordinates are nested unevenly"),
        }
        Ok(())
    }
}

/// An element of a list of coordinates.
enum Element {
    Number(f64),
    Null,
    List(Positions),
}

/// Reads the coordinates of a geometry.
pub(super) struct PositionsSeed<'s>(pub(super) &'s mut Counter);

impl<'de> DeserializeSeed<'de> for PositionsSeed<'_> {
    type Value = Positions;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Positions, D::Error> {
        match (ElementSeed { counter: self.0, depth: 0 }).deserialize(deserializer)? {
            Element::List(positions) => Ok(positions),
            Element::Number(_) => Err(D::Error::custom("coordinates are a list of numbers")),
            // A geometry without a place.
            Element::Null => Ok(Positions::Empty),
        }
    }
}

struct ElementSeed<'s> {
    counter: &'s mut Counter,
    depth: usize,
}

impl<'de> DeserializeSeed<'de> for ElementSeed<'_> {
    type Value = Element;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Element, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for ElementSeed<'_> {
    type Value = Element;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number of a coordinate, or a list of coordinates")
    }

    fn visit_f64<E>(self, number: f64) -> Result<Element, E> {
        Ok(Element::Number(number))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Element, E> {
        Ok(Element::Number(number as f64))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Element, E> {
        Ok(Element::Number(number as f64))
    }

    fn visit_unit<E>(self) -> Result<Element, E> {
        Ok(Element::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Element, A::Error> {
        let Self { counter, depth } = self;
        if depth == DEEPEST {
            return Err(A::Error::custom("the coordinates are nested too deep"));
        }
        let mut positions = Positions::Empty;
        let inner = depth + 1;
        while let Some(element) =
            list.next_element_seed(ElementSeed { counter: &mut *counter, depth: inner })?
        {
            match (element, &positions) {
                (Element::List(element), _) => positions.add(element).map_err(A::Error::custom)?,
                (Element::Number(lon), Positions::Empty) => {
                    return position(lon, counter, list).map(|vertex| Element::List(Positions::One(vertex)));
                }
                _ => return Err(A::Error::custom("a coordinate is not a number, or a list is incomplete")),
            }
        }
        Ok(Element::List(positions))
    }
}

/// Reads the rest of a position after its longitude.
fn position<'de, A: SeqAccess<'de>>(
    lon: f64,
    counter: &mut Counter,
    mut list: A,
) -> Result<Vertex, A::Error> {
    let short = || A::Error::custom("a position is [LON, LAT] or [LON, LAT, ALT]");
    let lat: f64 = list.next_element()?.ok_or_else(short)?;
    let altitude: Option<f64> = list.next_element::<Option<f64>>()?.flatten();
    while list.next_element::<IgnoredAny>()?.is_some() {}
    counter.vertex(lat, lon, altitude).map_err(A::Error::custom)
}
