//! 5 CLI: the firmware's command line, with completion and the range of the setting below the prompt.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use crate::ui::cli::CliLineKind;
use crate::ui::quantity::cut;
use crate::ui::state::{AppState, Pane};
use crate::ui::theme::Role;

use super::{line, row, span, wrapped};

/// Rows of completion candidates shown at most.
const CANDIDATE_ROWS: usize = 4;

/// Shown while nothing was entered yet.
const WELCOME: &str =
    "The firmware's own command line. Type `help`, paste a `diff all`; Tab completes, Esc leaves.";

/// The title: what it is doing.
pub fn title(state: &AppState) -> String {
    let name = Pane::Cli.title();
    match (state.cli.queued(), state.cli.waiting, state.cli.scroll) {
        (0, false, 0) => name.to_owned(),
        (0, true, 0) => format!("{name} — running"),
        (0, _, lines) => format!("{name} — {lines} newer below"),
        (queued, ..) => format!("{name} — {queued} lines to run, Ctrl-C stops"),
    }
}

/// Draws the inside; gives the place of the cursor.
pub fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    if area.height < 2 || area.width < 4 {
        return None;
    }
    let theme = &state.theme;
    let cli = &state.cli;
    let width = usize::from(area.width);
    let help_row = area.height - 1;
    let candidates = candidate_rows(&cli.candidates, width);
    let shown = candidates.len().min(usize::from(area.height - 2));
    // Like a terminal: the prompt follows the text until the panel is full.
    let above = shown + cli.lines.len().saturating_sub(cli.scroll);
    let empty = cli.lines.is_empty() && shown == 0;
    let words = if empty { wrapped(WELCOME, width) } else { Vec::new() };
    let prompt_row = (area.height - 2).min((above + words.len()).min(usize::from(u16::MAX)) as u16);
    let first_candidate = prompt_row - shown as u16;
    for (at, text) in candidates.iter().take(shown).enumerate() {
        row(buffer, area, first_candidate + at as u16, theme, Role::Title, text);
    }

    for (at, text) in words.iter().enumerate().take(usize::from(prompt_row)) {
        row(buffer, area, at as u16, theme, Role::Dim, text);
    }
    let mut next = usize::from(first_candidate);
    for (kind, text) in cli.lines.iter().rev().skip(cli.scroll) {
        let (prefix, role) = match kind {
            CliLineKind::Entered => ("# ", Role::Focus),
            CliLineKind::Output => ("", Role::Text),
            CliLineKind::Error => ("", Role::Fault),
            CliLineKind::Note => ("— ", Role::Dim),
        };
        let Some(at) = next.checked_sub(1) else { break };
        next = at;
        row(buffer, area, at as u16, theme, role, &format!("{prefix}{text}"));
    }

    let room = width - 3;
    let scroll = cli.input.visual_scroll(room);
    let visible: String = cli.input.value().chars().skip(scroll).take(room).collect();
    let prompt = Line::from(vec![span(theme, Role::Key, "# "), span(theme, Role::Text, visible)]);
    line(buffer, area, prompt_row, &prompt);
    if let Some(hint) = (state.cli_help.hint)(cli.input.value()) {
        row(buffer, area, help_row, theme, Role::Dim, &hint);
    }
    let column = 2 + cli.input.visual_cursor().saturating_sub(scroll).min(room);
    Some(Position::new(area.x + column as u16, area.y + prompt_row))
}

/// The last words of the candidates, in columns.
fn candidate_rows(candidates: &[String], width: usize) -> Vec<String> {
    let words: Vec<&str> =
        candidates.iter().map(|line| line.rsplit_once(' ').map_or(line.as_str(), |(_, word)| word)).collect();
    let Some(longest) = words.iter().map(|word| word.chars().count()).max() else { return Vec::new() };
    let column = longest + 2;
    let columns = (width / column).max(1);
    let fit = columns * CANDIDATE_ROWS;
    let mut rows: Vec<String> = words
        .iter()
        .take(if words.len() > fit { fit - columns } else { fit })
        .collect::<Vec<_>>()
        .chunks(columns)
        .map(|chunk| chunk.iter().map(|word| format!("{word:<column$}")).collect())
        .collect();
    if words.len() > fit {
        rows.push(cut(&format!("… {} more", words.len() - rows.len() * columns), width));
    }
    rows
}
