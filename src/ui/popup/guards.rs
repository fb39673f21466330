//! The popup that explains the shown guards and the abbreviations of the screen.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::telemetry::Guard;
use crate::ui::area::row;
use crate::ui::popup::frame::popup;
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// The width of the inside.
const WIDTH: u16 = 54;
/// The number of rows of an explanation.
const ROWS: u16 = 3;

/// The abbreviations of the status lines and panels.
const ABBREVIATIONS: [(&str, &str); 6] = [
    ("xte", "Cross-track error: how far the craft is beside its leg, positive to the right."),
    ("fence", "Distance from home at which the mission ends: ap_max_distance_from_home."),
    ("1×", "Speed of the simulated time: the current one, and the requested one where that is more."),
    ("sats", "Satellites in view of the receiver; 3D is a fix with altitude."),
    ("WP", "Waypoint, counted from 0."),
    ("ws tcp rc", "Doors for other programs: ● connected, ○ not connected, ✗ closed or busy."),
];

/// A name and its explanation.
type Entry = (&'static str, &'static str);

/// Returns the guards of the active state, then the abbreviations.
fn entries(state: &Shared) -> Vec<Entry> {
    let nav = state.view.vehicle.nav.as_ref();
    let explain = |guard: &Guard| -> Entry { (guard.name.into(), guard.name.explanation()) };
    let guards = nav.into_iter().flat_map(|nav| nav.guards.iter().map(explain));
    guards.chain(ABBREVIATIONS).collect()
}

/// Handles a key. Returns `false` if it closes the list.
pub(crate) fn key(selected: &mut usize, event: KeyEvent) -> bool {
    match event.code {
        KeyCode::Up | KeyCode::Char('k') => *selected = selected.saturating_sub(1),
        KeyCode::Down | KeyCode::Char('j') => *selected += 1,
        KeyCode::Esc | KeyCode::Enter | KeyCode::Char('q') => return false,
        _ => {}
    }
    true
}

/// Limits the selection to the existing entries.
pub(crate) fn limit(state: &Shared, selected: usize) -> usize {
    selected.min(entries(state).len() - 1)
}

/// Draws the list and, below it, the explanation of the selected entry.
pub(crate) fn draw(state: &Shared, selected: usize, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let entries = entries(state);
    let selected = limit(state, selected);
    let height = entries.len() as u16 + ROWS + 1;
    let title = "Meaning — ↑ ↓ choose, Esc closes";
    let inside = popup(theme, area, (WIDTH, height.min(area.height.saturating_sub(4))), title, buffer);
    let rows = usize::from(inside.height.saturating_sub(ROWS + 1));
    let first = (selected + 1).saturating_sub(rows);
    for (at, (name, _)) in entries.iter().enumerate().skip(first).take(rows) {
        let (mark, role) = if at == selected { ("▸", Role::Selected) } else { (" ", Role::Text) };
        row(buffer, inside, (at - first) as u16, theme, role, &format!("{mark} {name} "));
    }
    let text = wrapped(entries[selected].1, usize::from(inside.width.saturating_sub(2)));
    for (at, text) in text.iter().enumerate() {
        row(buffer, inside, rows as u16 + 1 + at as u16, theme, Role::Title, &format!(" {text}"));
    }
}
