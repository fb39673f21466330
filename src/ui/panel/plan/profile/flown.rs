//! The flown altitudes, over the length of the open plan.

use super::Point;
use crate::plan::Waypoint;
use crate::ui::acts::origin::origin;
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::shared::Shared;

/// Track points closer than this to each other share a mark of the profile: a share of its length, and m.
const NEAR_SHARE: f64 = 1.0 / 2000.0;
const NEAR_ALT_M: f64 = 0.05;

/// A point of the flown track: metres along the plan, metres above home.
pub(super) struct FlownPoint {
    pub(super) along_m: f64,
    pub(super) alt_m: f64,
    pub(super) place: MapPoint,
}

/// Returns the flown part of the open plan up to the shown instant; empty if the craft's plan has other places.
pub(super) fn flown(state: &Shared, points: &[Point]) -> Vec<FlownPoint> {
    let waypoints = &state.plan().waypoints;
    let vehicle = &state.view.vehicle;
    let Some(frame) = origin(state) else { return Vec::new() };
    let Some(flown) = vehicle.active_plan.as_ref().or(vehicle.stored_plan.as_ref()) else {
        return Vec::new();
    };
    if !are_at_the_same_places(waypoints, &flown.waypoints) {
        return Vec::new();
    }
    // Once for each waypoint, not for each of thousands of points: the end of its leg, along the plan and on the map.
    let ends: Vec<(Option<f64>, Option<MapPoint>)> = waypoints
        .iter()
        .enumerate()
        .map(|(index, wp)| {
            let end = points.iter().rfind(|point| point.index <= index);
            let place = wp.kind.uses_position().then(|| to_map(&frame, wp.position));
            (end.map(|end| end.along_m), place)
        })
        .collect();
    let near_m = points.last().map_or(0.0, |last| last.along_m * NEAR_SHARE);
    let mut along_m = 0.0_f64;
    let mut seen: Vec<FlownPoint> = Vec::new();
    let track = state.track.points().iter().take(state.track_points_shown());
    for (place, wp) in track.filter_map(|place| Some((place, usize::from(place.wp?)))) {
        // The end of the leg, less the remaining distance. The result never shrinks, as it would in a hold.
        if let Some(&(Some(end_m), target)) = ends.get(wp) {
            let left_m = target.map_or(0.0, |to| {
                let (north_m, east_m) = (to.n - place.n, to.e - place.e);
                (north_m * north_m + east_m * east_m).sqrt()
            });
            along_m = along_m.max(end_m - left_m);
        }
        let is_near = |last: &FlownPoint| {
            along_m - last.along_m <= near_m && (place.alt_m - last.alt_m).abs() <= NEAR_ALT_M
        };
        if !seen.last().is_some_and(is_near) {
            seen.push(FlownPoint { along_m, alt_m: place.alt_m, place: MapPoint::new(place.n, place.e) });
        }
    }
    seen
}

/// Returns `true` if two plans have the same types and places; their altitudes may differ.
fn are_at_the_same_places(a: &[Waypoint], b: &[Waypoint]) -> bool {
    let place = |wp: &Waypoint| (wp.kind, wp.kind.uses_position().then_some(wp.position));
    a.len() == b.len() && std::iter::zip(a, b).all(|(a, b)| place(a) == place(b))
}
