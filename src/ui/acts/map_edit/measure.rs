//! The measure tool: distance and bearing between two points of the map.

use super::position;
use crate::geo::distance_bearing;
use crate::ui::acts::origin::origin;
use crate::ui::acts::viewport::moves as view;
use crate::ui::formatting::compass;
use crate::ui::model::map_point::MapPoint;
use crate::ui::model::map_state::Measure;
use crate::ui::shared::Shared;

/// Begins to measure at the cursor of the map, else at its middle, or ends it.
pub(in crate::ui) fn toggle(state: &mut Shared) {
    if state.map.measure.take().is_some() {
        return;
    }
    let Some(view) = view::viewport(state) else { return };
    let cursor = state.map.edit.take().map_or(view.centre, |cursor| cursor.place);
    state.map.moving = None;
    state.map.measure = Some(Measure { cursor, ..Measure::default() });
    // In the modes Follow and Fit the map would move under the cursor.
    state.map.mode = view.free();
}

/// Begins to measure from a place.
pub(in crate::ui) fn begin_at(state: &mut Shared, place: MapPoint) {
    if state.map.measure.is_none() {
        toggle(state);
    }
    state.map.measure = Some(Measure { cursor: place, from: Some(place), to: None });
}

/// Sets the first or the second point at a place, else at the cursor. After both, a new line begins.
pub(in crate::ui) fn set_point(state: &mut Shared, place: Option<MapPoint>) {
    let Some(measure) = &mut state.map.measure else { return };
    let place = place.unwrap_or(measure.cursor);
    measure.cursor = place;
    match (measure.from, measure.to) {
        (Some(_), None) => measure.to = Some(place),
        (None, _) | (_, Some(_)) => (measure.from, measure.to) = (Some(place), None),
    }
}

/// Moves the second point, as the mouse does while it drags.
pub(in crate::ui) fn drag_to(state: &mut Shared, place: MapPoint) {
    if let Some(measure) = &mut state.map.measure {
        measure.cursor = place;
        measure.to = Some(place);
    }
}

/// Moves the cursor by cells, and the map with it at the edge. Returns `false` if nothing is measured.
pub(super) fn arrow(state: &mut Shared, columns: f64, rows: f64) -> bool {
    let (Some(measure), Some(view)) = (state.map.measure, view::viewport(state)) else { return false };
    let cursor = view.beside(measure.cursor, columns, rows);
    state.map.measure = Some(Measure { cursor, ..measure });
    if view.screen_cell(cursor).is_none() {
        view::pan(state, columns, rows);
    }
    true
}

/// Returns both ends of the measured line.
pub(in crate::ui) fn ends(measure: &Measure) -> Option<(MapPoint, MapPoint)> {
    Some((measure.from?, measure.to.unwrap_or(measure.cursor)))
}

/// Returns distance and bearing of the measured line.
pub(in crate::ui) fn measured(state: &Shared) -> Option<String> {
    let (from, to) = ends(state.map.measure.as_ref()?)?;
    let frame = origin(state)?;
    let (distance_m, bearing) = distance_bearing(position(&frame, from), position(&frame, to));
    let distance = state.units.length_text(distance_m, 1);
    Some(format!("{distance} {:03.0}°", compass(bearing.to_degrees())))
}
