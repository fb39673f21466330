//! The mouse: a click focuses and sets, a drag moves, the wheel zooms and scrolls.

use crossterm::event::{MouseButton, MouseEvent, MouseEventKind};

use crate::ui::acts::screen_layout;
use crate::ui::app_state::AppState;
use crate::ui::model::action::Action;
use crate::ui::model::effect::Effect;
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::{Outcome, Popup, command_line, palette};
use crate::ui::{hint_bar, notice, panel_bar, tutorial};

use super::popup::{chosen, enter, take_entry};
use super::view::focus;
use super::{act, arrange, carry_out, diff, flights, map_menu, plan_popup, shown_keys, timeline};

/// The number of lines of the help per step of the wheel.
const WHEEL_LINES: isize = 3;

/// Processes a mouse event.
pub(super) fn update(state: &mut AppState, event: MouseEvent) -> Vec<Effect> {
    if let MouseEventKind::Up(_) = event.kind {
        return release(state);
    }
    let has_keys_and_rows = matches!(state.popups.last(), Some(Popup::Flights(_) | Popup::Diff(_)));
    if event.kind == MouseEventKind::Down(MouseButton::Left)
        && has_keys_and_rows
        && let Some(effects) = shown_keys::press_shown(state, (event.column, event.row))
    {
        return effects;
    }
    if let Some(effects) = popup(state, event) {
        return effects;
    }
    let is_click = event.kind == MouseEventKind::Down(MouseButton::Left);
    if is_click
        && state.popups.is_empty()
        && let Some(effects) = plan_popup::click(&mut state.shared, (event.column, event.row))
    {
        return effects;
    }
    let arranges = matches!(state.popups.last(), Some(Popup::Layout));
    if !arranges && (!state.popups.is_empty() || state.shared.editor.popup.is_some()) {
        return shown_keys::mouse(state, event);
    }
    if arranges
        && is_click
        && let Some(effects) = shown_keys::press_shown(state, (event.column, event.row))
    {
        return effects;
    }
    if is_click
        && let Some(screen) = screen_layout::screen(&state.shared)
        && let foot = screen.timeline.unwrap_or(screen.hints)
        && let above = tutorial::rows(state.tutorial, &state.shared, foot)
        && notice::close_at(&mut state.shared, above, foot, (event.column, event.row))
    {
        return Vec::new();
    }
    if is_click && let Some(effects) = timeline::click(&state.shared, event.column, event.row) {
        return effects;
    }
    let Some(screen) = screen_layout::screen(&state.shared) else { return Vec::new() };
    if let (MouseEventKind::Drag(MouseButton::Left), Some(border)) = (event.kind, state.dragged) {
        arrange::drag(&mut state.shared, &screen, border, &event);
        return Vec::new();
    }
    let cell = (event.column, event.row);
    if !arranges && is_click && screen.status.contains(cell.into()) {
        return act(state, Action::Palette);
    }
    if !arranges && is_click {
        let hints = state.panels.of(state.shared.focus).hints(&state.shared);
        if let Some(action) = hint_bar::action_at(&hints, &state.shared, screen.hints, cell) {
            return act(state, action);
        }
    }
    if is_click && let Some(panel) = panel_bar::panel_at(&state.shared, &screen, (event.column, event.row)) {
        return focus(state, panel);
    }
    if is_click && let Some(border) = arrange::border_at(&screen, event.column, event.row) {
        state.dragged = Some(border);
        let panel = screen.at(event.column, event.row).map(|(panel, _)| panel);
        return panel.map_or_else(Vec::new, |panel| focus(state, panel));
    }
    if arranges {
        let clicked = screen.at(event.column, event.row);
        return match event.kind {
            MouseEventKind::Down(_) => clicked.map_or_else(Vec::new, |(panel, _)| focus(state, panel)),
            _ => Vec::new(),
        };
    }
    let at = match event.kind {
        // A drag belongs to the panel in which it began, even if the mouse leaves it.
        MouseEventKind::Drag(_) => state.pressed.and_then(|panel| Some((panel, screen.panel(panel)?))),
        _ => screen.at(event.column, event.row),
    };
    let Some((panel, area)) = at else { return Vec::new() };
    if let MouseEventKind::Down(MouseButton::Left | MouseButton::Right) = event.kind {
        focus(state, panel);
        state.has_chosen = false;
    }
    let content = state.panels.of_mut(panel);
    let shared = &state.shared;
    let inside = screen_layout::inner(area);
    let requests = match event.kind {
        MouseEventKind::Down(MouseButton::Left) => {
            state.pressed = Some(panel);
            content.press(shared, inside, &event)
        }
        MouseEventKind::Drag(MouseButton::Left) => content.drag(shared, inside, &event),
        MouseEventKind::Down(MouseButton::Right) => {
            state.popups.extend(content.menu(shared, inside, &event));
            Vec::new()
        }
        MouseEventKind::ScrollUp => content.wheel(shared, inside, &event, -1),
        MouseEventKind::ScrollDown => content.wheel(shared, inside, &event, 1),
        _ => Vec::new(),
    };
    carry_out(state, requests)
}

/// Ends a drag, at any position of the mouse.
fn release(state: &mut AppState) -> Vec<Effect> {
    state.pressed = None;
    state.dragged = None;
    let released = |panel| state.panels.of_mut(panel).release(&state.shared);
    let requests = Panel::ALL.into_iter().flat_map(released).collect();
    carry_out(state, requests)
}

/// Handles an event for the popup opened last, if it takes the mouse.
fn popup(state: &mut AppState, event: MouseEvent) -> Option<Vec<Effect>> {
    let (size, cell) = (state.shared.size, (event.column, event.row));
    let is_press = matches!(event.kind, MouseEventKind::Down(_));
    let wheel = match event.kind {
        MouseEventKind::ScrollUp => -1,
        MouseEventKind::ScrollDown => 1,
        _ => 0,
    };
    let effects = match state.popups.last_mut()? {
        Popup::MapMenu(menu) => {
            let (outcome, place) = (menu.click(size, cell), menu.place);
            if is_press { map_menu::take(state, place, outcome) } else { Vec::new() }
        }
        Popup::Flights(list) => {
            let result = list.mouse(&state.shared.flights, size, event);
            flights::take(state, result)
        }
        Popup::Diff(view) => {
            let result = view.mouse(&state.shared, event);
            diff::take(state, result)
        }
        Popup::Actions(menu) => {
            let outcome = if is_press { menu.click(size, cell) } else { Outcome::Open };
            chosen(&mut state.popups, outcome).map_or_else(Vec::new, |action| act(state, action))
        }
        Popup::Palette(palette) if wheel != 0 => {
            palette.scroll(&state.shared.used, wheel);
            Vec::new()
        }
        Popup::Palette(palette) => {
            let outcome = if is_press {
                palette::click(palette, &state.shared.used, size, cell)
            } else {
                Outcome::Open
            };
            take_entry(state, outcome)
        }
        Popup::CommandLine if event.kind == MouseEventKind::Down(MouseButton::Left) => {
            let outcome = command_line::click(&mut state.command_line, &state.shared, size, cell)?;
            enter(state, outcome)
        }
        Popup::Help(help) if wheel != 0 => {
            help.scroll_by(wheel * WHEEL_LINES);
            Vec::new()
        }
        Popup::Help(help) => {
            let outcome = if is_press { help.click(&state.shared, cell) } else { Outcome::Open };
            chosen(&mut state.popups, outcome).map_or_else(Vec::new, |action| act(state, action))
        }
        _ => return None,
    };
    Some(effects)
}
