//! Flights as points of two numbers.

use plotters::chart::ChartBuilder;
use plotters::element::{Circle, PathElement};
use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{Area, Drawn, filled, stroke, text, units};
use super::chart::{BELOW, LEFT, RIGHT, SMALL, WIDTH, number};
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
        let legend = Legend::new(&names, WIDTH - LEFT - RIGHT);
        picture.draw((WIDTH, legend.height() + 6.0 + HEIGHT + BELOW), |area| {
            legend.draw(area, (LEFT, 0.0))?;
            self.draw(area, legend.height())
        })
    }

    fn draw(&self, area: &Area<'_>, top: f64) -> Drawn {
        let all = || self.dots.iter().chain(&self.crosses);
        let x =
            range::around(all().map(|point| point.0).chain(self.marks.iter().map(|(value, _)| *value)), 0.01);
        let y = range::around(all().map(|point| point.1), 0.01);
        let mut chart = ChartBuilder::on(area)
            .margin_top(units(top + 6.0))
            .margin_right(units(RIGHT))
            .x_label_area_size(units(BELOW))
            .y_label_area_size(units(LEFT))
            .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
        chart
            .configure_mesh()
            .light_line_style(stroke(Colour::Grid, 0.0))
            .max_light_lines(0)
            .bold_line_style(stroke(Colour::Grid, 1.0))
            .axis_style(stroke(Colour::Axis, 1.0))
            .x_labels(9)
            .y_labels(7)
            .set_all_tick_mark_size(units(3.0))
            .x_label_formatter(&|value| number(*value))
            .y_label_formatter(&|value| number(*value))
            .label_style(text(SMALL, Colour::Label, HPos::Left, VPos::Top))
            .draw()?;
        let inside = |&(right, up): &Point| (right.clamp(x.0, x.1), up.clamp(y.0, y.1));
        let lines = self.marks.iter().map(|&(value, _)| {
            let value = value.clamp(x.0, x.1);
            PathElement::new(vec![(value, y.0), (value, y.1)], stroke(Colour::Plan, 1.25))
        });
        chart.draw_series(lines)?;
        let dots = self.dots.iter().map(inside);
        chart.draw_series(dots.map(|point| Circle::new(point, units(2.0), filled(Colour::First, 1.0))))?;
        let (across, up) = ((x.1 - x.0) / (WIDTH - LEFT - RIGHT) * ARM, (y.1 - y.0) / HEIGHT * ARM);
        let arms = self
            .crosses
            .iter()
            .map(inside)
            .flat_map(|(x, y)| [up, -up].map(|up| vec![(x - across, y - up), (x + across, y + up)]));
        chart.draw_series(arms.map(|arm| PathElement::new(arm, stroke(Colour::Exclusion, 1.5))))?;
        Ok(())
    }
}
