//! The newest notice, shown for a moment above the hint bar, and those that stay.

use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr as _;

use super::drawing;
use super::formatting::{cut, within};
use super::shared::{Notice, Shared};
use super::text_wrap::wrapped;
use crate::ui::model::event_log::Severity;

/// How long a notice stays.
const NOTICE_FOR: Duration = Duration::from_secs(8);
/// Rows a notice takes at most.
const NOTICE_ROWS: usize = 2;
/// Rows that a notice that stays takes at most: it names files.
const PINNED_ROWS: usize = 5;
/// Ends a notice that stays.
const CLOSED_BY: &str = "Esc closes this.";

/// A row of a notice.
struct Row {
    /// Cells of the row, those beside the text among them.
    place: Rect,
    /// From the first of these cells.
    text: String,
    severity: Severity,
    /// It belongs to a notice that stays.
    is_pinned: bool,
}

/// Returns the newest notice for a moment.
fn newest(state: &Shared) -> Option<&Notice> {
    state.notice.as_ref().filter(|notice| within(state.now, notice.at, NOTICE_FOR))
}

/// Returns the alarm above it for as long as it would have been shown alone.
fn alarm(state: &Shared) -> Option<&Notice> {
    state.alarm.as_ref().filter(|notice| within(state.now, notice.at, NOTICE_FOR))
}

/// Returns `true` while the newest notice is shown.
pub(super) fn is_shown(state: &Shared) -> bool {
    newest(state).is_some()
}

/// Lays out the newest notice for a moment, in the frame of the lowest panels, and in the row above it when it is long; all of
/// it above the `above` rows of the tutorial. Above it is the oldest of those that stay.
fn rows(state: &Shared, above: u16, hints: Rect) -> Vec<Row> {
    let width = usize::from(hints.width.saturating_sub(6));
    let newest = newest(state).map(|notice| (notice.severity, notice.text.clone(), NOTICE_ROWS));
    let pinned =
        state.pinned.first().map(|text| (Severity::Fault, format!("{text} {CLOSED_BY}"), PINNED_ROWS));
    let alarm = alarm(state).map(|notice| (notice.severity, notice.text.clone(), NOTICE_ROWS));
    let mut above = 1 + above;
    let mut rows = Vec::new();
    let passing = newest.into_iter().chain(alarm).map(|it| (false, it));
    for (is_pinned, notice) in passing.chain(pinned.map(|it| (true, it))) {
        let (severity, text, most) = notice;
        let mut lines = wrapped(&format!("{} {text}", severity.glyph()), width);
        if lines.len() > most {
            let rest = lines.split_off(most - 1).join(" ");
            lines.push(cut(&rest, width));
        }
        for line in lines.iter().rev() {
            // To both frames: no letter of the covered row is read as a part of it.
            let fill = " ".repeat(width - line.width().min(width));
            let place =
                Rect::new(hints.x + 1, hints.y.saturating_sub(above), hints.width.saturating_sub(2), 1);
            rows.push(Row { place, text: format!("  {line}{fill}  "), severity, is_pinned });
            above += 1;
        }
    }
    rows
}

/// Draws the notices.
pub(super) fn draw(state: &Shared, above: u16, hints: Rect, buffer: &mut Buffer) {
    for row in rows(state, above, hints) {
        drawing::text(buffer, row.place.x, row.place.y, row.text, state.theme.style(row.severity.role()));
    }
}

/// Closes the notice at a cell of the screen; returns `false` if there is none.
pub(super) fn close_at(state: &mut Shared, above: u16, hints: Rect, cell: (u16, u16)) -> bool {
    let Some(row) = rows(state, above, hints).into_iter().find(|row| row.place.contains(cell.into())) else {
        return false;
    };
    if row.is_pinned {
        state.pinned.remove(0);
    } else {
        state.notice = None;
        state.alarm = None;
    }
    true
}
