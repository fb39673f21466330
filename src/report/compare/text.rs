//! The comparison as a table for people.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::{Comparison, Side, Statistics};

/// The text for an unknown value.
const UNKNOWN: &str = "—";

pub(super) fn table(comparison: &Comparison) -> String {
    let [first, second] = &comparison.sides;
    let mut text = format!("{}, {}\n", comparison.plan, comparison.conditions);
    for (letter, side) in ["A", "B"].iter().zip([first, second]) {
        let _ = writeln!(text, "{letter}: {}, {}", side.name, flights(side));
    }
    text.push('\n');
    let mut lines = vec![
        ["".to_owned(), "".to_owned(), "A".to_owned(), "B".to_owned(), "B − A".to_owned()],
        ["result".to_owned(), "".to_owned(), results(first), results(second), String::new()],
    ];
    for row in &comparison.rows {
        let [a, b] = row.sides.map(|side| side.map_or_else(|| UNKNOWN.to_owned(), plain));
        let difference = row.difference.map_or_else(|| UNKNOWN.to_owned(), signed);
        let difference = marked(difference, row.is_beyond);
        lines.push([row.measure.title(), row.measure.unit().to_owned(), a, b, difference]);
    }
    let apart = &comparison.apart;
    let [a, b] = apart.among.map(|side| side.map(plain).unwrap_or_default());
    let between = marked(apart.between.map_or_else(|| UNKNOWN.to_owned(), plain), apart.is_beyond);
    lines.push(["tracks apart, RMS".to_owned(), "m".to_owned(), a, b, between]);
    text.push_str(&aligned(&lines));
    for (letter, side) in ["A", "B"].iter().zip([first, second]) {
        let first = side.flights.first().map_or(0, |flight| flight.seed);
        let of_several = side.flights.iter().any(|flight| flight.seed != first);
        for flight in side.flights.iter().filter(|flight| flight.result != "complete") {
            let of_seed = if of_several { format!(", seed {}", flight.seed) } else { String::new() };
            let _ = writeln!(text, "{letter}{of_seed}: {}: {}", flight.result, flight.reason);
        }
    }
    text.push_str(
        "\nMeasured from truth. Tracks apart: from each point of one track to the nearest of the other, both ways; \
         below\nA and B among the flights of that firmware.\n",
    );
    if comparison.sides.iter().any(|side| side.flights.len() > 1) {
        text.push_str(
            "Of several flights: the median, and in parentheses the least and the greatest value. B − A is the \
             difference\nof the medians. ",
        );
        let is_beyond: Vec<bool> =
            comparison.rows.iter().filter_map(|row| row.is_beyond).chain(apart.is_beyond).collect();
        text.push_str(match is_beyond.iter().any(|is_beyond| *is_beyond) {
            true => {
                "*: it is greater than the spread, from the least to the greatest value, of A and of B; tracks\nare \
                 farther apart than any two flights compared below A or below B.\n"
            }
            false if is_beyond.is_empty() => "The spread of one of them is unknown.\n",
            false => "None is greater than the spread, from the least to the greatest value, of A and of B.\n",
        });
    }
    text
}

/// Returns the number of flights in words.
fn flights(side: &Side) -> String {
    match side.flights.len() {
        0 => "not flown".to_owned(),
        1 if side.repeatable => "one flight, identical each time".to_owned(),
        1 => "one flight".to_owned(),
        count => format!("{count} flights"),
    }
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

/// Returns the difference with a mark if it is greater than the spread, and with its width in any case.
fn marked(difference: String, is_beyond: Option<bool>) -> String {
    difference
        + match is_beyond {
            Some(true) => " *",
            Some(false) => "  ",
            None => "",
        }
}

/// Rounds to the hundredth, without `-0.00`.
fn rounded(value: f64) -> String {
    format!("{:.2}", (value * 100.0).round() / 100.0 + 0.0)
}

/// Aligns columns to their widest cell: names left, values right.
fn aligned(lines: &[[String; 5]]) -> String {
    let width = |column: usize| {
        let cells = lines.iter().filter_map(|line| line.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let [title, unit, a, b, difference] = [0, 1, 2, 3, 4].map(width);
    let mut text = String::new();
    for [name, of, first, second, apart] in lines {
        let line = format!("{name:<title$}  {of:<unit$}  {first:>a$}  {second:>b$}  {apart:>difference$}");
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
