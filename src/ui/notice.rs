//! The newest notice, shown for a moment above the hint bar, and those that stay.

use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr as _;

use super::app_state::AppState;
use super::drawing;
use super::event_log::Severity;
use super::formatting::{cut, within};
use super::text_wrap::wrapped;
use super::tutorial;

/// How long a notice stays.
const NOTICE_FOR: Duration = Duration::from_secs(8);
/// Rows a notice takes at most.
const NOTICE_ROWS: usize = 2;
/// Rows that a notice that stays takes at most: it names files.
const PINNED_ROWS: usize = 5;
/// Ends a notice that stays.
const CLOSED_BY: &str = "Esc closes this.";

/// Draws the newest notice for a moment: in the frame of the lowest panels, and in the row above it when it is long; all of
/// it above the tutorial while that is shown. Above it stands the oldest of those that stay.
pub(super) fn draw(state: &AppState, hints: Rect, buffer: &mut Buffer) {
    let width = usize::from(hints.width.saturating_sub(6));
    let newest = state.notice.as_ref().filter(|notice| within(state.now, notice.at, NOTICE_FOR));
    let newest = newest.map(|notice| (notice.severity, notice.text.clone(), NOTICE_ROWS));
    let pinned =
        state.pinned.first().map(|text| (Severity::Fault, format!("{text} {CLOSED_BY}"), PINNED_ROWS));
    let mut above = 1 + tutorial::rows(state, hints);
    for (severity, text, rows) in newest.into_iter().chain(pinned) {
        let style = state.theme.style(severity.role());
        let mut lines = wrapped(&format!("{} {text}", severity.glyph()), width);
        if lines.len() > rows {
            let rest = lines.split_off(rows - 1).join(" ");
            lines.push(cut(&rest, width));
        }
        let widest = lines.iter().map(|line| line.width()).max().unwrap_or(0);
        for line in lines.iter().rev() {
            let fill = " ".repeat(widest - line.width());
            // Above the frame it stands on what a panel shows, of which no letter stays in front of it.
            let (x, lead) = if above == 1 { (hints.x + 2, " ") } else { (hints.x + 1, "  ") };
            drawing::text(buffer, x, hints.y.saturating_sub(above), format!("{lead}{line}{fill} "), style);
            above += 1;
        }
    }
}
