//! The mouse: a click focuses and sets, a drag moves, the wheel zooms and scrolls.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Rect;

use crate::plan::Altitude;
use crate::ui::app_state::AppState;
use crate::ui::editor::Column;
use crate::ui::layout;
use crate::ui::map_edit::item_at;
use crate::ui::map_point::MapPoint;
use crate::ui::map_state::{MapItem, MapMode};
use crate::ui::message::Effect;
use crate::ui::notice;
use crate::ui::panel::Panel;
use crate::ui::panel::plan::{self as plan_panel, PlanTarget};
use crate::ui::panel::{rc, world};
use crate::ui::panel_bar;
use crate::ui::popup::Popup;
use crate::ui::transmitter;
use crate::ui::tutorial;
use crate::ui::viewport::Viewport;

use super::map_edit;
use super::map_menu;
use super::timeline;
use super::view::{ZOOM_STEP, focus, scroll_panel};

/// The number of lines per step of the wheel.
const WHEEL_LINES: isize = 3;

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
        return focus(&mut state.shared, panel);
    }
    let at = match event.kind {
        // A drag belongs to the panel in which it began, even if the mouse leaves it.
        MouseEventKind::Drag(_) => state.pressed.and_then(|panel| Some((panel, screen.panel(panel)?))),
        _ => screen.at(event.column, event.row),
    };
    let Some((panel, area)) = at else { return Vec::new() };
    match event.kind {
        MouseEventKind::Down(MouseButton::Left) => {
            focus(&mut state.shared, panel);
            state.pressed = Some(panel);
            match panel {
                Panel::Map => press_on_map(state, area, &event),
                Panel::Rc => set_channel(state, area, &event),
                Panel::World => {
                    if let Some(knob) =
                        world::knob_at(&state.knobs, &state.shared, layout::inner(area), event.row)
                    {
                        state.knobs.field = None;
                        state.knobs.selected = knob;
                    }
                    Vec::new()
                }
                Panel::Plan => {
                    press_on_plan(state, area, &event);
                    Vec::new()
                }
                Panel::State | Panel::Cli | Panel::Graphs | Panel::Log => Vec::new(),
            }
        }
        MouseEventKind::Drag(MouseButton::Left) => match panel {
            Panel::Map => {
                match &mut state.shared.map.moving {
                    Some(_) => drag_item(state, area, &event),
                    None => drag_map(state, area, &event),
                }
                Vec::new()
            }
            // The pressed slider, even if the mouse slips to the one below.
            Panel::Rc => rc::value_at(layout::inner(area), state.channel, event.column)
                .map_or_else(Vec::new, |us| transmitter::set(&mut state.shared, state.channel, us)),
            Panel::Plan => {
                drag_altitude(state, &event);
                Vec::new()
            }
            Panel::State | Panel::Cli | Panel::Graphs | Panel::World | Panel::Log => Vec::new(),
        },
        MouseEventKind::Down(MouseButton::Right) => {
            focus(&mut state.shared, panel);
            if panel == Panel::Map {
                let view = Viewport::of(&state.shared, layout::inner(area));
                map_menu::open(state, &view, (event.column, event.row));
            }
            Vec::new()
        }
        MouseEventKind::ScrollUp => {
            wheel(state, panel, area, &event, -1);
            Vec::new()
        }
        MouseEventKind::ScrollDown => {
            wheel(state, panel, area, &event, 1);
            Vec::new()
        }
        _ => Vec::new(),
    }
}

/// Ends a drag, at any position of the mouse.
fn release(state: &mut AppState) -> Vec<Effect> {
    state.drag = None;
    state.pressed = None;
    if let Some((index, altitude)) = state.shared.editor.dragged_altitude.take() {
        return state.shared.editor.edit(&format!("altitude of WP{index}"), |document| {
            if let Some(wp) = document.plan.waypoints.get_mut(index) {
                wp.altitude = altitude;
            }
        });
    }
    if state.shared.map.moving.is_some_and(|moving| moving.by_mouse) {
        return map_edit::put_down(&mut state.shared);
    }
    Vec::new()
}

fn wheel(state: &mut AppState, panel: Panel, area: Rect, event: &MouseEvent, direction: isize) {
    if panel != Panel::Map {
        scroll_panel(state, panel, direction * WHEEL_LINES);
        return;
    }
    let factor = if direction < 0 { 1.0 / ZOOM_STEP } else { ZOOM_STEP };
    let view = Viewport::of(&state.shared, layout::inner(area));
    state.shared.map.mode = match state.shared.map.mode {
        MapMode::Follow(scale) => MapMode::Follow(scale * factor),
        MapMode::Fit | MapMode::Free { .. } => view.zoomed(factor, view.place(event.column, event.row)),
    };
}

/// Picks up a waypoint, home or the fence under the mouse, or starts dragging the map. A press with Ctrl adds a
/// waypoint.
fn press_on_map(state: &mut AppState, area: Rect, event: &MouseEvent) -> Vec<Effect> {
    let view = Viewport::of(&state.shared, layout::inner(area));
    let place = view.place(event.column, event.row);
    if event.modifiers.contains(KeyModifiers::CONTROL) {
        return map_edit::add_at(&mut state.shared, place);
    }
    let item = item_at(&state.shared, place, view.scale);
    // Home and fence move only in edit mode, because they are in areas where the map is dragged, too.
    let item = item.filter(|item| matches!(item, MapItem::Waypoint(_)) || state.shared.map.edit.is_some());
    match item.filter(|_| state.shared.view.vehicle.active_plan.is_none() || state.shared.map.edit.is_some())
    {
        Some(item) => map_edit::pick_up(&mut state.shared, item, place, true),
        None => state.drag = Some((event.column, event.row, view.centre.n, view.centre.e)),
    }
    Vec::new()
}

/// Moves the cursor to the value under the mouse, or picks up a waypoint of the altitude profile.
fn press_on_plan(state: &mut AppState, area: Rect, event: &MouseEvent) {
    match plan_panel::target_at(&state.shared, layout::inner(area), (event.column, event.row)) {
        Some(PlanTarget::Cell(row, column)) => state.shared.editor.go_to_cell(row, column),
        Some(PlanTarget::Altitude(index)) => {
            state.shared.editor.go_to_cell(index, Column::Altitude);
            let altitude = state.shared.plan().waypoints.get(index).map(|wp| wp.altitude);
            state.shared.editor.dragged_altitude = altitude.map(|altitude| (index, altitude));
            // The current scale: it changes with the altitude.
            let metres = plan_panel::metres_per_row(&state.shared, layout::inner(area)).unwrap_or_default();
            let from_m = altitude.unwrap_or_default().above_home_m();
            state.drag = Some((event.column, event.row, metres, from_m));
        }
        None => {}
    }
}

/// Drags an altitude of the profile, by whole metres or feet.
fn drag_altitude(state: &mut AppState, event: &MouseEvent) {
    let (Some((index, _)), Some((_, from_row, metres, from_m))) =
        (state.shared.editor.dragged_altitude, state.drag)
    else {
        return;
    };
    let rows = f64::from(from_row) - f64::from(event.row);
    let shown = state.shared.units.length(from_m + rows * metres).round();
    let altitude_m = state.shared.units.metres(shown);
    state.shared.editor.dragged_altitude = Some((index, Altitude::above_home(altitude_m)));
}

/// Moves the item that the mouse has picked up. The window stays still meanwhile.
fn drag_item(state: &mut AppState, area: Rect, event: &MouseEvent) {
    let view = Viewport::of(&state.shared, layout::inner(area));
    state.shared.map.mode = MapMode::Free { n: view.centre.n, e: view.centre.e, scale: view.scale };
    if let Some(moving) = &mut state.shared.map.moving {
        moving.place = view.place(event.column, event.row);
        moving.moved = true;
    }
}

fn drag_map(state: &mut AppState, area: Rect, event: &MouseEvent) {
    let Some((column, row, n, e)) = state.drag else { return };
    let view = Viewport { centre: MapPoint::new(n, e), ..Viewport::of(&state.shared, layout::inner(area)) };
    let columns = f64::from(column) - f64::from(event.column);
    let rows = f64::from(row) - f64::from(event.row);
    if columns != 0.0 || rows != 0.0 {
        state.shared.map.mode = view.panned(columns, rows);
    }
}

fn set_channel(state: &mut AppState, area: Rect, event: &MouseEvent) -> Vec<Effect> {
    match rc::channel_at(layout::inner(area), state.channel, (event.column, event.row)) {
        Some((channel, Some(us))) => {
            state.channel = channel;
            transmitter::set(&mut state.shared, channel, us)
        }
        Some((channel, None)) => {
            state.channel = channel;
            Vec::new()
        }
        None => Vec::new(),
    }
}
