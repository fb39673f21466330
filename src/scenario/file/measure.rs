//! `[[measure]]`: numbers taken from the flight for comparisons.

use std::rc::Rc;

use strum::IntoEnumIterator as _;

use super::Belongs;
use super::keys::MEASURE_KEYS;
use super::reader::{Layers, Reader};
use crate::plan::format::TomlTable;
use crate::scenario::case::{Better, Measure, Measured, Statistic, Window};
use crate::scenario::expression::Scope;
use crate::telemetry::quantity::Dimension;
use crate::telemetry::signal::Signal;

/// The kinds of measure; each table has one of these keys.
const KINDS: [&str; 6] = ["mean", "rms", "max", "min", "time", "value"];

/// Reads the measures of a case; later ones may use earlier ones.
pub(super) fn read(
    layers: &Layers<'_, '_>,
    belongs: &Belongs<'_>,
    scope: &mut Scope,
    reader: &mut Reader<'_, '_>,
) -> Vec<Measure> {
    let mut measures = Vec::new();
    for table in layers.lists("measure", reader) {
        reader.refuse_unknown(&table, MEASURE_KEYS);
        if !belongs.includes(&table, reader) {
            continue;
        }
        let Some(value) = reader.required(&table, "name") else { continue };
        let Some(name) = reader.name(value) else { continue };
        let is_name = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && name.starts_with(|c: char| c.is_ascii_alphabetic());
        if !is_name {
            reader.problem(
                value.span(),
                format!("{name} is not a name for a measure"),
                "letters, digits and _",
            );
            continue;
        }
        let problem = taken(&name).or_else(|| {
            scope.names.contains_key(&name).then(|| format!("a measure or a parameter {name} exists already"))
        });
        if let Some(problem) = problem {
            reader.problem(value.span(), problem, "choose another name");
            continue;
        }
        let better = better(&table, reader);
        if let Some((measured, dimension)) = read_measured(&table, scope, reader) {
            Rc::make_mut(&mut scope.names).insert(name.clone(), dimension);
            measures.push(Measure { name, dimension, measured, better });
        }
    }
    measures
}

/// Returns a problem if a parameter or a measure has the name of a signal, because expressions would never find it.
pub(super) fn taken(name: &str) -> Option<String> {
    Signal::find(name).map(|_| format!("{name} is a signal"))
}

/// Reads the direction in which a measure improves.
fn better(table: &TomlTable<'_, '_>, reader: &mut Reader<'_, '_>) -> Option<Better> {
    let value = table.get("better")?;
    let better = reader.text(value)?.parse().ok();
    if better.is_none() {
        reader.problem(value.span(), "unknown direction", "write less or more");
    }
    better
}

/// Reads the window of a table.
pub(super) fn window(table: &TomlTable<'_, '_>, scope: &Scope, reader: &mut Reader<'_, '_>) -> Window {
    let mut instant =
        |key| table.get(key).and_then(|value| reader.expression(value, |cursor| scope.read_instant(cursor)));
    Window { from: instant("from"), until: instant("until") }
}

fn read_measured(
    table: &TomlTable<'_, '_>,
    scope: &Scope,
    reader: &mut Reader<'_, '_>,
) -> Option<(Measured, Dimension)> {
    let given: Vec<&str> = KINDS.into_iter().filter(|key| table.get(key).is_some()).collect();
    let [kind] = given.as_slice() else {
        let message = match given.as_slice() {
            [first, second, ..] => format!("the measure has both {first} and {second}"),
            _ => "the measure is empty".to_owned(),
        };
        reader.problem(table.span(), message, format!("it needs one of {}", KINDS.join(", ")));
        return None;
    };
    let is_idle = |key: &str| match key {
        "from" | "until" => matches!(*kind, "time" | "value"),
        "at" => *kind != "value",
        _ => false,
    };
    for (key, span, _) in table.keys().filter(|(key, ..)| is_idle(key)) {
        reader.problem(span, format!("{key} has no meaning for {kind}"), "leave it out");
    }
    for statistic in Statistic::iter() {
        if let Some(value) = table.get(statistic.into()) {
            let window = window(table, scope, reader);
            let (number, dimension) = reader.expression(value, |cursor| scope.read_number(cursor))?;
            return Some((Measured::Over(window, statistic, number), dimension));
        }
    }
    if let Some(value) = table.get("time") {
        let (from, to) = reader.expression(value, |cursor| {
            let from = scope.read_instant(cursor)?;
            cursor.arrow("write engaged -> ARRIVED 1")?;
            Ok((from, scope.read_instant(cursor)?))
        })?;
        return Some((Measured::Time(from, to), Dimension::TIME));
    }
    let value = table.get("value")?;
    let (number, dimension) = reader.expression(value, |cursor| scope.read_number(cursor))?;
    let measured = match table.get("at") {
        None => Measured::Of(number),
        Some(at) => Measured::At(reader.expression(at, |cursor| scope.read_instant(cursor))?, number),
    };
    Some((measured, dimension))
}
