//! The interface of a panel: its picture, its keys and its mouse.

use crossterm::event::{KeyEvent, MouseEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::message::Request;
use crate::ui::popup::Popup;
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;

use super::in_words;

/// The number of lines per step of the wheel.
const WHEEL_LINES: isize = 3;

/// The greatest number of lines of a panel in words: more than the settings of the firmware.
const ROWS_IN_WORDS: u16 = 600;

/// The actions of a hint, and its label.
pub(in crate::ui) type Hint = (&'static [Action], &'static str);

/// The content of a panel: its own state, and its view of the state that all panels share, which it changes by requests
/// only. An area is the inside of the frame.
pub(in crate::ui) trait Content {
    /// Returns the title in the frame.
    fn title(&self, state: &Shared) -> String;

    /// Draws the inside. Returns the position of the cursor of a text field.
    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position>;

    /// Returns the inside as lines of text, for use without a screen.
    fn in_words(&self, state: &Shared) -> Vec<String> {
        in_words::drawn(state, ROWS_IN_WORDS, |area, buffer| {
            self.draw(state, area, buffer);
        })
    }

    /// Returns the hints of the panel, the most useful first.
    fn hints(&self, _: &Shared) -> Vec<Hint> {
        Vec::new()
    }

    /// Carries out an action of the panel.
    fn act(&mut self, _: &Shared, _: PanelAction) -> Vec<Request> {
        Vec::new()
    }

    /// Returns the action that begins to type a number in place of the selected value.
    fn typing(&self, _: &Shared) -> Option<Action> {
        None
    }

    /// Handles a key that is text here.
    fn key(&mut self, _: &Shared, _: KeyEvent) -> Vec<Request> {
        Vec::new()
    }

    /// Returns the open text field.
    fn field(&mut self) -> Option<&mut TextField> {
        None
    }

    fn close_field(&mut self) {}

    /// Goes back by one step. Returns `None` if there is none.
    fn go_back(&mut self, _: &Shared) -> Option<Vec<Request>> {
        None
    }

    /// Notes that it gets the focus.
    fn visit(&mut self) {}

    /// Scrolls by lines, within the content.
    fn scroll(&mut self, _: &Shared, _: Rect, _: isize) -> Vec<Request> {
        Vec::new()
    }

    fn wheel(&mut self, state: &Shared, area: Rect, _: &MouseEvent, direction: isize) -> Vec<Request> {
        self.scroll(state, area, direction * WHEEL_LINES)
    }

    /// Handles a press of the left button.
    fn press(&mut self, _: &Shared, _: Rect, _: &MouseEvent) -> Vec<Request> {
        Vec::new()
    }

    /// Handles a drag that began with a press in this panel.
    fn drag(&mut self, _: &Shared, _: Rect, _: &MouseEvent) -> Vec<Request> {
        Vec::new()
    }

    /// Handles the release of a button, at any position.
    fn release(&mut self, _: &Shared) -> Vec<Request> {
        Vec::new()
    }

    /// Returns the menu for a press of the right button.
    fn menu(&mut self, _: &Shared, _: Rect, _: &MouseEvent) -> Option<Popup> {
        None
    }
}

/// Moves a scroll position by lines, from 0 to `last`.
pub(super) fn scrolled(at: &mut usize, by: isize, last: usize) {
    *at = (*at).min(last).saturating_add_signed(by).min(last);
}
