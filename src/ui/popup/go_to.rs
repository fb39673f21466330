//! The popup to choose a waypoint to go to.

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::plan::FlightPlan;
use crate::ui::area::{line, row};
use crate::ui::popup::Outcome;
use crate::ui::popup::frame::{key_line, popup};
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

/// The width of the inside.
const WIDTH: u16 = 40;
/// The greatest number of waypoint rows.
const ROWS: usize = 12;

/// The waypoints to choose from, and the selected one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GoTo {
    /// Index and type of the waypoints with a place.
    waypoints: Vec<(u8, String)>,
    selected: usize,
    /// The digits typed so far.
    typed: String,
}

impl GoTo {
    /// Returns the popup for `plan`. The first waypoint from `current` on is selected.
    pub(crate) fn new(plan: &FlightPlan, current: u8) -> Self {
        let placed = (0..).zip(&plan.waypoints).filter(|(_, waypoint)| waypoint.kind.is_positional());
        let waypoints: Vec<_> = placed.map(|(index, waypoint)| (index, waypoint.kind.to_string())).collect();
        let selected = waypoints.iter().position(|(index, _)| *index >= current).unwrap_or(0);
        Self { waypoints, selected, typed: String::new() }
    }

    /// Returns index and type of the waypoints to choose from.
    pub(crate) fn waypoints(&self) -> impl Iterator<Item = (u8, &str)> {
        self.waypoints.iter().map(|(index, kind)| (*index, kind.as_str()))
    }

    pub(in crate::ui) fn key(&mut self, event: KeyEvent) -> Outcome<u8> {
        match event.code {
            KeyCode::Up | KeyCode::Char('k') => self.selected = self.selected.saturating_sub(1),
            KeyCode::Down | KeyCode::Char('j') => {
                self.selected = (self.selected + 1).min(self.waypoints.len().saturating_sub(1));
            }
            KeyCode::Char(digit @ '0'..='9') => self.type_digit(digit),
            KeyCode::Enter => {
                let chosen = self.waypoints.get(self.selected);
                return chosen.map_or(Outcome::Left, |(index, _)| Outcome::Chosen(*index));
            }
            KeyCode::Esc | KeyCode::Char('G' | 'q') => return Outcome::Left,
            _ => {}
        }
        Outcome::Open
    }

    /// Selects by number. A digit that leads to no waypoint begins a new number.
    fn type_digit(&mut self, digit: char) {
        self.typed.push(digit);
        for _ in 0..2 {
            let found = self.waypoints.iter().position(|(index, _)| index.to_string() == self.typed);
            if let Some(found) = found {
                self.selected = found;
                return;
            }
            self.typed = digit.to_string();
        }
    }
}

pub(crate) fn draw(state: &Shared, question: &GoTo, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let shown = question.waypoints.len().min(ROWS);
    let first = question.selected.saturating_sub(ROWS - 1);
    let title = if state.flies_older_plan() { "Continue on the new plan from" } else { "Go now to" };
    let inside = popup(theme, area, (WIDTH, shown as u16 + 2), title, buffer);
    for (at, (index, kind)) in question.waypoints.iter().skip(first).take(shown).enumerate() {
        let (mark, role) =
            if first + at == question.selected { ("▸", Role::Selected) } else { (" ", Role::Text) };
        row(buffer, inside, at as u16, theme, role, &format!("{mark} waypoint {index:>2}  {kind}"));
    }
    let keys = [(" ↑ ↓ 0…9", " choose  "), ("Enter", " go  "), ("Esc", " close")];
    line(buffer, inside, shown as u16 + 1, &key_line(theme, &keys));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Waypoint, WaypointType};
    use crossterm::event::KeyModifiers;

    fn press(question: &mut GoTo, code: KeyCode) -> Outcome<u8> {
        question.key(KeyEvent::new(code, KeyModifiers::NONE))
    }

    #[test]
    fn a_waypoint_is_chosen_by_arrows_or_by_its_number() {
        let mut plan = FlightPlan::default();
        for _ in 0..14 {
            plan.waypoints.push(Waypoint { kind: WaypointType::Flyover, ..Waypoint::default() });
        }
        plan.waypoints[1].kind = WaypointType::YawRate;
        let mut question = GoTo::new(&plan, 2);
        assert!(matches!(press(&mut question, KeyCode::Up), Outcome::Open));
        assert!(matches!(press(&mut question, KeyCode::Enter), Outcome::Chosen(0)), "1 has no place");
        for (digit, chosen) in [('1', 0), ('2', 12), ('3', 3), ('9', 9)] {
            press(&mut question, KeyCode::Char(digit));
            let Outcome::Chosen(index) = press(&mut question, KeyCode::Enter) else { panic!("{digit}") };
            assert_eq!(index, chosen, "after {digit}");
        }
        assert!(matches!(press(&mut question, KeyCode::Esc), Outcome::Left));
    }
}
