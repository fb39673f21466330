//! The parts of lines and areas inside a rectangle.

use super::Point;

/// A rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    /// The left lower corner.
    pub(super) low: Point,
    /// The right upper corner.
    pub(super) high: Point,
}

impl Frame {
    /// Returns `true` if the point is inside.
    pub(super) fn contains(&self, (x, y): Point) -> bool {
        (self.low.0..=self.high.0).contains(&x) && (self.low.1..=self.high.1).contains(&y)
    }

    /// Returns the parts of a line inside.
    pub(super) fn line(&self, points: &[Point]) -> Vec<Vec<Point>> {
        let mut parts: Vec<Vec<Point>> = Vec::new();
        for ends in points.windows(2) {
            let [from, to] = ends else { continue };
            let Some((from, to)) = self.segment(*from, *to) else { continue };
            match parts.last_mut() {
                Some(part) if part.last() == Some(&from) => part.push(to),
                _ => parts.push(vec![from, to]),
            }
        }
        parts
    }

    /// Returns the part of a segment inside (Liang and Barsky).
    fn segment(&self, from: Point, to: Point) -> Option<(Point, Point)> {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (towards, room) in [
            (-dx, from.0 - self.low.0),
            (dx, self.high.0 - from.0),
            (-dy, from.1 - self.low.1),
            (dy, self.high.1 - from.1),
        ] {
            if towards == 0.0 && room < 0.0 {
                return None;
            }
            if towards < 0.0 {
                enter = enter.max(room / towards);
            } else if towards > 0.0 {
                leave = leave.min(room / towards);
            }
        }
        // The whole ends stay as they are, so that the parts of a line meet.
        let at = |share: f64| (from.0 + share * dx, from.1 + share * dy);
        let start = if enter > 0.0 { at(enter) } else { from };
        let end = if leave < 1.0 { at(leave) } else { to };
        (enter <= leave).then_some((start, end))
    }

    /// Returns the part of an area inside (Sutherland and Hodgman); empty if there is none.
    pub(super) fn ring(&self, ring: &[Point]) -> Vec<Point> {
        let mut points = ring.to_vec();
        for (axis, limit, sign) in
            [(0, self.low.0, 1.0), (0, self.high.0, -1.0), (1, self.low.1, 1.0), (1, self.high.1, -1.0)]
        {
            let value = |point: Point| if axis == 0 { point.0 } else { point.1 };
            let inside = |point: Point| sign * (value(point) - limit) >= 0.0;
            let mut cut = Vec::with_capacity(points.len() + 4);
            for (index, &point) in points.iter().enumerate() {
                let before = points[(index + points.len() - 1) % points.len()];
                if inside(point) != inside(before) {
                    let share = (limit - value(before)) / (value(point) - value(before));
                    cut.push((
                        before.0 + share * (point.0 - before.0),
                        before.1 + share * (point.1 - before.1),
                    ));
                }
                if inside(point) {
                    cut.push(point);
                }
            }
            points = cut;
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Frame = Frame { low: (0.0, 0.0), high: (10.0, 10.0) };

    #[test]
    fn a_line_is_cut_where_it_leaves_and_comes_back() {
        let line = [(-5.0, 5.0), (5.0, 5.0), (5.0, 20.0), (8.0, 20.0), (8.0, 2.0)];
        assert_eq!(
            UNIT.line(&line),
            [vec![(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)], vec![(8.0, 10.0), (8.0, 2.0)]]
        );
        assert_eq!(UNIT.line(&[(-5.0, -5.0), (-1.0, 20.0)]), [[]; 0]);
        assert_eq!(UNIT.line(&[(1.0, 1.0), (2.0, 2.0)]), [[(1.0, 1.0), (2.0, 2.0)]]);
    }

    #[test]
    fn an_area_around_everything_fills_the_rectangle() {
        let around = [(-9e6, -9e6), (9e6, -9e6), (9e6, 9e6), (-9e6, 9e6)];
        let inside = UNIT.ring(&around);
        assert_eq!(inside.len(), 4);
        assert!(inside.iter().all(|point| UNIT.contains(*point)), "{inside:?}");
        assert_eq!(UNIT.ring(&[(20.0, 20.0), (30.0, 20.0), (30.0, 30.0)]), []);
        assert_eq!(UNIT.ring(&[]), []);
    }
}
