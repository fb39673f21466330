//! The list of recorded series, found by a few letters of their names.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use crate::ui::formatting::cut;
use crate::ui::fuzzy;
use crate::ui::panel::row;
use crate::ui::popup::frame::popup;
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use crate::ui::theme::Role;

/// The inner size on a screen that has room for it.
const SIZE: (u16, u16) = (50, 16);

/// The search text, and the selected row.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SeriesList {
    pub(in crate::ui) query: TextField,
    selected: usize,
}

/// The result of a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::ui) enum SeriesKey {
    Open,
    Left,
    /// Show the series with this name, or hide it.
    Toggle(String),
}

/// Returns the indices of the series that match a query, the best first.
fn found(state: &Shared, query: &str) -> Vec<usize> {
    let all = state.series().iter().enumerate();
    let mut scored: Vec<(u32, usize)> =
        all.filter_map(|(at, series)| Some((fuzzy::score(query, &series.name)?, at))).collect();
    // Stable: series with equal scores stay in the order of the record.
    scored.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
    scored.into_iter().map(|(_, at)| at).collect()
}

/// Handles a key while the list is open.
pub(in crate::ui) fn key(list: &mut SeriesList, state: &Shared, event: KeyEvent) -> SeriesKey {
    let found = found(state, list.query.value());
    let last = found.len().saturating_sub(1);
    match event.code {
        KeyCode::Esc => return SeriesKey::Left,
        KeyCode::Enter => {
            let series = found.get(list.selected).and_then(|at| state.series().get(*at));
            return series.map_or(SeriesKey::Open, |series| SeriesKey::Toggle(series.name.clone()));
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
    SeriesKey::Open
}

/// Draws the list. Returns the position of the cursor.
pub(in crate::ui) fn draw(
    state: &Shared,
    list: &SeriesList,
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let inside = popup(theme, area, SIZE, "Series — Enter shows or hides, Esc closes", buffer);
    let found = found(state, list.query.value());
    let rows = usize::from(inside.height.saturating_sub(1));
    let first = (list.selected + 1).saturating_sub(rows);
    for (at, index) in found.iter().enumerate().skip(first).take(rows) {
        let Some(series) = state.series().get(*index) else { continue };
        let role = if at == list.selected { Role::Selected } else { Role::Text };
        let mark = if state.graphs.shows_series(&series.name) { "✓" } else { " " };
        let value = state.series_value(*index).map_or_else(|| "—".to_owned(), |value| format!("{value:.2}"));
        let name = cut(&series.name, 26);
        let text = format!(" {mark} {name:<26} {value:>10} {:<8}", cut(series.unit, 8));
        row(buffer, inside, 1 + (at - first) as u16, theme, role, &text);
    }
    if found.is_empty() {
        row(buffer, inside, 1, theme, Role::Dim, " Nothing found: fewer letters find more.");
    }
    row(buffer, inside, 0, theme, Role::Key, "> ");
    let field =
        Rect { x: inside.x + 2, width: inside.width.checked_sub(2)?, height: inside.height.min(1), ..inside };
    list.query.draw(theme, field, buffer)
}
