//! A line of text being typed: its editing keys, and drawing it in a row.

use crossterm::event::{Event as TerminalEvent, KeyCode, KeyEvent, KeyModifiers};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use tui_input::backend::crossterm::EventHandler as _;
use tui_input::{Input, InputRequest};

use super::drawing;
use super::theme::{Role, Theme};
use crate::text::printable;

/// The greatest length, characters. Text pasted by mistake must not block the screen.
const LONGEST: usize = 2048;

/// A line of text with a cursor. While its whole text is selected, typed text replaces it.
#[derive(Debug, Clone, Default)]
pub struct TextField {
    input: Input,
    selected: bool,
}

impl TextField {
    /// Returns a field with this text and the cursor after it.
    pub fn new(text: impl Into<String>) -> Self {
        Self { input: Input::new(text.into()), selected: false }
    }

    /// Returns a field whose text is selected.
    pub fn selected(text: impl Into<String>) -> Self {
        let mut field = Self::new(text);
        field.select(true);
        field
    }

    /// Selects or deselects the whole text.
    pub fn select(&mut self, selected: bool) {
        self.selected = selected && !self.is_empty();
    }

    pub fn value(&self) -> &str {
        self.input.value()
    }

    /// Returns `true` if there is no text.
    pub fn is_empty(&self) -> bool {
        self.value().is_empty()
    }

    /// Removes and returns the text, which leaves the field empty.
    pub fn take(&mut self) -> String {
        self.selected = false;
        self.input.value_and_reset()
    }

    /// Inserts text at the cursor or in place of the selected text. Leaves out characters that no terminal shows and
    /// text beyond the greatest length.
    pub fn insert(&mut self, text: &str) {
        if std::mem::take(&mut self.selected) && text.chars().any(printable::is_printable) {
            self.input.reset();
        }
        let room = LONGEST.saturating_sub(self.value().chars().count());
        for c in text.chars().filter(|&c| printable::is_printable(c)).take(room) {
            self.input.handle(InputRequest::InsertChar(c));
        }
    }

    /// Handles an editing key: characters, cursor keys, Home, End, Backspace, Delete, and the usual control keys.
    /// Returns `true` if it was one. A character replaces selected text, Backspace and Delete delete it, the other keys
    /// keep it.
    pub fn key(&mut self, event: KeyEvent) -> bool {
        let is_selected = std::mem::take(&mut self.selected);
        let types = matches!(event.code, KeyCode::Char(_))
            && !event.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT);
        if is_selected && matches!(event.code, KeyCode::Backspace | KeyCode::Delete) {
            self.input.reset();
            return true;
        }
        if is_selected && types {
            self.input.reset();
        }
        self.input.handle_event(&TerminalEvent::Key(event)).is_some()
    }

    /// Puts the cursor at a column of the text as [`Self::draw`] shows it in a row of this width.
    pub fn click(&mut self, column: u16, width: u16) {
        self.selected = false;
        let scroll = self.input.visual_scroll(usize::from(width.saturating_sub(1)));
        self.input.handle(InputRequest::SetCursor(scroll + usize::from(column)));
    }

    /// Draws the text in the first row of the area, scrolled so that the cursor is visible. Returns the position of the
    /// cursor.
    pub fn draw(&self, theme: &Theme, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let area = area.intersection(buffer.area);
        if area.is_empty() {
            return None;
        }
        // The last column is for the cursor after a full row.
        let room = usize::from(area.width - 1);
        let scroll = self.input.visual_scroll(room);
        let mut visible: Vec<char> = self.value().chars().skip(scroll).take(room).collect();
        // Marks the ends that are out of sight.
        let goes_on = self.value().chars().count() > scroll + room;
        if let Some(first) = visible.first_mut().filter(|_| scroll > 0) {
            *first = '…';
        }
        if let Some(last) = visible.last_mut().filter(|_| goes_on) {
            *last = '…';
        }
        let visible: String = visible.into_iter().collect();
        let role = if self.selected { Role::Selected } else { Role::Text };
        drawing::text_within(buffer, area.x, area.y, visible, room, theme.style(role));
        let column = self.input.visual_cursor().saturating_sub(scroll).min(room);
        Some(Position::new(area.x + column as u16, area.y))
    }
}

impl PartialEq for TextField {
    fn eq(&self, other: &Self) -> bool {
        (self.value(), self.input.cursor(), self.selected)
            == (other.value(), other.input.cursor(), other.selected)
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
    fn ends_that_are_out_of_sight_are_marked() {
        let drawn = |field: &TextField| {
            let mut buffer = Buffer::empty(Rect::new(0, 0, 9, 1));
            field.draw(&Theme::default(), buffer.area, &mut buffer);
            buffer.content.iter().map(ratatui::buffer::Cell::symbol).collect::<String>()
        };
        let mut field = TextField::new("40.4635000,-79.5182000");
        assert_eq!(drawn(&field), "…5182000 ");
        press(&mut field, KeyCode::Home);
        assert_eq!(drawn(&field), "40.4635… ");
        assert_eq!(drawn(&TextField::new("40.46")), "40.46    ");
    }

    #[test]
    fn selected_text_is_reversed_and_replaced_by_what_is_typed() {
        let selected = || TextField::selected("20");
        let reversed = |field: &TextField| {
            let mut buffer = Buffer::empty(Rect::new(0, 0, 8, 1));
            field.draw(&Theme::default(), buffer.area, &mut buffer);
            buffer.cell((0, 0)).unwrap().modifier.contains(ratatui::style::Modifier::REVERSED)
        };
        for (code, value) in [
            (KeyCode::Char('3'), "3"),
            (KeyCode::Backspace, ""),
            (KeyCode::Delete, ""),
            (KeyCode::Left, "20"),
            (KeyCode::Right, "20"),
            (KeyCode::Home, "20"),
            (KeyCode::End, "20"),
        ] {
            let mut field = selected();
            assert!(reversed(&field), "before {code}");
            press(&mut field, code);
            assert_eq!((field.value(), reversed(&field)), (value, false), "after {code}");
        }
        let mut field = selected();
        press(&mut field, KeyCode::Home);
        press(&mut field, KeyCode::Char('1'));
        assert_eq!(field.value(), "120");
        let mut field = selected();
        field.insert("35");
        field.insert("6");
        assert_eq!(field.value(), "356", "pasted text replaces once");
        assert!(!TextField::selected("").selected);
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
