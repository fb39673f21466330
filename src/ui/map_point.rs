//! Places on the map: metres north and east of the boot place.

use nalgebra::Vector3;

use crate::geo::{LatLon, LocalFrame};
use crate::session::SessionView;

use super::app_state::AppState;

/// A place on the ground, metres north and east of the boot place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct MapPoint {
    /// North, m.
    pub n: f64,
    /// East, m.
    pub e: f64,
}

impl MapPoint {
    pub(super) const fn new(n: f64, e: f64) -> Self {
        Self { n, e }
    }

    /// Returns the distance to another place, m.
    pub(super) fn distance(self, other: Self) -> f64 {
        (self.n - other.n).hypot(self.e - other.e)
    }

    /// Returns the place at the fraction `t` of the way to `other`.
    pub(super) fn towards(self, other: Self, t: f64) -> Self {
        Self::new(self.n + (other.n - self.n) * t, self.e + (other.e - self.e) * t)
    }
}

/// Returns the position from which the map counts metres; home or the first waypoint while it is unknown.
pub(super) fn origin(state: &AppState) -> Option<LocalFrame> {
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

/// Converts a position to metres from the origin of the map.
pub(super) fn to_map(origin: &LocalFrame, position: LatLon) -> MapPoint {
    let enu = origin.to_enu(position.lat_deg(), position.lon_deg(), 0.0);
    MapPoint::new(enu.y, enu.x)
}

/// Returns the position of the craft: the true one if the simulator reports it, else the estimate.
pub(super) fn craft(view: &SessionView) -> Option<MapPoint> {
    let vehicle = &view.vehicle;
    match (&vehicle.truth, vehicle.estimate.n, vehicle.estimate.e) {
        (Some(truth), ..) => Some(MapPoint::new(truth.n, truth.e)),
        (None, Some(n), Some(e)) => Some(MapPoint::new(n, e)),
        _ => None,
    }
    .filter(|place| place.n.is_finite() && place.e.is_finite())
}
