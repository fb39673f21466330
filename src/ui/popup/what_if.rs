//! The popup to choose a what-if.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::flight::forecast::{WHAT_IFS, WhatIf};
use crate::ui::popup::Outcome;
use crate::ui::popup::frame::{key_line, popup};
use crate::ui::theme::{Role, Theme};

use crate::ui::panel::{line, row};

/// The width of the inside.
const WIDTH: u16 = 34;

/// Handles a key for the list; `selected` is the selected row.
pub(crate) fn key(selected: &mut usize, event: KeyEvent) -> Outcome<WhatIf> {
    match event.code {
        KeyCode::Up | KeyCode::Char('k') => *selected = selected.saturating_sub(1),
        KeyCode::Down | KeyCode::Char('j') => *selected = (*selected + 1).min(WHAT_IFS.len() - 1),
        KeyCode::Enter => {
            return WHAT_IFS.get(*selected).map_or(Outcome::Left, |&chosen| Outcome::Chosen(chosen));
        }
        KeyCode::Esc | KeyCode::Char('w' | 'q') => return Outcome::Left,
        _ => {}
    }
    Outcome::Open
}

/// Draws the popup; `selected` is the selected row.
pub(crate) fn draw(theme: &Theme, selected: usize, area: Rect, buffer: &mut Buffer) {
    let height = WHAT_IFS.len() as u16 + 2;
    let inside = popup(theme, area, (WIDTH, height), "What if, from this instant on:", buffer);
    for (at, what_if) in WHAT_IFS.iter().enumerate() {
        let (mark, role) = if at == selected { ("▸", Role::Selected) } else { (" ", Role::Text) };
        row(buffer, inside, at as u16, theme, role, &format!("{mark} {}", what_if.title));
    }
    let keys = [(" ↑ ↓", " choose  "), ("Enter", " fly  "), ("Esc", " close")];
    line(buffer, inside, height - 1, &key_line(theme, &keys));
}
