//! The help popup: the keys of the focused panel and the general ones, from the action table.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::ui::action::{ACTIONS, Context};
use crate::ui::popup::frame::popup;
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::{Role, Theme};

use super::{line, span};

/// The width of the keys.
const KEYS: usize = 12;

/// Draws the popup, scrolled down by `scroll` lines.
pub(crate) fn draw(state: &Shared, scroll: usize, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    // The width inside the frame.
    let columns = usize::from(area.width.saturating_sub(2));
    let mut lines: Vec<Line<'static>> = Vec::new();
    let own =
        |context: Context| matches!(context, Context::In(_) | Context::Lists) && context.applies(state.focus);
    let general = |context: Context| matches!(context, Context::Global | Context::Always);
    let sections: [(String, &dyn Fn(Context) -> bool); 2] =
        [(format!("In {}", state.panel_title(state.focus)), &own), ("Everywhere".to_owned(), &general)];
    for (title, wanted) in sections {
        let rows: Vec<_> = ACTIONS.iter().filter(|spec| wanted(spec.context)).collect();
        if rows.is_empty() {
            continue;
        }
        lines.push(Line::from(span(theme, Role::Title, title)));
        for spec in rows {
            let keys = state.keymap.shown_keys(spec.action);
            lines.extend(explained(theme, &keys.join(" "), spec.help, columns));
        }
    }
    lines.push(Line::from(span(theme, Role::Title, "Mouse")));
    for (what, text) in [
        ("click", "Focus a panel, set a channel"),
        ("double", "Add a waypoint on the map"),
        ("drag", "Move the map"),
        ("right", "What can be done at a place of the map"),
        ("wheel", "Zoom the map at the pointer, scroll the others"),
        ("Shift", "Lets the terminal select text"),
    ] {
        lines.extend(explained(theme, what, text, columns));
    }
    let width = lines.iter().map(Line::width).max().unwrap_or(0) as u16 + 1;
    let height = lines.len() as u16;
    let shows = area.height.saturating_sub(4).min(height);
    let inside = popup(theme, area, (width, shows), "Keys — any other key closes, ↑ ↓ scroll", buffer);
    let first = scroll.min(lines.len().saturating_sub(usize::from(inside.height)));
    for (at, text) in lines.iter().skip(first).take(usize::from(inside.height)).enumerate() {
        line(buffer, inside, at as u16, text);
    }
}

/// Returns keys and their explanation, in as many lines as it takes at this width.
fn explained(theme: &Theme, keys: &str, text: &str, columns: usize) -> Vec<Line<'static>> {
    let rows = wrapped(text, columns.saturating_sub(KEYS.max(keys.chars().count()) + 2).max(1));
    let keys = std::iter::once(keys).chain(std::iter::repeat(""));
    std::iter::zip(keys, rows)
        .map(|(keys, text)| {
            Line::from(vec![
                span(theme, Role::Key, format!("{keys:>KEYS$}  ")),
                span(theme, Role::Text, text),
            ])
        })
        .collect()
}
