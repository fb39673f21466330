//! Metres on the ground as pixels of a map.

use crate::report::plot::Point;
use crate::report::plot::clip::Frame;

/// Width of a map, px.
const WIDTH: f64 = 560.0;
/// The least and the greatest height of a map, px.
const HEIGHTS: (f64, f64) = (220.0, 560.0);
/// The margin around the places, px. The names of waypoints use it, too.
const MARGIN: f64 = 40.0;
/// The least extent of the ground on the map, m.
const MIN_M: f64 = 20.0;
/// The greatest distance of a place from home, m. Others are not drawn.
const FARTHEST_M: f64 = 1e6;

/// The mapping from the ground to a map.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    /// The middle of the map, m.
    middle: Point,
    px_per_m: f64,
    height: f64,
    top: f64,
}

impl View {
    /// Returns a map that contains all the places.
    pub(super) fn around(places: impl Iterator<Item = Point>) -> Self {
        let is_near = |(east, north): &Point| east.abs() <= FARTHEST_M && north.abs() <= FARTHEST_M;
        let (mut low, mut high) = ((0.0_f64, 0.0_f64), (0.0_f64, 0.0_f64));
        for (east, north) in places.filter(is_near) {
            low = (low.0.min(east), low.1.min(north));
            high = (high.0.max(east), high.1.max(north));
        }
        let (across, up) = ((high.0 - low.0).max(MIN_M), (high.1 - low.1).max(MIN_M));
        let (least, most) = HEIGHTS;
        let px_per_m = ((WIDTH - 2.0 * MARGIN) / across).min((most - 2.0 * MARGIN) / up);
        Self {
            middle: (f64::midpoint(low.0, high.0), f64::midpoint(low.1, high.1)),
            px_per_m,
            height: (up * px_per_m + 2.0 * MARGIN).clamp(least, most),
            top: 0.0,
        }
    }

    /// Returns the same map below `top` px of texts.
    pub(super) fn below(self, top: f64) -> Self {
        Self { top, ..self }
    }

    pub(super) fn width(&self) -> f64 {
        WIDTH
    }

    pub(super) fn height(&self) -> f64 {
        self.height
    }

    /// Returns the lower edge of the map, px down.
    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub(super) fn px_per_m(&self) -> f64 {
        self.px_per_m
    }

    /// Converts a place to px to the right and down.
    pub(super) fn px(&self, (east, north): Point) -> Point {
        let (right, up) = (east - self.middle.0, north - self.middle.1);
        (WIDTH / 2.0 + right * self.px_per_m, self.top + self.height / 2.0 - up * self.px_per_m)
    }

    /// Returns the rectangle of the map, px.
    pub(super) fn frame(&self) -> Frame {
        Frame { low: (0.5, self.top + 0.5), high: (WIDTH - 0.5, self.bottom() - 0.5) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn north_is_up_and_east_to_the_right() {
        let view = View::around([(50.0, 100.0)].into_iter()).below(30.0);
        let (home, far) = (view.px((0.0, 0.0)), view.px((50.0, 100.0)));
        assert!(far.0 > home.0 && far.1 < home.1);
        assert!((far.0 - home.0 - 50.0 * view.px_per_m()).abs() < 1e-9);
        assert!(view.frame().contains(home) && view.frame().contains(far), "{home:?} {far:?}");
    }

    #[test]
    fn a_map_of_one_place_or_of_a_lost_craft_has_a_size() {
        for places in [&[(0.0, 0.0)][..], &[(f64::NAN, 3.0)], &[(1e300, 0.0)], &[(9e5, -9e5)], &[]] {
            let view = View::around(places.iter().copied());
            assert!((220.0..=560.0).contains(&view.height()) && view.px_per_m() > 0.0, "{places:?}");
        }
    }
}
