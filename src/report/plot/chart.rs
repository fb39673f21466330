//! Values over time.

use plotters::chart::ChartBuilder;
use plotters::element::{PathElement, Polygon};
use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{Area, Drawn, filled, stroke, text, units};
use super::legend::Legend;
use super::{Colour, Picture, Point, range, simplify};

/// Width of a chart, px.
pub(super) const WIDTH: f64 = 560.0;
/// Width left of the axis, px.
pub(super) const LEFT: f64 = 48.0;
/// Width right of the chart, px.
pub(super) const RIGHT: f64 = 14.0;
/// Height below the axis, px.
pub(super) const BELOW: f64 = 22.0;
/// Size of numbers, px.
pub(super) const SMALL: f64 = 11.0;

/// A chart of lines.
#[derive(Debug, Clone, Default)]
pub(in crate::report) struct Chart {
    /// The first and the last time, s.
    pub(in crate::report) time: (f64, f64),
    /// The lines; the last one is on top.
    pub(in crate::report) lines: Vec<Line>,
    /// The smallest range of values.
    pub(in crate::report) least_span: f64,
    /// Height of the lines, px.
    pub(in crate::report) height: f64,
    /// The most points of a line.
    pub(in crate::report) most_points: usize,
}

/// A line of a chart.
#[derive(Debug, Clone)]
pub(in crate::report) struct Line {
    pub(in crate::report) name: String,
    pub(in crate::report) colour: Colour,
    /// Width, px.
    pub(in crate::report) width: f64,
    /// `true` to fill the area below.
    pub(in crate::report) is_filled: bool,
    /// Seconds and values; NaN is a gap.
    pub(in crate::report) points: Vec<Point>,
}

impl Chart {
    /// Returns the chart as SVG.
    pub(in crate::report) fn svg(&self, picture: &Picture) -> String {
        let names: Vec<(Colour, f64, String)> = self
            .lines
            .iter()
            .rev()
            .map(|line| (line.colour, line.width.max(1.5), line.name.clone()))
            .collect();
        let legend = Legend::new(&names, WIDTH - LEFT - RIGHT);
        let size = (WIDTH, legend.height() + 6.0 + self.height + BELOW);
        picture.draw(size, |area| {
            legend.draw(area, (LEFT, 0.0))?;
            self.draw(area, legend.height())
        })
    }

    fn draw(&self, area: &Area<'_>, top: f64) -> Drawn {
        let values = self.lines.iter().flat_map(|line| line.points.iter().map(|(_, value)| *value));
        let (low, high) = range::around(values, self.least_span);
        let (from, to) = self.time;
        let mut chart = ChartBuilder::on(area)
            .margin_top(units(top + 6.0))
            .margin_right(units(RIGHT))
            .x_label_area_size(units(BELOW))
            .y_label_area_size(units(LEFT))
            .build_cartesian_2d(from..to, low..high)?;
        chart
            .configure_mesh()
            .light_line_style(stroke(Colour::Grid, 0.0))
            .max_light_lines(0)
            .bold_line_style(stroke(Colour::Grid, 1.0))
            .axis_style(stroke(Colour::Axis, 1.0))
            .x_labels(9)
            .y_labels(5)
            .set_all_tick_mark_size(units(3.0))
            .x_label_formatter(&|seconds| number(*seconds))
            .y_label_formatter(&|value| number(*value))
            .label_style(text(SMALL, Colour::Label, HPos::Left, VPos::Top))
            .draw()?;
        let px = |(time, value): Point| {
            let (time, value) = (time.clamp(from, to), value.clamp(low, high));
            ((time - from) / (to - from) * (WIDTH - LEFT - RIGHT), (value - low) / (high - low) * self.height)
        };
        let back = |(x, y): Point| {
            (from + x / (WIDTH - LEFT - RIGHT) * (to - from), low + y / self.height * (high - low))
        };
        for line in &self.lines {
            let parts = line.points.split(|(_, value)| !value.is_finite());
            for part in parts.filter(|part| part.len() > 1) {
                let part: Vec<Point> = part.iter().map(|point| px(*point)).collect();
                let part = simplify::simplified(&part, self.most_points).into_iter().map(back);
                let part: Vec<Point> = part.collect();
                if line.is_filled {
                    chart.draw_series([Polygon::new(down_to(low, &part), filled(line.colour, 0.25))])?;
                }
                chart.draw_series([PathElement::new(part, stroke(line.colour, line.width))])?;
            }
        }
        Ok(())
    }
}

/// Returns the area below a line.
fn down_to(low: f64, line: &[Point]) -> Vec<Point> {
    let mut area = line.to_vec();
    area.extend(line.last().map(|(time, _)| (*time, low)));
    area.extend(line.first().map(|(time, _)| (*time, low)));
    area
}

/// Returns a number at an axis, with the decimals that it needs.
pub(super) fn number(value: f64) -> String {
    let rounded = (value * 1000.0).round() / 1000.0 + 0.0;
    rounded.to_string()
}
