//! Shapes of a map: points, lines and areas from the files of other programs.

use crate::geo::LatLon;

/// A vertex of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// The place.
    pub position: LatLon,
    /// Altitude, m, in the reference of the shape; `NaN` = not given.
    pub altitude_m: f32,
}

/// A shape.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A point.
    Point(Vertex),
    /// At least two vertices.
    Line(Vec<Vertex>),
    /// The outer ring and the holes, each without its closing vertex.
    Area(Vec<Vec<Vertex>>),
}

/// The meaning of an area for a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Zone {
    /// The craft must stay inside.
    Inclusion,
    /// The craft must stay outside.
    Exclusion,
}

/// A named shape of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// May be empty.
    pub name: String,
    /// The shape.
    pub shape: Shape,
    /// Set only for an area that is a fence or a no-fly zone.
    pub zone: Option<Zone>,
}

impl Feature {
    /// Returns all vertices.
    pub fn vertices(&self) -> impl Iterator<Item = &Vertex> {
        let (point, lines): (&[Vertex], &[Vec<Vertex>]) = match &self.shape {
            Shape::Point(vertex) => (std::slice::from_ref(vertex), &[]),
            Shape::Line(line) => (line, &[]),
            Shape::Area(rings) => (&[], rings),
        };
        point.iter().chain(lines.iter().flatten())
    }
}
