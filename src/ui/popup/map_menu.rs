//! The menu of a place on the map, opened by the right mouse button.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::{Block, Clear, Widget as _};

use crate::geo::LatLon;
use crate::ui::acts::screen_layout;
use crate::ui::area::row;
use crate::ui::popup::Outcome;
use crate::ui::theme::{Role, Theme};

/// The width of the inside.
const WIDTH: u16 = 30;

/// An action at the place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum MapChoice {
    /// Put a waypoint there.
    AddWaypoint,
    /// Make it the home of the plan.
    SetHome,
    /// Set the fence so that it goes through the place.
    SetFence,
    /// Show the waypoint at the place in the plan table.
    EditWaypoint(usize),
    DeleteWaypoint(usize),
    /// Measure from there.
    Measure,
    /// Fly to the waypoint now.
    GoTo(u8),
}

impl MapChoice {
    /// Returns its key and its label.
    fn shown(self) -> (char, String) {
        match self {
            Self::AddWaypoint => ('i', "add a waypoint here".to_owned()),
            Self::SetHome => ('h', "home of the plan here".to_owned()),
            Self::SetFence => ('f', "fence through here".to_owned()),
            Self::EditWaypoint(index) => ('e', format!("edit WP{index} in the table")),
            Self::DeleteWaypoint(index) => ('d', format!("delete WP{index}")),
            Self::Measure => ('m', "measure from here".to_owned()),
            Self::GoTo(index) => ('g', format!("go to WP{index} now")),
        }
    }
}

/// The open menu.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MapMenu {
    /// The place of the menu.
    pub(in crate::ui) place: LatLon,
    /// Column and row of the mouse when it was opened.
    at: (u16, u16),
    choices: Vec<MapChoice>,
    selected: usize,
}

impl MapMenu {
    /// Returns a menu of these choices.
    pub(in crate::ui) fn new(place: LatLon, at: (u16, u16), choices: Vec<MapChoice>) -> Self {
        Self { place, at, choices, selected: 0 }
    }

    pub(in crate::ui) fn key(&mut self, event: KeyEvent) -> Outcome<MapChoice> {
        match event.code {
            KeyCode::Up | KeyCode::Char('k') => self.selected = self.selected.saturating_sub(1),
            KeyCode::Down | KeyCode::Char('j') => {
                self.selected = (self.selected + 1).min(self.choices.len().saturating_sub(1));
            }
            KeyCode::Enter => return self.chosen(self.selected),
            KeyCode::Esc | KeyCode::Char('q') => return Outcome::Left,
            KeyCode::Char(key) => {
                if let Some(choice) = self.choices.iter().find(|choice| choice.shown().0 == key) {
                    return Outcome::Chosen(*choice);
                }
            }
            _ => {}
        }
        Outcome::Open
    }

    /// Handles a click on a screen of this size. A click outside closes the menu.
    pub(in crate::ui) fn click(&self, size: (u16, u16), (column, line): (u16, u16)) -> Outcome<MapChoice> {
        let inside = screen_layout::inner(self.rect(Rect::new(0, 0, size.0, size.1)));
        let is_inside = (inside.left()..inside.right()).contains(&column)
            && (inside.top()..inside.bottom()).contains(&line);
        if is_inside { self.chosen(usize::from(line - inside.y)) } else { Outcome::Left }
    }

    fn chosen(&self, index: usize) -> Outcome<MapChoice> {
        self.choices.get(index).map_or(Outcome::Left, |choice| Outcome::Chosen(*choice))
    }

    /// Returns the area of the menu: beside the mouse if there is room.
    fn rect(&self, area: Rect) -> Rect {
        let width = (WIDTH + 2).min(area.width);
        let height = (self.choices.len() as u16 + 2).min(area.height);
        let x = self.at.0.saturating_add(1).min(area.right() - width);
        let y = self.at.1.min(area.bottom() - height);
        Rect { x, y, width, height }
    }
}

pub(in crate::ui) fn draw(theme: &Theme, menu: &MapMenu, area: Rect, buffer: &mut Buffer) {
    let place = menu.rect(area);
    Clear.render(place, buffer);
    Block::bordered().border_style(theme.style(Role::Focus)).render(place, buffer);
    let inside = screen_layout::inner(place);
    for (at, choice) in menu.choices.iter().enumerate().take(usize::from(inside.height)) {
        let (mark, role) = if at == menu.selected { ("▸", Role::Selected) } else { (" ", Role::Text) };
        let (key, name) = choice.shown();
        row(buffer, inside, at as u16, theme, role, &format!("{mark} {key}  {name}"));
    }
}
