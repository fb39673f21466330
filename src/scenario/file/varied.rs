//! `[vary]` of a campaign: each key is an input with a list of values, a distribution or a table of winds.

mod number;
mod wind;

pub(super) use number::refuse_both;

use toml::de::DeValue;

use super::air;
use super::craft::airframe_named;
use super::keys::{OF_FAULTS, VARY_KEYS};
use super::reader::Reader;
use super::variant::scalar;
use crate::flight::setup::check_setting;
use crate::plan::format::{TomlTable, Value, setting_line};
use crate::scenario::varied::{Change, Choice, NumberInput, Spread, Tolerance, VariedInput};
use crate::sim::{STEP_RATES_HZ, Switches};

/// The most values of one input.
const MAX_CHOICES: usize = 10_000;
/// The most inputs.
const MAX_INPUTS: usize = 200;

/// Returns `true` if a file varies something other than lists, so that its flights are drawn.
pub(super) fn is_drawn(top: &TomlTable<'_, '_>) -> bool {
    let table = match top.get("vary").map(toml::Spanned::get_ref) {
        Some(DeValue::Table(table)) => table,
        _ => return false,
    };
    table.values().any(|value| !matches!(value.get_ref(), DeValue::Array(_)))
}

/// Reads all inputs, in the order of their names.
pub(super) fn read(top: &TomlTable<'_, '_>, reader: &mut Reader<'_, '_>) -> Vec<VariedInput> {
    let Some(table) = top.get("vary").and_then(|value| reader.table("vary", value)) else {
        return Vec::new();
    };
    reader.refuse_unknown(&table, VARY_KEYS);
    let mut inputs = Vec::new();
    for (key, _, value) in table.keys().filter(|(key, ..)| VARY_KEYS.contains(key)) {
        match key {
            "settings" | "world" | OF_FAULTS if value.get_ref().is_table() => {
                let Some(inner) = reader.table(key, value) else { continue };
                for (name, span, value) in inner.keys() {
                    if inputs.iter().any(|known: &VariedInput| known.name == name) {
                        reader.problem(span, format!("{name} is varied twice"), "leave one out");
                    } else if let Some((name, spread)) = inner_input(key, name, value, reader) {
                        inputs.push(VariedInput { name, spread });
                    }
                }
            }
            _ => {
                if let Some(spread) = input(key, value, reader) {
                    inputs.push(VariedInput { name: key.to_owned(), spread });
                }
            }
        }
    }
    if inputs.len() > MAX_INPUTS {
        let message = format!("{} inputs are varied", inputs.len());
        reader.problem(table.span(), message, format!("allowed: {MAX_INPUTS}"));
        inputs.truncate(MAX_INPUTS);
    }
    inputs.sort_by(|a, b| a.name.cmp(&b.name));
    inputs
}

/// Reads an input of `[vary]` itself.
fn input(key: &str, value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Option<Spread> {
    if key == "wind" {
        return wind::read(value, reader);
    }
    if let Some((input, low, high)) = number_input(key) {
        return number::read(&input, value, (low, high), reader);
    }
    choices(value, reader, |value, reader| {
        let text = || value.get_ref().as_str();
        let word = |change: Result<Change, String>, reader: &mut Reader<'_, '_>| {
            change.map_err(|problem| reader.problem(value.span(), problem, "")).ok()
        };
        match key {
            "rate_hz" => {
                let rate = reader.integer(value)?;
                let rate = u32::try_from(rate).ok().filter(|rate| STEP_RATES_HZ.contains(rate));
                let rate = rate.ok_or_else(|| {
                    let allowed = STEP_RATES_HZ.map(|rate| rate.to_string()).join(", ");
                    format!("this is not a step rate; allowed: {allowed}")
                });
                word(rate.map(Change::Rate), reader)
            }
            "turbulence" => word(air::turbulence(&reader.text(value)?).map(Change::Turbulence), reader),
            "noise" => word(air::noise(&reader.text(value)?).map(Change::Noise), reader),
            "airframe" => {
                let name = reader.text(value)?;
                let airframe = airframe_named(&name, reader);
                word(airframe.map(|airframe| Change::Airframe(Box::new(airframe))), reader)
            }
            "world" => word(world(&reader.text(value)?), reader),
            "settings" => {
                reader.text(value)?;
                setting(text().unwrap_or_default(), value, reader)
            }
            _ => None,
        }
    })
}

/// Reads an input of a table inside `[vary]`.
fn inner_input(
    table: &str,
    name: &str,
    value: &Value<'_>,
    reader: &mut Reader<'_, '_>,
) -> Option<(String, Spread)> {
    let spread = match table {
        "settings" => match value.get_ref() {
            DeValue::Array(_) => choices(value, reader, |value, reader| {
                setting(&format!("{name} = {}", scalar(value)), value, reader)
            })?,
            _ => number::read_setting(name, value, reader)?,
        },
        "world" => match value.get_ref() {
            DeValue::Array(_) => choices(value, reader, |value, reader| {
                world(&format!("{name}={}", scalar(value)))
                    .map_err(|problem| reader.problem(value.span(), problem, ""))
                    .ok()
            })?,
            _ => number::read_switch(name, value, reader)?,
        },
        _ => return number::read_fault(name, value, reader),
    };
    Some((name.to_owned(), spread))
}

/// Returns the input of a key whose values are numbers, with its limits.
fn number_input(key: &str) -> Option<(NumberInput, f64, f64)> {
    use strum::IntoEnumIterator as _;
    Some(match key {
        "gust_mps" => (NumberInput::Gust, 0.0, 60.0),
        "takeoff_m" => (NumberInput::Takeoff, 0.0, 500.0),
        "heading_deg" => (NumberInput::Heading, -360.0, 360.0),
        _ => {
            let of = Tolerance::iter().find(|of| of.key() == key)?;
            (NumberInput::Tolerance(of), -90.0, 900.0)
        }
    })
}

/// Reads a list of values.
fn choices(
    value: &Value<'_>,
    reader: &mut Reader<'_, '_>,
    mut read: impl FnMut(&Value<'_>, &mut Reader<'_, '_>) -> Option<Change>,
) -> Option<Spread> {
    let DeValue::Array(values) = value.get_ref() else {
        reader.problem(value.span(), "a list is expected here", "write [\"…\", \"…\"]");
        return None;
    };
    if values.is_empty() || values.len() > MAX_CHOICES {
        let message = format!("there are {} values", values.len());
        reader.problem(value.span(), message, format!("allowed: 1 to {MAX_CHOICES}"));
        return None;
    }
    let choices = values
        .iter()
        .filter_map(|value| Some(Choice { shown: scalar(value), change: read(value, reader)? }))
        .collect::<Vec<_>>();
    (!choices.is_empty()).then_some(Spread::Choice(choices))
}

fn world(text: &str) -> Result<Change, String> {
    let set = Switches::default().set(text);
    set.map(|()| Change::World(text.to_owned())).map_err(|error| error.problem().to_owned())
}

fn setting(text: &str, value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Option<Change> {
    let Some(line) = setting_line(text) else {
        reader.problem(value.span(), "this is not a setting", "write \"ap_max_angle = 25\"");
        return None;
    };
    let (name, number) = line.split_once(" = ")?;
    match check_setting(name, number) {
        Ok(()) => Some(Change::Setting(line)),
        Err(fault) => {
            reader.problem(value.span(), fault.message, fault.hint);
            None
        }
    }
}
