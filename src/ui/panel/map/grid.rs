//! The coordinate grid: parallels and meridians at round degrees, with their degrees at the edges.

use crate::geo::{LatLon, LocalFrame};
use crate::ui::map_edit;
use crate::ui::map_point::{MapPoint, to_map};
use crate::ui::theme::Role;
use crate::ui::viewport::Viewport;

use super::labels::Labels;
use super::raster::Raster;

/// The least distance between two lines, columns of the map.
const LEAST_COLUMNS: f64 = 16.0;
/// The distance between two dots of a line, dots.
const DOT_GAP: usize = 4;
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
        let least_m = LEAST_COLUMNS * view.scale;
        // One step for both directions, so that they can be compared.
        let least_deg = least_m / (2.0 * degree.e.abs().min(degree.n.abs()).max(1e-3));
        let step_deg = round_step(least_deg).min(WIDEST_DEG);
        let corner = |n: usize, e: usize| {
            let [north, east] = [view.north_bounds()[n], view.east_bounds()[e]];
            map_edit::position(frame, MapPoint::new(north, east))
        };
        let (low, high) = (corner(0, 0), corner(1, 1));
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

/// Returns the shortest round step (1, 2, 5 times a power of ten) not below `degrees`.
fn round_step(degrees: f64) -> f64 {
    let degrees = degrees.max(1e-7);
    let decade = 10_f64.powf(degrees.log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|step| step * decade);
    steps.into_iter().find(|step| *step >= degrees * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

/// Sets the dots of the lines.
pub(super) fn paint(frame: &LocalFrame, view: &Viewport, raster: &mut Raster) {
    let grid = Grid::of(frame, view);
    let (columns, rows) = (usize::from(view.area.width) * 2, usize::from(view.area.height) * 4);
    for line in &grid.parallels {
        let (_, y) = view.dot(line.place);
        for x in (0..columns).step_by(DOT_GAP) {
            raster.line((x as f64, y), (x as f64, y));
        }
    }
    for line in &grid.meridians {
        let (x, _) = view.dot(line.place);
        for y in (0..rows).step_by(DOT_GAP) {
            raster.line((x, y as f64), (x, y as f64));
        }
    }
}

/// Writes the degrees: those of parallels at the left edge, those of meridians above the bottom line.
pub(super) fn write(frame: &LocalFrame, labels: &mut Labels<'_>) {
    let view = *labels.view();
    let grid = Grid::of(frame, &view);
    let [west, _] = view.east_bounds();
    let [south, _] = view.north_bounds();
    let text = |line: &GridLine| format!("{:.*}°", grid.decimals, line.degrees);
    for line in &grid.parallels {
        let edge = MapPoint::new(line.place.n, west + 0.5 * view.scale);
        labels.on_free_ground(edge, &text(line), &[(0, 0)], Role::Dim);
    }
    for line in &grid.meridians {
        let edge = MapPoint::new(south + 3.0 * view.scale, line.place.e);
        labels.on_free_ground(edge, &text(line), &[(0, 0), (1, 0)], Role::Dim);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;

    #[test]
    fn steps_are_round_and_wide_enough() {
        for (degrees, step) in [(0.0011, 0.002), (0.002, 0.002), (0.3, 0.5), (7.0, 10.0), (1e-9, 1e-7)] {
            assert!((round_step(degrees) / step - 1.0).abs() < 1e-9, "{degrees}");
        }
    }

    #[test]
    fn the_lines_are_in_the_window_wherever_it_is() {
        for (lat, lon) in [(40.46, -79.52), (-33.9, 151.2), (0.0, 180.0), (89.9, 10.0), (-89.9999, -170.0)] {
            let frame = LocalFrame::new(lat, lon, 0.0);
            for scale in [0.05, 2.0, 300.0, 20_000.0] {
                let area = Rect::new(0, 0, 120, 40);
                let view = Viewport { area, centre: MapPoint::new(3.0, -2.0), scale };
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
