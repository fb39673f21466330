//! Inputs whose values are numbers: a list, one number, or the text of a distribution.

use toml::de::DeValue;

use super::{choices, scalar};
use crate::design::{Distribution, DistributionError};
use crate::firmware::settings::{Kind, find};
use crate::flight::setup::check_setting;
use crate::plan::format::{TomlTable, Value};
use crate::scenario::file::reader::Reader;
use crate::scenario::varied::{NumberInput, Spread};
use crate::sim::{ScheduledFault, Switches};

/// The latest start of a fault, s after the engagement.
const LATEST_S: f64 = 1e6;

/// Reads the values of an input.
pub(super) fn read(
    input: &NumberInput,
    value: &Value<'_>,
    (low, high): (f64, f64),
    reader: &mut Reader<'_, '_>,
) -> Option<Spread> {
    if matches!(value.get_ref(), DeValue::Array(_)) {
        return choices(value, reader, |value, reader| {
            reader.number_in(Some(value), low, high, "").map(|number| input.change(number))
        });
    }
    let distribution = distribution(value, reader)?.within(low, high);
    let distribution = distribution.map_err(|error| report(value, error, reader)).ok()?;
    Some(Spread::Number(input.clone(), distribution))
}

/// Reads a setting of the firmware.
pub(super) fn read_setting(name: &str, value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Option<Spread> {
    let limits = match find(name).map(|setting| setting.kind) {
        Some(Kind::Number { min, max, .. }) => (min as f64, max as f64),
        Some(_) => {
            reader.problem(value.span(), format!("{name} is not a number"), "write a list of its values");
            return None;
        }
        None => {
            let message = check_setting(name, "0")
                .err()
                .map_or_else(|| format!("the range of {name} is not known"), |fault| fault.message);
            reader.problem(value.span(), message, "write a list of its values");
            return None;
        }
    };
    read(&NumberInput::Setting(name.to_owned()), value, limits, reader)
}

/// Reads a switch of the world.
pub(super) fn read_switch(name: &str, value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Option<Spread> {
    let distribution = distribution(value, reader)?;
    // The limits of a switch are known only by trying.
    for unit in [1.0 - 1e-9, 1e-9] {
        let text = format!("{name}={}", distribution.quantile(unit));
        if let Err(error) = Switches::default().set(&text) {
            reader.problem(value.span(), error.problem().to_owned(), "limit it: 0.5 +- 0.2 in 0..1");
            return None;
        }
    }
    Some(Spread::Number(NumberInput::World(name.to_owned()), distribution))
}

/// Reads the times of a fault, whose name is that of `fault` without its time.
pub(super) fn read_fault(
    name: &str,
    value: &Value<'_>,
    reader: &mut Reader<'_, '_>,
) -> Option<(String, Spread)> {
    let (fault, rest) = name.split_once(',').unwrap_or((name, ""));
    let text = if rest.is_empty() { format!("{fault}@0") } else { format!("{fault}@0,{rest}") };
    let scheduled = match text.parse::<ScheduledFault>() {
        Ok(scheduled) if scheduled.fault.needs_link() => {
            reader.problem(value.span(), format!("{fault} needs an external simulator"), "leave it out");
            return None;
        }
        Ok(scheduled) => scheduled,
        Err(error) => {
            let hint = "write NAME[,FOR][,VALUE], such as \"gps-loss,6\" or \"motor,,2:0.8\"";
            reader.problem(value.span(), error.problem().to_owned(), hint);
            return None;
        }
    };
    let input = NumberInput::FaultTime(scheduled.fault, scheduled.for_s);
    Some((format!("{name}_at_s"), read(&input, value, (0.0, LATEST_S), reader)?))
}

pub(super) fn distribution(value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Option<Distribution> {
    let text = match value.get_ref() {
        DeValue::String(_) | DeValue::Integer(_) | DeValue::Float(_) => scalar(value),
        _ => {
            reader.problem(value.span(), "a distribution is expected here", "write \"4..8\", or [4, 6, 8]");
            return None;
        }
    };
    text.parse().map_err(|error| report(value, error, reader)).ok()
}

fn report(value: &Value<'_>, error: DistributionError, reader: &mut Reader<'_, '_>) {
    reader.problem(value.span(), error.message, error.hint);
}

/// Refuses a key that `[craft]` gives and `[vary]`, too, because both would act.
pub(in crate::scenario::file) fn refuse_both(
    craft: &[TomlTable<'_, '_>],
    vary: &TomlTable<'_, '_>,
    key: &str,
    reader: &mut Reader<'_, '_>,
) {
    if let Some(value) = vary.get(key).filter(|_| craft.iter().any(|table| table.get(key).is_some())) {
        let message = format!("{key} is in [craft] and in [vary]");
        reader.problem(value.span(), message, "leave one out: both would act");
    }
}
