//! Values over time.

use super::axes::{ACROSS, Axes, BELOW, LEFT, WIDTH};
use super::canvas::{Area, filled, stroke};
use super::legend::Legend;
use super::{Colour, Picture, Point, range, simplify};

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
        let legend = Legend::new(&names, ACROSS);
        let size = (WIDTH, legend.height() + 6.0 + self.height + BELOW);
        picture.draw(size, |area| {
            legend.draw(area, (LEFT, 0.0));
            self.draw(area, legend.height() + 6.0);
        })
    }

    fn draw(&self, area: &mut Area, top: f64) {
        let values = self.lines.iter().flat_map(|line| line.points.iter().map(|(_, value)| *value));
        let y = range::around(values, self.least_span);
        let axes = Axes { x: self.time, y, top, height: self.height };
        axes.draw(area, (9, 5), "");
        for line in &self.lines {
            let parts = line.points.split(|(_, value)| !value.is_finite());
            for part in parts.filter(|part| part.len() > 1) {
                let part: Vec<Point> = part.iter().map(|point| axes.px(*point)).collect();
                let mut part = simplify::simplified(&part, self.most_points);
                let ends = [part.last(), part.first()].map(|end| end.map(|(x, _)| (*x, top + self.height)));
                area.line(&part, &stroke(line.colour, line.width));
                if line.is_filled {
                    part.extend(ends.into_iter().flatten());
                    area.polygon(&part, &filled(line.colour, 0.25));
                }
            }
        }
    }
}
