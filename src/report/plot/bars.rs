//! Shares of flights along a number, or by words.

use plotters::chart::ChartBuilder;
use plotters::element::{PathElement, Rectangle, Text};
use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{Area, Drawn, filled, stroke, text, text_width, units};
use super::chart::{BELOW, LEFT, RIGHT, SMALL, WIDTH, number};
use super::legend::Legend;
use super::{Colour, Picture, Point, range};

/// Height of the bars, px.
const HEIGHT: f64 = 150.0;
/// The greatest share on the axis is at least this, per cent.
const LEAST_TOP: f64 = 10.0;

/// A picture of bars.
#[derive(Debug, Clone, Default)]
pub(in crate::report) struct Bars {
    /// The bars in their order.
    pub(in crate::report) bars: Vec<Bar>,
    /// Values and shares of flights up to them, per cent.
    pub(in crate::report) curve: Vec<Point>,
    /// Values to be marked by a dashed line, with their names.
    pub(in crate::report) marks: Vec<(f64, String)>,
    /// The meaning of the bars and of the curve.
    pub(in crate::report) names: [String; 2],
}

/// A bar.
#[derive(Debug, Clone)]
pub(in crate::report) struct Bar {
    pub(in crate::report) from: f64,
    pub(in crate::report) to: f64,
    /// Its height, per cent.
    pub(in crate::report) share: f64,
    /// A word for it instead of the numbers of the axis; may be empty.
    pub(in crate::report) word: String,
}

impl Bars {
    /// Returns the picture as SVG.
    pub(in crate::report) fn svg(&self, picture: &Picture) -> String {
        let [bars, curve] = &self.names;
        let mut names = vec![(Colour::First, 8.0, bars.clone())];
        if !self.curve.is_empty() {
            names.push((Colour::Second, 1.75, curve.clone()));
        }
        names.extend(self.marks.iter().map(|(_, name)| (Colour::Plan, 1.25, name.clone())));
        let legend = Legend::new(&names, WIDTH - LEFT - RIGHT);
        picture.draw((WIDTH, legend.height() + 6.0 + HEIGHT + BELOW), |area| {
            legend.draw(area, (LEFT, 0.0))?;
            self.draw(area, legend.height())
        })
    }

    fn draw(&self, area: &Area<'_>, top: f64) -> Drawn {
        let ends = self.bars.iter().flat_map(|bar| [bar.from, bar.to]);
        let marked = self.marks.iter().map(|(value, _)| *value);
        let (low, high) = range::around(ends.chain(marked), 0.01);
        let tallest = self.bars.iter().map(|bar| bar.share).fold(LEAST_TOP, f64::max);
        let most = if self.curve.is_empty() { (tallest * 1.1).min(105.0) } else { 105.0 };
        let has_words = self.bars.iter().any(|bar| !bar.word.is_empty());
        let mut chart = ChartBuilder::on(area)
            .margin_top(units(top + 6.0))
            .margin_right(units(RIGHT))
            .x_label_area_size(units(BELOW))
            .y_label_area_size(units(LEFT))
            .build_cartesian_2d(low..high, 0.0..most)?;
        chart
            .configure_mesh()
            .light_line_style(stroke(Colour::Grid, 0.0))
            .max_light_lines(0)
            .bold_line_style(stroke(Colour::Grid, 1.0))
            .axis_style(stroke(Colour::Axis, 1.0))
            .x_labels(if has_words { 0 } else { 9 })
            .y_labels(5)
            .set_all_tick_mark_size(units(3.0))
            .x_label_formatter(&|value| number(*value))
            .y_label_formatter(&|share| format!("{} %", number(*share)))
            .label_style(text(SMALL, Colour::Label, HPos::Left, VPos::Top))
            .draw()?;
        let inside = |value: f64| value.clamp(low, high);
        let shape = |bar: &Bar| [(inside(bar.from), 0.0), (inside(bar.to), bar.share.min(most))];
        chart.draw_series(
            self.bars.iter().map(|bar| Rectangle::new(shape(bar), filled(Colour::First, 0.45))),
        )?;
        chart.draw_series(
            self.bars.iter().map(|bar| Rectangle::new(shape(bar), stroke(Colour::First, 1.0))),
        )?;
        let curve: Vec<Point> = self.curve.iter().map(|&(value, share)| (inside(value), share)).collect();
        chart.draw_series([PathElement::new(curve, stroke(Colour::Second, 1.75))])?;
        let lines = self.marks.iter().map(|&(value, _)| {
            PathElement::new(vec![(inside(value), 0.0), (inside(value), most)], stroke(Colour::Plan, 1.25))
        });
        chart.draw_series(lines)?;
        let px_each = (WIDTH - LEFT - RIGHT) / (high - low);
        let words = self.bars.iter().filter(|bar| {
            !bar.word.is_empty() && text_width(&bar.word, SMALL) < 1.3 * (bar.to - bar.from) * px_each
        });
        chart.draw_series(words.map(|bar| {
            let style = text(SMALL, Colour::Ink, HPos::Center, VPos::Top);
            Text::new(bar.word.clone(), (f64::midpoint(bar.from, bar.to), most), style)
        }))?;
        Ok(())
    }
}
