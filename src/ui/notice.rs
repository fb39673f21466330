//! The newest notice, shown for a moment above the hint bar.

use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr as _;

use super::app_state::AppState;
use super::formatting::{cut, within};
use super::text_wrap::wrapped;

/// How long a notice stays.
const NOTICE_FOR: Duration = Duration::from_secs(8);
/// Rows a notice takes at most.
const NOTICE_ROWS: usize = 2;

/// Draws the newest notice for a moment: in the frame of the lowest panels, and in the row above it when it is long.
pub(super) fn draw(state: &AppState, hints: Rect, buffer: &mut Buffer) {
    let Some(notice) = state.notice.as_ref().filter(|notice| within(state.now, notice.at, NOTICE_FOR)) else {
        return;
    };
    let style = state.theme.style(notice.severity.role());
    let width = usize::from(hints.width.saturating_sub(6));
    let mut lines = wrapped(&format!("{} {}", notice.severity.glyph(), notice.text), width);
    if lines.len() > NOTICE_ROWS {
        let rest = lines.split_off(NOTICE_ROWS - 1).join(" ");
        lines.push(cut(&rest, width));
    }
    let widest = lines.iter().map(|line| line.width()).max().unwrap_or(0);
    for (above, line) in (1..).zip(lines.iter().rev()) {
        let fill = " ".repeat(widest - line.width());
        // Above the frame it stands on what a panel shows, of which no letter stays in front of it.
        let (x, lead) = if above == 1 { (hints.x + 2, " ") } else { (hints.x + 1, "  ") };
        buffer.set_string(x, hints.y.saturating_sub(above), format!("{lead}{line}{fill} "), style);
    }
}
