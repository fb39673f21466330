//! Editing on the map: the cursor, picking up and putting down.

use super::measure;
use crate::plan::Waypoint;
use crate::plan::format::HomePosition;
use crate::ui::acts::origin::origin;
use crate::ui::acts::viewport::moves as view;
use crate::ui::acts::{map_edit, plan_edits as plan};
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::model::map_state::{MapCursor, MapItem, MapMode, Moving};
use crate::ui::model::plan_id::PlanId;
use crate::ui::shared::Shared;

/// The greatest radius of the fence that the craft accepts, m.
const WIDEST_FENCE_M: f64 = 10_000.0;

/// Shows or hides the cursor.
pub(in crate::ui) fn toggle(state: &mut Shared) -> Vec<Effect> {
    state.map.moving = None;
    state.map.measure = None;
    if state.map.edit.take().is_some() {
        return Vec::new();
    }
    let Some(view) = view::viewport(state) else { return Vec::new() };
    state.map.edit = Some(MapCursor { place: view.centre });
    // In the modes Follow and Fit the map would move under the cursor.
    state.map.mode = view.free();
    Vec::new()
}

/// Handles an arrow key: moves the cursor by a cell if there is one, else the map.
pub(in crate::ui) fn arrow(state: &mut Shared, columns: f64, rows: f64) {
    if measure::arrow(state, columns, rows) {
        return;
    }
    let (Some(cursor), Some(view)) = (state.map.edit, view::viewport(state)) else {
        view::pan(state, columns, rows);
        return;
    };
    let place = view.beside(cursor.place, columns, rows);
    state.map.edit = Some(MapCursor { place });
    if let Some(moving) = &mut state.map.moving {
        moving.place = place;
        moving.moved = true;
    }
    if view.screen_cell(place).is_none() {
        view::pan(state, columns, rows);
    }
}

/// Moves the cursor to the next waypoint with a place, or by as many as `by`; without a cursor, the middle of the map.
/// The row of the plan moves with it.
pub(in crate::ui) fn to_waypoint(state: &mut Shared, by: isize) -> Vec<Effect> {
    if state.map.moving.is_some() {
        let key = state.key(Action::Edit(EditAction::Pick));
        return state.only_notify(Severity::Info, format!("`{key}` puts the waypoint down first."));
    }
    let (Some(frame), Some(view)) = (origin(state), view::viewport(state)) else { return Vec::new() };
    let places: Vec<(usize, MapPoint)> = {
        let waypoints = state.plan().waypoints.iter().enumerate().filter(|(_, wp)| wp.kind.uses_position());
        waypoints.map(|(index, wp)| (index, to_map(&frame, wp.position))).collect()
    };
    let Some(last) = places.len().checked_sub(1) else {
        return state.only_notify(Severity::Info, "The plan has no waypoint with a place.");
    };
    let row = state.editor.row();
    // From the row of the plan on, unless the map shows another place than that of its waypoint.
    let here = state.map.edit.map_or(view.centre, |cursor| cursor.place);
    let is_here = |(index, place): &(usize, MapPoint)| *index == row && place.distance(here) < view.scale;
    let at = match places.iter().position(is_here) {
        Some(at) => at.checked_add_signed(by).unwrap_or(last),
        None => places.iter().position(|(index, _)| *index >= row).unwrap_or(0),
    };
    let (index, place) = places[if at > last { 0 } else { at }];
    state.editor.go_to_row(index);
    if state.map.edit.is_some() {
        state.map.edit = Some(MapCursor { place });
    }
    if state.map.edit.is_none() || view.screen_cell(place).is_none() {
        state.map.mode = MapMode::Free { n: place.n, e: place.e, scale: view.scale };
    }
    Vec::new()
}

/// Picks up the item at the cursor, or puts down the item picked up before.
pub(in crate::ui) fn pick(state: &mut Shared) -> Vec<Effect> {
    if state.map.measure.is_some() {
        measure::set_point(state, None);
        return Vec::new();
    }
    let Some(cursor) = state.map.edit else {
        let key = state.key(Action::Edit(EditAction::OnMap));
        let text = format!("`{key}` shows a cursor with which waypoints are picked, added and moved.");
        return state.only_notify(Severity::Info, text);
    };
    if state.map.moving.is_some() {
        return put_down(state);
    }
    let Some(view) = view::viewport(state) else { return Vec::new() };
    match map_edit::item_at(state, cursor.place, view.scale) {
        Some(item) => pick_up(state, item, cursor.place, false),
        None => {
            let key = state.key(Action::Edit(EditAction::AddOnMap));
            state.notify(Severity::Info, format!("Nothing is here: `{key}` adds a waypoint at the cursor."));
        }
    }
    Vec::new()
}

/// Picks an item up.
pub(in crate::ui) fn pick_up(state: &mut Shared, item: MapItem, place: MapPoint, by_mouse: bool) {
    if let MapItem::Waypoint(index) = item {
        state.editor.go_to_row(index);
    }
    state.map.moving = Some(Moving { item, place, moved: false, by_mouse, of: revision(state) });
}

/// Returns the shown plan and its revision.
fn revision(state: &Shared) -> (PlanId, usize) {
    let plan = state.editor.plan();
    (plan.id(), plan.history().at())
}

/// Ends measuring, else drops the picked-up item at its old place, else hides the cursor. Returns `true` if there was any.
pub(in crate::ui) fn leave(state: &mut Shared) -> bool {
    state.map.measure.take().is_some() || state.map.moving.take().is_some() || state.map.edit.take().is_some()
}

/// Puts an item at a place, as one edit.
pub(in crate::ui) fn put(state: &mut Shared, item: MapItem, place: MapPoint) -> Vec<Effect> {
    state.map.moving = Some(Moving { item, place, moved: true, by_mouse: false, of: revision(state) });
    put_down(state)
}

/// Puts down the item being moved, as one edit.
pub(in crate::ui) fn put_down(state: &mut Shared) -> Vec<Effect> {
    let (Some(moving), Some(frame)) = (state.map.moving.take(), origin(state)) else {
        return Vec::new();
    };
    if !moving.moved {
        return Vec::new();
    }
    if moving.of != revision(state) {
        return state.only_notify(
            Severity::Warn,
            "The plan was changed meanwhile, so nothing was moved: pick it up again.",
        );
    }
    let position = map_edit::position(&frame, moving.place);
    match moving.item {
        MapItem::Waypoint(index) => plan::place_waypoint(state, index, position),
        MapItem::Home => {
            state.notify(Severity::Info, "Home of the plan: the craft is there at the next start with it.");
            state.editor.edit("move home", |document| {
                let amsl_m = document.home.and_then(|home| home.amsl_m);
                document.home = Some(HomePosition { position, amsl_m });
            })
        }
        MapItem::Fence => {
            let Some(home) = map_edit::home(state) else { return Vec::new() };
            let metres = home.distance(moving.place).round().clamp(1.0, WIDEST_FENCE_M);
            state.notify(
                Severity::Info,
                format!("Fence of the plan: {} around home.", state.units.length_text(metres, 0)),
            );
            state.editor.edit("fence", |document| {
                document.settings.retain(|line| !line.starts_with("ap_max_distance_from_home"));
                document.settings.push(format!("ap_max_distance_from_home = {metres:.0}"));
            })
        }
    }
}

/// Adds a waypoint at the cursor.
pub(in crate::ui) fn add(state: &mut Shared) -> Vec<Effect> {
    let Some(cursor) = state.map.edit else {
        toggle(state);
        let key = state.key(Action::Edit(EditAction::AddOnMap));
        let text = format!("Move the cursor with the arrow keys; `{key}` adds a waypoint there.");
        return state.only_notify(Severity::Info, text);
    };
    add_at(state, cursor.place)
}

/// Adds a waypoint at a place.
pub(in crate::ui) fn add_at(state: &mut Shared, place: MapPoint) -> Vec<Effect> {
    let Some(frame) = origin(state) else { return Vec::new() };
    let position = map_edit::position(&frame, place);
    let like = plan::next_waypoint(state).unwrap_or_default();
    plan::insert_waypoint(state, Waypoint { position, ..like })
}

/// Deletes the waypoint at the cursor.
pub(in crate::ui) fn delete(state: &mut Shared) -> Vec<Effect> {
    let (Some(cursor), Some(view)) = (state.map.edit, view::viewport(state)) else {
        let [shows, deletes] =
            [EditAction::OnMap, EditAction::DeleteOnMap].map(|action| state.key(Action::Edit(action)));
        let text = format!("`{shows}` shows a cursor: `{deletes}` deletes the waypoint under it.");
        return state.only_notify(Severity::Info, text);
    };
    let Some(MapItem::Waypoint(index)) = map_edit::item_at(state, cursor.place, view.scale) else {
        return state.only_notify(Severity::Info, "No waypoint is here.");
    };
    state.map.moving = None;
    state.editor.cancel();
    state.editor.go_to_row(index);
    state.editor.delete()
}
