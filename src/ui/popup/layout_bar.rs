//! The keys that arrange the panels, in place of the hints.

use crate::ui::acts::named_layouts;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use crate::ui::area::span;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;
use crate::ui::{drawing, notice};

/// The keys and their effects, the most useful first.
const KEYS: [(&str, &str); 6] =
    [("←→↑↓", "size"), ("Tab", "panel"), ("s", "swap"), ("Esc", "done"), ("w", "save"), ("0", "default")];

/// Draws the keys and the names of the layouts: in one line, or in two if one has no room for them.
pub(in crate::ui) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let keys: Vec<_> = KEYS.map(|(key, effect)| (key.to_owned(), effect.to_owned())).to_vec();
    let names: Vec<_> = (1..=9)
        .zip(named_layouts::names(state))
        .map(|(key, name)| (key.to_string(), name.to_owned()))
        .collect();
    let all = [&keys[..], &names[..]].concat();
    if draw_line(state, area, 1, &all, buffer) {
        return;
    }
    draw_line(state, area, 1, &keys, buffer);
    // A notice is in the row of the names until the next key.
    if !notice::is_shown(state) {
        draw_line(state, area, 2, &names, buffer);
    }
}

/// Draws keys and their effects in a row counted from below, as many as have room. Returns `true` if all have.
fn draw_line(state: &Shared, area: Rect, row: u16, hints: &[(String, String)], buffer: &mut Buffer) -> bool {
    let theme = &state.theme;
    let y = area.bottom().saturating_sub(row).max(area.y);
    let mut spans: Vec<Span<'static>> = vec![span(theme, Role::Active, " LAYOUT ")];
    let mut has_room = true;
    for (key, effect) in hints {
        let hint =
            [span(theme, Role::Key, format!(" {key}")), span(theme, Role::Text, format!(" {effect} "))];
        let width = spans.iter().chain(&hint).map(Span::width).sum::<usize>();
        if width > usize::from(area.width) {
            has_room = false;
            break;
        }
        spans.extend(hint);
    }
    let blank = " ".repeat(usize::from(area.width));
    drawing::text(buffer, area.x, y, blank, theme.style(Role::Text));
    drawing::line(buffer, area.x, y, &Line::from(spans), area.width);
    has_room
}
