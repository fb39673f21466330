//! Values of a scenario's tables with their places, and the problems in them.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use toml::de::DeValue;

use super::Files;
use super::bounds::Spent;
use super::variant::Variant;
use crate::plan::FlightPlan;
use crate::plan::builtin::BuiltinPlan;
use crate::plan::format::{PlanFile, Problems, TomlTable, Value};
use crate::scenario::expression::{Cursor, SyntaxError};

/// A reader of values. It notes a problem only once, even if many cases read the same value.
pub(super) struct Reader<'r, 'p> {
    text: &'r str,
    /// The beginning of each line.
    lines: Vec<usize>,
    files: &'r mut dyn Files,
    /// The plans and texts of files read so far, because many cases name the same file.
    plans: BTreeMap<String, Result<PlanFile, String>>,
    texts: BTreeMap<String, Result<String, String>>,
    problems: &'r mut Problems<'p>,
    noted: BTreeSet<(usize, usize, String)>,
    /// The cases that each table applies to, by the beginning of the table; `None` = all.
    chosen: BTreeMap<usize, Option<BTreeSet<String>>>,
    /// The most flights of all cases together.
    pub(super) max_flights: usize,
    pub(super) spent: Spent,
}

/// The sources of the values of a case: the varied values, the case, the file.
pub(super) struct Layers<'l, 't> {
    pub(super) top: &'l TomlTable<'l, 't>,
    pub(super) case: Option<&'l TomlTable<'l, 't>>,
    pub(super) variant: &'l Variant<'l, 't>,
    /// The seeds that replace those of the file.
    pub(super) seeds: Option<&'l [u64]>,
    /// `true` if a campaign draws the flights of the case.
    pub(super) is_drawn: bool,
}

impl<'l, 't> Layers<'l, 't> {
    /// Returns a value of the case, or else of the file.
    pub(super) fn value(&self, key: &str) -> Option<&'l Value<'t>> {
        self.case.and_then(|case| case.get(key)).or_else(|| self.top.get(key))
    }

    /// Returns the tables of the file and of the case that exist, the one of the file first.
    pub(super) fn tables(&self, key: &str, reader: &mut Reader<'_, '_>) -> Vec<TomlTable<'l, 't>> {
        let both = [self.top.get(key), self.case.and_then(|case| case.get(key))];
        both.into_iter().flatten().filter_map(|value| reader.table(key, value)).collect()
    }

    /// Returns the tables of a list of the file, then those of the case.
    pub(super) fn lists(&self, key: &str, reader: &mut Reader<'_, '_>) -> Vec<TomlTable<'l, 't>> {
        let mut tables = reader.tables(self.top, key, key);
        if let Some(case) = self.case {
            tables.extend(reader.tables(case, key, key));
        }
        tables
    }

    /// Returns a value of a section: the varied value, else the one of the case, else the one of the file.
    pub(super) fn of_section(&self, section: &[TomlTable<'l, 't>], key: &str) -> Option<&'l Value<'t>> {
        self.variant.get(key).or_else(|| section.iter().rev().find_map(|table| table.get(key)))
    }

    /// Returns the texts of a list of a section: those of the file, of the case and of the varied values.
    pub(super) fn lines(
        &self,
        section: &[TomlTable<'l, 't>],
        key: &str,
        reader: &mut Reader<'_, '_>,
    ) -> Vec<(String, Range<usize>)> {
        let mut lines = Vec::new();
        for table in section {
            lines.extend(reader.texts(table, key).unwrap_or_default());
        }
        if let Some(value) = self.variant.get(key)
            && let Some(text) = reader.text(value)
        {
            lines.push((text, value.span()));
        }
        lines
    }
}

impl<'r, 'p> Reader<'r, 'p> {
    pub(super) fn new(
        max_flights: usize,
        text: &'r str,
        files: &'r mut dyn Files,
        problems: &'r mut Problems<'p>,
    ) -> Self {
        Self {
            text,
            lines: text.match_indices('\n').map(|(at, _)| at + 1).collect(),
            files,
            plans: BTreeMap::new(),
            texts: BTreeMap::new(),
            problems,
            noted: BTreeSet::new(),
            chosen: BTreeMap::new(),
            max_flights,
            spent: Spent::default(),
        }
    }

    /// Returns `true` if more problems would only be counted.
    pub(super) fn is_full(&self) -> bool {
        self.problems.is_full()
    }

    /// Returns `true` if a table applies to a case: without `cases` it applies to all.
    pub(super) fn is_for(&mut self, case: &str, table: &TomlTable<'_, '_>) -> bool {
        self.cases_of(table).is_none_or(|names| names.contains(case))
    }

    /// Returns the cases that a table names in `cases`; `None` without that key.
    pub(super) fn cases_of(&mut self, table: &TomlTable<'_, '_>) -> Option<&BTreeSet<String>> {
        let key = table.span().start;
        if !self.chosen.contains_key(&key) {
            let names = self.texts(table, "cases");
            let names = names.map(|names| names.into_iter().map(|(name, _)| name).collect());
            self.chosen.insert(key, names);
        }
        self.chosen.get(&key).and_then(Option::as_ref)
    }

    /// Notes a problem at a place.
    pub(super) fn problem(
        &mut self,
        span: Range<usize>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        let message = message.into();
        if self.noted.insert((span.start, span.end, message.clone())) {
            self.problems.add(span, message, hint);
        }
    }

    /// Notes a problem inside the text of a value.
    pub(super) fn syntax(&mut self, value: &Value<'_>, error: SyntaxError) {
        let span = self.place_inside(value, &error.span);
        self.problem(span, error.message, error.hint);
    }

    /// Returns the place in the file of a part of a value's text; the place of the whole value if escapes hide the
    /// part.
    fn place_inside(&self, value: &Value<'_>, part: &Range<usize>) -> Range<usize> {
        let (whole, Some(text)) = (value.span(), value.get_ref().as_str()) else { return value.span() };
        let raw = self.text.get(whole.clone()).unwrap_or_default();
        match raw.find(text) {
            Some(at) if !text.is_empty() => {
                let start = whole.start + at;
                start + part.start..start + part.end.max(part.start)
            }
            _ => whole,
        }
    }

    pub(super) fn refuse_unknown(&mut self, table: &TomlTable<'_, '_>, known: &'static [&'static str]) {
        for (name, span, _) in table.keys() {
            if !known.contains(&name) {
                let hint = crate::text::did_you_mean::hint(name, known.iter().copied());
                self.problem(span, format!("{name} is not a key of {}", table.what()), hint);
            }
        }
    }

    pub(super) fn required<'t, 'i>(&mut self, table: &TomlTable<'t, 'i>, key: &str) -> Option<&'t Value<'i>> {
        let value = table.get(key);
        if value.is_none() {
            let message = format!("{key} is missing in {}", table.what());
            self.problem(table.span(), message, format!("add {key} = …"));
        }
        value
    }

    /// Returns the value as a table, or notes a problem.
    pub(super) fn table<'t, 'i>(&mut self, what: &str, value: &'t Value<'i>) -> Option<TomlTable<'t, 'i>> {
        if value.get_ref().is_table() {
            return TomlTable::new(what.to_owned(), value, self.problems);
        }
        self.problem(value.span(), format!("{what} is not a table"), format!("start it with [{what}]"));
        None
    }

    /// Returns the tables of a list `[[key]]`.
    pub(super) fn tables<'t, 'i>(
        &mut self,
        table: &TomlTable<'t, 'i>,
        key: &str,
        what: &str,
    ) -> Vec<TomlTable<'t, 'i>> {
        let Some(value) = table.get(key) else { return Vec::new() };
        let DeValue::Array(values) = value.get_ref() else {
            self.problem(
                value.span(),
                format!("{key} is not a list of tables"),
                format!("start each with [[{key}]]"),
            );
            return Vec::new();
        };
        values.iter().filter_map(|value| self.table(what, value)).collect()
    }

    pub(super) fn text(&mut self, value: &Value<'_>) -> Option<String> {
        let text = value.get_ref().as_str().map(str::to_owned);
        if text.is_none() {
            self.problem(value.span(), "a text is expected here", "write it in quotes");
        }
        text
    }

    pub(super) fn string(&mut self, table: &TomlTable<'_, '_>, key: &str) -> Option<String> {
        self.text(table.get(key)?)
    }

    /// Returns the texts of a list, or one single text, with their places.
    pub(super) fn texts(
        &mut self,
        table: &TomlTable<'_, '_>,
        key: &str,
    ) -> Option<Vec<(String, Range<usize>)>> {
        let value = table.get(key)?;
        match value.get_ref() {
            DeValue::Array(values) => {
                Some(values.iter().filter_map(|value| Some((self.text(value)?, value.span()))).collect())
            }
            _ => self.text(value).map(|text| vec![(text, value.span())]),
        }
    }

    pub(super) fn boolean(&mut self, table: &TomlTable<'_, '_>, key: &str) -> Option<bool> {
        let value = table.get(key)?;
        let truth = value.get_ref().as_bool();
        if truth.is_none() {
            self.problem(value.span(), format!("{key} is true or false"), "without quotes");
        }
        truth
    }

    pub(super) fn integer(&mut self, value: &Value<'_>) -> Option<i64> {
        let number = match value.get_ref() {
            DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix()).ok(),
            _ => None,
        };
        if number.is_none() {
            self.problem(value.span(), "a whole number is expected here", "write 5");
        }
        number
    }

    /// Reads a number, whole or not.
    pub(super) fn number(&mut self, value: &Value<'_>) -> Option<f64> {
        let number = match value.get_ref() {
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        };
        let number = number.filter(|number: &f64| number.is_finite());
        if number.is_none() {
            self.problem(value.span(), "a number is expected here", "write 12.5, without quotes");
        }
        number
    }

    pub(super) fn number_in(
        &mut self,
        value: Option<&Value<'_>>,
        low: f64,
        high: f64,
        unit: &str,
    ) -> Option<f64> {
        let value = value?;
        let number = self.number(value)?;
        if (low..=high).contains(&number) {
            return Some(number);
        }
        self.problem(
            value.span(),
            format!("{number} is out of range"),
            format!("allowed: {low} to {high} {unit}"),
        );
        None
    }

    /// Reads the text of a value to its end with a grammar.
    pub(super) fn expression<T>(
        &mut self,
        value: &Value<'_>,
        read: impl FnOnce(&mut Cursor<'_>) -> Result<T, SyntaxError>,
    ) -> Option<T> {
        if !self.has_terms() {
            return None;
        }
        let text = self.text(value)?;
        let mut cursor = Cursor::new(&text);
        let result = read(&mut cursor).and_then(|read| cursor.finish().map(|()| read));
        self.take_terms(cursor.reads(), value.span());
        match result {
            Ok(read) => Some(read),
            Err(error) => {
                self.syntax(value, error);
                None
            }
        }
    }

    /// Returns the plan for a name: a built-in plan or a file.
    pub(super) fn plan(&mut self, name: &str) -> Result<FlightPlan, String> {
        self.plan_file(name).map(|file| file.plan)
    }

    pub(super) fn plan_file(&mut self, name: &str) -> Result<PlanFile, String> {
        match BuiltinPlan::find(name) {
            Some(plan) => plan.read().map_err(|errors| crate::plan::format::report(&errors)),
            None => self.plan_from_file(name),
        }
    }

    /// Returns the plan in a file.
    pub(super) fn plan_from_file(&mut self, name: &str) -> Result<PlanFile, String> {
        if let Some(known) = self.plans.get(name) {
            return known.clone();
        }
        let plan = self.files.plan(name);
        self.plans.insert(name.to_owned(), plan.clone());
        plan
    }

    /// Returns the text of a file.
    pub(super) fn file(&mut self, name: &str) -> Result<&str, String> {
        let known = match self.texts.entry(name.to_owned()) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(unknown) => unknown.insert(self.files.text(name)),
        };
        known.as_deref().map_err(Clone::clone)
    }

    /// Returns the line of a place, from 1.
    pub(super) fn line(&self, span: Range<usize>) -> usize {
        self.lines.partition_point(|&begin| begin <= span.start) + 1
    }
}
