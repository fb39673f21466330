//! 5 CLI: the firmware's command line, with completion and the range of the setting below the prompt.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::Content;
use crate::ui::formatting::cut;
use crate::ui::model::action::Action;
use crate::ui::model::console::{CliLineKind, CliState};
use crate::ui::model::effect::Effect;
use crate::ui::model::files::FileRequest;
use crate::ui::model::history::LineField;
use crate::ui::model::message::{Request, requests};
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use super::content::scrolled;
use crate::ui::area::row;
use crate::ui::text_wrap::{fitting, folded, wrapped};

/// The greatest number of rows of completion candidates.
const CANDIDATE_ROWS: usize = 4;

/// The prompt before the typed text.
const PROMPT: &str = "# ";

/// The text shown before the first entry.
const WELCOME: &str =
    "The firmware's own command line. Type `help`, paste a `diff all`; Tab completes, Esc leaves.";

/// The description without a screen, where the answers were written before.
const IN_WORDS: &str = "The firmware's own command line: a line goes to it, such as `diff all`, until another panel is \
                        named. A line that begins with a colon is a command of the program.";

/// The state of the CLI panel.
#[derive(Debug, Default)]
pub struct CliPanel {
    pub console: CliState,
}

impl CliPanel {
    /// Returns the panel with the lines entered in earlier runs.
    pub(super) fn with_history(lines: &[String]) -> Self {
        Self { console: CliState::with_history(lines) }
    }
}

impl Content for CliPanel {
    /// Returns the title with the current activity.
    fn title(&self, state: &Shared) -> String {
        let cli = &self.console;
        let name = state.panel_title(Panel::Cli);
        match (cli.queued(), cli.waiting, cli.scroll) {
            (0, false, 0) => name.to_owned(),
            (0, true, 0) => format!("{name} — running"),
            (0, _, lines) => format!("{name} — {lines} newer below"),
            (queued, ..) => format!("{name} — {queued} lines to run, Ctrl-C stops"),
        }
    }

    /// Draws the inside. Returns the position of the cursor.
    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let cli = &self.console;
        if area.height < 2 || area.width < 4 {
            return None;
        }
        let theme = &state.theme;
        let width = usize::from(area.width);
        let help = help_rows(cli, state, area);
        let bottom = area.height - 1 - help.len() as u16;
        for (at, text) in help.iter().enumerate() {
            row(buffer, area, bottom + 1 + at as u16, theme, Role::Dim, text);
        }

        // Upwards from the prompt: candidates, then entered lines and answers, as many as fit.
        let mut rows: Vec<(Role, String)> = Vec::new();
        let candidates = candidate_rows(&cli.candidates, width);
        rows.extend(candidates.into_iter().rev().map(|text| (Role::Title, text)));
        let scroll = cli.scroll.min(last_scroll(cli, state, area));
        for entry in cli.lines.iter().rev().skip(scroll) {
            if rows.len() >= usize::from(bottom) {
                break;
            }
            let role = role(entry.0);
            rows.extend(lines(entry, width).into_iter().rev().map(|text| (role, text)));
        }
        if cli.lines.is_empty() && rows.is_empty() {
            rows.extend(wrapped(WELCOME, width).into_iter().rev().map(|text| (Role::Dim, text)));
        }
        // As in a terminal, the prompt follows the text until the panel is full.
        let prompt_row = bottom.min(rows.len() as u16);
        for (above, (role, text)) in (1..=prompt_row).zip(&rows) {
            row(buffer, area, prompt_row - above, theme, *role, text);
        }

        row(buffer, area, prompt_row, theme, Role::Key, PROMPT);
        let prompt = PROMPT.len() as u16;
        let place = Rect::new(area.x + prompt, area.y + prompt_row, area.width - prompt, 1);
        cli.input.draw(theme, place.intersection(area), buffer)
    }

    fn in_words(&self, _: &Shared) -> Vec<String> {
        vec![IN_WORDS.to_owned()]
    }

    fn key(&mut self, state: &Shared, event: KeyEvent) -> Vec<Request> {
        match event.code {
            KeyCode::Enter => {
                let entered = self.console.enter();
                let keep = entered.map(|line| Effect::Files(FileRequest::KeepLine(LineField::Cli, line)));
                return requests(self.console.next_effect().into_iter().chain(keep).collect());
            }
            KeyCode::Tab if self.console.input.is_empty() => return vec![Request::Act(Action::Next)],
            KeyCode::Tab => self.console.complete(state.cli_help),
            KeyCode::Up => self.console.older(),
            KeyCode::Down => self.console.newer(),
            KeyCode::PageUp => return vec![Request::Act(Action::PageUp)],
            KeyCode::PageDown => return vec![Request::Act(Action::PageDown)],
            _ => {
                if self.console.input.key(event) {
                    self.console.candidates.clear();
                    self.console.scroll = 0;
                }
            }
        }
        Vec::new()
    }

    fn scroll(&mut self, state: &Shared, area: Rect, by: isize) -> Vec<Request> {
        // The newest line is at the bottom, so scrolling up increases its position.
        let last = last_scroll(&self.console, state, area);
        scrolled(&mut self.console.scroll, by.saturating_neg(), last);
        Vec::new()
    }
}

/// Returns the greatest scroll position, at which the oldest line is the first on the screen.
fn last_scroll(cli: &CliState, state: &Shared, area: Rect) -> usize {
    let lines_of = &cli.lines;
    let height = usize::from(area.height).saturating_sub(1 + help_rows(cli, state, area).len());
    let rows = lines_of.iter().map(|entry| lines(entry, usize::from(area.width)).len());
    lines_of.len().saturating_sub(fitting(rows, height))
}

/// Returns the help for the typed text: at least one row, so that the prompt keeps its place, at most three rows and
/// about a quarter of the panel.
fn help_rows(cli: &CliState, state: &Shared, area: Rect) -> Vec<String> {
    let width = usize::from(area.width);
    let most = usize::from(area.height / 4).clamp(1, 3);
    let hint = (state.cli_help.hint)(cli.input.value()).unwrap_or_default();
    let mut rows = wrapped(&hint, width);
    if rows.len() > most {
        let rest = rows.split_off(most - 1).join(" ");
        rows.push(cut(&rest, width));
    }
    rows.resize(rows.len().max(1), String::new());
    rows
}

fn role(kind: CliLineKind) -> Role {
    match kind {
        CliLineKind::Entered => Role::Focus,
        CliLineKind::Output => Role::Text,
        CliLineKind::Error => Role::Fault,
        CliLineKind::Note => Role::Dim,
    }
}

/// Returns the rows of an entry.
fn lines((kind, text): &(CliLineKind, String), width: usize) -> Vec<String> {
    let prefix = match kind {
        CliLineKind::Entered => "# ",
        CliLineKind::Output | CliLineKind::Error => "",
        CliLineKind::Note => "— ",
    };
    folded(&format!("{prefix}{text}"), width)
}

/// Returns the last words of the candidates, in columns.
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
