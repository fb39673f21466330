//! The tracks of a comparison from above and over time.

use super::{Comparison, Side};
use crate::report::flight::{Detail, Figure};
use crate::report::plot::{Chart, Colour, Ground, Line, Map, MapTrack, Picture, Point};

/// The colours of the two firmwares. People who cannot see red or green can tell them apart, too.
const COLOURS: [Colour; 2] = [Colour::First, Colour::Second];
/// The widths of their first flights, so that both are visible where they coincide, px.
const WIDTHS: [f64; 2] = [1.5, 3.5];
/// Width of the other flights, px.
const THIN: f64 = 0.75;
/// The most other flights of a firmware in a page. All are in a picture of its own.
const MAX_OTHERS: usize = 12;
/// The most points of a track in a picture of its own.
const MAX_POINTS: usize = 20_000;

/// Returns the picture as a document of its own, north up.
pub(super) fn document(comparison: &Comparison) -> String {
    let description = format!("The tracks of {}, north up.", comparison.names().join(" and "));
    let picture = Picture::new("tracks", &comparison.title(), &description).standing_alone();
    map(comparison, Vec::new(), MAX_POINTS, usize::MAX).svg(&picture)
}

/// Returns the pictures for a page, with a map under the tracks.
pub(super) fn figures(comparison: &Comparison, ground: Vec<Ground>, detail: Detail) -> Vec<Figure> {
    let names = comparison.names().join(" and ");
    let [of_map, _] = captions(comparison);
    let others = MAX_OTHERS.min(detail.points / 50);
    let map = map(comparison, ground, detail.points, others);
    let picture = Picture::new("compare-map", "Tracks", &format!("The tracks of {names}, north up."));
    let map = Figure {
        svg: map.svg(&picture),
        title: "Tracks.".to_owned(),
        caption: of_map.to_owned(),
        is_wide: false,
    };
    [Some(map), altitude(comparison, &names, detail)].into_iter().flatten().collect()
}

/// Returns the captions of the map and of the altitudes.
fn captions(comparison: &Comparison) -> [&'static str; 2] {
    if comparison.has_log() {
        [
            "The track of the log by its GPS, and the true track of the simulated flight; crosses are touchdowns.",
            "Seconds after the AUTOPILOT switch; the altitude in the log, and the true one of the simulated flight.",
        ]
    } else {
        [
            "The true tracks; crosses are touchdowns. The first flight of each firmware is bold.",
            "Seconds after the pilot switched the autopilot on; the first flight of each firmware.",
        ]
    }
}

fn map(comparison: &Comparison, ground: Vec<Ground>, most_points: usize, most_others: usize) -> Map {
    let place = |sample: &crate::report::route::TrackSample| -> Point { (sample.ne.y, sample.ne.x) };
    let first = comparison.sides.iter().find_map(|side| side.flights.first()?.samples.first());
    let mut map = Map {
        legs: first.map(place).into_iter().chain(comparison.route.legs()).collect(),
        rings: comparison.route.rings(),
        marks: comparison.route.marks(),
        ground,
        legend: legend(comparison),
        most_points,
        ..Map::default()
    };
    // The first firmware is on top.
    for ((side, colour), bold) in comparison.sides.iter().zip(COLOURS).zip(WIDTHS).rev() {
        for (index, flight) in side.flights.iter().enumerate().take(most_others.saturating_add(1)).rev() {
            let points = flight.samples.iter().map(place).collect();
            map.tracks.push(MapTrack { points, colour, width: if index == 0 { bold } else { THIN } });
            map.touchdowns.extend(flight.touchdown.map(|landing| ((landing.ne.y, landing.ne.x), colour)));
        }
    }
    map
}

/// Returns the names of the firmwares with the looks of their first flights.
fn legend(comparison: &Comparison) -> Vec<(Colour, f64, String)> {
    let letters = ["A", "B"].into_iter().zip(COLOURS).zip(WIDTHS);
    let names = letters.zip(comparison.names());
    let entry = |(((letter, colour), width), name): (((&str, Colour), f64), &str)| {
        (colour, width, format!("{letter}: {}", crate::text::printable::name(name)))
    };
    names.map(entry).chain([(Colour::Plan, 1.0, "plan".to_owned())]).collect()
}

/// Returns the altitudes of the first flights; `None` if nobody flew.
fn altitude(comparison: &Comparison, names: &str, detail: Detail) -> Option<Figure> {
    let [_, of_altitude] = captions(comparison);
    let sides = comparison.sides.iter().zip(COLOURS).zip(WIDTHS).zip(["A", "B"]);
    let line = |(((side, colour), width), letter): (((&Side, Colour), f64), &str)| {
        let points: Vec<Point> =
            side.flights.first()?.samples.iter().map(|sample| (sample.time_s, sample.alt_m)).collect();
        (points.len() > 1).then(|| Line { name: letter.to_owned(), colour, width, is_filled: false, points })
    };
    let mut lines: Vec<Line> = sides.filter_map(line).collect();
    let ends = lines.iter().filter_map(|line| line.points.last()).map(|(time, _)| *time);
    let time = (0.0, ends.reduce(f64::max)?);
    if time.1 < 0.1 {
        return None;
    }
    // The first firmware is on top.
    lines.reverse();
    let description = format!("The altitudes of {names} over {:.0} s.", time.1);
    let picture = Picture::new("compare-altitude", "Altitude", &description);
    let chart = Chart { time, lines, least_span: 5.0, height: 160.0, most_points: detail.points };
    Some(Figure {
        svg: chart.svg(&picture),
        title: "Altitude, m above home.".to_owned(),
        caption: of_altitude.to_owned(),
        is_wide: true,
    })
}
