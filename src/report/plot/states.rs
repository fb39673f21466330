//! The states of a flight over time.

use super::axes::{ACROSS, Axes, BELOW, LEFT, SMALL, WIDTH};
use super::canvas::{Anchor, Height, filled, text, text_width};
use super::legend::Legend;
use super::{Colour, Picture};

/// Height of the bar, px.
const HEIGHT: f64 = 30.0;
/// The least width of a stay that is drawn, px.
const LEAST: f64 = 0.5;

/// A stay in a state.
#[derive(Debug, Clone)]
pub(in crate::report) struct Stay {
    /// Begin and end, s.
    pub(in crate::report) from: f64,
    pub(in crate::report) to: f64,
    /// The name of the state, for the legend.
    pub(in crate::report) name: &'static str,
    pub(in crate::report) colour: Colour,
    /// A short text inside the bar.
    pub(in crate::report) label: String,
}

/// The bar of the states.
#[derive(Debug, Clone, Default)]
pub(in crate::report) struct StateBar {
    /// The first and the last time, s.
    pub(in crate::report) time: (f64, f64),
    /// The stays, oldest first.
    pub(in crate::report) stays: Vec<Stay>,
}

impl StateBar {
    /// Returns the bar as SVG.
    pub(in crate::report) fn svg(&self, picture: &Picture) -> String {
        let (from, to) = self.time;
        let px_per_s = ACROSS / (to - from);
        let visible = || self.stays.iter().filter(|stay| (stay.to - stay.from) * px_per_s >= LEAST);
        let mut names: Vec<(Colour, f64, String)> = Vec::new();
        for stay in visible() {
            if !names.iter().any(|(colour, ..)| *colour == stay.colour) {
                names.push((stay.colour, 8.0, stay.name.to_owned()));
            }
        }
        let legend = Legend::new(&names, ACROSS);
        picture.draw((WIDTH, legend.height() + 6.0 + HEIGHT + BELOW), |area| {
            legend.draw(area, (LEFT, 0.0));
            let axes = Axes { x: self.time, y: (0.0, 1.0), top: legend.height() + 6.0, height: HEIGHT };
            axes.below(area, 9);
            for stay in visible() {
                let corners = [axes.px((stay.from, 0.0)), axes.px((stay.to, 1.0))];
                area.rectangle(corners, &filled(stay.colour, 1.0));
            }
            let fitting =
                |stay: &&Stay| text_width(&stay.label, SMALL) + 4.0 < (stay.to - stay.from) * px_per_s;
            let style = text(SMALL, Colour::Paper, Anchor::Middle, Height::Middle);
            for stay in visible().filter(fitting) {
                area.text(&stay.label, axes.px((f64::midpoint(stay.from, stay.to), 0.5)), &style);
            }
        })
    }
}
