//! Two firmwares on the same plan: the measures of their tracks as a table, JSON and a picture.
//!
//! All measures come from truth, in the same way for both firmwares; their own reports do not count. `route` is the
//! plan in metres, `passage` finds the times at which a track passed the waypoints, `measure` takes the other
//! measures, and `distance` gives the distance between two tracks.

mod distance;
mod json;
mod measure;
mod passage;
mod route;
mod statistics;
mod svg;
mod text;
mod track;

#[cfg(test)]
mod tests;

pub use measure::Measure;
pub use route::Route;
pub use statistics::Statistics;
pub use track::{Track, TrackSample};

use measure::measures;

/// The flights of one firmware.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    /// The name of the firmware.
    pub name: String,
    /// `true` if all flights are equal to the last bit, so that one flight is enough.
    pub repeatable: bool,
    pub flights: Vec<Track>,
}

/// Two firmwares on the same plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    plan: String,
    conditions: String,
    route: Route,
    sides: [Side; 2],
    rows: Vec<Row>,
    apart: Apart,
}

/// A measure of both firmwares.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Row {
    measure: Measure,
    sides: [Option<Statistics>; 2],
}

impl Row {
    /// Returns the second value less the first.
    fn difference(&self) -> Option<Statistics> {
        let [first, second] = self.sides;
        Some(second?.less(first?))
    }
}

/// Distances between tracks: root mean square of the distance to the nearest point of the other track, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Apart {
    /// Each flight of one firmware against each flight of the other.
    between: Option<Statistics>,
    /// The flights of each firmware against each other.
    among: [Option<Statistics>; 2],
}

impl Comparison {
    /// Measures the flights. `conditions` describes the air in which they were flown.
    pub fn new(plan: &str, conditions: &str, route: Route, sides: [Side; 2]) -> Self {
        let measured = sides.each_ref().map(|side| {
            side.flights.iter().map(|flight| measures(&route, flight)).collect::<Vec<Vec<(Measure, f64)>>>()
        });
        let of = |side: &[Vec<(Measure, f64)>], measure: Measure| {
            let values = side.iter().filter_map(|flight| {
                flight.iter().find(|(found, _)| *found == measure).map(|(_, value)| *value)
            });
            Statistics::of(values)
        };
        let rows = Measure::all(&route)
            .map(|measure| Row { measure, sides: measured.each_ref().map(|side| of(side, measure)) })
            .filter(|row| row.sides.iter().any(Option::is_some))
            .collect();
        let apart = Apart::new(&sides);
        Self { plan: plan.to_owned(), conditions: conditions.to_owned(), route, sides, rows, apart }
    }

    /// Returns the table for people.
    pub fn text(&self) -> String {
        text::table(self)
    }

    pub fn json(&self) -> String {
        json::object(self)
    }

    /// Returns a picture with both tracks, north up.
    pub fn svg(&self) -> String {
        svg::picture(self)
    }
}

impl Apart {
    fn new(sides: &[Side; 2]) -> Self {
        let [first, second] = sides;
        let between = first
            .flights
            .iter()
            .flat_map(|one| second.flights.iter().filter_map(move |other| distance::rms_m(one, other)));
        let among = sides.each_ref().map(|side| {
            let flights = &side.flights;
            let pairs = flights.iter().enumerate().flat_map(|(index, one)| {
                flights.iter().skip(index + 1).filter_map(move |other| distance::rms_m(one, other))
            });
            Statistics::of(pairs)
        });
        Self { between: Statistics::of(between), among }
    }
}
