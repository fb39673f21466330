//! The library of recorded flights: found by a few letters, shown, compared, deleted.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use crate::text::printable;
use crate::ui::acts::screen_layout;
use crate::ui::area::{line, row};
use crate::ui::formatting::cut;
use crate::ui::model::flights::{FlightsState, LibraryFlight};
use crate::ui::popup::frame::{framed, key_line, place};
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use crate::ui::theme::Role;

/// The greatest inner size.
const SIZE: (u16, u16) = (96, 30);
/// The rows of the screen that stay free, also for the frame: notices are below the list.
const FREE: u16 = 8;
/// The rows around the list: the search line and the heading above it, the reason and the keys below it.
const ABOVE: u16 = 2;
const AROUND: u16 = ABOVE + 2;
/// The width of all columns but the plan.
const BUT_PLAN: usize = 54;
/// The flights that are shown beside each other.
const BESIDE: usize = 2;

/// The search text, the selected row, the marked flights, and the flight that is deleted after a question.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FlightsList {
    pub query: TextField,
    pub(in crate::ui) selected: usize,
    /// The flights to show beside each other, in the order of their marking.
    pub(in crate::ui) marked: Vec<PathBuf>,
    pub(in crate::ui) deleting: Option<PathBuf>,
}

/// The result of a key or of the mouse.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::ui) enum FlightsKey {
    Open,
    Left,
    /// Show these flights. `again` flies the first one again.
    Show {
        files: Vec<PathBuf>,
        again: bool,
    },
    Delete(PathBuf),
    /// The key has no effect, for this reason.
    Refused(String),
}

impl FlightsList {
    /// Returns the selected flight.
    pub(in crate::ui) fn selected<'f>(&self, flights: &'f FlightsState) -> Option<&'f LibraryFlight> {
        flights.matching(self.query.value()).get(self.selected).copied()
    }

    /// Keeps a flight selected in a list that has changed. Forgets marks of flights that are gone.
    pub(in crate::ui) fn follow(&mut self, flights: &FlightsState, selected: Option<PathBuf>) {
        let found = flights.matching(self.query.value());
        let at = selected.and_then(|file| found.iter().position(|flight| flight.file == file));
        self.selected = at.unwrap_or(self.selected).min(found.len().saturating_sub(1));
        let is_there = |file: &PathBuf| flights.all().iter().any(|flight| flight.file == *file);
        self.marked.retain(is_there);
        self.deleting = self.deleting.take().filter(is_there);
    }

    pub(in crate::ui) fn key(&mut self, flights: &FlightsState, event: KeyEvent) -> FlightsKey {
        if let Some(file) = self.deleting.take() {
            match event.code {
                KeyCode::Char('y' | 'Y') => return FlightsKey::Delete(file),
                KeyCode::Char('n' | 'N') | KeyCode::Esc => {}
                _ => self.deleting = Some(file),
            }
            return FlightsKey::Open;
        }
        let last = flights.matching(self.query.value()).len().saturating_sub(1);
        let control = event.modifiers.contains(KeyModifiers::CONTROL);
        match event.code {
            KeyCode::Esc => return FlightsKey::Left,
            KeyCode::Enter => return self.show(flights, false),
            KeyCode::Char('o') if control => return self.show(flights, true),
            KeyCode::Tab => return self.mark(flights),
            KeyCode::Delete => return self.delete(flights),
            KeyCode::Up => self.selected = self.selected.saturating_sub(1),
            KeyCode::Down => self.selected = (self.selected + 1).min(last),
            KeyCode::PageUp => self.selected = self.selected.saturating_sub(10),
            KeyCode::PageDown => self.selected = (self.selected + 10).min(last),
            _ => {
                if self.query.key(event) {
                    self.selected = 0;
                }
            }
        }
        FlightsKey::Open
    }

    /// Handles the mouse: a click selects, a click on the selected flight shows it, the right button marks, the wheel moves.
    pub(in crate::ui) fn mouse(
        &mut self,
        flights: &FlightsState,
        size: (u16, u16),
        event: MouseEvent,
    ) -> FlightsKey {
        let last = flights.matching(self.query.value()).len().saturating_sub(1);
        let button = match event.kind {
            MouseEventKind::ScrollUp => {
                self.selected = self.selected.saturating_sub(1);
                return FlightsKey::Open;
            }
            MouseEventKind::ScrollDown => {
                self.selected = (self.selected + 1).min(last);
                return FlightsKey::Open;
            }
            MouseEventKind::Down(button) if self.deleting.is_none() => button,
            _ => return FlightsKey::Open,
        };
        let inside = screen_layout::inner(frame_in(Rect::new(0, 0, size.0, size.1)));
        if !inside.contains(Position::new(event.column, event.row)) {
            return FlightsKey::Left;
        }
        let rows = usize::from(inside.height.saturating_sub(AROUND));
        let Some(at) = (event.row - inside.y).checked_sub(ABOVE).map(usize::from).filter(|at| *at < rows)
        else {
            return FlightsKey::Open;
        };
        let clicked = first(self.selected, rows) + at;
        if clicked > last {
            return FlightsKey::Open;
        }
        let was_selected = std::mem::replace(&mut self.selected, clicked) == clicked;
        match button {
            MouseButton::Right => self.mark(flights),
            MouseButton::Left if was_selected => self.show(flights, false),
            _ => FlightsKey::Open,
        }
    }

    /// Returns the flights to show: the marked ones, else the selected one.
    fn show(&self, flights: &FlightsState, again: bool) -> FlightsKey {
        let Some(selected) = self.selected(flights) else { return FlightsKey::Open };
        if self.marked.len() == BESIDE && !again {
            return FlightsKey::Show { files: self.marked.clone(), again };
        }
        if !selected.is_readable {
            return FlightsKey::Refused(format!("{} cannot be shown: {}.", selected.name(), selected.reason));
        }
        if again && selected.is_growing {
            return FlightsKey::Refused(
                "This flight is still being recorded: it can be flown again once it is over.".to_owned(),
            );
        }
        FlightsKey::Show { files: vec![selected.file.clone()], again }
    }

    /// Marks the selected flight for a comparison, or removes its mark. A third mark replaces the first.
    pub(in crate::ui) fn mark(&mut self, flights: &FlightsState) -> FlightsKey {
        let Some(selected) = self.selected(flights) else { return FlightsKey::Open };
        if !selected.is_readable {
            return FlightsKey::Refused(format!("{} cannot be shown: {}.", selected.name(), selected.reason));
        }
        match self.marked.iter().position(|file| *file == selected.file) {
            Some(at) => {
                self.marked.remove(at);
            }
            None => {
                if self.marked.len() == BESIDE {
                    self.marked.remove(0);
                }
                self.marked.push(selected.file.clone());
            }
        }
        FlightsKey::Open
    }

    /// Asks before the selected flight is deleted.
    fn delete(&mut self, flights: &FlightsState) -> FlightsKey {
        match self.selected(flights) {
            Some(flight) if flight.is_growing => FlightsKey::Refused(
                "This flight is still being recorded: it can be deleted once it is over.".to_owned(),
            ),
            Some(flight) => {
                self.deleting = Some(flight.file.clone());
                FlightsKey::Open
            }
            None => FlightsKey::Open,
        }
    }

    /// Returns the question before a flight is deleted.
    pub(in crate::ui) fn question(&self, flights: &FlightsState) -> Option<String> {
        let file = self.deleting.as_ref()?;
        let flight = flights.all().iter().find(|flight| flight.file == *file)?;
        Some(format!("Delete the recording {}?", printable::line(&flight.name())))
    }
}

/// Returns the place of the list on a screen.
fn frame_in(area: Rect) -> Rect {
    place(area, (SIZE.0, SIZE.1.min(area.height.saturating_sub(FREE))))
}

/// Returns the first shown row.
fn first(selected: usize, rows: usize) -> usize {
    (selected + 1).saturating_sub(rows)
}

/// Draws the list. Returns the position of the cursor.
pub(in crate::ui) fn draw(
    state: &Shared,
    list: &FlightsList,
    area: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = &state.theme;
    let found = state.flights.matching(list.query.value());
    let title = match state.flights.all().len() {
        0 => "Recorded flights".to_owned(),
        all if found.len() == all => format!("Recorded flights — {all}"),
        all => format!("Recorded flights — {} of {all}", found.len()),
    };
    let inside = framed(theme, frame_in(area), &title, buffer);
    let plan = usize::from(inside.width).saturating_sub(BUT_PLAN);
    let heading =
        format!("    {:<19} {:<plan$} {:<12} {:>7} {:>8}", "date (UTC)", "plan", "verdict", "time", "size");
    row(buffer, inside, 1, theme, Role::Dim, &heading);
    let rows = usize::from(inside.height.saturating_sub(AROUND));
    let first = first(list.selected, rows);
    for (at, flight) in found.iter().enumerate().skip(first).take(rows) {
        let is_selected = at == list.selected;
        let role = match (is_selected, flight.is_readable) {
            (true, _) => Role::Selected,
            (false, false) => Role::Dim,
            (false, true) => Role::Text,
        };
        let number = list.marked.iter().position(|file| *file == flight.file);
        let mark = number.map_or(' ', |number| if number == 0 { 'A' } else { 'B' });
        let pointer = if is_selected { '▸' } else { ' ' };
        let text = format!(
            "{pointer} {mark} {:<19} {:<plan$} {:<12} {:>7} {:>8}",
            cut(&flight.date, 19),
            cut(&printable::line(&flight.plan), plan),
            cut(&printable::line(&flight.verdict), 12),
            flight.duration,
            size(flight.bytes)
        );
        row(buffer, inside, ABOVE + (at - first) as u16, theme, role, &text);
    }
    foot(state, list, inside, buffer);
    row(buffer, inside, 0, theme, Role::Key, "> ");
    let field =
        Rect { x: inside.x + 2, width: inside.width.checked_sub(2)?, height: inside.height.min(1), ..inside };
    list.query.draw(theme, field, buffer).filter(|_| list.deleting.is_none())
}

/// Draws the reason of the selected flight, and the keys.
fn foot(state: &Shared, list: &FlightsList, inside: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let keys_at = inside.height.saturating_sub(1);
    if let Some(question) = list.question(&state.flights) {
        row(buffer, inside, keys_at.saturating_sub(1), theme, Role::Warn, &format!(" {question}"));
        line(buffer, inside, keys_at, &key_line(theme, &[(" y", " delete  "), ("n", " keep")]));
        return;
    }
    let (role, text) = match (&state.flights.list, list.selected(&state.flights)) {
        (None, _) => (Role::Dim, "Reading the library…".to_owned()),
        (Some(Err(problem)), _) => (Role::Fault, problem.clone()),
        (Some(Ok(all)), None) if all.is_empty() => {
            (Role::Dim, "No flights yet. Recording starts when the craft is armed.".to_owned())
        }
        (Some(Ok(_)), None) => (Role::Dim, "Nothing found: fewer letters find more.".to_owned()),
        (Some(Ok(_)), Some(flight)) if !flight.is_readable => {
            (Role::Warn, format!("{}: {}", flight.name(), flight.reason))
        }
        (Some(Ok(_)), Some(flight)) => (Role::Dim, flight.reason.clone()),
    };
    row(buffer, inside, keys_at.saturating_sub(1), theme, role, &format!(" {}", printable::line(&text)));
    let show = if list.marked.len() == BESIDE { " compare A and B  " } else { " show  " };
    let keys = [
        (" Enter", show),
        ("Ctrl-O", " fly again  "),
        ("Tab", " mark  "),
        ("Del", " delete  "),
        ("Esc", " close"),
    ];
    line(buffer, inside, keys_at, &key_line(theme, &keys));
}

/// Returns a size in the unit that fits.
fn size(bytes: u64) -> String {
    match bytes {
        0..=999_999 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}
