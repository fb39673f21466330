//! Edits on the map: waypoints, home and the fence, by a cursor or by the mouse.

pub(in crate::ui) mod actions;
pub(in crate::ui) mod measure;

use super::settings_in_force;
use crate::geo::{LatLon, LocalFrame, distance_bearing};
use crate::ui::acts::origin::origin;
use crate::ui::formatting::compass;
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::model::map_state::MapItem;
use crate::ui::shared::Shared;
use nalgebra::Vector3;

/// The greatest distance from the cursor at which an item is selected, columns of the map.
const REACH_COLUMNS: f64 = 2.5;

/// Returns home on the map: the plan's, else the craft's, else the boot place.
pub(in crate::ui) fn home(state: &Shared) -> Option<MapPoint> {
    let frame = origin(state)?;
    let planned = state.editor.document().home.map(|home| home.position);
    Some(
        planned.or(state.view.vehicle.craft.home).map_or_else(MapPoint::default, |home| to_map(&frame, home)),
    )
}

/// Returns the radius of the fence that the plan or the craft sets, m.
pub(in crate::ui) fn fence_m(state: &Shared) -> Option<f64> {
    settings_in_force::assumptions(state, state.editor.document()).fence_m
}

/// Converts a place to latitude and longitude.
pub(in crate::ui) fn position(frame: &LocalFrame, place: MapPoint) -> LatLon {
    let (lat, lon, _) = frame.to_geodetic(Vector3::new(place.e, place.n, 0.0));
    LatLon::from_degrees(lat, lon)
}

/// Returns the item at a place on the map at this scale: the nearest waypoint, else home, else the fence.
pub(in crate::ui) fn item_at(state: &Shared, place: MapPoint, metres_per_column: f64) -> Option<MapItem> {
    let frame = origin(state)?;
    let reach = REACH_COLUMNS * metres_per_column;
    let waypoints = state.plan().waypoints.iter().enumerate().filter(|(_, wp)| wp.kind.uses_position());
    let nearest = waypoints
        .map(|(index, wp)| (index, to_map(&frame, wp.position).distance(place)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((index, _)) = nearest.filter(|(_, distance)| *distance <= reach) {
        return Some(MapItem::Waypoint(index));
    }
    let from_home = home(state)?.distance(place);
    if from_home <= reach {
        return Some(MapItem::Home);
    }
    fence_m(state).filter(|fence_m| (from_home - fence_m).abs() <= reach).map(|_| MapItem::Fence)
}

/// Returns distances and bearings to a place where the user is about to put something.
pub(in crate::ui) fn measured(state: &Shared, place: MapPoint, moving: Option<MapItem>) -> Option<String> {
    let frame = origin(state)?;
    let here = position(&frame, place);
    let from = |name: &str, there: LatLon| {
        let (distance_m, bearing) = distance_bearing(there, here);
        format!(
            "{} {:03.0}° from {name}",
            state.units.length_text(distance_m, 1),
            compass(bearing.to_degrees())
        )
    };
    let waypoints = &state.plan().waypoints;
    let before = match moving {
        Some(MapItem::Waypoint(index)) => index,
        Some(MapItem::Home | MapItem::Fence) => 0,
        None => (state.editor.row() + 1).min(waypoints.len()),
    };
    let last = waypoints[..before].iter().enumerate().rev().find(|(_, wp)| wp.kind.uses_position());
    let leg = last.map(|(index, wp)| from(&format!("WP{index}"), wp.position) + " · ").unwrap_or_default();
    let home = position(&frame, home(state)?);
    Some(leg + &from("home", home))
}
