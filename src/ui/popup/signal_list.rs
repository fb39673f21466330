//! The list of the signals and recorded series, found by a few letters of their names or by a word of their meaning.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use crate::ui::acts::named_signal::Named;
use crate::ui::area::row;
use crate::ui::formatting::cut;
use crate::ui::fuzzy;
use crate::ui::popup::frame::popup;
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use crate::ui::theme::Role;

/// The inner size on a screen that has room for it.
const SIZE: (u16, u16) = (60, 18);

/// The search text, and the selected row.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SignalList {
    pub(in crate::ui) query: TextField,
    selected: usize,
}

/// The result of a key press while the list of signals is open.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::ui) enum SignalKey {
    Open,
    Left,
    /// Show the signal or series with this name, or hide it.
    Toggle(String),
}

/// Returns the signals that match a query, the best first: those whose names match, then those whose meaning contains
/// it.
pub(in crate::ui) fn found<'a>(state: &'a Shared, query: &str) -> Vec<Named<'a>> {
    let word = query.trim().to_lowercase();
    let means = |named: &Named<'_>| named.help(state).is_some_and(|help| help.to_lowercase().contains(&word));
    let score = |named: Named<'a>| {
        let by_name = fuzzy::score(query, named.name()).map(|score| score + 1);
        Some((by_name.or_else(|| means(&named).then_some(0))?, named))
    };
    let mut scored: Vec<(u32, Named<'a>)> = Named::all(state).into_iter().filter_map(score).collect();
    // Stable: signals with equal scores stay in the order of the record.
    scored.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
    scored.into_iter().map(|(_, named)| named).collect()
}

/// Handles a key while the list is open.
pub(in crate::ui) fn key(list: &mut SignalList, state: &Shared, event: KeyEvent) -> SignalKey {
    let found = found(state, list.query.value());
    let last = found.len().saturating_sub(1);
    match event.code {
        KeyCode::Esc => return SignalKey::Left,
        KeyCode::Enter => {
            let selected = found.get(list.selected);
            return selected.map_or(SignalKey::Open, |named| SignalKey::Toggle(named.name().to_owned()));
        }
        KeyCode::Up => list.selected = list.selected.saturating_sub(1),
        KeyCode::Down => list.selected = (list.selected + 1).min(last),
        KeyCode::PageUp => list.selected = list.selected.saturating_sub(10),
        KeyCode::PageDown => list.selected = (list.selected + 10).min(last),
        _ => {
            if list.query.key(event) {
                list.selected = 0;
            }
        }
    }
    SignalKey::Open
}

/// Draws the list. Returns the position of the cursor.
pub(in crate::ui) fn draw(
    state: &Shared,
    list: &SignalList,
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let inside = popup(theme, area, SIZE, "Signals — Enter shows or hides, Esc closes", buffer);
    let found = found(state, list.query.value());
    // The first row is the search, the last the meaning.
    let rows = usize::from(inside.height.saturating_sub(2));
    let first = (list.selected + 1).saturating_sub(rows);
    for (at, named) in found.iter().enumerate().skip(first).take(rows) {
        let role = if at == list.selected { Role::Selected } else { Role::Text };
        let mark = if state.graphs.shows_series(named.name()) { "✓" } else { " " };
        let value = named.value(state).map_or_else(|| "—".to_owned(), |value| format!("{value:.2}"));
        let name = cut(named.name(), 26);
        let text = format!(" {mark} {name:<26} {value:>10} {:<18}", cut(&named.unit(), 8));
        row(buffer, inside, 1 + (at - first) as u16, theme, role, &text);
    }
    if let Some(help) = found.get(list.selected).and_then(|named| named.help(state)) {
        let help = cut(&help, usize::from(inside.width.saturating_sub(1)));
        row(buffer, inside, inside.height.saturating_sub(1), theme, Role::Dim, &format!(" {help}"));
    }
    if found.is_empty() {
        row(buffer, inside, 1, theme, Role::Dim, " Nothing found: fewer letters find more.");
    }
    row(buffer, inside, 0, theme, Role::Key, "> ");
    let field =
        Rect { x: inside.x + 2, width: inside.width.checked_sub(2)?, height: inside.height.min(1), ..inside };
    list.query.draw(theme, field, buffer)
}
