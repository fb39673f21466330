//! The popup to choose a what-if.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::flight::forecast::{WHAT_IFS, WhatIf};
use crate::ui::popup::Outcome;
use crate::ui::popup::frame::{key_line, popup};
use crate::ui::theme::{Role, Theme};

use crate::ui::area::{line, row};

/// The width of the inside.
const WIDTH: u16 = 34;
/// The last row.
pub(crate) const GO_NO_GO: &str = "go or no-go (100 noisy flights)";

/// A row of the list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Choice {
    WhatIf(WhatIf),
    /// A hundred noisy flights of the plan, from home.
    GoNoGo,
}

/// Handles a key for the list; `selected` is the selected row.
pub(crate) fn key(selected: &mut usize, event: KeyEvent) -> Outcome<Choice> {
    match event.code {
        KeyCode::Up | KeyCode::Char('k') => *selected = selected.saturating_sub(1),
        KeyCode::Down | KeyCode::Char('j') => *selected = (*selected + 1).min(WHAT_IFS.len()),
        KeyCode::Enter => {
            let what_if = WHAT_IFS.into_iter().nth(*selected);
            return Outcome::Chosen(what_if.map_or(Choice::GoNoGo, Choice::WhatIf));
        }
        KeyCode::Esc | KeyCode::Char('w' | 'q') => return Outcome::Left,
        _ => {}
    }
    Outcome::Open
}

/// Returns the title; on the ground the plan is flown from home.
pub(crate) fn title(flies: bool) -> &'static str {
    if flies { "What if, from this instant on:" } else { "What if, flown from home:" }
}

/// Draws the popup; `selected` is the selected row.
pub(crate) fn draw(theme: &Theme, flies: bool, selected: usize, area: Rect, buffer: &mut Buffer) {
    let height = WHAT_IFS.len() as u16 + 3;
    let inside = popup(theme, area, (WIDTH, height), title(flies), buffer);
    let rows = WHAT_IFS.into_iter().map(|what_if| what_if.title).chain([GO_NO_GO.into()]);
    for (at, title) in rows.enumerate() {
        let (mark, role) = if at == selected { ("▸", Role::Selected) } else { (" ", Role::Text) };
        row(buffer, inside, at as u16, theme, role, &format!("{mark} {title}"));
    }
    let keys = [(" ↑ ↓", " choose  "), ("Enter", " fly  "), ("Esc", " close")];
    line(buffer, inside, height - 1, &key_line(theme, &keys));
}
