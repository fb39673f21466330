//! The times at which a track passed each waypoint of a route, found from the track alone.
//!
//! Waypoints after one that was not reached do not count. The passages are the instants, in the order of the route,
//! with the least sum of the squared distances. This also works for a waypoint that the plan flies over twice, and
//! for a route that crosses itself.

use super::track::Track;
use crate::report::route::{Route, RoutePoint, TrackSample};

/// The distance from the closest approach within which the craft counts as at the waypoint, m.
const NEAR_M: f64 = 1.0;

/// A passed waypoint; indices are of the samples of the track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Passage {
    /// The index in the route.
    pub(super) index: usize,
    pub(super) point: RoutePoint,
    /// The first sample within a metre of the closest approach.
    pub(super) reached: usize,
    /// The sample at which the next leg begins: the closest approach, or the last sample at a place with a hold.
    pub(super) left: usize,
}

/// Returns the waypoints that the track passed, in their order.
pub(super) fn passages(route: &Route, track: &Track) -> Vec<Passage> {
    let samples = &track.samples;
    let points = reached(&route.points, samples);
    let closest = closest_in_order(points, samples);
    let mut passed = Vec::new();
    let mut from = 0;
    for (index, (point, &at)) in points.iter().zip(&closest).enumerate() {
        let Some(best_m) = samples.get(at).map(|sample| point.distance_m(sample)) else { continue };
        let is_near = |sample: &TrackSample| point.distance_m(sample) <= best_m + NEAR_M;
        let between = |from: usize, to: usize| samples.get(from..=to).unwrap_or_default();
        let reached = from + between(from, at).iter().position(is_near).unwrap_or(at - from);
        let next = closest.get(index + 1).copied().unwrap_or(samples.len().saturating_sub(1));
        let left = match between(at, next).iter().rposition(is_near) {
            Some(last) if point.holds => at + last,
            _ => at,
        };
        passed.push(Passage { index, point: *point, reached, left });
        from = left;
    }
    passed
}

/// Returns the waypoints before the first that was not reached in order.
fn reached<'r>(points: &'r [RoutePoint], samples: &[TrackSample]) -> &'r [RoutePoint] {
    let mut ahead = samples.iter().peekable();
    let mut came_to = |point: &RoutePoint| {
        while let Some(sample) = ahead.peek() {
            if point.distance_m(sample) <= point.reach_m {
                return true;
            }
            ahead.next();
        }
        false
    };
    let count = points.iter().position(|point| !came_to(point)).unwrap_or(points.len());
    points.get(..count).unwrap_or_default()
}

/// Returns for each point the sample at which the track passes it.
fn closest_in_order(points: &[RoutePoint], samples: &[TrackSample]) -> Vec<usize> {
    // `cost[i]` is the least sum for the points so far, with the last of them passed at or before sample `i`.
    // `choices` has the sample of that passage for each point.
    let mut cost = vec![0.0; samples.len()];
    let mut choices: Vec<Vec<usize>> = Vec::with_capacity(points.len());
    for point in points {
        let mut best = (f64::INFINITY, 0);
        let mut choice = Vec::with_capacity(samples.len());
        for (index, (cost, sample)) in cost.iter_mut().zip(samples).enumerate() {
            let distance_m = point.distance_m(sample);
            let sum = *cost + if distance_m <= point.reach_m { distance_m.powi(2) } else { f64::INFINITY };
            if sum < best.0 {
                best = (sum, index);
            }
            *cost = best.0;
            choice.push(best.1);
        }
        choices.push(choice);
    }
    let mut last = samples.len().saturating_sub(1);
    let mut closest: Vec<usize> = Vec::with_capacity(points.len());
    for choice in choices.iter().rev() {
        last = choice.get(last).copied().unwrap_or(0);
        closest.push(last);
    }
    closest.reverse();
    closest
}
