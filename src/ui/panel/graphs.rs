//! 6 Graphs: signals over time, in plots below each other with one time axis, and a cursor.

mod chart;
mod charts;
mod in_words;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::{Content, Hint};
use crate::signals::SimTime;
use crate::ui::formatting::{clock, clock_ms};
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::graphs::{Graph, PLOTS};
use crate::ui::model::message::{Change, NewPopup, Request};
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::frame::popup;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use crate::ui::area::row;
use chart::Chart;

/// The width of the numbers left of a plot.
const AXIS: u16 = 8;
/// The least number of rows of a plot with its title.
const MIN_ROWS: u16 = 4;

/// The Graphs panel; its signals and its cursor are shared.
#[derive(Debug, Default)]
pub(super) struct GraphsPanel;

impl Content for GraphsPanel {
    /// Returns the title with the shown time span and the cursor.
    fn title(&self, state: &Shared) -> String {
        let span = state.graphs.span_s();
        let span = if span < 1.0 {
            format!("{:.0} ms", span * 1000.0)
        } else if span < 120.0 {
            format!("{span:.0} s")
        } else {
            format!("{:.0} min", span / 60.0)
        };
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

    fn in_words(&self, state: &Shared) -> Vec<String> {
        in_words::lines(state)
    }

    fn hints(&self, state: &Shared) -> Vec<Hint> {
        let mut hints: Vec<Hint> = vec![
            (&[Action::Panel(PanelAction::CursorBack), Action::Panel(PanelAction::CursorOn)], "cursor"),
            (&[Action::Panel(PanelAction::SpanLess), Action::Panel(PanelAction::SpanMore)], "time"),
            (&[Action::Panel(PanelAction::ChoosePlots)], "choose"),
            (&[Action::Panel(PanelAction::ChooseSignals)], "find a signal"),
        ];
        if state.other.is_some() {
            hints.push((&[Action::ShiftEarlier, Action::ShiftLater], "shift"));
        }
        hints
    }

    fn act(&mut self, _: &Shared, action: PanelAction) -> Vec<Request> {
        vec![match action {
            PanelAction::CursorBack => Change::GraphsCursor(-1.0).into(),
            PanelAction::CursorOn => Change::GraphsCursor(1.0).into(),
            PanelAction::SpanLess => Change::GraphsSpan(-1).into(),
            PanelAction::SpanMore => Change::GraphsSpan(1).into(),
            PanelAction::ChoosePlots => Request::Open(NewPopup::Plots),
            PanelAction::ChooseSignals => Request::Open(NewPopup::Signals),
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
    let cursor = state.graphs.cursor_s(&state.view);
    let window = state.graphs.window(cursor);
    let graphs: Vec<Graph<'_>> = state.graphs.graphs(state.other_flight().is_some()).collect();
    if graphs.is_empty() {
        row(buffer, area, 0, theme, Role::Dim, "No graph is chosen: Enter lists them.");
        return;
    }
    if area.height <= MIN_ROWS || area.width <= AXIS + 8 {
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
    // The signals that were chosen by name are always visible.
    let is_named = |graph: &&Graph<'_>| matches!(graph, Graph::Named(_));
    let named = graphs.iter().filter(is_named);
    let plots = graphs.iter().filter(|graph| !is_named(graph));
    let charts = named.chain(plots).filter_map(|graph| charts::chart(state, *graph, window));
    let charts: Vec<Chart> = charts.collect();
    let fitting = usize::from(body.height / MIN_ROWS).clamp(1, charts.len().max(1));
    let rows = body.height / fitting as u16;
    let spare = body.height % fitting as u16;
    let mut y = body.y;
    for (at, chart) in charts.iter().take(fitting).enumerate() {
        let height = rows + u16::from((at as u16) < spare);
        chart::draw(state, chart, Rect { y, height, ..body }, window, buffer);
        y += height;
    }
    let curves = Rect { x: body.x + AXIS, width: body.width - AXIS, ..body };
    if let Some(cursor) = cursor {
        draw_cursor(state, curves, window, cursor, buffer);
    }
    draw_time_axis(state, area, window, charts.len().saturating_sub(fitting), buffer);
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
    let clock = if to - from < 10.0 { clock_ms } else { clock };
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

/// Returns the number of rows in the list of plots.
pub(crate) fn choices(state: &Shared) -> usize {
    if state.other.is_some() { 2 * PLOTS.len() } else { PLOTS.len() }
}

/// Draws the popup with the list of plots. The differences of two flights come after them.
pub(crate) fn draw_choice(state: &Shared, selected: usize, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let size = (50, choices(state) as u16);
    let inside = popup(theme, area, size, "Graphs — Enter shows or hides, Esc closes", buffer);
    let first = (selected + 1).saturating_sub(usize::from(inside.height));
    let rows = PLOTS.iter().map(|plot| (plot, "")).chain(PLOTS.iter().map(|plot| (plot, "Δ ")));
    let rows = rows.take(choices(state)).enumerate();
    for (at, (plot, difference)) in rows.skip(first).take(usize::from(inside.height)) {
        let role = if at == selected { Role::Selected } else { Role::Text };
        let mark = if state.graphs.is_shown(at) { "✓" } else { " " };
        let names: Vec<&str> = plot.curves.iter().rev().map(|curve| curve.1).collect();
        let names =
            if difference.is_empty() { names.join(", ") } else { "shown − second flight".to_owned() };
        let text = format!(" {mark} {:<12} {names:<34}", format!("{difference}{}", plot.name));
        row(buffer, inside, (at - first) as u16, theme, role, &text);
    }
}
