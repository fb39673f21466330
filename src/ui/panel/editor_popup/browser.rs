//! The file browser: its rows, and the part of it at a cell.

use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Position, Rect};

use super::{WIDTH, keys};
use crate::ui::area::{line, row};
use crate::ui::model::editor::{Browser, BrowserPlace, Purpose};
use crate::ui::popup::frame::{framed, place};
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

/// The columns before the typed name.
const NAME: u16 = 6;
/// The rows above the entries, and with those below them.
const ABOVE: u16 = 2;
const AROUND: u16 = ABOVE + 2;

/// Returns the frame of the browser on a screen.
fn frame_in(area: Rect) -> Rect {
    place(area, (WIDTH, area.height.saturating_sub(6).min(22)))
}

/// Returns the row of the typed name.
fn name_in(inside: Rect) -> Rect {
    let row =
        Rect { x: inside.x + NAME, y: inside.y + 1, width: inside.width.saturating_sub(NAME), height: 1 };
    row.intersection(inside)
}

/// Returns the first shown entry for so many rows.
fn first(browser: &Browser, rows: usize) -> usize {
    browser.at.unwrap_or(0).saturating_sub(rows.saturating_sub(1))
}

/// Returns the part of the browser at a cell of the screen.
pub(crate) fn place_at(browser: &Browser, area: Rect, cell: (u16, u16)) -> Option<BrowserPlace> {
    let inside = frame_in(area).inner(Margin::new(1, 1));
    if !inside.contains(cell.into()) {
        return None;
    }
    let name = name_in(inside);
    match cell.1 - inside.y {
        0 => Some(BrowserPlace::Directory),
        1 => Some(BrowserPlace::Text { column: cell.0.saturating_sub(name.x), width: name.width }),
        row => {
            let rows = usize::from(inside.height.saturating_sub(AROUND));
            let at = usize::from(row - ABOVE);
            let entry = first(browser, rows) + at;
            (at < rows && entry < browser.visible().len()).then_some(BrowserPlace::Entry(entry))
        }
    }
}

/// Draws the browser. Returns the position of the cursor.
pub(super) fn draw(state: &Shared, browser: &Browser, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = &state.theme;
    let title = match browser.purpose {
        Purpose::Open => "Open a plan",
        Purpose::Save(_) => "Save as",
        Purpose::Backdrop(_) => "Show a file under the plan",
    };
    let inside = framed(theme, frame_in(area), title, buffer);
    let directory = browser.listing.directory.display().to_string();
    let slash = if directory.ends_with('/') { "" } else { "/" };
    row(buffer, inside, 0, theme, Role::Dim, &format!(" {directory}{slash}"));
    row(buffer, inside, 1, theme, Role::Title, " name ");
    let cursor = browser.text.draw(theme, name_in(inside), buffer);
    let rows = usize::from(inside.height.saturating_sub(AROUND));
    let visible = browser.visible();
    let first = first(browser, rows);
    if visible.is_empty() {
        let text = match browser.purpose {
            Purpose::Backdrop(_) => " No map (.geojson, .kml, .kmz, .gpx) and no directory here.",
            Purpose::Open | Purpose::Save(_) => " No plan and no directory here.",
        };
        row(buffer, inside, ABOVE, theme, Role::Dim, text);
    }
    for (at, entry) in visible.iter().enumerate().skip(first).take(rows) {
        let here = browser.at == Some(at);
        let (mark, role) = if here { ("▸", Role::Focus) } else { (" ", Role::Text) };
        let slash = if entry.is_directory { "/" } else { "" };
        let text = format!("{mark}{}{slash}", entry.name);
        row(buffer, inside, ABOVE + (at - first) as u16, theme, role, &text);
    }
    let action = match browser.purpose {
        Purpose::Open => "open",
        Purpose::Save(_) => "save",
        Purpose::Backdrop(_) => "show",
    };
    let keys =
        keys(state, &[("Enter", action), ("↑ ↓", "choose"), ("←", "directory above"), ("Esc", "close")]);
    line(buffer, inside, inside.height.saturating_sub(1), &keys);
    cursor
}
