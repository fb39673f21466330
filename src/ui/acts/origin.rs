//! The position from which the map counts metres.

use nalgebra::Vector3;

use crate::geo::LocalFrame;
use crate::ui::shared::Shared;

/// Returns the position from which the map counts metres; home or the first waypoint while it is unknown.
pub(in crate::ui) fn origin(state: &Shared) -> Option<LocalFrame> {
    let vehicle = &state.view.vehicle;
    if let Some(truth) = &vehicle.truth {
        let here = LocalFrame::new(truth.lat_deg, truth.lon_deg, 0.0);
        let (lat, lon, _) = here.to_geodetic(Vector3::new(-truth.e, -truth.n, 0.0));
        return Some(LocalFrame::new(lat, lon, 0.0));
    }
    let first =
        || state.shown_plan().waypoints.iter().find(|wp| wp.kind.uses_position()).map(|wp| wp.position);
    let place = vehicle.origin.or(vehicle.craft.home).or_else(first)?;
    Some(LocalFrame::new(place.lat_deg(), place.lon_deg(), 0.0))
}
