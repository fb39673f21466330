//! `wind` in `[vary]`: a list, a distribution of speed and direction, a rose or a forecast.

use toml::de::DeValue;

use super::choices;
use crate::design::{Distribution, DistributionError, WindTable};
use crate::plan::format::Value;
use crate::scenario::air::{WindProblem, WindText};
use crate::scenario::file::reader::Reader;
use crate::scenario::varied::{Change, Spread};
use crate::sim::Wind;

/// The forms of a wind, for messages.
const HINT: &str = "write \"6+-2@250+-20\", \"weibull(6, 2)@0..360\", \"table rose.csv\", or a list of winds";
/// The word before the name of a file.
const TABLE: &str = "table ";

pub(super) fn read(value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Option<Spread> {
    if matches!(value.get_ref(), DeValue::Array(_)) {
        return choices(value, reader, |value, reader| {
            let text = reader.text(value)?;
            let wind = WindText::new(text).and_then(|wind| wind.of_seed(1).map(|_| wind));
            wind.map_err(|WindProblem { message, hint }| reader.problem(value.span(), message, hint))
                .ok()
                .map(Change::Wind)
        });
    }
    let text = reader.text(value)?;
    if let Some(name) = text.trim().strip_prefix(TABLE) {
        let table = reader.file(name.trim()).and_then(WindTable::parse);
        return table
            .map_err(|problem| reader.problem(value.span(), format!("{}: {problem}", name.trim()), ""))
            .ok()
            .map(Spread::Table);
    }
    distributions(&text)
        .map_err(|error| reader.problem(value.span(), error.message, error.hint))
        .ok()
        .map(|(speed, from)| Spread::Wind { speed, from })
}

/// Reads `SPEED@FROM`, each a distribution.
fn distributions(text: &str) -> Result<(Distribution, Distribution), DistributionError> {
    let (speed, from) = text.split_once('@').ok_or_else(|| DistributionError {
        message: "the direction it blows from is missing".to_owned(),
        hint: HINT.to_owned(),
    })?;
    let speed = speed.parse::<Distribution>()?.within(0.0, Wind::MAX_MPS)?;
    Ok((speed, from.parse()?))
}
