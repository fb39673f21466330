//! A chart: curves over one time axis, with their names and present values above them.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::{Canvas, Line as CanvasLine};

use crate::ui::formatting::fixed;
use crate::ui::graphs::Stroke;
use crate::ui::panel::{line, row, span};
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::AXIS;

/// The values at a time: the time, s, the least and the greatest value. They are `None` where nothing is known.
pub(super) type Point = (f64, Option<(f64, f64)>);

/// A curve of a chart.
#[derive(Debug)]
pub(super) struct Strand {
    pub(super) name: String,
    pub(super) role: Role,
    pub(super) stroke: Stroke,
    /// The points, oldest first.
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

fn glyph(stroke: Stroke) -> &'static str {
    match stroke {
        Stroke::Solid => "──",
        Stroke::Dashed => "╌╌",
        Stroke::Dotted => "┈┈",
    }
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
pub(super) fn draw(state: &Shared, chart: &Chart, area: Rect, (from, to): (f64, f64), buffer: &mut Buffer) {
    let theme = &state.theme;
    let known = chart.strands.iter().flat_map(|strand| strand.points.iter().filter_map(|point| point.1));
    let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (least, greatest)| {
        (low.min(least), high.max(greatest))
    });
    let decimals = chart.decimals.unwrap_or_else(|| decimals_of((high - low).max(chart.least_range)));
    let mut title = vec![span(theme, Role::Title, chart.title.clone())];
    for strand in chart.strands.iter().rev() {
        let legend = [
            span(theme, strand.role, format!("  {} {}", glyph(strand.stroke), strand.name)),
            span(theme, Role::Text, fixed(strand.now, 7, decimals)),
        ];
        let width = title.iter().chain(&legend).map(Span::width).sum::<usize>();
        if width <= usize::from(area.width) {
            title.extend(legend);
        }
    }
    line(buffer, area, 0, &Line::from(title));
    let canvas = Rect::new(area.x + AXIS, area.y + 1, area.width - AXIS, area.height - 1);
    if low > high {
        row(buffer, canvas, 0, theme, Role::Dim, "—");
        return;
    }
    let spare = ((chart.least_range - (high - low)) / 2.0).max((high - low) * 0.04);
    let (low, high) = (low - spare, high + spare);
    let number = |value: f64| fixed(Some(value), usize::from(AXIS) - 2, decimals);
    row(buffer, area, 1, theme, Role::Dim, &format!("{} ┤", number(high)));
    row(buffer, area, area.height - 1, theme, Role::Dim, &format!("{} ┤", number(low)));
    let columns = usize::from(canvas.width) * 2;
    Canvas::default()
        .marker(theme.marker())
        .x_bounds([from, to])
        .y_bounds([low, high])
        .paint(|context| {
            for strand in &chart.strands {
                let colour = theme.colour(strand.role);
                for ((x1, y1), (x2, y2)) in segments(strand, (from, to), columns) {
                    context.draw(&CanvasLine { x1, y1, x2, y2, color: colour });
                }
                context.layer();
            }
        })
        .render(canvas, buffer);
}

/// A column of dots: its time, the least, the greatest and the last value.
#[derive(Debug, Clone, Copy)]
struct Column {
    column: usize,
    time_s: f64,
    least: f64,
    greatest: f64,
    last: f64,
}

/// Returns the strokes of a curve: at most one step per column of dots, over the least and the greatest value in it.
fn segments(strand: &Strand, (from, to): (f64, f64), columns: usize) -> Vec<((f64, f64), (f64, f64))> {
    // Rounds as the canvas does, so that no column of dots is left out.
    let last_column = columns.saturating_sub(1) as f64;
    let column_of = |time_s: f64| ((time_s - from) / (to - from) * last_column).round() as usize;
    let is_drawn = |column: usize| match strand.stroke {
        Stroke::Solid => true,
        Stroke::Dashed => column % 6 < 4,
        Stroke::Dotted => column.is_multiple_of(4),
    };
    let mut segments = Vec::new();
    let mut open: Option<Column> = None;
    let mut close = |bucket: Option<Column>| {
        if let Some(Column { column, time_s, least, greatest, .. }) = bucket
            && is_drawn(column)
        {
            segments.push(((time_s, least), (time_s, greatest)));
        }
    };
    for &(time_s, values) in &strand.points {
        let Some((least, greatest)) = values else {
            close(open.take());
            continue;
        };
        let (column, middle) = (column_of(time_s), f64::midpoint(least, greatest));
        match &mut open {
            Some(bucket) if bucket.column == column => {
                bucket.least = bucket.least.min(least);
                bucket.greatest = bucket.greatest.max(greatest);
                bucket.last = middle;
            }
            before => {
                let joined = before.map(|bucket| (bucket.time_s, bucket.last));
                close(before.take());
                if let Some((before_s, last)) = joined {
                    // Fills the columns between: points may be several columns apart.
                    let steps = column.saturating_sub(column_of(before_s)).clamp(1, 2 * columns);
                    let mix = |a: f64, b: f64, step: usize| a + (b - a) * step as f64 / steps as f64;
                    for step in 1..steps {
                        let (time_s, value) = (mix(before_s, time_s, step), mix(last, middle, step));
                        let column = column_of(time_s);
                        close(Some(Column { column, time_s, least: value, greatest: value, last: value }));
                    }
                }
                let half = joined.map(|(_, last)| f64::midpoint(last, middle));
                let (least, greatest) =
                    half.map_or((least, greatest), |half| (half.min(least), half.max(greatest)));
                *before = Some(Column { column, time_s, least, greatest, last: middle });
            }
        }
    }
    close(open);
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strand(points: Vec<Point>) -> Strand {
        Strand { name: String::new(), role: Role::Track, stroke: Stroke::Solid, points, now: None }
    }

    #[test]
    fn each_column_between_two_points_is_filled_and_a_gap_is_not() {
        let points =
            vec![(0.0, Some((0.0, 0.0))), (5.0, Some((5.0, 5.0))), (6.0, None), (9.0, Some((9.0, 9.0)))];
        let drawn = segments(&strand(points), (0.0, 9.0), 10);
        let times: Vec<_> = drawn.iter().map(|((time_s, _), _)| time_s.round()).collect();
        assert_eq!(times, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 9.0]);
    }

    #[test]
    fn the_extremes_of_a_step_are_drawn() {
        let points = vec![(0.0, Some((0.0, 0.0))), (1.0, Some((-3.0, 7.0))), (1.01, Some((1.0, 1.0)))];
        let drawn = segments(&strand(points), (0.0, 9.0), 10);
        assert_eq!(drawn[1], ((1.0, -3.0), (1.0, 7.0)));
    }

    #[test]
    fn small_ranges_have_more_decimals() {
        assert_eq!([0.3, 5.0, 50.0, 5000.0].map(decimals_of), [3, 2, 1, 0]);
    }
}
