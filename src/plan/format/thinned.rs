//! Lines with fewer points (Douglas–Peucker).

use std::collections::BinaryHeap;
use std::ops::Range;

use nalgebra::Vector3;

use crate::geo::local_offset;
use crate::plan::feature::Vertex;

/// A thinned line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Thinned {
    /// The indices of the points that are kept, in order.
    pub(super) kept: Vec<usize>,
    /// The largest distance of a point that is left out from the line without it, m.
    pub(super) distance_m: f64,
}

/// A part of the line between two kept points, and its point that is farthest from the straight line.
#[derive(Debug, Clone, PartialEq)]
struct Part {
    distance_m: f64,
    farthest: usize,
    ends: Range<usize>,
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.distance_m.total_cmp(&other.distance_m).then(other.farthest.cmp(&self.farthest))
    }
}

/// Keeps the points of a line that are farther than `tolerance_m` from the line without them. Stops at `most` points:
/// the tolerance may not be reached then. The part with the largest distance is divided first, so that each point
/// takes one pass over a part of the line.
pub(super) fn thinned(line: &[Vertex], tolerance_m: f64, most: usize) -> Thinned {
    let Some(origin) = line.first().map(|vertex| vertex.position) else {
        return Thinned { kept: Vec::new(), distance_m: 0.0 };
    };
    let has_altitudes = line.iter().all(|vertex| vertex.altitude_m.is_finite());
    let place = |vertex: &Vertex| {
        let ne = local_offset(origin, vertex.position);
        Vector3::new(ne.x, ne.y, if has_altitudes { f64::from(vertex.altitude_m) } else { 0.0 })
    };
    let points: Vec<Vector3<f64>> = line.iter().map(place).collect();
    let last = points.len() - 1;
    let mut kept = vec![0];
    if last > 0 {
        kept.push(last);
    }
    let mut parts: BinaryHeap<Part> = part(&points, 0..last).into_iter().collect();
    while kept.len() < most && parts.peek().is_some_and(|widest| widest.distance_m > tolerance_m) {
        let Some(Part { farthest, ends, .. }) = parts.pop() else { break };
        kept.push(farthest);
        parts.extend(part(&points, ends.start..farthest));
        parts.extend(part(&points, farthest..ends.end));
    }
    kept.sort_unstable();
    Thinned { kept, distance_m: parts.peek().map_or(0.0, |widest| widest.distance_m) }
}

fn part(points: &[Vector3<f64>], ends: Range<usize>) -> Option<Part> {
    let (start, end) = (points[ends.start], points[ends.end]);
    let along = end - start;
    let length_squared = along.norm_squared();
    let distance = |point: &Vector3<f64>| {
        let share = if length_squared > 0.0 { (point - start).dot(&along) / length_squared } else { 0.0 };
        (point - start - along * share.clamp(0.0, 1.0)).norm()
    };
    let inner = ends.start + 1..ends.end;
    let distances = inner.map(|index| (distance(&points[index]), index));
    let farthest = distances.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    farthest.map(|(distance_m, farthest)| Part { distance_m, farthest, ends })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::{LatLon, offset_to_latlon};
    use nalgebra::Vector2;

    fn line(points: &[(f64, f64, f32)]) -> Vec<Vertex> {
        let home = LatLon::new(404_635_000, -795_182_000);
        let vertex = |&(north, east, altitude_m)| Vertex {
            position: offset_to_latlon(home, Vector2::new(north, east)),
            altitude_m,
        };
        points.iter().map(vertex).collect()
    }

    #[test]
    fn near_points_are_left_out() {
        let nan = f32::NAN;
        let zigzag = line(&[
            (0.0, 0.0, nan),
            (50.0, 1.0, nan),
            (100.0, 0.0, nan),
            (100.0, 60.0, nan),
            (100.5, 90.0, nan),
        ]);
        let kept = |tolerance_m| thinned(&zigzag, tolerance_m, 30).kept;
        assert_eq!(kept(2.0), [0, 2, 4]);
        assert_eq!(kept(0.5), [0, 1, 2, 4]);
        assert_eq!(kept(0.0), [0, 1, 2, 3, 4]);
        assert_eq!(kept(1000.0), [0, 4]);
        let some = thinned(&zigzag, 0.0, 3);
        assert_eq!(some.kept, [0, 2, 4]);
        assert!((some.distance_m - 1.0).abs() < 0.02, "{some:?}");
    }

    #[test]
    fn altitudes_and_closed_lines_count() {
        let climb = line(&[(0.0, 0.0, 10.0), (50.0, 0.0, 40.0), (100.0, 0.0, 10.0)]);
        assert_eq!(thinned(&climb, 5.0, 30).kept, [0, 1, 2]);
        let square =
            line(&[(0.0, 0.0, 1.0), (9.0, 0.0, 1.0), (9.0, 9.0, 1.0), (0.0, 9.0, 1.0), (0.0, 0.0, 1.0)]);
        assert_eq!(thinned(&square, 1.0, 30).kept, [0, 1, 2, 3, 4]);
        assert_eq!(thinned(&square[..1], 1.0, 30).kept, [0]);
        assert_eq!(thinned(&[], 1.0, 30).kept, [0; 0]);
    }
}
