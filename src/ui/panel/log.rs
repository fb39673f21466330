//! 8 Log: every event and notice, the newest on top.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::ui::app_state::AppState;
use crate::ui::event_log::LogLine;
use crate::ui::formatting::clock_ms;
use crate::ui::panel::Panel;
use crate::ui::theme::Role;

use super::{line, row, span};
use crate::ui::text_wrap::{fitting, wrapped};

/// Columns of time and mark in front of the text.
const STAMP: usize = 12;

/// The title: how many lines are above the first one shown.
pub(crate) fn title(state: &AppState) -> String {
    let name = Panel::Log.title();
    match state.scrolls.log {
        0 => name.to_owned(),
        newer => format!("{name} — {newer} newer above"),
    }
}

/// Columns of the text.
fn text_width(area: Rect) -> usize {
    usize::from(area.width).saturating_sub(STAMP)
}

/// The furthest that the panel scrolls: then its oldest line is the last on the screen.
pub(crate) fn last_scroll(state: &AppState, area: Rect) -> usize {
    let rows = state.log.oldest_first().map(|entry| wrapped(&entry.text, text_width(area)).len());
    state.log.len().saturating_sub(fitting(rows, usize::from(area.height)))
}

/// The newest lines that are left out while an earlier instant is shown: all that came later but one.
fn later_above(state: &AppState) -> usize {
    let later = state.log.newest_first().take_while(|entry| state.is_later_than_shown(entry.time)).count();
    later.saturating_sub(1)
}

/// Draws the inside.
pub(crate) fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    if state.log.len() == 0 {
        row(buffer, area, 0, theme, Role::Dim, "Nothing has happened yet.");
        return;
    }
    let first = (state.scrolls.log + later_above(state)).min(last_scroll(state, area));
    let text_width = text_width(area);
    let mut at = 0;
    for entry in state.log.newest_first().skip(first) {
        let (mut mark, role) = match entry {
            LogLine { left_behind: true, .. } => ("╎", Role::Dim),
            later if state.is_later_than_shown(later.time) => (later.severity.glyph(), Role::Dim),
            LogLine { severity, .. } => (severity.glyph(), severity.role()),
        };
        let mut stamp = format!("{} ", clock_ms(entry.time));
        for part in wrapped(&entry.text, text_width) {
            if at == area.height {
                return;
            }
            let spans = vec![
                span(theme, Role::Dim, stamp),
                span(theme, role, format!("{mark} ")),
                span(theme, role, part),
            ];
            line(buffer, area, at, &Line::from(spans));
            at += 1;
            (stamp, mark) = (" ".repeat(STAMP - 2), " ");
        }
    }
}
