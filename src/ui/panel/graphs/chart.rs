//! A chart: curves over one time axis, with their names and present values above them.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use crate::ui::area::{line, row, span};
use crate::ui::axis::ticks;
use crate::ui::curve::{self, Limits, Point, Stroke};
use crate::ui::formatting::fixed;
use crate::ui::raster::Raster;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::AXIS;

/// The rows of a chart from which it has ticks at round values. A lower one shows its limits.
const ROWS_FOR_TICKS: u16 = 5;
/// The least distance between two ticks, rows.
const ROWS_OF_A_TICK: u16 = 2;
/// The distance between two dots of the zero line, dots.
const ZERO_GAP: usize = 8;

/// A curve of a chart.
#[derive(Debug)]
pub(super) struct Strand {
    pub(super) name: String,
    pub(super) role: Role,
    pub(super) stroke: Stroke,
    /// The points, oldest first, over times in s.
    pub(super) points: Vec<Point>,
    /// The value at the cursor.
    pub(super) now: Option<f64>,
}

/// Curves with one axis. All values are in the shown unit.
#[derive(Debug)]
pub(super) struct Chart {
    pub(super) title: String,
    /// The least range of the axis, so that noise does not fill the chart.
    pub(super) least_range: f64,
    /// The decimals of numbers; `None` for as many as the range needs.
    pub(super) decimals: Option<usize>,
    /// The curves; the last is the most important.
    pub(super) strands: Vec<Strand>,
}

/// Returns the decimals that show a hundredth of a range.
fn decimals_of(range: f64) -> usize {
    match range {
        range if range < 1.0 => 3,
        range if range < 10.0 => 2,
        range if range < 200.0 => 1,
        _ => 0,
    }
}

/// Draws the chart for a time, s.
pub(super) fn draw(state: &Shared, chart: &Chart, area: Rect, along: (f64, f64), buffer: &mut Buffer) {
    let theme = &state.theme;
    let known = chart.strands.iter().flat_map(|strand| strand.points.iter().filter_map(|point| point.1));
    let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (least, greatest)| {
        (low.min(least), high.max(greatest))
    });
    let decimals = chart.decimals.unwrap_or_else(|| decimals_of((high - low).max(chart.least_range)));
    draw_legend(state, chart, decimals, area, buffer);
    let plot = Rect::new(area.x + AXIS, area.y + 1, area.width - AXIS, area.height - 1);
    if low > high {
        row(buffer, plot, 0, theme, Role::Dim, "—");
        return;
    }
    let spare = ((chart.least_range - (high - low)) / 2.0).max((high - low) * 0.04);
    let limits = Limits { along, values: (low - spare, high + spare) };
    draw_axis(state, limits.values, decimals, Rect { x: area.x, width: AXIS, ..plot }, buffer);
    if limits.values.0 < 0.0 && limits.values.1 > 0.0 {
        draw_zero_line(state, limits.values, plot, buffer);
    }
    for stroke in Stroke::BY_DENSITY {
        for strand in chart.strands.iter().filter(|strand| strand.stroke == stroke) {
            let mut raster = Raster::new(plot);
            curve::draw(&mut raster, limits, stroke, &strand.points);
            raster.add(theme.style(strand.role), theme.charset, stroke.plain(), buffer);
        }
    }
}

/// Draws the title, and the names and values of the curves for which there is room.
fn draw_legend(state: &Shared, chart: &Chart, decimals: usize, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let mut title = vec![span(theme, Role::Title, chart.title.clone())];
    for strand in chart.strands.iter().rev() {
        let sign = strand.stroke.sign(theme.charset);
        let legend = [
            span(theme, strand.role, format!("  {sign} {}", strand.name)),
            span(theme, Role::Text, fixed(strand.now, 7, decimals)),
        ];
        let width = title.iter().chain(&legend).map(Span::width).sum::<usize>();
        if width <= usize::from(area.width) {
            title.extend(legend);
        }
    }
    line(buffer, area, 0, &Line::from(title));
}

/// Draws the numbers of the axis: round values, or the limits of a low chart.
fn draw_axis(state: &Shared, (low, high): (f64, f64), decimals: usize, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let row_of = |value: f64| ((high - value) / (high - low) * f64::from(area.height) - 0.5).round();
    let mut label = |at: u16, value: f64, decimals| {
        let number = fixed(Some(value), usize::from(AXIS) - 2, decimals);
        row(buffer, area, at, theme, Role::Dim, &format!("{number} ┤"));
    };
    if area.height < ROWS_FOR_TICKS {
        label(0, high, decimals);
        label(area.height - 1, low, decimals);
        let zero = row_of(0.0);
        if zero > 0.0 && zero < f64::from(area.height - 1) {
            label(zero as u16, 0.0, 0);
        }
        return;
    }
    for tick in ticks(low, high, usize::from(area.height / ROWS_OF_A_TICK)) {
        label(row_of(tick).clamp(0.0, f64::from(area.height - 1)) as u16, tick, decimals);
    }
}

fn draw_zero_line(state: &Shared, (low, high): (f64, f64), plot: Rect, buffer: &mut Buffer) {
    let mut raster = Raster::new(plot);
    let (columns, rows) = raster.dots();
    let y = high / (high - low) * rows.saturating_sub(1) as f64;
    for x in (0..columns).step_by(ZERO_GAP) {
        raster.dot((x as f64, y));
    }
    raster.add(state.theme.style(Role::Backdrop), state.theme.charset, '-', buffer);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_ranges_have_more_decimals() {
        assert_eq!([0.3, 5.0, 50.0, 5000.0].map(decimals_of), [3, 2, 1, 0]);
    }
}
