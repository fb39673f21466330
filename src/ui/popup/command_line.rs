//! The `:` line: a command typed by its name, with history and suggestions.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Widget as _};

use crate::ui::acts::screen_layout;
use crate::ui::area::{line, row, span};
use crate::ui::command::{self, Suggestion};
use crate::ui::completion::common_prefix;
use crate::ui::formatting::cut;
use crate::ui::model::history::History;
use crate::ui::popup::Outcome;
use crate::ui::popup::frame::key_line;
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// The greatest number of suggestions shown.
const MOST: usize = 8;
/// The least and the greatest width of the column of suggested words.
const WORD: (usize, usize) = (21, 44);

/// The keys at the foot of the suggestions.
const KEYS: [(&str, &str); 4] =
    [(" Enter", " runs  "), ("Tab", " completes  "), ("↑ ↓", " history  "), ("Esc", " leaves ")];

/// The line and its history.
#[derive(Debug, Default)]
pub struct CommandLine {
    /// The typed text.
    pub field: TextField,
    history: History,
}

impl CommandLine {
    /// Returns a line with the history of earlier runs.
    pub(in crate::ui) fn with_history(lines: &[String]) -> Self {
        Self { history: History::of(lines), ..Self::default() }
    }

    /// Opens the line with this text.
    pub(in crate::ui) fn open(&mut self, text: &str) {
        self.field = TextField::new(text);
        self.history.forget_place();
    }

    /// Completes the typed word as far as all suggestions agree.
    fn complete(&mut self, suggestions: &[Suggestion]) {
        let common = common_prefix(suggestions.iter().map(|suggestion| suggestion.line.as_str()));
        // A suggested full name need not begin with the typed short word.
        if common.len() > self.field.value().trim_start().len() {
            self.field = TextField::new(common);
        }
    }
}

/// Handles a key while the line is open.
pub(in crate::ui) fn key(line: &mut CommandLine, state: &Shared, event: KeyEvent) -> Outcome<(String, bool)> {
    match event.code {
        KeyCode::Esc => return Outcome::Left,
        KeyCode::Backspace if line.field.is_empty() => return Outcome::Left,
        KeyCode::Enter => return enter(line),
        KeyCode::Tab => {
            let suggestions = command::suggestions(state, line.field.value());
            line.complete(&suggestions);
        }
        KeyCode::Up | KeyCode::Down => {
            let CommandLine { field, history } = line;
            let recalled =
                if event.code == KeyCode::Up { history.older(field.value()) } else { history.newer() };
            if let Some(recalled) = recalled {
                *field = TextField::new(recalled);
            }
        }
        _ => {
            line.field.key(event);
        }
    }
    Outcome::Open
}

fn enter(line: &mut CommandLine) -> Outcome<(String, bool)> {
    let entered = line.field.take();
    let is_new = line.history.remember(&entered);
    Outcome::Chosen((entered, is_new))
}

/// Handles a click on a screen of this size: the first one on a suggestion completes the line, a click on the completed one
/// runs it. Returns `None` beside the suggestions.
pub(in crate::ui) fn click(
    entered: &mut CommandLine,
    state: &Shared,
    size: (u16, u16),
    cell: (u16, u16),
) -> Option<Outcome<(String, bool)>> {
    let typed = entered.field.value();
    let list = List::of(state, typed, Rect::new(0, 0, size.0, size.1.checked_sub(1)?))?;
    let inside = screen_layout::inner(list.place);
    let rows = Rect { height: list.shown as u16, ..inside };
    if !rows.contains(cell.into()) {
        return None;
    }
    let suggestion = list.suggestions.get(usize::from(cell.1 - rows.y))?;
    if suggestion.line == typed {
        return Some(enter(entered));
    }
    entered.field = TextField::new(suggestion.line.clone());
    Some(Outcome::Open)
}

/// The suggestions for a line, and the hint about it.
struct List {
    suggestions: Vec<Suggestion>,
    /// The number of suggestions that have a row.
    shown: usize,
    hint: Vec<String>,
    place: Rect,
}

impl List {
    /// Returns the list in an area above the line; `None` if there is nothing to show, or no room.
    fn of(state: &Shared, typed: &str, above: Rect) -> Option<Self> {
        let suggestions = command::suggestions(state, typed);
        let width = above.width.min(78);
        let inside = usize::from(width.saturating_sub(2));
        let hint = command::hint(state, typed).map_or_else(Vec::new, |hint| wrapped(&hint, inside));
        let shown = suggestions.len().min(MOST);
        let more = usize::from(suggestions.len() > shown);
        let height = (shown + more + hint.len() + 2) as u16;
        if shown + hint.len() == 0 || height > above.height || inside < WORD.0 + 4 {
            return None;
        }
        let place = Rect::new(above.x, above.y + above.height - height, width, height);
        Some(Self { suggestions, shown, hint, place })
    }
}

/// Draws the line in the last row and the suggestions above it. Returns the position of the cursor.
pub(in crate::ui) fn draw(
    entered: &CommandLine,
    state: &Shared,
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let bottom = Rect { y: area.y + area.height.checked_sub(1)?, height: 1, ..area };
    Clear.render(bottom, buffer);
    row(buffer, bottom, 0, theme, Role::Key, ":");
    let typed = entered.field.value();
    draw_suggestions(state, typed, Rect { height: area.height - 1, ..area }, buffer);
    let field = Rect { x: bottom.x + 1, width: bottom.width.checked_sub(1)?, ..bottom };
    entered.field.draw(theme, field, buffer)
}

fn draw_suggestions(state: &Shared, typed: &str, above: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let Some(List { suggestions, shown, hint, place }) = List::of(state, typed, above) else { return };
    let area = screen_layout::inner(place);
    let inside = usize::from(area.width);
    Clear.render(place, buffer);
    let keys = key_line(theme, &KEYS);
    let keys = Some(keys).filter(|keys| keys.width() <= inside).unwrap_or_default();
    Block::bordered().border_style(theme.style(Role::Dim)).title_bottom(keys).render(place, buffer);
    let widest = suggestions.iter().take(shown).map(|suggestion| suggestion.word.chars().count()).max();
    let word = widest.unwrap_or(0).clamp(WORD.0, WORD.1.min(inside));
    for (at, suggestion) in suggestions.iter().take(shown).enumerate() {
        let room = inside.saturating_sub(word + 1);
        let keys = cut(&suggestion.keys, room);
        let help = cut(suggestion.help, room.saturating_sub(keys.chars().count() + 1));
        let fill = room.saturating_sub(help.chars().count() + keys.chars().count());
        let spans = vec![
            span(theme, Role::Text, format!("{:<word$} ", cut(&suggestion.word, word))),
            span(theme, Role::Dim, format!("{help}{}", " ".repeat(fill))),
            span(theme, Role::Key, keys),
        ];
        line(buffer, area, at as u16, &Line::from(spans));
    }
    let more = suggestions.len() - shown;
    if more > 0 {
        row(buffer, area, shown as u16, theme, Role::Dim, &format!("… {more} more"));
    }
    for (at, text) in hint.iter().enumerate() {
        row(buffer, area, (shown + usize::from(more > 0) + at) as u16, theme, Role::Title, text);
    }
}
