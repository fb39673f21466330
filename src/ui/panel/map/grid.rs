//! The coordinate grid: parallels and meridians at round degrees, with their degrees at the edges.

use ratatui::layout::Rect;

use crate::geo::{LatLon, LocalFrame};
use crate::ui::acts::map_edit;
use crate::ui::acts::viewport::Viewport;
use crate::ui::axis::round_step;
use crate::ui::model::map_point::{MapPoint, to_map};
use crate::ui::raster::Raster;
use crate::ui::theme::Role;

use super::labels::Labels;

/// The least distance between two lines, columns of the map.
const MIN_COLUMNS: f64 = 16.0;
/// The distance between two dots of a line, dots.
const DOT_GAP: f64 = 4.0;
/// The most dots of a line, more than any screen shows.
const MAX_DOTS: f64 = 2000.0;
/// The narrowest step, degrees: the resolution of positions.
const MIN_DEG: f64 = 1e-7;
/// The widest step, degrees. Near a pole nothing is wider.
const WIDEST_DEG: f64 = 10.0;

/// A line of the grid: degrees and the place where it crosses the middle of the window.
struct GridLine {
    degrees: f64,
    place: MapPoint,
}

/// The lines in a window.
struct Grid {
    parallels: Vec<GridLine>,
    meridians: Vec<GridLine>,
    /// The decimals with which neighbours read differently.
    decimals: usize,
}

impl Grid {
    fn of(frame: &LocalFrame, view: &Viewport) -> Self {
        let degree = to_map(frame, LatLon::from_degrees(frame.lat_deg + 0.5, frame.lon_deg + 0.5));
        let least_m = MIN_COLUMNS * view.scale;
        // One step for both directions, so that they can be compared.
        let least_deg = least_m / (2.0 * degree.e.abs().min(degree.n.abs()).max(1e-3));
        let step_deg = round_step(least_deg.max(MIN_DEG)).min(WIDEST_DEG);
        let (north_m, east_m) = view.reach();
        let corner = |side: f64| {
            let place = MapPoint::new(view.centre.n + side * north_m, view.centre.e + side * east_m);
            map_edit::position(frame, place)
        };
        let (low, high) = (corner(-1.0), corner(1.0));
        let centre = map_edit::position(frame, view.centre);
        let steps = |low: f64, high: f64| {
            let first = (low / step_deg).ceil();
            let count = ((high / step_deg).floor() - first).clamp(-1.0, 200.0) as i32 + 1;
            (0..count).map(move |line| (first + f64::from(line)) * step_deg).collect::<Vec<_>>()
        };
        // The eastern edge may be on the other side of the antimeridian.
        let east = if high.lon_deg() < low.lon_deg() { high.lon_deg() + 360.0 } else { high.lon_deg() };
        let parallels = steps(low.lat_deg(), high.lat_deg()).into_iter().map(|degrees| {
            let place = to_map(frame, LatLon::from_degrees(degrees, centre.lon_deg()));
            GridLine { degrees, place }
        });
        let meridians = steps(low.lon_deg(), east).into_iter().map(|degrees| {
            let degrees = if degrees > 180.0 { degrees - 360.0 } else { degrees };
            GridLine { degrees, place: to_map(frame, LatLon::from_degrees(centre.lat_deg(), degrees)) }
        });
        let decimals = (-step_deg.log10()).ceil().clamp(0.0, 7.0) as usize;
        Self { parallels: parallels.collect(), meridians: meridians.collect(), decimals }
    }
}

/// The places of the dots of a line, from the west or the south on.
fn dots<'a>(
    line: &'a GridLine,
    is_parallel: bool,
    view: &'a Viewport,
) -> impl Iterator<Item = MapPoint> + 'a {
    let (north_m, east_m) = view.reach();
    let reach_m = if is_parallel { east_m } else { north_m };
    // Dots are half a column apart, and rows of dots, too.
    let gap_m = DOT_GAP * view.scale / 2.0;
    let count = (2.0 * reach_m / gap_m).clamp(0.0, MAX_DOTS) as u32;
    (0..=count).map(move |dot| {
        let along_m = f64::from(dot) * gap_m - reach_m;
        if is_parallel {
            MapPoint::new(line.place.n, view.centre.e + along_m)
        } else {
            MapPoint::new(view.centre.n + along_m, line.place.e)
        }
    })
}

/// Sets the dots of the lines.
pub(super) fn paint(frame: &LocalFrame, view: &Viewport, raster: &mut Raster) {
    let grid = Grid::of(frame, view);
    for (lines, is_parallel) in [(&grid.parallels, true), (&grid.meridians, false)] {
        for place in lines.iter().flat_map(|line| dots(line, is_parallel, view)) {
            raster.dot(view.dot(place));
        }
    }
}

/// Writes the degrees where a line enters the window: those of parallels from the west, those of meridians from the
/// south, above the bottom line.
pub(super) fn write(frame: &LocalFrame, labels: &mut Labels<'_>) {
    let view = *labels.view();
    let grid = Grid::of(frame, &view);
    let free = Rect { height: view.area.height.saturating_sub(1), ..view.area };
    let is_free = |place: &MapPoint| view.screen_cell(*place).is_some_and(|cell| free.contains(cell.into()));
    for (lines, is_parallel) in [(&grid.parallels, true), (&grid.meridians, false)] {
        for line in lines {
            let text = format!("{:.*}°", grid.decimals, line.degrees);
            if let Some(place) = dots(line, is_parallel, &view).find(is_free) {
                labels.on_free_ground(place, &text, &[(0, 0), (1, 0)], Role::Dim);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lines_are_in_the_window_wherever_it_is() {
        for (lat, lon) in [(40.46, -79.52), (-33.9, 151.2), (0.0, 180.0), (89.9, 10.0), (-89.9999, -170.0)] {
            let frame = LocalFrame::new(lat, lon, 0.0);
            for scale in [0.05, 2.0, 300.0, 20_000.0] {
                let area = Rect::new(0, 0, 120, 40);
                let view = Viewport { area, centre: MapPoint::new(3.0, -2.0), scale, up_rad: 0.0 };
                let grid = Grid::of(&frame, &view);
                assert!(grid.parallels.len() <= 20 && grid.meridians.len() <= 40, "{lat} {scale}");
                for line in &grid.parallels {
                    let (_, row) = view.cell(line.place);
                    assert!((-1.0..=41.0).contains(&row), "{lat} {scale} {row}");
                }
            }
        }
    }
}
