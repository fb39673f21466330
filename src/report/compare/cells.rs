//! The cells of the table of a comparison, for people.

use std::collections::BTreeMap;

use super::{Comparison, Side, Statistics};

/// The text for an unknown value.
const UNKNOWN: &str = "—";

/// A row of the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::report) struct TableRow {
    pub(in crate::report) title: String,
    pub(in crate::report) unit: &'static str,
    /// The values of the two firmwares.
    pub(in crate::report) a: String,
    pub(in crate::report) b: String,
    pub(in crate::report) difference: String,
    /// `true` if the difference is greater than the spread of either firmware; `None` if a spread is unknown.
    pub(super) is_beyond: Option<bool>,
}

impl TableRow {
    /// Returns `true` if the difference is marked.
    pub(in crate::report) fn is_marked(&self) -> bool {
        self.is_beyond == Some(true)
    }
}

/// Returns all rows: the results, the measures, and the distance between the tracks.
pub(super) fn rows(comparison: &Comparison) -> Vec<TableRow> {
    let [first, second] = &comparison.sides;
    let (a, b) = (results(first), results(second));
    let (title, difference) = ("result".to_owned(), String::new());
    let mut rows = vec![TableRow { title, unit: "", a, b, difference, is_beyond: None }];
    rows.extend(comparison.rows.iter().map(|row| {
        let [a, b] = row.sides.map(|side| side.map_or_else(|| UNKNOWN.to_owned(), plain));
        let difference = row.difference.map_or_else(|| UNKNOWN.to_owned(), signed);
        let (title, unit) = (row.measure.title(), row.measure.unit());
        TableRow { title, unit, a, b, difference, is_beyond: row.is_beyond }
    }));
    let apart = &comparison.apart;
    let [a, b] = apart.among.map(|side| side.map(plain).unwrap_or_default());
    let difference = apart.between.map_or_else(|| UNKNOWN.to_owned(), plain);
    let title = "tracks apart, RMS".to_owned();
    rows.push(TableRow { title, unit: "m", a, b, difference, is_beyond: apart.is_beyond });
    rows
}

/// Returns the number of flights in words.
pub(super) fn flights(side: &Side) -> String {
    match side.flights.len() {
        _ if side.is_log => "as logged".to_owned(),
        0 => "not flown".to_owned(),
        1 if side.repeatable => "one flight, identical each time".to_owned(),
        1 => "one flight".to_owned(),
        count => format!("{count} flights"),
    }
}

/// Returns a sentence for each flight that did not complete: `B, seed 3: crashed: the hull touched the ground`.
pub(super) fn incomplete(comparison: &Comparison) -> Vec<String> {
    let mut sentences = Vec::new();
    for (letter, side) in ["A", "B"].iter().zip(&comparison.sides).filter(|(_, side)| !side.is_log) {
        let first = side.flights.first().map_or(0, |flight| flight.seed);
        let of_several = side.flights.iter().any(|flight| flight.seed != first);
        for flight in side.flights.iter().filter(|flight| flight.result != "complete") {
            let of_seed = if of_several { format!(", seed {}", flight.seed) } else { String::new() };
            sentences.push(format!("{letter}{of_seed}: {}: {}", flight.result, flight.reason));
        }
    }
    sentences
}

/// Returns the meaning of the numbers.
pub(super) fn notes(comparison: &Comparison) -> Vec<String> {
    let measured = if comparison.has_log() {
        "The log is measured by its GPS and its altitude, the simulated flight from truth. The touchdown is where the \
         craft was disarmed. Tracks apart: from each point of one track to the nearest of the other, both ways."
    } else {
        "Measured from truth. Tracks apart: from each point of one track to the nearest of the other, both ways; \
         below A and B among the flights of that firmware."
    };
    let mut notes = vec![measured.to_owned()];
    if comparison.sides.iter().any(|side| side.flights.len() > 1) {
        let marks = comparison.rows.iter().filter_map(|row| row.is_beyond).chain(comparison.apart.is_beyond);
        let is_beyond: Vec<bool> = marks.collect();
        let marked = match is_beyond.iter().any(|is_beyond| *is_beyond) {
            true => {
                "*: it is greater than the spread, from the least to the greatest value, of A and of B; tracks are \
                 farther apart than any two flights compared below A or below B."
            }
            false if is_beyond.is_empty() => "The spread of one of them is unknown.",
            false => "None is greater than the spread, from the least to the greatest value, of A and of B.",
        };
        notes.push(format!(
            "Of several flights: the median, and in parentheses the least and the greatest value. B − A is the \
             difference of the medians. {marked}"
        ));
    }
    notes
}

/// Returns the results; equal results are counted.
fn results(side: &Side) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for flight in &side.flights {
        *counts.entry(&flight.result).or_default() += 1;
    }
    let all = side.flights.len();
    if all == 0 {
        return UNKNOWN.to_owned();
    }
    let reported = counts.iter().map(|(result, count)| match all {
        1 => (*result).to_owned(),
        _ => format!("{result} {count}/{all}"),
    });
    reported.collect::<Vec<_>>().join(", ")
}

/// Returns the median with the spread: `12.34 (12.30..12.41)`.
fn plain(value: Statistics) -> String {
    let median = rounded(value.median);
    match value.count {
        1 => median,
        _ => format!("{median} ({}..{})", rounded(value.min), rounded(value.max)),
    }
}

/// Returns a value with its sign: `+0.12`.
fn signed(value: f64) -> String {
    let text = rounded(value);
    if text.starts_with('-') { text } else { format!("+{text}") }
}

/// Rounds to the hundredth, without `-0.00`.
fn rounded(value: f64) -> String {
    format!("{:.2}", (value * 100.0).round() / 100.0 + 0.0)
}
