//! Two firmwares, or a log and its simulation, on the same plan: the measures of their tracks as tables, JSON and a picture.
//!
//! All measures come from truth, in the same way for both firmwares; their own reports do not count. The flight of a log
//! is measured by its GPS and its altitude (`log_track`). `passage` finds the times at which a track passed the waypoints,
//! `take`, `leg` and `hold` the other measures, and `distance` gives the distance between two tracks.

mod cells;
mod distance;
mod flown_track;
mod hold;
mod json;
mod leg;
mod log_track;
mod markdown;
mod measure;
mod passage;
mod picture;
mod statistics;
mod take;
mod text;
mod track;

#[cfg(test)]
mod tests;

pub(super) use cells::TableRow;
pub use flown_track::flown_track;
pub use log_track::begin_of_log;
pub use measure::Measure;
pub use statistics::Statistics;
pub use take::measures;
pub use track::{Landing, Track};

use super::flight::{Detail, Figure};
use super::plot::Ground;
use super::route::Route;

/// The flights of one firmware.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    /// The name of the firmware, or of the log.
    pub name: String,
    /// `true` if its flight is measured by its log instead of by truth.
    pub is_log: bool,
    /// `true` if all flights with one seed are equal to the last bit.
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
    /// The second median less the first.
    difference: Option<f64>,
    /// `true` if the difference is greater than the spread of either firmware; `None` if a spread is unknown.
    is_beyond: Option<bool>,
}

/// Distances between tracks: root mean square of the distance to the nearest point of the other track, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Apart {
    /// The flights of both firmwares with the same seed.
    between: Option<Statistics>,
    /// Each flight of a firmware and its next one.
    among: [Option<Statistics>; 2],
    /// `true` if the median between the firmwares is greater than each distance among the flights of either; `None` if
    /// these are unknown.
    is_beyond: Option<bool>,
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
            .map(|measure| Row::new(measure, measured.each_ref().map(|side| of(side, measure)), &sides))
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
        picture::document(self)
    }

    /// Returns the table as Markdown, with the command that gives the comparison again.
    pub fn markdown(&self, command: Option<&str>) -> String {
        markdown::markdown(self, command)
    }

    /// Returns the plan and the air.
    pub(super) fn title(&self) -> String {
        format!("{}, {}", self.plan, self.conditions)
    }

    /// Returns the names of the sides.
    pub(super) fn names(&self) -> [&str; 2] {
        self.sides.each_ref().map(|side| side.name.as_str())
    }

    /// Returns `true` if all simulated flights, and those of real firmwares, completed.
    pub fn is_complete(&self) -> bool {
        let judged = self.sides.iter().filter(|side| !side.is_log);
        judged.flat_map(|side| &side.flights).all(|flight| flight.result == "complete")
    }

    /// Returns `true` if one side is a log.
    pub(super) fn has_log(&self) -> bool {
        self.sides.iter().any(|side| side.is_log)
    }

    /// Returns the number of the flights of each side in words.
    pub(super) fn flights(&self) -> String {
        let [a, b] = self.sides.each_ref().map(|side| format!("{}, {}", side.name, cells::flights(side)));
        format!("A: {a}; B: {b}.")
    }

    /// Returns a sentence for each flight that did not complete.
    pub(super) fn incomplete(&self) -> Vec<String> {
        cells::incomplete(self)
    }

    /// Returns the rows of the table.
    pub(super) fn table(&self) -> Vec<TableRow> {
        cells::rows(self)
    }

    /// Returns the meaning of the numbers.
    pub(super) fn notes(&self) -> String {
        cells::notes(self).join(" ")
    }

    /// Returns the pictures for a page.
    pub(super) fn figures(&self, ground: Vec<Ground>, detail: Detail) -> Vec<Figure> {
        picture::figures(self, ground, detail)
    }
}

impl Row {
    fn new(measure: Measure, of_sides: [Option<Statistics>; 2], sides: &[Side; 2]) -> Self {
        let [first, second] = of_sides;
        let difference = first.zip(second).map(|(first, second)| second.median - first.median);
        let spreads = of_sides.map(|of_side| of_side.filter(|found| found.count > 1).map(Statistics::spread));
        Self { measure, sides: of_sides, difference, is_beyond: is_beyond(difference, spreads, sides) }
    }
}

impl Apart {
    fn new(sides: &[Side; 2]) -> Self {
        let [first, second] = sides;
        let between = Statistics::of(first.flights.iter().flat_map(|one| {
            let same_air = second.flights.iter().filter(|other| other.seed == one.seed);
            same_air.filter_map(|other| distance::rms_m(one, other))
        }));
        let among = sides.each_ref().map(|side| {
            let pairs = side.flights.iter().zip(side.flights.iter().skip(1));
            Statistics::of(pairs.filter_map(|(one, next)| distance::rms_m(one, next)))
        });
        let greatest = among.map(|among| among.map(|among| among.max));
        let is_beyond = is_beyond(between.map(|between| between.median), greatest, sides);
        Self { between, among, is_beyond }
    }
}

/// The smallest difference that the table shows. A smaller one is never marked.
const SMALLEST: f64 = 0.005;

/// Returns `true` if a difference is greater than both spreads; `None` if that cannot be known. The spread of a firmware
/// that flew once is zero if it would fly the same again, but not if neither firmware flew more often.
fn is_beyond(difference: Option<f64>, spreads: [Option<f64>; 2], sides: &[Side; 2]) -> Option<bool> {
    if sides.iter().all(|side| side.flights.len() == 1) {
        return None;
    }
    let [first, second] = sides;
    let known = |spread: Option<f64>, side: &Side| {
        spread.or((side.repeatable && side.flights.len() == 1).then_some(0.0))
    };
    let [one, other] = spreads;
    let greater = known(one, first)?.max(known(other, second)?);
    Some(difference?.abs() > greater.max(SMALLEST))
}
