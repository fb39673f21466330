//! Lines at several levels of detail, so that a wide view draws few of their vertices.

use crate::geo::{LatLon, METRES_PER_E7};

/// The finest and the coarsest tolerance, m. Each level has twice the tolerance of the one before.
const FINEST_M: f64 = 0.25;
const COARSEST_M: f64 = 16_000.0;
/// A level with more than this share of the vertices of the one before is left out.
const WORTH_KEEPING: f64 = 0.7;
/// The number of segments that are left out together where the window does not show them.
const RUN: usize = 32;
/// Half a turn, degrees × 10⁷.
const HALF_TURN: i64 = 1_800_000_000;

/// Lines at several levels of detail.
#[derive(Debug)]
pub(in crate::ui) struct Detail {
    /// The finest first.
    levels: Vec<Level>,
}

/// The lines with a tolerance: no left-out vertex is farther than that from a kept one.
#[derive(Debug)]
struct Level {
    tolerance_m: f64,
    vertices: Vec<LatLon>,
    runs: Vec<Run>,
}

/// Successive vertices of one line. The last one is also the first of the next run of the line.
#[derive(Debug)]
struct Run {
    start: usize,
    end: usize,
    low: LatLon,
    high: LatLon,
}

/// A window on the globe.
#[derive(Debug, Clone, Copy)]
pub(in crate::ui) struct Window {
    pub(in crate::ui) centre: LatLon,
    /// Half of its height and of its width, degrees × 10⁷.
    pub(in crate::ui) half_lat_e7: f64,
    pub(in crate::ui) half_lon_e7: f64,
}

impl Window {
    /// Returns `true` if the window shows this position.
    pub(in crate::ui) fn shows(&self, position: LatLon) -> bool {
        let north = f64::from(position.lat_e7) - f64::from(self.centre.lat_e7);
        north.abs() <= self.half_lat_e7 && (east_of(self.centre, position) as f64).abs() <= self.half_lon_e7
    }

    fn may_show(&self, run: &Run) -> bool {
        let centre = f64::from(self.centre.lat_e7);
        if f64::from(run.low.lat_e7) > centre + self.half_lat_e7
            || f64::from(run.high.lat_e7) < centre - self.half_lat_e7
        {
            return false;
        }
        let width = i64::from(run.high.lon_e7) - i64::from(run.low.lon_e7);
        // A run around the globe or across the antimeridian.
        if width > HALF_TURN {
            return true;
        }
        let west = east_of(self.centre, run.low);
        let (west, east) = (west as f64, (west + width) as f64);
        let turn = 2.0 * HALF_TURN as f64;
        west <= self.half_lon_e7 && east >= -self.half_lon_e7 || east >= turn - self.half_lon_e7
    }
}

/// Returns the difference in longitude, degrees × 10⁷, at most half a turn.
fn east_of(from: LatLon, to: LatLon) -> i64 {
    let apart = i64::from(to.lon_e7) - i64::from(from.lon_e7);
    (apart + HALF_TURN).rem_euclid(2 * HALF_TURN) - HALF_TURN
}

impl Detail {
    pub(super) fn new(lines: impl Iterator<Item = Vec<LatLon>>) -> Self {
        let lines: Vec<Vec<LatLon>> = lines.filter(|line| !line.is_empty()).collect();
        let mut levels = vec![Level::new(0.0, lines.iter().cloned())];
        let mut tolerance_m = FINEST_M;
        let mut finer = lines.clone();
        while tolerance_m <= COARSEST_M {
            // From all vertices, so that the errors of levels do not add up.
            let coarser: Vec<Vec<LatLon>> = lines.iter().map(|line| simplified(line, tolerance_m)).collect();
            let count = |lines: &[Vec<LatLon>]| lines.iter().map(Vec::len).sum::<usize>() as f64;
            if count(&coarser) <= WORTH_KEEPING * count(&finer) {
                levels.push(Level::new(tolerance_m, coarser.iter().cloned()));
                finer = coarser;
            }
            tolerance_m *= 2.0;
        }
        Self { levels }
    }

    /// Returns the parts of the lines that the window may show, in the detail that this tolerance allows.
    pub(in crate::ui) fn runs(&self, tolerance_m: f64, window: Window) -> impl Iterator<Item = &[LatLon]> {
        let level = self.levels.iter().rfind(|level| level.tolerance_m <= tolerance_m);
        let runs = level.into_iter().flat_map(|level| level.runs.iter().map(move |run| (level, run)));
        runs.filter(move |(_, run)| window.may_show(run))
            .map(|(level, run)| &level.vertices[run.start..run.end])
    }
}

impl Level {
    fn new(tolerance_m: f64, lines: impl Iterator<Item = Vec<LatLon>>) -> Self {
        let mut level = Self { tolerance_m, vertices: Vec::new(), runs: Vec::new() };
        for line in lines {
            let (start, end) = (level.vertices.len(), level.vertices.len() + line.len());
            level.vertices.extend(line);
            let mut from = start;
            while from < end {
                let to = (from + RUN + 1).min(end);
                level.runs.push(Run::of(&level.vertices, from, to));
                from = if to == end { end } else { to - 1 };
            }
        }
        level.vertices.shrink_to_fit();
        level
    }
}

impl Run {
    fn of(vertices: &[LatLon], start: usize, end: usize) -> Self {
        let part = &vertices[start..end];
        let (mut low, mut high) = (part[0], part[0]);
        for vertex in part {
            low = LatLon::new(low.lat_e7.min(vertex.lat_e7), low.lon_e7.min(vertex.lon_e7));
            high = LatLon::new(high.lat_e7.max(vertex.lat_e7), high.lon_e7.max(vertex.lon_e7));
        }
        Self { start, end, low, high }
    }
}

/// Returns the line without the vertices that are nearer than the tolerance to the last kept one. Both ends are kept.
fn simplified(line: &[LatLon], tolerance_m: f64) -> Vec<LatLon> {
    let [first, middle @ .., last] = line else { return line.to_vec() };
    // The longest metres of a degree on the line, so that no distance counts as shorter than it is.
    let nearest = line.iter().map(|vertex| vertex.lat_e7.unsigned_abs()).min().unwrap_or(0);
    let cosine = (f64::from(nearest) * 1e-7).to_radians().cos();
    let mut kept = vec![*first];
    let mut from = *first;
    for &vertex in middle {
        let north = (f64::from(vertex.lat_e7) - f64::from(from.lat_e7)) * METRES_PER_E7;
        let east = east_of(from, vertex) as f64 * METRES_PER_E7 * cosine;
        if north * north + east * east >= tolerance_m * tolerance_m {
            kept.push(vertex);
            from = vertex;
        }
    }
    kept.push(*last);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::distance_bearing;
    use proptest::prelude::*;

    fn wide() -> Window {
        Window { centre: LatLon::default(), half_lat_e7: 9e8, half_lon_e7: 1.8e9 }
    }

    fn line() -> impl Strategy<Value = Vec<LatLon>> {
        let step = (-3000..3000_i32, -3000..3000_i32);
        (-800_000_000..800_000_000_i32, proptest::collection::vec(step, 0..300)).prop_map(|(lat, steps)| {
            let mut at = LatLon::new(lat, 1_799_999_000);
            let mut line = vec![at];
            for (north, east) in steps {
                let lon = (i64::from(at.lon_e7) + i64::from(east) + HALF_TURN).rem_euclid(2 * HALF_TURN);
                at = LatLon::new(at.lat_e7 + north, (lon - HALF_TURN) as i32);
                line.push(at);
            }
            line
        })
    }

    proptest! {
        #[test]
        fn what_is_left_out_is_near_what_is_kept(line in line(), tolerance_m in 0.0..200.0_f64) {
            let kept = simplified(&line, tolerance_m);
            prop_assert!(kept.len() <= line.len().max(1));
            prop_assert_eq!((kept.first(), kept.last()), (line.first(), line.last()));
            for vertex in &line {
                let nearest = kept.iter().map(|kept| distance_bearing(*kept, *vertex).0).fold(f64::MAX, f64::min);
                prop_assert!(nearest <= tolerance_m * 1.01 + 0.02, "{nearest} of {tolerance_m}");
            }
        }

        #[test]
        fn a_window_gets_every_vertex_that_it_shows(
            line in line(), at in 0_usize..300, half in 1.0..20_000.0_f64,
        ) {
            let centre = line[at % line.len()];
            let window = Window { centre, half_lat_e7: half, half_lon_e7: half };
            let detail = Detail::new(std::iter::once(line.clone()));
            let got: Vec<LatLon> = detail.runs(0.0, window).flatten().copied().collect();
            for vertex in line.iter().filter(|vertex| window.shows(**vertex)) {
                prop_assert!(got.contains(vertex));
            }
            let all: Vec<LatLon> = detail.runs(0.0, wide()).flatten().copied().collect();
            prop_assert!(all.len() >= line.len());
        }
    }

    #[test]
    fn coarse_levels_have_few_vertices_and_all_of_them_together_stay_bounded() {
        let circle = (0..200_000).map(|step| {
            let angle = f64::from(step) / 200_000.0 * std::f64::consts::TAU;
            LatLon::from_degrees(47.0 + 0.01 * angle.cos(), 8.0 + 0.01 * angle.sin())
        });
        let detail = Detail::new(std::iter::once(circle.collect()));
        let count = |tolerance_m| detail.runs(tolerance_m, wide()).map(<[LatLon]>::len).sum::<usize>();
        assert!(count(0.0) >= 200_000);
        assert!(count(10.0) < 1500, "{}", count(10.0));
        assert!(count(1000.0) < 16, "{}", count(1000.0));
        let all: usize = detail.levels.iter().map(|level| level.vertices.len()).sum();
        assert!(all < 4 * 200_000, "{all}");
    }
}
