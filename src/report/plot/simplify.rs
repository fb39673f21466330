//! Lines with fewer points that look the same.

use super::Point;

/// The deviation that nobody sees, px.
const UNSEEN: f64 = 0.3;

/// Returns a line of at most `most` points, none of them farther than necessary from the given line. The first and the
/// last point stay.
pub(super) fn simplified(points: &[Point], most: usize) -> Vec<Point> {
    let most = most.max(2);
    let mut tolerance = UNSEEN;
    let mut kept = reduced(points, tolerance);
    // Each doubling removes points, until only the ends are left.
    while kept.len() > most {
        tolerance *= 2.0;
        kept = reduced(&kept, tolerance);
    }
    kept
}

/// Leaves out points that are nearer than `tolerance` to the line through the others (Ramer, Douglas and Peucker).
fn reduced(points: &[Point], tolerance: f64) -> Vec<Point> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[last] = true;
    let mut parts = vec![(0, last)];
    while let Some((from, to)) = parts.pop() {
        let between = points.get(from + 1..to).unwrap_or_default();
        let distances = between.iter().map(|point| distance(*point, points[from], points[to]));
        let farthest = distances.enumerate().max_by(|(_, one), (_, other)| one.total_cmp(other));
        if let Some((index, distance)) = farthest
            && distance > tolerance
        {
            let middle = from + 1 + index;
            keep[middle] = true;
            parts.extend([(from, middle), (middle, to)]);
        }
    }
    points.iter().zip(keep).filter(|(_, keep)| *keep).map(|(point, _)| *point).collect()
}

/// Returns the distance of a point from a segment.
fn distance((x, y): Point, from: Point, to: Point) -> f64 {
    let (along_x, along_y) = (to.0 - from.0, to.1 - from.1);
    let length = along_x * along_x + along_y * along_y;
    let share = if length > 0.0 {
        (((x - from.0) * along_x + (y - from.1) * along_y) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (x - from.0 - share * along_x).hypot(y - from.1 - share * along_y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(points: usize) -> Vec<Point> {
        let angle = |index: usize| index as f64 / points as f64 * std::f64::consts::TAU;
        (0..=points).map(|index| (100.0 * angle(index).cos(), 100.0 * angle(index).sin())).collect()
    }

    #[test]
    fn a_straight_line_has_two_points() {
        let line: Vec<Point> = (0..1000).map(|x| (f64::from(x), 2.0 * f64::from(x))).collect();
        assert_eq!(simplified(&line, 500), [(0.0, 0.0), (999.0, 1998.0)]);
        assert_eq!(simplified(&[], 10), []);
        assert_eq!(simplified(&[(1.0, 2.0)], 10), [(1.0, 2.0)]);
    }

    #[test]
    fn a_curve_keeps_its_form_and_its_ends() {
        let all = circle(20_000);
        let kept = simplified(&all, 2000);
        assert!((20..200).contains(&kept.len()), "{}", kept.len());
        assert_eq!((kept.first(), kept.last()), (all.first(), all.last()));
        for point in all {
            let nearest = kept.windows(2).map(|ends| distance(point, ends[0], ends[1]));
            assert!(nearest.fold(f64::INFINITY, f64::min) <= UNSEEN, "{point:?}");
        }
    }

    #[test]
    fn the_number_of_points_is_bounded() {
        let jagged: Vec<Point> = (0..1000).map(|x| (f64::from(x), f64::from(x % 2) * 50.0)).collect();
        for most in [0, 2, 10, 300] {
            assert!(simplified(&jagged, most).len() <= most.max(2), "{most}");
        }
    }
}
