//! The timeline and the map of a sweep in characters.

use super::minutes;
use crate::flight::sweep::{Fate, SweepPoint};

/// The meaning of the characters.
pub(super) const LEGEND: &str = "H home   . comes home   o ends elsewhere under control   X lost";
/// The seconds in a line of the timeline.
const LINE: usize = 60;
/// The greatest size of the map, characters.
const WIDTH: usize = 72;
const HEIGHT: usize = 24;

fn mark(fate: Fate) -> char {
    match fate {
        Fate::Home => '.',
        Fate::Off => 'o',
        Fate::Lost => 'X',
    }
}

/// Returns a character a second.
pub(super) fn timeline(points: &[SweepPoint]) -> Vec<String> {
    points
        .chunks(LINE)
        .map(|line| {
            let start = line.first().map_or(0, |point| point.second);
            let marks: String = line.iter().map(|point| mark(point.fate)).collect();
            format!("  {:>5}  {marks}", minutes(start))
        })
        .collect()
}

/// Returns the flight from above, north up. A character is twice as high as wide. Where several seconds share a character,
/// the worst one is shown.
pub(super) fn map(points: &[SweepPoint]) -> Vec<String> {
    let places = || points.iter().map(|point| [point.place_enu[0], point.place_enu[1]]).chain([[0.0, 0.0]]);
    let bounds = |axis: usize| {
        let values = places().map(|place| place[axis]);
        values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ((west, east), (south, north)) = (bounds(0), bounds(1));
    // Metres of a character's width; its height is twice as many.
    let scale =
        ((east - west) / (WIDTH - 1) as f64).max((north - south) / (2 * (HEIGHT - 1)) as f64).max(0.1);
    if !scale.is_finite() {
        return Vec::new();
    }
    let cell = |[x, y]: [f64; 2]| {
        (((north - y) / (2.0 * scale)).round() as usize, ((x - west) / scale).round() as usize)
    };
    let (rows, columns) = cell([east, south]);
    let mut grid = vec![vec![' '; columns + 1]; rows + 1];
    let mut in_order: Vec<&SweepPoint> = points.iter().collect();
    in_order.sort_by_key(|point| point.fate);
    for point in in_order {
        let (row, column) = cell([point.place_enu[0], point.place_enu[1]]);
        grid[row][column] = mark(point.fate);
    }
    let (row, column) = cell([0.0, 0.0]);
    grid[row][column] = 'H';
    let line = |row: Vec<char>| format!("  {}", row.into_iter().collect::<String>()).trim_end().to_owned();
    let mut lines: Vec<String> = grid.into_iter().map(line).collect();
    lines.push(format!("  a character is {scale:.1} m wide and {:.1} m high; north is up", 2.0 * scale));
    lines
}
