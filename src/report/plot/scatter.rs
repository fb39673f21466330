//! Flights as points of two numbers.

use super::axes::{ACROSS, Axes, BELOW, LEFT, WIDTH};
use super::canvas::{Area, filled, stroke};
use super::legend::Legend;
use super::{Colour, Picture, Point, range};

/// Height of the field of the points, px.
const HEIGHT: f64 = 260.0;
/// Half of the width of a cross, px.
const ARM: f64 = 3.0;

/// A picture of points. Those of the second group are crosses and lie on top.
#[derive(Debug, Clone, Default)]
pub(in crate::report) struct Scatter {
    /// The names of the groups.
    pub(in crate::report) names: [&'static str; 2],
    pub(in crate::report) dots: Vec<Point>,
    pub(in crate::report) crosses: Vec<Point>,
    /// Values to the right that are marked by a dashed line, with their names.
    pub(in crate::report) marks: Vec<(f64, String)>,
}

impl Scatter {
    /// Returns the picture as SVG.
    pub(in crate::report) fn svg(&self, picture: &Picture) -> String {
        let [dots, crosses] = self.names;
        let groups = [(Colour::First, dots, &self.dots), (Colour::Exclusion, crosses, &self.crosses)];
        let groups = groups.into_iter().filter(|(.., points)| !points.is_empty());
        let names: Vec<(Colour, f64, String)> = groups
            .map(|(colour, name, _)| (colour, 4.0, name.to_owned()))
            .chain(self.marks.iter().map(|(_, name)| (Colour::Plan, 1.25, name.clone())))
            .collect();
        let legend = Legend::new(&names, ACROSS);
        picture.draw((WIDTH, legend.height() + 6.0 + HEIGHT + BELOW), |area| {
            legend.draw(area, (LEFT, 0.0));
            self.draw(area, legend.height() + 6.0);
        })
    }

    fn draw(&self, area: &mut Area, top: f64) {
        let all = || self.dots.iter().chain(&self.crosses);
        let x =
            range::around(all().map(|point| point.0).chain(self.marks.iter().map(|(value, _)| *value)), 0.01);
        let y = range::around(all().map(|point| point.1), 0.01);
        let axes = Axes { x, y, top, height: HEIGHT };
        axes.draw(area, (9, 7), "");
        for (value, _) in &self.marks {
            area.line(&[axes.px((*value, y.0)), axes.px((*value, y.1))], &stroke(Colour::Plan, 1.25));
        }
        for dot in &self.dots {
            area.circle(axes.px(*dot), 2.0, &filled(Colour::First, 1.0));
        }
        for cross in &self.crosses {
            area.cross(axes.px(*cross), ARM, &stroke(Colour::Exclusion, 1.5));
        }
    }
}
