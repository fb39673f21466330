//! 6 Graphs: signals over time, in plots below each other with one time axis, and a cursor.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget as _;
use ratatui::widgets::canvas::{Canvas, Line as CanvasLine};

use crate::signals::SimTime;
use crate::telemetry::quantity::Dimension;
use crate::telemetry::signal::Signal;
use crate::ui::action::{Action, PanelAction};
use crate::ui::formatting::{clock, fixed};
use crate::ui::graphs::{PLOTS, Plot, Sample, Stroke};
use crate::ui::message::{Change, Request};
use crate::ui::panel::{Content, Hint, Panel};
use crate::ui::popup::Popup;
use crate::ui::popup::frame::popup;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::{line, row, span};

/// The width of the numbers left of a plot.
const AXIS: u16 = 8;
/// The least number of rows of a plot with its title.
const LEAST_ROWS: u16 = 4;

/// The Graphs panel; its signals and its cursor are shared.
#[derive(Debug, Default)]
pub(super) struct GraphsPanel;

impl Content for GraphsPanel {
    /// Returns the title with the shown time span and the cursor.
    fn title(&self, state: &Shared) -> String {
        let span = state.graphs.span_s();
        let span = if span < 120.0 { format!("{span:.0} s") } else { format!("{:.0} min", span / 60.0) };
        let cursor = state
            .graphs
            .cursor_s(&state.view)
            .map_or_else(String::new, |cursor| format!(" — at {}", clock(SimTime::from_secs_f64(cursor))));
        format!("{} — {span}{cursor}", state.panel_title(Panel::Graphs))
    }

    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw(state, area, buffer);
        None
    }

    fn hints(&self, _: &Shared) -> Vec<Hint> {
        vec![
            (&[Action::Panel(PanelAction::CursorBack), Action::Panel(PanelAction::CursorOn)], "cursor"),
            (&[Action::Panel(PanelAction::SpanLess), Action::Panel(PanelAction::SpanMore)], "time"),
            (&[Action::Panel(PanelAction::ChoosePlots)], "choose"),
        ]
    }

    fn act(&mut self, _: &Shared, action: PanelAction) -> Vec<Request> {
        vec![match action {
            PanelAction::CursorBack => Change::GraphsCursor(-1.0).into(),
            PanelAction::CursorOn => Change::GraphsCursor(1.0).into(),
            PanelAction::SpanLess => Change::GraphsSpan(-1).into(),
            PanelAction::SpanMore => Change::GraphsSpan(1).into(),
            PanelAction::ChoosePlots => Request::Open(Popup::Plots { selected: 0 }),
            PanelAction::CursorOff => Change::NoGraphsCursor.into(),
            _ => return Vec::new(),
        }]
    }

    fn go_back(&mut self, state: &Shared) -> Option<Vec<Request>> {
        state.graphs.pointed_at().map(|_| vec![Change::NoGraphsCursor.into()])
    }
}

fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let plots: Vec<&Plot> = state.graphs.plots().collect();
    if plots.is_empty() {
        row(buffer, area, 0, theme, Role::Dim, "No graph is chosen: Enter lists them.");
        return;
    }
    if area.height <= LEAST_ROWS || area.width <= AXIS + 8 {
        row(
            buffer,
            area,
            0,
            theme,
            Role::Dim,
            &format!("Too little room: {} zooms.", state.key(Action::Zoom)),
        );
        return;
    }
    let body = Rect { height: area.height - 1, ..area };
    let fitting = usize::from(body.height / LEAST_ROWS).clamp(1, plots.len());
    let cursor = state.graphs.cursor_s(&state.view);
    let window = state.graphs.window(cursor);
    let rows = body.height / fitting as u16;
    let spare = body.height % fitting as u16;
    let mut y = body.y;
    for (at, plot) in plots.iter().take(fitting).enumerate() {
        let height = rows + u16::from((at as u16) < spare);
        draw_plot(state, plot, Rect { y, height, ..body }, window, buffer);
        y += height;
    }
    let curves = Rect { x: body.x + AXIS, width: body.width - AXIS, ..body };
    if let Some(cursor) = cursor {
        draw_cursor(state, curves, window, cursor, buffer);
    }
    draw_time_axis(state, area, window, plots.len() - fitting, buffer);
}

/// Returns the factor and the unit for the values of a plot, and the number of decimals.
fn unit(state: &Shared, dimension: Dimension) -> (f64, &'static str, usize) {
    let units = state.units;
    match dimension {
        Dimension::LENGTH => (units.length(1.0), units.length_unit(), 1),
        Dimension::SPEED => (units.speed(1.0), units.speed_unit(), 1),
        Dimension::ANGLE => (1.0, "°", 1),
        Dimension::PULSE => (1.0, "µs", 0),
        Dimension::VOLTAGE => (1.0, "V", 2),
        Dimension::CURRENT => (1.0, "A", 1),
        _ => (100.0, "%", 0),
    }
}

/// Returns the role of the curve at this index of its plot; the last one is the most important.
fn role(plot: &Plot, at: usize) -> Role {
    match plot.curves.len() - 1 - at {
        0 => Role::Track,
        1 => Role::Target,
        2 => Role::Key,
        _ => Role::Warn,
    }
}

fn glyph(stroke: Stroke) -> &'static str {
    match stroke {
        Stroke::Solid => "──",
        Stroke::Dashed => "╌╌",
        Stroke::Dotted => "┈┈",
    }
}

fn draw_plot(state: &Shared, plot: &Plot, area: Rect, (from, to): (f64, f64), buffer: &mut Buffer) {
    let theme = &state.theme;
    let (factor, unit, decimals) = unit(state, plot.dimension());
    let now = state.graphs.sample_at(state.graphs.cursor_s(&state.view));
    let mut title = vec![span(theme, Role::Title, format!("{} {unit}", plot.name))];
    for (at, (signal, name, stroke)) in plot.curves.iter().enumerate().rev() {
        let value = now.and_then(|sample| sample.value(*signal)).map(|value| value * factor);
        let legend = [
            span(theme, role(plot, at), format!("  {} {name}", glyph(*stroke))),
            span(theme, Role::Text, fixed(value, 7, decimals)),
        ];
        let width = title.iter().chain(&legend).map(Span::width).sum::<usize>();
        if width <= usize::from(area.width) {
            title.extend(legend);
        }
    }
    line(buffer, area, 0, &Line::from(title));

    let samples: Vec<&Sample> = state.graphs.samples(from, to).collect();
    let values = plot.curves.iter().flat_map(|(signal, ..)| samples.iter().filter_map(|s| s.value(*signal)));
    let (low, high) = values
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let canvas = Rect::new(area.x + AXIS, area.y + 1, area.width - AXIS, area.height - 1);
    if low > high {
        row(buffer, canvas, 0, theme, Role::Dim, "—");
        return;
    }
    let spare = ((plot.least_range - (high - low)) / 2.0).max((high - low) * 0.04);
    let (low, high) = (low - spare, high + spare);
    let number = |value: f64| fixed(Some(value * factor), usize::from(AXIS) - 2, decimals);
    row(buffer, area, 1, theme, Role::Dim, &format!("{} ┤", number(high)));
    row(buffer, area, area.height - 1, theme, Role::Dim, &format!("{} ┤", number(low)));
    let columns = usize::from(canvas.width) * 2;
    Canvas::default()
        .marker(theme.marker())
        .x_bounds([from, to])
        .y_bounds([low, high])
        .paint(|context| {
            for (at, (signal, _, stroke)) in plot.curves.iter().enumerate() {
                let colour = theme.colour(role(plot, at));
                for ((x1, y1), (x2, y2)) in segments(&samples, *signal, *stroke, (from, to), columns) {
                    context.draw(&CanvasLine { x1, y1, x2, y2, color: colour });
                }
                context.layer();
            }
        })
        .render(canvas, buffer);
}

/// Returns the strokes of a curve: at most one step per column of dots, over the least and the greatest value in it.
fn segments(
    samples: &[&Sample],
    signal: Signal,
    stroke: Stroke,
    (from, to): (f64, f64),
    columns: usize,
) -> Vec<((f64, f64), (f64, f64))> {
    // Rounds as the canvas does, so that no column of dots is left out.
    let last = columns.saturating_sub(1) as f64;
    let column_of = |time_s: f64| ((time_s - from) / (to - from) * last).round() as usize;
    let is_drawn = |column: usize| match stroke {
        Stroke::Solid => true,
        Stroke::Dashed => column % 6 < 4,
        Stroke::Dotted => column.is_multiple_of(4),
    };
    let mut segments = Vec::new();
    // Column, time, least, greatest and last value.
    let mut open: Option<(usize, f64, f64, f64, f64)> = None;
    let mut close = |bucket: Option<(usize, f64, f64, f64, f64)>| {
        if let Some((column, time, least, greatest, _)) = bucket
            && is_drawn(column)
        {
            segments.push(((time, least), (time, greatest)));
        }
    };
    for sample in samples {
        let Some(value) = sample.value(signal) else {
            close(open.take());
            continue;
        };
        let column = column_of(sample.time_s);
        match &mut open {
            Some((at, _, least, greatest, last)) if *at == column => {
                *least = least.min(value);
                *greatest = greatest.max(value);
                *last = value;
            }
            before => {
                let joined = before.map(|(_, time, .., last)| (time, last));
                close(before.take());
                if let Some((time, last)) = joined {
                    // Fills the columns between: samples may be several columns apart.
                    let steps = column.saturating_sub(column_of(time)).clamp(1, 2 * columns);
                    let mix = |a: f64, b: f64, step: usize| a + (b - a) * step as f64 / steps as f64;
                    for step in 1..steps {
                        let point = (mix(time, sample.time_s, step), mix(last, value, step));
                        close(Some((column_of(point.0), point.0, point.1, point.1, point.1)));
                    }
                }
                let (least, greatest) = joined.map_or((value, value), |(_, last)| {
                    let half = f64::midpoint(last, value);
                    (half.min(value), half.max(value))
                });
                *before = Some((column, sample.time_s, least, greatest, value));
            }
        }
    }
    close(open);
    segments
}

fn draw_cursor(state: &Shared, area: Rect, (from, to): (f64, f64), cursor: f64, buffer: &mut Buffer) {
    let share = (cursor - from) / (to - from);
    if !(0.0..=1.0).contains(&share) {
        return;
    }
    let column = area.x + (share * f64::from(area.width - 1)).round() as u16;
    for y in area.top()..area.bottom() {
        if let Some(cell) = buffer.cell_mut((column, y))
            && matches!(cell.symbol(), " " | "\u{2800}")
        {
            cell.set_symbol("│").set_style(state.theme.style(Role::Focus));
        }
    }
}

fn draw_time_axis(state: &Shared, area: Rect, (from, to): (f64, f64), hidden: usize, buffer: &mut Buffer) {
    let theme = &state.theme;
    let left = clock(SimTime::from_secs_f64(from.max(0.0)));
    let right = clock(SimTime::from_secs_f64(to.max(0.0)));
    let middle = match hidden {
        0 => String::new(),
        hidden => format!("{hidden} more: {} zooms", state.key(Action::Zoom)),
    };
    let width = usize::from(area.width - AXIS).saturating_sub(left.len() + right.len());
    let text = format!("{}{left}{middle:^width$}{right}", " ".repeat(usize::from(AXIS)));
    row(buffer, area, area.height - 1, theme, Role::Dim, &text);
}

/// Draws the popup with the list of plots.
pub(crate) fn draw_choice(state: &Shared, selected: usize, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let size = (50, PLOTS.len() as u16);
    let inside = popup(theme, area, size, "Graphs — Enter shows or hides, Esc closes", buffer);
    let first = (selected + 1).saturating_sub(usize::from(inside.height));
    for (at, plot) in PLOTS.iter().enumerate().skip(first).take(usize::from(inside.height)) {
        let role = if at == selected { Role::Selected } else { Role::Text };
        let mark = if state.graphs.is_shown(at) { "✓" } else { " " };
        let names: Vec<&str> = plot.curves.iter().rev().map(|curve| curve.1).collect();
        let text = format!(" {mark} {:<12} {:<34}", plot.name, names.join(", "));
        row(buffer, inside, (at - first) as u16, theme, role, &text);
    }
}
