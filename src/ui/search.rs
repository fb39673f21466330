//! A search by words in a list: typed after `/`, kept by `Enter`, ended by `Esc`.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::drawing;
use super::text_field::TextField;
use super::theme::{Role, Theme};

/// The words that a line must have.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Search {
    pub(super) field: TextField,
    /// `true` while the words are typed.
    pub(super) is_typing: bool,
}

impl Search {
    /// Returns a search whose words are typed next.
    pub(super) fn begun() -> Self {
        Self { is_typing: true, ..Self::default() }
    }

    /// Returns `true` if there are words, or if they are being typed.
    pub(super) fn is_on(&self) -> bool {
        self.is_typing || !self.field.is_empty()
    }

    /// Handles a key while the words are typed.
    pub(super) fn key(&mut self, event: KeyEvent) {
        match event.code {
            KeyCode::Esc => *self = Self::default(),
            KeyCode::Enter => self.is_typing = false,
            _ => {
                self.field.key(event);
            }
        }
    }

    /// Returns the words, in lower case.
    pub(super) fn words(&self) -> Vec<String> {
        self.field.value().split_whitespace().map(str::to_lowercase).collect()
    }

    /// Returns the title of a popup whose lines are searched: its name and the keys of the moment. `other_keys` are
    /// those without a search.
    pub(super) fn title(&self, name: &str, other_keys: &str) -> String {
        match (self.is_typing, self.field.is_empty()) {
            (true, _) => format!("{name} — Enter keeps the search, Esc ends it"),
            (false, true) => format!("{name} — / searches, {other_keys}"),
            (false, false) => format!("{name} — /{}, Esc shows all", self.field.value()),
        }
    }

    /// Draws the words in the lower border of a popup while they are typed. Returns the position of the cursor.
    pub(super) fn draw_in_border(&self, theme: &Theme, place: Rect, buffer: &mut Buffer) -> Option<Position> {
        if !self.is_typing {
            return None;
        }
        let width = place.width.saturating_sub(2);
        let foot = Rect { x: place.x + 1, y: place.bottom().checked_sub(1)?, width, height: 1 };
        let foot = foot.intersection(buffer.area);
        let width = usize::from(foot.width);
        drawing::text_within(
            buffer,
            foot.x,
            foot.y,
            format!("/{}", " ".repeat(width)),
            width,
            theme.style(Role::Key),
        );
        let field = Rect { x: foot.x + 1, width: foot.width.checked_sub(1)?, ..foot };
        self.field.draw(theme, field, buffer)
    }
}

/// Returns `true` if a text in lower case has all the words.
pub(super) fn has_all(text: &str, words: &[String]) -> bool {
    words.iter().all(|word| text.contains(word.as_str()))
}
