//! The measures of a hold.

use std::f64::consts::TAU;

use super::measure::Measure;
use super::passage::Passage;
use crate::math::atan2;
use crate::report::route::TrackSample;

/// Returns the measures of a hold from the samples of the stay at its waypoint.
pub(super) fn in_hold(passage: &Passage, stay: &[TrackSample]) -> Vec<(Measure, f64)> {
    let point = &passage.point;
    let Some(centre) = point.ne.filter(|_| point.holds) else { return Vec::new() };
    if point.pattern_m == 0.0 {
        let greatest = stay.iter().map(|sample| (sample.ne - centre).norm()).reduce(f64::max);
        return greatest
            .map(|distance_m| (Measure::HoldDistance(point.wp), distance_m))
            .into_iter()
            .collect();
    }
    if !point.is_ring {
        return Vec::new();
    }
    // From north to east is clockwise.
    let step = |pair: &[TrackSample]| match pair {
        [from, to] => {
            let (from, to) = (from.ne - centre, to.ne - centre);
            atan2(from.perp(&to), from.dot(&to))
        }
        _ => 0.0,
    };
    // Only the last lap: the craft first flies to the waypoint, and from there to the ring.
    let (mut turned, mut begin) = (0.0_f64, stay.len().saturating_sub(1));
    while begin > 0 && turned.abs() < TAU {
        begin -= 1;
        turned += stay.get(begin..begin + 2).map_or(0.0, step);
    }
    let lap = stay.get(begin..).unwrap_or_default();
    let (Some(first), Some(last)) = (lap.first(), lap.last()) else { return Vec::new() };
    let seconds = last.time_s - first.time_s;
    if turned.abs() < TAU {
        return Vec::new();
    }
    let distances = lap.iter().map(|sample| (sample.ne - centre).norm());
    let squares = distances.clone().map(|distance_m| (distance_m - point.pattern_m).powi(2));
    let count = lap.len() as f64;
    vec![
        (Measure::RingError(point.wp), (squares.sum::<f64>() / count).sqrt()),
        (Measure::RingRadius(point.wp), distances.sum::<f64>() / count),
        (Measure::RingRate(point.wp), turned.to_degrees() / seconds),
    ]
}
