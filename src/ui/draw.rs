//! Draws the whole screen: status, panels, hints, popups.

use crate::ui::acts::{availability, screen_layout, setting_changes};
use crate::ui::{area, survey_strip};
use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Color;
use ratatui::text::Line;
use ratatui::widgets::{Block, BorderType, Widget as _};

use super::app_state::AppState;
use super::popup::frame::{key_line, popup};
use super::popup::{
    Popup, action_menu, command_line, diff_view, flights_list, go_to, guards, help, layout_bar, map_menu,
    palette, signal_list, what_if,
};
use super::shared::Shared;
use super::text_wrap::wrapped;
use super::theme::{Charset, Role};
use super::{
    ascii, formatting, hint_bar, notice, panel, panel_bar, permission, status_bar, timeline, tutorial,
};
use crate::text::printable;
use crate::ui::acts::screen_layout::SMALLEST;
use crate::ui::area::span;
use crate::ui::model::action::Action;
use crate::ui::model::panel_table::Panel;

/// Draws the state; it only reads.
pub fn draw(state: &AppState, frame: &mut Frame<'_>) {
    let shared = &state.shared;
    let area = frame.area();
    let buffer = frame.buffer_mut();
    let screen = screen_layout::divided(shared, (area.width, area.height));
    let beside = screen.as_ref().and_then(|screen| screen.form);
    let cursor = match screen {
        Some(screen) => {
            status_bar::draw(shared, screen.status, buffer);
            let mut cursor = None;
            for &(panel, area) in &screen.panels {
                cursor = cursor.or(framed_panel(state, panel, area, buffer));
            }
            panel_bar::draw(shared, &screen, buffer);
            if matches!(state.popups.last(), Some(Popup::Diff(_))) {
                hint_bar::draw_doors(shared, screen.hints, buffer);
            } else {
                hint_bar::draw(&state.panels.of(shared.focus).hints(shared), shared, screen.hints, buffer);
            }
            if let Some(area) = screen.timeline {
                timeline::draw(shared, area, buffer);
            }
            if let Some(area) = screen.sweep {
                survey_strip::draw(shared, area, buffer);
            }
            let foot = screen.sweep.or(screen.timeline).unwrap_or(screen.hints);
            tutorial::draw(state.tutorial, shared, foot, buffer);
            notice::draw(shared, tutorial::rows(state.tutorial, shared, foot), foot, buffer);
            cursor
        }
        None => {
            too_small(shared, area, buffer);
            None
        }
    };
    let mut cursor = match shared.editor.popup {
        Some(_) => panel::editor_popup::draw(shared, area, beside, buffer),
        None => cursor,
    }
    .filter(|_| state.popups.is_empty());
    for popup in &state.popups {
        cursor = draw_popup(state, popup, area, buffer);
    }
    clean(buffer);
    paint_background(shared, buffer);
    if shared.theme.charset == Charset::Ascii {
        ascii::replace(buffer);
    }
    if let Some(position) = cursor.filter(|&position| area.contains(position)) {
        frame.set_cursor_position(position);
    }
}

/// Draws a popup. Returns the position of the cursor of its text field.
fn draw_popup(state: &AppState, popup: &Popup, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let shared = &state.shared;
    match popup {
        Popup::CommandLine => return command_line::draw(&state.command_line, shared, area, buffer),
        Popup::Flights(list) => return flights_list::draw(shared, list, area, buffer),
        Popup::Signals(list) => return signal_list::draw(shared, list, area, buffer),
        Popup::Palette(palette) => return palette::draw(shared, palette, area, buffer),
        Popup::Help(help) => return help::draw(shared, help, area, buffer),
        Popup::Diff(view) => return diff_view::draw(shared, view, area, buffer),
        Popup::GoTo(question) => go_to::draw(shared, question, area, buffer),
        Popup::MapMenu(menu) => map_menu::draw(&shared.theme, menu, area, buffer),
        Popup::WhatIf { selected } => {
            what_if::draw(&shared.theme, availability::flies(shared).is_ok(), *selected, area, buffer);
        }
        Popup::Guards { selected } => guards::draw(shared, *selected, area, buffer),
        Popup::Actions(menu) => action_menu::draw(shared, menu, area, buffer),
        Popup::ResetSettings => reset_question(shared, area, buffer),
        Popup::Layout => layout_bar::draw(shared, area, buffer),
        Popup::Quit => quit_question(shared, area, buffer),
        Popup::Permission => permission::draw(shared, area, buffer),
        Popup::Plots { selected } => panel::graphs::draw_choice(shared, *selected, area, buffer),
    }
    None
}

/// Fills in the colours of cells that have none, for themes that do not rely on the terminal's colours.
fn paint_background(state: &Shared, buffer: &mut Buffer) {
    let Some(background) = state.theme.background() else { return };
    let text = state.theme.colour(Role::Text);
    for cell in &mut buffer.content {
        if cell.bg == Color::Reset {
            cell.bg = background;
        }
        if cell.fg == Color::Reset {
            cell.fg = text;
        }
    }
}

/// Replaces characters that a terminal would obey instead of show, from any source.
fn clean(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        // Most cells are one byte, which the buffer itself keeps free of control characters.
        let symbol = cell.symbol();
        if symbol.len() > 1 && (!symbol.chars().all(printable::is_printable) || is_joined(symbol)) {
            cell.set_symbol("?");
        }
    }
}

/// Returns `true` for characters that some terminals join to one picture and others show beside each other, so that the rest
/// of the row would move.
fn is_joined(symbol: &str) -> bool {
    let is_modifier = |c: char| matches!(c, '\u{200d}' | '\u{fe0f}' | '\u{1f3fb}'..='\u{1f3ff}' | '\u{1f1e6}'..='\u{1f1ff}');
    symbol.chars().any(is_modifier)
}

/// Draws a panel with its frame. Returns the position of the cursor if it is in this panel.
fn framed_panel(state: &AppState, panel: Panel, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let shared = &state.shared;
    let theme = &shared.theme;
    let focused = shared.focus == panel;
    let content = state.panels.of(panel);
    let title = content.title(shared);
    let title = formatting::cut(&title, usize::from(area.width.saturating_sub(4)));
    let (mark, frame_role, title_role) =
        if focused { ("▸", Role::Focus, Role::Focus) } else { ("", Role::Dim, Role::Title) };
    Block::bordered()
        .border_type(BorderType::Plain)
        .border_style(theme.style(frame_role))
        .title(Line::from(span(theme, title_role, format!("{mark}{title}"))))
        .render(area, buffer);
    content.draw(shared, screen_layout::inner(area), buffer).filter(|_| focused)
}

fn too_small(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let text = format!(
        "betadeck needs at least {}x{}, now {}x{}. The flight goes on; {} quits.",
        SMALLEST.0,
        SMALLEST.1,
        area.width,
        area.height,
        state.key(Action::Quit)
    );
    for (row, line) in wrapped(&text, usize::from(area.width)).iter().enumerate() {
        area::row(buffer, area, row as u16, &state.theme, Role::Text, line);
    }
}

fn quit_question(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let inside = popup(&state.theme, area, (46, 3), "Quit?", buffer);
    let theme = &state.theme;
    area::row(buffer, inside, 0, theme, Role::Warn, " ▲ The craft is armed and flying ends here.");
    let answers = [(" y", " quit   "), ("n", " stay")];
    area::line(buffer, inside, 2, &key_line(theme, &answers));
}

fn reset_question(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let text = wrapped(&format!("▲ {}", setting_changes::reset_question(state)), 54);
    let inside = popup(theme, area, (56, text.len() as u16 + 2), "Defaults?", buffer);
    for (at, text) in (0..).zip(&text) {
        area::row(buffer, inside, at, theme, Role::Warn, &format!(" {text}"));
    }
    let answers = [(" y", " reset   "), ("n", " change nothing")];
    area::line(buffer, inside, text.len() as u16 + 1, &key_line(theme, &answers));
}
