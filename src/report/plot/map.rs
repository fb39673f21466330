//! The ground from above, north up.

mod ground;
mod view;

use super::canvas::{Anchor, Area, Height, filled, stroke, text};
use super::labels::Labels;
use super::legend::Legend;
use super::{Colour, Picture, Point, range, simplify};
pub(in crate::report) use ground::{Ground, GroundKind};
use view::View;

/// Size of the names of waypoints, px.
const SIZE: f64 = 12.0;
/// Size of the other names, px.
const SMALL: f64 = 11.0;
/// The longest scale bar, px.
const BAR: f64 = 160.0;
/// Height of the scale below the map, px.
const SCALE: f64 = 24.0;
/// Points of a circle.
const CIRCLE: usize = 72;

/// A map.
#[derive(Debug, Clone, Default)]
pub(in crate::report) struct Map {
    /// The straight legs, in their order.
    pub(in crate::report) legs: Vec<Point>,
    /// Hold patterns and the fence: centre and radius, m.
    pub(in crate::report) rings: Vec<(Point, f64)>,
    /// Waypoints with their names.
    pub(in crate::report) marks: Vec<Mark>,
    /// The tracks; the last one is on top.
    pub(in crate::report) tracks: Vec<MapTrack>,
    /// Places where a craft came down.
    pub(in crate::report) touchdowns: Vec<(Point, Colour)>,
    /// Lines and areas under everything.
    pub(in crate::report) ground: Vec<Ground>,
    /// The names of the tracks.
    pub(in crate::report) legend: Vec<(Colour, f64, String)>,
    /// The most points of a track, and of all lines of the ground.
    pub(in crate::report) most_points: usize,
}

/// A waypoint.
#[derive(Debug, Clone)]
pub(in crate::report) struct Mark {
    pub(in crate::report) place: Point,
    pub(in crate::report) name: String,
}

/// A track.
#[derive(Debug, Clone)]
pub(in crate::report) struct MapTrack {
    pub(in crate::report) points: Vec<Point>,
    pub(in crate::report) colour: Colour,
    /// Width, px.
    pub(in crate::report) width: f64,
}

impl Map {
    /// Returns the map as SVG. Home is at the origin.
    pub(in crate::report) fn svg(&self, picture: &Picture) -> String {
        let flown = self.tracks.iter().flat_map(|track| track.points.iter().copied());
        let marked = self.marks.iter().map(|mark| mark.place);
        let view = View::around(self.legs.iter().copied().chain(marked).chain(flown).chain([(0.0, 0.0)]));
        let legend = Legend::new(&self.legend, view.width());
        let top = if legend.height() > 0.0 { legend.height() + 6.0 } else { 0.0 };
        let view = view.below(top);
        picture.with_edged_texts().draw((view.width(), top + view.height() + SCALE), |area| {
            legend.draw(area, (2.0, 0.0));
            self.draw(area, &view);
            scale(area, &view);
        })
    }

    fn draw(&self, area: &mut Area, view: &View) {
        let mut labels = Labels::default();
        let mut names = Vec::new();
        let names_of_ground = ground::draw(&self.ground, area, view, self.most_points);
        area.rectangle([view.frame().low, view.frame().high], &stroke(Colour::Axis, 0.25));
        for (centre, radius) in &self.rings {
            self.line(area, view, &circle(*centre, *radius), &stroke(Colour::Plan, 1.0));
        }
        self.line(area, view, &self.legs, &stroke(Colour::Plan, 1.0));
        for track in &self.tracks {
            self.line(area, view, &track.points, &stroke(track.colour, track.width));
        }
        let is_inside = |place: &Point| view.frame().contains(view.px(*place));
        for (place, colour) in self.touchdowns.iter().filter(|(place, _)| is_inside(place)) {
            area.cross(view.px(*place), 4.0, &stroke(*colour, 2.0));
        }
        let (x, y) = view.px((0.0, 0.0));
        area.rectangle([(x - 4.0, y - 4.0), (x + 4.0, y + 4.0)], &filled(Colour::Ink, 1.0));
        labels.mark((x, y), 4.0);
        names.push(((x, y), "home"));
        for mark in self.marks.iter().filter(|mark| is_inside(&mark.place)) {
            let place = view.px(mark.place);
            area.circle(place, 4.0, &filled(Colour::Paper, 1.0));
            area.circle(place, 4.0, &stroke(Colour::Ink, 1.25));
            labels.mark(place, 4.0);
            names.push((place, mark.name.as_str()));
        }
        let own = names.into_iter().rev().map(|(place, name)| (place, name, SIZE, Colour::Ink));
        let of_ground = names_of_ground.into_iter().map(|(place, name)| (place, name, SMALL, Colour::Label));
        for (place, name, size, colour) in own.chain(of_ground) {
            if let Some((anchor, place)) = labels.place(place, name, size, view.width()) {
                area.text(name, place, &text(size, colour, anchor, Height::Middle));
            }
        }
    }

    /// Draws the parts of a line inside the map.
    fn line(&self, area: &mut Area, view: &View, line: &[Point], style: &str) {
        let line: Vec<Point> = line.iter().map(|place| view.px(*place)).collect();
        for part in view.frame().line(&line) {
            area.line(&simplify::simplified(&part, self.most_points), style);
        }
    }
}

/// Returns a circle as a line.
fn circle((x, y): Point, radius: f64) -> Vec<Point> {
    let angle = |index: usize| index as f64 / CIRCLE as f64 * std::f64::consts::TAU;
    (0..=CIRCLE).map(|index| (x + radius * angle(index).cos(), y + radius * angle(index).sin())).collect()
}

/// Draws a bar of a round length, and the direction of north.
fn scale(area: &mut Area, view: &View) {
    let metres = range::round_length(BAR / view.px_per_m());
    let (left, y) = (2.0, view.bottom() + SCALE - 6.0);
    let right = left + metres * view.px_per_m();
    area.line(&[(left, y - 5.0), (left, y), (right, y), (right, y - 5.0)], &stroke(Colour::Ink, 1.0));
    let name = if metres < 1000.0 { format!("{metres} m") } else { format!("{} km", metres / 1000.0) };
    for (name, x, anchor) in
        [(name.as_str(), right + 6.0, Anchor::Start), ("north ↑", view.width() - 2.0, Anchor::End)]
    {
        area.text(name, (x, y - 3.0), &text(SMALL, Colour::Label, anchor, Height::Middle));
    }
}
