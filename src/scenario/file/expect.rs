//! `[[expect]]`: the expectations of a flight.

use strum::{EnumCount as _, IntoEnumIterator as _};

use super::keys::EXPECT_KEYS;
use super::measure::window;
use super::reader::{Layers, Reader};
use super::{Allowance, Belongs};
use crate::plan::format::{TomlTable, Value};
use crate::scenario::case::{Expectation, Expected, StateStep, Statistic, Window};
use crate::scenario::expression::{
    Comparison, Condition, Cursor, Scope, SyntaxError, read_pattern, read_span_from,
};
use crate::scenario::happening::{Pattern, RESULTS};
use crate::telemetry::FirmwareProfile;

/// The kinds of expectation; each table has one of these keys.
const KINDS: [&str; 13] = [
    "result",
    "states",
    "event",
    "no_event",
    "always",
    "never",
    "eventually",
    "mostly",
    "mean",
    "rms",
    "max",
    "min",
    "that",
];

/// Reads the expectations of a case.
pub(super) fn read(
    layers: &Layers<'_, '_>,
    belongs: &Belongs<'_>,
    scope: &Scope,
    allowance: &Allowance,
    reader: &mut Reader<'_, '_>,
) -> Vec<Expectation> {
    let mut expectations = Vec::new();
    for table in layers.lists("expect", reader) {
        reader.refuse_unknown(&table, EXPECT_KEYS);
        if !belongs.includes(&table, reader) {
            continue;
        }
        let exact = reader.boolean(&table, "exact").unwrap_or(false);
        let allowance = if exact { Allowance::default() } else { *allowance };
        expectations.extend(read_one(&table, scope, &allowance, reader));
    }
    expectations
}

/// Adds the default expectation for the result, for each kind of firmware without one.
pub(super) fn add_usual_result(expectations: &mut Vec<Expectation>, ends: bool) {
    let without: Vec<FirmwareProfile> = FirmwareProfile::iter()
        .filter(|&kind| {
            !expectations.iter().any(|expectation| {
                expectation.holds_for(Some(kind)) && matches!(expectation.expected, Expected::Result(_))
            })
        })
        .collect();
    if without.len() == FirmwareProfile::COUNT {
        expectations.insert(0, usual_result(ends, None));
        return;
    }
    for kind in without {
        expectations.insert(0, usual_result(ends, Some(kind)));
    }
}

fn usual_result(ends: bool, firmware: Option<FirmwareProfile>) -> Expectation {
    let words: &[&str] = if ends { &["stopped", "complete", "landed"] } else { &["complete"] };
    Expectation {
        label: format!("result {}", words.join(" or ")),
        line: 1,
        firmware,
        window: Window::default(),
        expected: Expected::Result(words.iter().map(|&word| word.to_owned()).collect()),
    }
}

/// Reads the kind of firmware for which an expectation holds.
pub(super) fn read_firmware(
    table: &TomlTable<'_, '_>,
    reader: &mut Reader<'_, '_>,
) -> Option<FirmwareProfile> {
    let value = table.get("firmware")?;
    let word = reader.text(value)?;
    let kind = word.parse().ok();
    if kind.is_none() {
        let allowed: Vec<&str> = FirmwareProfile::iter().map(Into::into).collect();
        let guess = crate::text::did_you_mean::suffix(&word, allowed.iter().copied());
        let message = format!("{word} is not a kind of firmware{guess}");
        reader.problem(value.span(), message, format!("allowed: {}", allowed.join(", ")));
    }
    kind
}

fn read_one(
    table: &TomlTable<'_, '_>,
    scope: &Scope,
    allowance: &Allowance,
    reader: &mut Reader<'_, '_>,
) -> Option<Expectation> {
    let kinds: Vec<&str> = KINDS.into_iter().filter(|key| table.get(key).is_some()).collect();
    let [kind] = kinds.as_slice() else {
        let message = match kinds.as_slice() {
            [] => "the expectation is empty".to_owned(),
            [first, second, ..] => format!("the expectation has both {first} and {second}"),
            [_] => String::new(),
        };
        reader.problem(table.span(), message, format!("it needs one of {}", KINDS.join(", ")));
        return None;
    };
    let value = table.get(kind)?;
    refuse_idle(kind, table, reader);
    let window = window(table, scope, reader);
    let expected = read_expected(kind, value, table, scope, reader)?.widened(allowance);
    let label = reader.string(table, "name").unwrap_or_else(|| label(kind, value, table, reader));
    let firmware = read_firmware(table, reader);
    Some(Expectation { label, line: reader.line(value.span()), firmware, window, expected })
}

/// Returns the label of an expectation: `always altitude in 19..21 m, from ARRIVED 0`.
fn label(kind: &str, value: &Value<'_>, table: &TomlTable<'_, '_>, reader: &mut Reader<'_, '_>) -> String {
    let text = match value.get_ref().as_str() {
        Some(text) => text.to_owned(),
        None => reader
            .texts(table, kind)
            .unwrap_or_default()
            .iter()
            .map(|(text, _)| text.as_str())
            .collect::<Vec<_>>()
            .join(" or "),
    };
    let mut label = if kind == "that" { text } else { format!("{} {text}", kind.replace('_', " ")) };
    for key in ["at", "within", "with", "from", "until"] {
        if let Some(text) = table.get(key).and_then(|value| value.get_ref().as_str()) {
            label.push_str(&format!(", {key} {text}"));
        }
    }
    label
}

/// Refuses keys that have no meaning for this kind.
fn refuse_idle(kind: &str, table: &TomlTable<'_, '_>, reader: &mut Reader<'_, '_>) {
    let of_events = ["count", "within", "with"];
    let of_windows = ["from", "until"];
    let is_idle = |key: &str| match key {
        _ if of_events.contains(&key) => kind != "event",
        _ if of_windows.contains(&key) => ["result", "states", "that"].contains(&kind),
        "share" => kind != "mostly",
        "at" => kind != "that",
        _ => false,
    };
    for (key, span, _) in table.keys().filter(|(key, ..)| is_idle(key)) {
        reader.problem(span, format!("{key} has no meaning for {kind}"), "leave it out");
    }
}

fn read_expected(
    kind: &str,
    value: &Value<'_>,
    table: &TomlTable<'_, '_>,
    scope: &Scope,
    reader: &mut Reader<'_, '_>,
) -> Option<Expected> {
    Some(match kind {
        "result" => Expected::Result(read_results(kind, table, reader)?),
        "states" => Expected::States(reader.expression(value, |cursor| read_states(cursor, scope))?),
        "event" => read_event(value, table, scope, reader)?,
        "no_event" => Expected::NoEvent(reader.expression(value, |cursor| read_pattern(cursor, scope))?),
        "always" => Expected::Always(condition(value, scope, reader)?, false),
        "never" => Expected::Always(condition(value, scope, reader)?, true),
        "eventually" => Expected::Eventually(condition(value, scope, reader)?),
        "mostly" => {
            let share = reader.required(table, "share")?;
            let percent = reader.number_in(Some(share), 0.0, 100.0, "%")?;
            Expected::Mostly(condition(value, scope, reader)?, percent / 100.0)
        }
        "that" => {
            let condition = condition(value, scope, reader)?;
            match table.get("at") {
                Some(at) => {
                    Expected::At(reader.expression(at, |cursor| scope.read_instant(cursor))?, condition)
                }
                None => Expected::That(condition),
            }
        }
        _ => {
            let statistic = Statistic::iter().find(|statistic| kind == <&str>::from(statistic))?;
            Expected::Statistic(statistic, comparison(value, scope, reader)?)
        }
    })
}

fn condition(value: &Value<'_>, scope: &Scope, reader: &mut Reader<'_, '_>) -> Option<Condition> {
    reader.expression(value, |cursor| scope.read_condition(cursor))
}

fn comparison(value: &Value<'_>, scope: &Scope, reader: &mut Reader<'_, '_>) -> Option<Comparison> {
    match condition(value, scope, reader)? {
        Condition::Compare(comparison) => Some(comparison),
        _ => {
            reader.problem(
                value.span(),
                "a number that is compared is expected here",
                "write speed <= 5.5 m/s",
            );
            None
        }
    }
}

fn read_results(kind: &str, table: &TomlTable<'_, '_>, reader: &mut Reader<'_, '_>) -> Option<Vec<String>> {
    let words = reader.texts(table, kind)?;
    for (word, span) in &words {
        if !RESULTS.contains(&word.as_str()) {
            let guess = crate::text::did_you_mean::suffix(word, RESULTS);
            let hint = format!("allowed: {}", RESULTS.join(", "));
            reader.problem(span.clone(), format!("{word} is not a result{guess}"), hint);
        }
    }
    Some(words.into_iter().map(|(word, _)| word).collect())
}

fn read_event(
    value: &Value<'_>,
    table: &TomlTable<'_, '_>,
    scope: &Scope,
    reader: &mut Reader<'_, '_>,
) -> Option<Expected> {
    let pattern = reader.expression(value, |cursor| read_pattern(cursor, scope))?;
    let count = match table.get("count") {
        None => None,
        Some(value) => {
            let count = reader.integer(value)?;
            let Ok(count) = usize::try_from(count) else {
                reader.problem(value.span(), format!("{count} is not a count"), "write 0, 1, 2 and so on");
                return None;
            };
            Some(count)
        }
    };
    let within = match table.get("within") {
        None => None,
        Some(value) => Some(reader.expression(value, |cursor| read_span_from(cursor, scope))?),
    };
    let with = match table.get("with") {
        None => None,
        Some(value) => {
            let scope = Scope { fields: pattern.fields(), ..scope.clone() };
            Some(condition(value, &scope, reader)?)
        }
    };
    Some(Expected::Event { pattern, count, within, with })
}

/// Reads an order of states: `APPROACHING 0, ARRIVED 0, ..., COMPLETE`.
fn read_states(cursor: &mut Cursor<'_>, scope: &Scope) -> Result<Vec<StateStep>, SyntaxError> {
    let mut steps = Vec::new();
    loop {
        if cursor.ellipsis() {
            cursor.term()?;
            steps.push(StateStep::Any);
        } else {
            let start = cursor.at();
            match read_pattern(cursor, scope)? {
                Pattern::State { state, wp, source, reason: None } => {
                    steps.push(StateStep::Enter { state, wp, source });
                }
                _ => {
                    return Err(cursor.error_since(
                        start,
                        "a state is expected here",
                        "write APPROACHING 0, or ...",
                    ));
                }
            }
        }
        if !cursor.comma() {
            return Ok(steps);
        }
    }
}
