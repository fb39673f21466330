//! The states of a flight over time.

use plotters::chart::ChartBuilder;
use plotters::element::{Rectangle, Text};
use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{filled, stroke, text, text_width, units};
use super::chart::{BELOW, LEFT, RIGHT, SMALL, WIDTH, number};
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
        let px_per_s = (WIDTH - LEFT - RIGHT) / (to - from);
        let visible = || self.stays.iter().filter(|stay| (stay.to - stay.from) * px_per_s >= LEAST);
        let mut names: Vec<(Colour, f64, String)> = Vec::new();
        for stay in visible() {
            if !names.iter().any(|(colour, ..)| *colour == stay.colour) {
                names.push((stay.colour, 8.0, stay.name.to_owned()));
            }
        }
        let legend = Legend::new(&names, WIDTH - LEFT - RIGHT);
        picture.draw((WIDTH, legend.height() + 6.0 + HEIGHT + BELOW), |area| {
            legend.draw(area, (LEFT, 0.0))?;
            let mut chart = ChartBuilder::on(area)
                .margin_top(units(legend.height() + 6.0))
                .margin_right(units(RIGHT))
                .margin_left(units(LEFT))
                .x_label_area_size(units(BELOW))
                .build_cartesian_2d(from..to, 0.0..1.0)?;
            chart
                .configure_mesh()
                .disable_mesh()
                .axis_style(stroke(Colour::Axis, 1.0))
                .x_labels(9)
                .set_all_tick_mark_size(units(3.0))
                .x_label_formatter(&|seconds| number(*seconds))
                .label_style(text(SMALL, Colour::Label, HPos::Left, VPos::Top))
                .draw()?;
            let bars = visible()
                .map(|stay| Rectangle::new([(stay.from, 0.0), (stay.to, 1.0)], filled(stay.colour, 1.0)));
            chart.draw_series(bars)?;
            let fitting =
                |stay: &&Stay| text_width(&stay.label, SMALL) + 4.0 < (stay.to - stay.from) * px_per_s;
            let labels = visible().filter(fitting).map(|stay| {
                let style = text(SMALL, Colour::Paper, HPos::Center, VPos::Center);
                Text::new(stay.label.clone(), (f64::midpoint(stay.from, stay.to), 0.5), style)
            });
            chart.draw_series(labels)?;
            Ok(())
        })
    }
}
