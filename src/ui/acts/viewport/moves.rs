//! Moves the window of the map.

use super::Viewport;
use crate::ui::acts::screen_layout;
use crate::ui::model::map_point;
use crate::ui::model::map_point::MapPoint;
use crate::ui::model::map_state::MapMode;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;

/// The factor of a zoom step of the map.
pub(in crate::ui) const ZOOM_STEP: f64 = 1.5;

/// Returns the current window of the map.
pub(in crate::ui) fn viewport(state: &Shared) -> Option<Viewport> {
    let area = screen_layout::screen(state)?.panel(Panel::Map)?;
    Some(Viewport::of(state, screen_layout::inner(area)))
}

/// Returns the mode that keeps the craft in the middle of the map, at the current scale.
pub(in crate::ui) fn following(state: &Shared) -> Option<MapMode> {
    viewport(state).map(|view| MapMode::Follow(view.scale))
}

/// Moves the map by an eighth of its size.
pub(in crate::ui) fn pan(state: &mut Shared, columns: f64, rows: f64) {
    if let Some(view) = viewport(state) {
        let (width, height) = (f64::from(view.area.width), f64::from(view.area.height));
        state.map.mode = view.panned(columns * (width / 8.0).ceil(), rows * (height / 8.0).ceil());
    }
}

/// Returns the mode after a zoom around the edit cursor, else around the craft if it is in the window, which then keeps it
/// in view, else around the middle.
pub(in crate::ui) fn zoomed(state: &Shared, factor: f64) -> Option<MapMode> {
    let view = viewport(state)?;
    Some(match state.map.mode {
        MapMode::Follow(scale) => MapMode::Follow(scale * factor),
        MapMode::Fit | MapMode::Free { .. } | MapMode::Near { .. } => {
            let is_seen = |place: &MapPoint| view.screen_cell(*place).is_some();
            let measured = state.map.measure.map(|measure| measure.cursor);
            let cursor = state.map.edit.map(|cursor| cursor.place).or(measured);
            let craft = map_point::craft(&state.view).filter(is_seen);
            match (cursor.filter(is_seen), craft) {
                (Some(cursor), _) => view.zoomed(factor, cursor).free(),
                (None, Some(craft)) => view.zoomed(factor, craft).near(),
                (None, None) => view.zoomed(factor, view.centre).free(),
            }
        }
    })
}
