//! The mouse: a click focuses and sets, a drag moves, the wheel zooms and scrolls.

use crossterm::event::{MouseButton, MouseEvent, MouseEventKind};

use crate::ui::app_state::AppState;
use crate::ui::message::{Effect, Request};
use crate::ui::panel::Panel;
use crate::ui::popup::Popup;
use crate::ui::{layout, notice, panel_bar, tutorial};

use super::popup::chosen;
use super::view::focus;
use super::{act, carry_out, flights, map_menu, timeline};

/// Processes a mouse event.
pub(super) fn update(state: &mut AppState, event: MouseEvent) -> Vec<Effect> {
    if let MouseEventKind::Up(_) = event.kind {
        return release(state);
    }
    if let Some(Popup::MapMenu(menu)) = state.popups.last() {
        let (outcome, place) = (menu.click(state.shared.size, (event.column, event.row)), menu.place);
        let is_click = matches!(event.kind, MouseEventKind::Down(_));
        return if is_click { map_menu::take(state, place, outcome) } else { Vec::new() };
    }
    if let Some(Popup::Flights(list)) = state.popups.last_mut() {
        let result = list.mouse(&state.shared.flights, state.shared.size, event);
        return flights::take(state, result);
    }
    if let Some(Popup::Actions(menu)) = state.popups.last() {
        if !matches!(event.kind, MouseEventKind::Down(_)) {
            return Vec::new();
        }
        let outcome = menu.click(state.shared.size, (event.column, event.row));
        return chosen(&mut state.popups, outcome).map_or_else(Vec::new, |action| act(state, action));
    }
    if !state.popups.is_empty() || state.shared.editor.popup.is_some() {
        return Vec::new();
    }
    if event.kind == MouseEventKind::Down(MouseButton::Left)
        && let Some(screen) = layout::screen(&state.shared)
        && let foot = screen.timeline.unwrap_or(screen.hints)
        && let above = tutorial::rows(state.tutorial, &state.shared, foot)
        && notice::close_at(&mut state.shared, above, foot, (event.column, event.row))
    {
        return Vec::new();
    }
    if event.kind == MouseEventKind::Down(MouseButton::Left)
        && let Some(effects) = timeline::click(&state.shared, event.column, event.row)
    {
        return effects;
    }
    let Some(screen) = layout::screen(&state.shared) else { return Vec::new() };
    if event.kind == MouseEventKind::Down(MouseButton::Left)
        && let Some(panel) = panel_bar::panel_at(&state.shared, &screen, (event.column, event.row))
    {
        return focus(state, panel);
    }
    let at = match event.kind {
        // A drag belongs to the panel in which it began, even if the mouse leaves it.
        MouseEventKind::Drag(_) => state.pressed.and_then(|panel| Some((panel, screen.panel(panel)?))),
        _ => screen.at(event.column, event.row),
    };
    let Some((panel, area)) = at else { return Vec::new() };
    if let MouseEventKind::Down(MouseButton::Left | MouseButton::Right) = event.kind {
        focus(state, panel);
    }
    let content = state.panels.of_mut(panel);
    let shared = &state.shared;
    let inside = layout::inner(area);
    let requests = match event.kind {
        MouseEventKind::Down(MouseButton::Left) => {
            state.pressed = Some(panel);
            content.press(shared, inside, &event)
        }
        MouseEventKind::Drag(MouseButton::Left) => content.drag(shared, inside, &event),
        MouseEventKind::Down(MouseButton::Right) => {
            content.menu(shared, inside, &event).map(Request::Open).into_iter().collect()
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
    let released = |panel| state.panels.of_mut(panel).release(&state.shared);
    let requests = Panel::ALL.into_iter().flat_map(released).collect();
    carry_out(state, requests)
}
