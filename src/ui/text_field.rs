//! One line of text that is being typed: what editing keys do to it, and how it is drawn in a row.

use crossterm::event::{Event as TerminalEvent, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use tui_input::backend::crossterm::EventHandler as _;
use tui_input::{Input, InputRequest};

use super::drawing;
use super::theme::{Role, Theme};
use crate::printable;

/// Most characters that are inserted at once: what is pasted by mistake must not hold the screen up.
const LONGEST: usize = 2048;

/// A line of text with a cursor.
#[derive(Debug, Clone, Default)]
pub struct TextField {
    input: Input,
}

impl TextField {
    /// A field with this text, the cursor behind it.
    #[must_use]
    pub fn new(text: impl Into<String>) -> Self {
        Self { input: Input::new(text.into()) }
    }

    /// The text.
    #[must_use]
    pub fn value(&self) -> &str {
        self.input.value()
    }

    /// Whether there is no text.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.value().is_empty()
    }

    /// Takes the text out, which leaves the field empty.
    pub fn take(&mut self) -> String {
        self.input.value_and_reset()
    }

    /// Inserts text at the cursor, without what no terminal shows and what is longer than any line.
    pub fn insert(&mut self, text: &str) {
        let room = LONGEST.saturating_sub(self.value().chars().count());
        for c in text.chars().filter(|&c| printable::is_printable(c)).take(room) {
            self.input.handle(InputRequest::InsertChar(c));
        }
    }

    /// Does what an editing key says: characters, cursor keys, Home, End, Backspace, Delete, and the usual keys with
    /// control. Whether it was one.
    pub fn key(&mut self, event: KeyEvent) -> bool {
        self.input.handle_event(&TerminalEvent::Key(event)).is_some()
    }

    /// Draws the text in the first row of the area, scrolled so that the cursor is visible; gives the cursor's place.
    pub fn draw(&self, theme: &Theme, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let area = area.intersection(buffer.area);
        if area.is_empty() {
            return None;
        }
        // The last column is the cursor's behind a full row.
        let room = usize::from(area.width - 1);
        let scroll = self.input.visual_scroll(room);
        let visible: String = self.value().chars().skip(scroll).take(room).collect();
        drawing::text_within(buffer, area.x, area.y, visible, room, theme.style(Role::Text));
        let column = self.input.visual_cursor().saturating_sub(scroll).min(room);
        Some(Position::new(area.x + column as u16, area.y))
    }
}

impl PartialEq for TextField {
    fn eq(&self, other: &Self) -> bool {
        (self.value(), self.input.cursor()) == (other.value(), other.input.cursor())
    }
}

impl Eq for TextField {}

#[cfg(test)]
mod tests {
    use super::*;
    use crossterm::event::{KeyCode, KeyModifiers};

    fn press(field: &mut TextField, code: KeyCode) -> bool {
        field.key(KeyEvent::new(code, KeyModifiers::NONE))
    }

    #[test]
    fn keys_edit_at_the_cursor() {
        let mut field = TextField::new("ac");
        assert!(press(&mut field, KeyCode::Left) && press(&mut field, KeyCode::Char('b')));
        assert_eq!(field.value(), "abc");
        assert!(press(&mut field, KeyCode::Backspace) && press(&mut field, KeyCode::End));
        field.insert("\u{1b}d\r\n");
        assert_eq!(field.value(), "acd", "what no terminal shows is not text");
        assert!(!press(&mut field, KeyCode::Enter) && !press(&mut field, KeyCode::Tab));
        assert_eq!(field.take(), "acd");
        assert!(field.is_empty());
    }

    #[test]
    fn a_row_outside_the_window_has_no_text_and_no_cursor() {
        for area in [Rect::new(2, 1, 6, 1), Rect::new(8, 0, 3, 1), Rect::new(0, 0, 3, 0)] {
            let mut buffer = Buffer::empty(Rect::new(0, 0, 8, 1));
            assert_eq!(TextField::new("text").draw(&Theme::default(), area, &mut buffer), None);
            assert_eq!(buffer, Buffer::empty(buffer.area));
        }
    }

    #[test]
    fn the_cursor_is_visible_at_every_width() {
        let mut field = TextField::new("0123456789");
        for width in 0..20 {
            for _ in 0..12 {
                let area = Rect::new(3, 1, width, 1);
                let mut buffer = Buffer::empty(Rect::new(0, 0, 30, 3));
                let cursor = field.draw(&Theme::default(), area, &mut buffer);
                assert_eq!(cursor.is_some(), width > 0);
                assert!(cursor.is_none_or(|place| area.contains(place)), "{width}: {cursor:?}");
                press(&mut field, KeyCode::Left);
            }
            press(&mut field, KeyCode::End);
        }
    }
}
