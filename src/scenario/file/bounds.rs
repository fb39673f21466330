//! Limits for the expanded size of a scenario. A short file can name many cases, each with all expectations and
//! seeds, so the products are checked before anything is created.

use std::ops::Range;

use toml::de::DeValue;

use super::reader::Reader;
use crate::plan::format::TomlTable;
use crate::scenario::expression::MAX_NAME;

/// The most cases, with all combinations of varied values.
pub(super) const MAX_CASES: usize = 1000;
/// The most entries of one list of tables, such as the `[[expect]]` of the file or of a case.
const MAX_LIST: usize = 1000;
/// The most inputs, measures, expectations or parameters of all cases together.
const MAX_ENTRIES: usize = 50_000;
/// The most terms of the expressions of all cases together: some 100 MB.
const MAX_TERMS: usize = 1_000_000;
/// The most bytes of settings and lines of all cases together, including those of settings files.
const MAX_LINES: usize = 64 << 20;

/// The limits with their names in the reference.
#[cfg(test)]
pub(in crate::scenario) const BOUNDS: [(&str, usize); 5] = [
    ("cases, with every combination", MAX_CASES),
    ("one list of inputs", MAX_LIST),
    ("the inputs, measures, expectations or parameters of all cases", MAX_ENTRIES),
    ("the expressions of all cases", MAX_TERMS),
    ("the settings and lines of all cases", MAX_LINES >> 20),
];

/// The lists whose entries come from both the case and the file, with the word for messages.
const LISTS: [(&str, &str); 4] =
    [("parameters", "parameters"), ("input", "inputs"), ("measure", "measures"), ("expect", "expectations")];

/// The amounts used by the cases read so far.
#[derive(Debug, Default)]
pub(super) struct Spent {
    flights: usize,
    /// The place at which there were too many flights.
    too_many_at: Option<Range<usize>>,
    terms: usize,
    line_bytes: usize,
}

/// Returns `true` if the cases can be read. Reports lists that are too long, too many cases, and too many entries of
/// all cases.
pub(super) fn check(
    top: &TomlTable<'_, '_>,
    cases: &[TomlTable<'_, '_>],
    variants: usize,
    reader: &mut Reader<'_, '_>,
) -> bool {
    let mut is_small = is_short(top, "compare", "comparisons", reader);
    let count = cases.len().max(1).saturating_mul(variants);
    if count > MAX_CASES {
        let place = first_place(top, "case").or_else(|| first_place(top, "vary")).unwrap_or(0..0);
        reader.problem(
            place,
            format!("the scenario has {count} cases"),
            format!("allowed: {MAX_CASES}; leave some out, or make several scenarios of it"),
        );
        return false;
    }
    for (key, word) in LISTS {
        let mut is_each_short = true;
        // This checks all of them, so that all problems are reported.
        for table in std::iter::once(top).chain(cases) {
            is_each_short &= is_short(table, key, word, reader);
        }
        is_small &= is_each_short;
        let entries = entries(top, cases, key, reader).saturating_mul(variants);
        if is_each_short && entries > MAX_ENTRIES {
            let owner = std::iter::once(top).chain(cases).find_map(|table| first_place(table, key));
            reader.problem(
                owner.unwrap_or(0..0),
                format!("the {count} cases have {entries} {word} together"),
                format!(
                    "allowed: {MAX_ENTRIES}; assign each to its cases with cases = [\"NAME\"], or make several \
                     scenarios of it"
                ),
            );
            is_small = false;
        }
    }
    is_small
}

/// Returns the number of entries of all cases of one variant.
fn entries(
    top: &TomlTable<'_, '_>,
    cases: &[TomlTable<'_, '_>],
    key: &str,
    reader: &mut Reader<'_, '_>,
) -> usize {
    let shared: usize = match top.get(key).map(toml::Spanned::get_ref) {
        Some(DeValue::Array(_)) => {
            let tables = reader.tables(top, key, key);
            tables
                .iter()
                .map(|table| {
                    reader.cases_of(table).map_or(cases.len().max(1), std::collections::BTreeSet::len)
                })
                .sum()
        }
        Some(DeValue::Table(table)) => table.len().saturating_mul(cases.len().max(1)),
        _ => 0,
    };
    cases.iter().map(|case| length(case, key)).fold(shared, usize::saturating_add)
}

fn length(table: &TomlTable<'_, '_>, key: &str) -> usize {
    match table.get(key).map(toml::Spanned::get_ref) {
        Some(DeValue::Array(values)) => values.len(),
        Some(DeValue::Table(table)) => table.len(),
        _ => 0,
    }
}

fn is_short(table: &TomlTable<'_, '_>, key: &str, word: &str, reader: &mut Reader<'_, '_>) -> bool {
    let length = length(table, key);
    if length > MAX_LIST {
        reader.problem(
            first_place(table, key).unwrap_or(0..0),
            format!("there are {length} {word} in one list"),
            format!("allowed: {MAX_LIST}; make several scenarios of it"),
        );
    }
    length <= MAX_LIST
}

/// Returns the place of a table, or of the first table of a list.
fn first_place(table: &TomlTable<'_, '_>, key: &str) -> Option<Range<usize>> {
    let value = table.get(key)?;
    match value.get_ref() {
        DeValue::Array(values) => values.iter().next().map(toml::Spanned::span),
        _ => Some(value.span()),
    }
}

impl Reader<'_, '_> {
    /// Counts the flights of a case, which come from `place`. Returns `true` if there is room for them.
    pub(super) fn take_flights(&mut self, flights: usize, place: Range<usize>) -> bool {
        self.spent.flights = self.spent.flights.saturating_add(flights);
        let has_room = self.spent.flights <= self.max_flights;
        if !has_room {
            self.spent.too_many_at.get_or_insert(place);
        }
        has_room
    }

    /// Reports the flights for which there was no room.
    pub(super) fn check_flights(&mut self) {
        if let Some(place) = self.spent.too_many_at.take() {
            let (flights, max) = (self.spent.flights, self.max_flights);
            self.problem(
                place,
                format!("the scenario has {flights} flights"),
                format!("allowed: {max}; take fewer seeds or cases, or add --max-flights {flights}"),
            );
        }
    }

    /// Returns `true` if there is room for more expressions.
    pub(super) fn has_terms(&self) -> bool {
        self.spent.terms <= MAX_TERMS
    }

    /// Counts the terms of an expression.
    pub(super) fn take_terms(&mut self, terms: usize, place: Range<usize>) {
        self.spent.terms += terms;
        if !self.has_terms() {
            self.problem(
                place,
                format!("the expressions of all cases together have more than {MAX_TERMS} terms"),
                "shorten them, or make several scenarios of it",
            );
        }
    }

    /// Counts the settings and lines that a case keeps. Returns `true` if there is room for them.
    pub(super) fn take_lines(&mut self, bytes: usize, place: Range<usize>) -> bool {
        self.spent.line_bytes = self.spent.line_bytes.saturating_add(bytes);
        let has_room = self.spent.line_bytes <= MAX_LINES;
        if !has_room {
            self.problem(
                place,
                format!(
                    "the settings and lines of all cases together have more than {} MiB",
                    MAX_LINES >> 20
                ),
                "shorten them, or make several scenarios of it",
            );
        }
        has_room
    }

    /// Returns `true` if another case should be read: no limit is reached and there is room for more problems.
    pub(super) fn can_go_on(&self) -> bool {
        self.has_terms() && self.spent.line_bytes <= MAX_LINES && !self.is_full()
    }

    /// Reads the name of a case, an input or a measure.
    pub(super) fn name(&mut self, value: &crate::plan::format::Value<'_>) -> Option<String> {
        let name = self.text(value)?;
        let length = name.chars().count();
        if length > MAX_NAME {
            self.problem(
                value.span(),
                format!("this name has {length} characters"),
                format!("allowed: {MAX_NAME}"),
            );
            return None;
        }
        Some(name)
    }
}
