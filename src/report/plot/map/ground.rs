//! Lines, areas and points under a flight.

use super::view::View;
use crate::report::plot::canvas::{Area, filled, stroke};
use crate::report::plot::{Colour, Point, simplify};

/// The most names.
const MAX_NAMES: usize = 40;

/// The meaning of a shape for a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum GroundKind {
    Plain,
    /// The craft must stay outside.
    Exclusion,
    /// The craft must stay inside.
    Inclusion,
}

/// A shape on the ground.
#[derive(Debug, Clone)]
pub(in crate::report) struct Ground {
    pub(in crate::report) kind: GroundKind,
    /// The lines; of an area its rings, closed.
    pub(in crate::report) lines: Vec<Vec<Point>>,
    pub(in crate::report) is_area: bool,
    /// May be empty.
    pub(in crate::report) name: String,
}

impl Ground {
    fn colour(&self) -> Colour {
        match self.kind {
            GroundKind::Plain => Colour::Backdrop,
            GroundKind::Exclusion => Colour::Exclusion,
            GroundKind::Inclusion => Colour::Inclusion,
        }
    }

    fn opacity(&self) -> f64 {
        if self.kind == GroundKind::Inclusion { 0.06 } else { 0.14 }
    }
}

/// Draws the shapes, with at most so many points in all. Returns the names with their places, px.
pub(super) fn draw<'g>(
    shapes: &'g [Ground],
    area: &mut Area,
    view: &View,
    most_points: usize,
) -> Vec<(Point, &'g str)> {
    let frame = view.frame();
    let mut points_left = most_points;
    let mut names = Vec::new();
    for shape in shapes {
        let to_px = |line: &Vec<Point>| line.iter().map(|place| view.px(*place)).collect::<Vec<_>>();
        let lines: Vec<Vec<Point>> = shape.lines.iter().map(to_px).collect();
        let mut named_at = None;
        // A hole would be filled, too.
        if shape.is_area
            && let [ring] = &lines[..]
        {
            let inside = simplify::simplified(&frame.ring(ring), points_left);
            points_left = points_left.saturating_sub(inside.len());
            named_at = middle(&inside);
            area.polygon(&inside, &filled(shape.colour(), shape.opacity()));
        }
        for line in &lines {
            if let [place] = line[..]
                && frame.contains(place)
            {
                named_at.get_or_insert(place);
                area.circle(place, 2.0, &filled(shape.colour(), 1.0));
            }
            for part in frame.line(line) {
                if points_left == 0 {
                    return names;
                }
                let part = simplify::simplified(&part, points_left);
                points_left = points_left.saturating_sub(part.len());
                let half = part.len().saturating_sub(1) / 2;
                named_at = named_at.or_else(|| middle(part.get(half..half + 2)?));
                let width = if shape.kind == GroundKind::Plain { 1.0 } else { 1.5 };
                area.line(&part, &stroke(shape.colour(), width));
            }
        }
        names.extend(named_at.filter(|_| !shape.name.is_empty()).map(|at| (at, shape.name.as_str())));
    }
    names.truncate(MAX_NAMES);
    names
}

/// Returns the mean of some points.
fn middle(points: &[Point]) -> Option<Point> {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0, y + point.1));
    (count > 0.0).then_some((x / count, y / count))
}
