//! The ground under the open plan, under its flown estimate and under the track, over the length of the plan.

use super::Point;
use super::flown::FlownPoint;
use crate::ui::acts::ground_under;
use crate::ui::acts::origin::origin;
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::shared::Shared;

/// The number of looks at the ground under the plan. No screen has more columns for them.
const LOOKS: u32 = 240;

/// A point of the ground: metres along the plan, metres above home.
pub(super) struct GroundPoint {
    pub(super) along_m: f64,
    pub(super) alt_m: f64,
}

/// Returns the ground; empty without elevation tiles at home.
pub(super) fn ground_line(state: &Shared, points: &[Point], flown: &[FlownPoint]) -> Vec<GroundPoint> {
    let Some((relief, frame)) = ground_under::relief(state).zip(origin(state)) else { return Vec::new() };
    let Some(length_m) = points.last().map(|last| last.along_m) else { return Vec::new() };
    let waypoints = &state.plan().waypoints;
    let place_of = |point: &Point| {
        let waypoint = waypoints.get(point.index).filter(|waypoint| waypoint.kind.uses_position())?;
        Some(to_map(&frame, waypoint.position))
    };
    let mut from = (0.0, to_map(&frame, relief.home()));
    let mut places: Vec<(f64, MapPoint)> = Vec::new();
    for point in points {
        let to = (point.along_m, place_of(point).unwrap_or(from.1));
        let looks =
            (f64::from(LOOKS) * (to.0 - from.0) / length_m.max(1.0)).ceil().clamp(1.0, f64::from(LOOKS));
        places.extend((0..=looks as u32).map(|look| {
            let share = f64::from(look) / looks;
            (from.0 + (to.0 - from.0) * share, from.1.towards(to.1, share))
        }));
        from = to;
    }
    if let Some(estimate) = state.forecast.estimate() {
        let path = estimate.path.iter().filter(|point| point.along_m >= 0.0);
        places.extend(path.map(|point| (point.along_m, MapPoint::new(point.n, point.e))));
    }
    places.extend(flown.iter().map(|point| (point.along_m, point.place)));
    places
        .into_iter()
        .filter_map(|(along_m, place)| {
            let alt_m = ground_under::above_home_m(&relief, &frame, place)?;
            Some(GroundPoint { along_m, alt_m })
        })
        .collect()
}
