//! 7 World: wind, turbulence, noise and faults as a list of knobs. A mark shows each knob that is not at its default.

use crossterm::event::{KeyEvent, MouseEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::{Content, Hint};
use crate::ui::formatting::{clock, cut};
use crate::ui::knobs::{Knob, KnobsState, knobs};
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::message::Request;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use crate::ui::theme::Role;

use super::content::scrolled;
use crate::ui::area::row;

/// The width of a name with its mark.
const NAME: usize = 18;
/// The width of the knobs beside the history of the flight, and the width from which there is room for both.
const KNOBS: u16 = 38;
const WITH_HISTORY: u16 = 76;

/// The state of the World panel.
#[derive(Debug, Default)]
pub struct WorldPanel {
    pub knobs: KnobsState,
}

impl Content for WorldPanel {
    /// Returns the title with the airframe.
    fn title(&self, state: &Shared) -> String {
        let name = state.panel_title(Panel::World);
        match state.view.vehicle.world.airframe.as_str() {
            "" => name.to_owned(),
            airframe => format!("{name} — airframe {airframe}"),
        }
    }

    /// Draws the inside. Returns the position of the cursor while a value is typed.
    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let own = &self.knobs;
        let theme = &state.theme;
        if state.view.replay.is_some() {
            row(
                buffer,
                area,
                0,
                theme,
                Role::Dim,
                "The air and the faults of a recorded flight are unknown.",
            );
            return None;
        }
        let rows = usize::from(area.height.checked_sub(1)?);
        let (list, history) = divided(state, area);
        if let Some(history) = history {
            draw_history(state, history, buffer);
        }
        let all = knobs(state);
        let focused = state.focus == Panel::World;
        let mut cursor = None;
        for (at, knob) in all.iter().enumerate().skip(first(own, state, rows)).take(rows) {
            let is_selected = focused && at == own.selected;
            let is_default = knob.is_default(&state.view.vehicle.world);
            let role = match (is_selected, is_default, knob) {
                (true, ..) => Role::Focus,
                (false, false, Knob::Fault(_)) => Role::Warn,
                (false, false, _) => Role::Text,
                (false, true, Knob::Fault(_)) => Role::Dim,
                (false, true, _) => Role::Text,
            };
            let pointer = if is_selected { '▸' } else { ' ' };
            let mark = match (is_default, knob) {
                (true, _) => ' ',
                (false, Knob::Fault(_)) => '▲',
                (false, _) => '●',
            };
            let line = (at - first(own, state, rows)) as u16;
            let name = format!("{pointer}{mark} {:<15}", cut(knob.name(), 15));
            let typed = own.field.as_ref().filter(|_| is_selected);
            match typed {
                Some(field) => {
                    row(buffer, list, line, theme, role, &name);
                    let width = list.width.saturating_sub(NAME as u16);
                    let place = Rect::new(list.x + NAME as u16, list.y + line, width, 1);
                    cursor = field.draw(theme, place.intersection(list), buffer);
                }
                None => row(buffer, list, line, theme, role, &format!("{name}{}", knob.value(state))),
            }
        }
        let help = match all.get(own.selected) {
            Some(knob) if focused => knob.help(state.units),
            _ => format!(
                "wind, noise and faults, changed while it flies: {}",
                state.key(Action::Show(Panel::World))
            ),
        };
        row(buffer, area, area.height - 1, theme, Role::Dim, &help);
        cursor
    }

    fn hints(&self, _: &Shared) -> Vec<Hint> {
        vec![
            (&[Action::Panel(PanelAction::KnobUp), Action::Panel(PanelAction::KnobDown)], "knob"),
            (&[Action::Panel(PanelAction::KnobLess), Action::Panel(PanelAction::KnobMore)], "value"),
            (&[Action::Panel(PanelAction::KnobEnter)], "change"),
        ]
    }

    fn act(&mut self, state: &Shared, action: PanelAction) -> Vec<Request> {
        let last = knobs(state).len().saturating_sub(1);
        match action {
            PanelAction::KnobUp => {
                self.knobs.selected = self.knobs.selected.saturating_sub(1);
                Vec::new()
            }
            PanelAction::KnobDown => {
                self.knobs.selected = (self.knobs.selected + 1).min(last);
                Vec::new()
            }
            PanelAction::KnobLess => self.knobs.turn(state, -1),
            PanelAction::KnobMore => self.knobs.turn(state, 1),
            PanelAction::KnobEnter => self.knobs.enter(state),
            PanelAction::KnobEdit => self.knobs.edit(),
            PanelAction::KnobDefault => self.knobs.reset(state),
            _ => Vec::new(),
        }
    }

    fn typing(&self, state: &Shared) -> Option<Action> {
        self.knobs.is_number(state).then_some(Action::Panel(PanelAction::KnobEdit))
    }

    fn key(&mut self, state: &Shared, event: KeyEvent) -> Vec<Request> {
        self.knobs.field_key(state, event)
    }

    fn field(&mut self) -> Option<&mut TextField> {
        self.knobs.field.as_mut()
    }

    fn close_field(&mut self) {
        self.knobs.field = None;
    }

    fn scroll(&mut self, state: &Shared, _: Rect, by: isize) -> Vec<Request> {
        // The knob whose value is typed stays selected.
        if self.knobs.field.is_none() {
            scrolled(&mut self.knobs.selected, by, knobs(state).len().saturating_sub(1));
        }
        Vec::new()
    }

    fn press(&mut self, state: &Shared, area: Rect, event: &MouseEvent) -> Vec<Request> {
        let is_knob = event.column < divided(state, area).0.right();
        if let Some(knob) = knob_at(&self.knobs, state, area, event.row).filter(|_| is_knob) {
            self.knobs.field = None;
            self.knobs.selected = knob;
            return vec![Request::Chosen];
        }
        Vec::new()
    }
}

/// Returns the first shown knob, so that the selected one is visible.
fn first(own: &KnobsState, state: &Shared, rows: usize) -> usize {
    let last = knobs(state).len().saturating_sub(rows);
    own.selected.saturating_sub(rows / 2).min(last)
}

/// Returns the knob at a row of the inside.
fn knob_at(own: &KnobsState, state: &Shared, area: Rect, line: u16) -> Option<usize> {
    let rows = usize::from(area.height.saturating_sub(1));
    let at = usize::from(line.checked_sub(area.y)?);
    let index = first(own, state, rows) + at;
    (at < rows && index < knobs(state).len()).then_some(index)
}

/// Divides the inside into the knobs and, if the panel is zoomed and wide enough, the history of the flight.
fn divided(state: &Shared, area: Rect) -> (Rect, Option<Rect>) {
    if !state.zoomed || area.width < WITH_HISTORY {
        return (area, None);
    }
    let history = Rect { x: area.x + KNOBS, width: area.width - KNOBS, ..area };
    (Rect { width: KNOBS - 1, ..area }, Some(history))
}

/// Draws the changes up to the shown instant, the newest on top.
fn draw_history(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    row(buffer, area, 0, theme, Role::Title, "Changes in this flight");
    let rows = area.height.saturating_sub(2);
    let changes = state.world_history.until(state.view.vehicle.time);
    let mut shown = 0;
    for (at, change) in (1..=rows).zip(changes) {
        let (name, value) = (change.name, &change.value);
        let text = format!("{} {name:<15} {value}", clock(change.time));
        row(buffer, area, at, theme, Role::Text, &cut(&text, usize::from(area.width)));
        shown = at;
    }
    if shown == 0 {
        row(buffer, area, 1, theme, Role::Dim, "none");
    }
}
