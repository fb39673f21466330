//! A menu of actions, opened by the right mouse button.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::ui::acts::availability::enabled;
use crate::ui::acts::screen_layout;
use crate::ui::area::{line, span};
use crate::ui::formatting::cut;
use crate::ui::model::action::{Action, spec_of};
use crate::ui::popup::Outcome;
use crate::ui::popup::frame::framed;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

/// The width of the inside.
const WIDTH: u16 = 52;
/// The width of the keys.
const KEYS: usize = 7;

/// The open menu.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ActionMenu {
    title: String,
    /// Column and row of the mouse when it was opened.
    at: (u16, u16),
    actions: Vec<Action>,
    selected: usize,
}

impl ActionMenu {
    /// Returns a menu of these actions.
    pub(in crate::ui) fn new(title: String, at: (u16, u16), actions: Vec<Action>) -> Self {
        Self { title, at, actions, selected: 0 }
    }

    /// Handles a key; `found` is the action of the key without a menu.
    pub(in crate::ui) fn key(&mut self, event: KeyEvent, found: Option<Action>) -> Outcome<Action> {
        match event.code {
            KeyCode::Up => self.selected = self.selected.saturating_sub(1),
            KeyCode::Down => self.selected = (self.selected + 1).min(self.actions.len().saturating_sub(1)),
            KeyCode::Enter => return self.chosen(self.selected),
            KeyCode::Esc => return Outcome::Left,
            _ => {
                if let Some(action) = found.filter(|action| self.actions.contains(action)) {
                    return Outcome::Chosen(action);
                }
            }
        }
        Outcome::Open
    }

    /// Handles a click on a screen of this size. A click outside closes the menu.
    pub(in crate::ui) fn click(&self, size: (u16, u16), (column, row): (u16, u16)) -> Outcome<Action> {
        let inside = screen_layout::inner(self.rect(Rect::new(0, 0, size.0, size.1)));
        if inside.contains((column, row).into()) {
            self.chosen(usize::from(row - inside.y))
        } else {
            Outcome::Left
        }
    }

    fn chosen(&self, index: usize) -> Outcome<Action> {
        self.actions.get(index).map_or(Outcome::Left, |action| Outcome::Chosen(*action))
    }

    /// Returns the area of the menu: beside the mouse if there is room.
    fn rect(&self, area: Rect) -> Rect {
        let width = (WIDTH + 2).min(area.width);
        let height = (self.actions.len() as u16 + 2).min(area.height);
        let x = self.at.0.saturating_add(1).min(area.right() - width);
        let y = self.at.1.min(area.bottom() - height);
        Rect { x, y, width, height }
    }
}

pub(in crate::ui) fn draw(state: &Shared, menu: &ActionMenu, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let place = menu.rect(area);
    let title = cut(&menu.title, usize::from(place.width.saturating_sub(2)));
    let inside = framed(theme, place, &title, buffer);
    for (at, &action) in menu.actions.iter().enumerate() {
        let Some(spec) = spec_of(action) else { continue };
        let is_selected = at == menu.selected;
        let role = match (is_selected, enabled(state, action)) {
            (true, _) => Role::Selected,
            (false, Ok(())) => Role::Text,
            (false, Err(_)) => Role::Dim,
        };
        let mark = if is_selected { '▸' } else { ' ' };
        let key = cut(&state.key(action), KEYS);
        let room = usize::from(inside.width).saturating_sub(KEYS + 4);
        let spans = vec![
            span(
                theme,
                if is_selected { Role::Selected } else { Role::Key },
                format!("{mark} {key:>KEYS$}  "),
            ),
            span(theme, role, format!("{:<room$}", cut(spec.help, room))),
        ];
        line(buffer, inside, at as u16, &Line::from(spans));
    }
}
