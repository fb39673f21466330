//! The altitudes that were flown, over the length of the open plan.

use super::Point;
use crate::plan::Waypoint;
use crate::ui::app_state::AppState;
use crate::ui::map_point::{self, MapPoint, to_map};

/// A place of the flown track: metres along the plan, metres above home.
pub(super) struct FlownPoint {
    pub(super) along_m: f64,
    pub(super) alt_m: f64,
}

/// What was flown of the open plan, up to the instant that is shown; nothing when the craft flew other places.
pub(super) fn flown(state: &AppState, points: &[Point]) -> Vec<FlownPoint> {
    let waypoints = &state.plan().waypoints;
    let vehicle = &state.view.vehicle;
    let Some(frame) = map_point::origin(state) else { return Vec::new() };
    let Some(flown) = vehicle.active_plan.as_ref().or(vehicle.stored_plan.as_ref()) else {
        return Vec::new();
    };
    if !are_at_the_same_places(waypoints, &flown.waypoints) {
        return Vec::new();
    }
    // Not once for each of thousands of points.
    let targets: Vec<Option<MapPoint>> =
        waypoints.iter().map(|wp| wp.kind.uses_position().then(|| to_map(&frame, wp.position))).collect();
    let mut along_m = 0.0_f64;
    let track = state.track.points().iter().take(state.track_points_shown());
    let on_leg = track.filter_map(|place| Some((place, usize::from(place.wp?))));
    on_leg
        .map(|(place, wp)| {
            // Where the leg ends, less what is left of it; the distance never shrinks, as in a hold.
            if let Some(end) = points.iter().rfind(|point| point.index <= wp) {
                let target = targets.get(wp).copied().flatten();
                let left_m = target.map_or(0.0, |to| to.distance(MapPoint::new(place.n, place.e)));
                along_m = along_m.max(end.along_m - left_m);
            }
            FlownPoint { along_m, alt_m: place.alt_m }
        })
        .collect()
}

/// Whether two plans lead through the same places; their altitudes may differ.
fn are_at_the_same_places(a: &[Waypoint], b: &[Waypoint]) -> bool {
    let place = |wp: &Waypoint| (wp.kind, wp.kind.uses_position().then_some(wp.position));
    a.len() == b.len() && std::iter::zip(a, b).all(|(a, b)| place(a) == place(b))
}
