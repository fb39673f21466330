//! Shares of flights along a number, or by words.

use super::axes::{ACROSS, Axes, BELOW, LEFT, SMALL, WIDTH};
use super::canvas::{Anchor, Area, Height, filled, stroke, text, text_width};
use super::legend::Legend;
use super::{Colour, Picture, Point, range};

/// Height of the bars, px.
const HEIGHT: f64 = 150.0;
/// The greatest share on the axis is at least this, per cent.
const MIN_TOP: f64 = 10.0;

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
        let legend = Legend::new(&names, ACROSS);
        picture.draw((WIDTH, legend.height() + 6.0 + HEIGHT + BELOW), |area| {
            legend.draw(area, (LEFT, 0.0));
            self.draw(area, legend.height() + 6.0);
        })
    }

    fn draw(&self, area: &mut Area, top: f64) {
        let ends = self.bars.iter().flat_map(|bar| [bar.from, bar.to]);
        let marked = self.marks.iter().map(|(value, _)| *value);
        let x = range::around(ends.chain(marked), 0.01);
        let tallest = self.bars.iter().map(|bar| bar.share).fold(MIN_TOP, f64::max);
        let most = if self.curve.is_empty() { (tallest * 1.1).min(105.0) } else { 105.0 };
        let has_words = self.bars.iter().any(|bar| !bar.word.is_empty());
        let axes = Axes { x, y: (0.0, most), top, height: HEIGHT };
        axes.draw(area, (if has_words { 0 } else { 9 }, 5), " %");
        for style in [filled(Colour::First, 0.45), stroke(Colour::First, 0.25)] {
            for bar in &self.bars {
                area.rectangle([axes.px((bar.from, 0.0)), axes.px((bar.to, bar.share))], &style);
            }
        }
        let curve: Vec<Point> = self.curve.iter().map(|point| axes.px(*point)).collect();
        area.line(&curve, &stroke(Colour::Second, 1.75));
        for (value, _) in &self.marks {
            area.line(&[axes.px((*value, 0.0)), axes.px((*value, most))], &stroke(Colour::Plan, 1.25));
        }
        let px_each = ACROSS / (x.1 - x.0);
        let style = text(SMALL, Colour::Ink, Anchor::Middle, Height::Top);
        let fits = |bar: &&Bar| text_width(&bar.word, SMALL) < 1.3 * (bar.to - bar.from) * px_each;
        for bar in self.bars.iter().filter(|bar| !bar.word.is_empty()).filter(fits) {
            area.text(&bar.word, axes.px((f64::midpoint(bar.from, bar.to), most)), &style);
        }
    }
}
