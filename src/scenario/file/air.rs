//! `[air]` and `seeds`: the air of each flight of a case.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;

use super::Air;
use super::keys::AIR_KEYS;
use super::reader::{Layers, Reader};
use crate::plan::format::{TomlTable, Value};
use crate::scenario::air::{AirTemplate, WindProblem, WindText};
use crate::scenario::campaign_spec::FlightSeeds;
use crate::sim::{Noise, Wind, WorldConfig};
use crate::telemetry::Turbulence;
use toml::de::DeValue;

/// The most seeds of a case.
pub const MAX_SEEDS: u64 = 1_000_000;

/// Returns the air of each seed.
pub(super) fn read(layers: &Layers<'_, '_>, reader: &mut Reader<'_, '_>) -> Vec<Air> {
    if layers.is_drawn {
        let (template, seeds) = read_drawn(layers, reader);
        return template.of_seed(seeds.at(0)).into_iter().collect();
    }
    let (template, wind_value) = template(layers, reader);
    let seeds_value = layers.value("seeds");
    let of_file = seeds_value.map_or_else(
        || Seeds::One(WorldConfig::default().seed),
        |value| {
            // Replaced seeds are not flown, so any number of them is allowed.
            let most = if layers.seeds.is_some() { usize::MAX } else { reader.max_flights };
            read_seeds(value, most, reader)
        },
    );
    let seeds = layers.seeds.map_or(of_file, Seeds::Given);
    // Without randomness one flight is enough.
    let wanted = if template.is_random() { seeds.count() } else { 1 };
    let place = seeds_value.map(toml::Spanned::span).or(layers.case.map(TomlTable::span)).unwrap_or(0..0);
    // Too many flights are reported after all cases are counted. They are not created.
    let made = if reader.take_flights(wanted, place) { wanted } else { 1 };
    seeds
        .iter()
        .take(made)
        .map(|seed| {
            template.of_seed(seed).unwrap_or_else(|WindProblem { message, hint }| {
                reader.problem(wind_value.map_or(0..0, toml::Spanned::span), message, hint);
                Air { seed, ..Air::default() }
            })
        })
        .collect()
}

/// Returns the air of a case of a campaign, and the seeds of its flights.
pub(super) fn read_drawn(layers: &Layers<'_, '_>, reader: &mut Reader<'_, '_>) -> (AirTemplate, FlightSeeds) {
    let (template, wind_value) = template(layers, reader);
    let given = layers.seeds.map(|seeds| FlightSeeds::List(seeds.to_vec()));
    let seeds = given.unwrap_or_else(|| match layers.value("seeds") {
        None => FlightSeeds::From(WorldConfig::default().seed),
        Some(value) => read_flight_seeds(value, reader),
    });
    if let Err(WindProblem { message, hint }) = template.of_seed(seeds.at(0)) {
        reader.problem(wind_value.map_or(0..0, toml::Spanned::span), message, hint);
    }
    (template, seeds)
}

/// Returns the air without the seed, and the place of its wind.
fn template<'l, 't>(
    layers: &Layers<'l, 't>,
    reader: &mut Reader<'_, '_>,
) -> (AirTemplate, Option<&'l Value<'t>>) {
    let section = layers.tables("air", reader);
    for table in &section {
        reader.refuse_unknown(table, AIR_KEYS);
    }
    let usual = WorldConfig::default();
    let get = |key| layers.of_section(&section, key);
    let gust_mps = reader.number_in(get("gust_mps"), 0.0, Wind::MAX_MPS, "m/s").unwrap_or(usual.gust_mps);
    let turbulence = word(get("turbulence"), reader, turbulence);
    let noise = word(get("noise"), reader, noise);
    let wind_value = get("wind");
    let wind = wind_value.and_then(|value| {
        let text = reader.text(value)?;
        WindText::new(text)
            .map_err(|WindProblem { message, hint }| reader.problem(value.span(), message, hint))
            .ok()
    });
    let noise = noise.unwrap_or(usual.noise);
    (AirTemplate { wind, gust_mps, turbulence: turbulence.unwrap_or_default(), noise }, wind_value)
}

pub(super) fn turbulence(text: &str) -> Result<Turbulence, String> {
    Turbulence::parse(text).map_err(|error| error.problem().to_owned())
}

pub(super) fn noise(text: &str) -> Result<Noise, String> {
    Noise::parse(text).map_err(|error| error.problem().to_owned())
}

pub(super) fn word<T>(
    value: Option<&Value<'_>>,
    reader: &mut Reader<'_, '_>,
    parse: impl Fn(&str) -> Result<T, String>,
) -> Option<T> {
    let value = value?;
    let text = reader.text(value)?;
    parse(&text).map_err(|problem| reader.problem(value.span(), problem, "")).ok()
}

/// Reads `seeds = 3`, `[1, 2]` or `"1..5"`. Of `"5.."`, which a campaign takes on and on, only the first is taken. At most
/// `most` seeds are allowed.
fn read_seeds<'s>(value: &Value<'_>, most: usize, reader: &mut Reader<'_, '_>) -> Seeds<'s> {
    let hint = "write seeds = 3, [1, 2, 3] or \"1..5\"";
    if let Some(first) = first_of_all(value) {
        return Seeds::One(first);
    }
    match value.get_ref() {
        DeValue::Array(values) if values.is_empty() => {
            reader.problem(value.span(), "there is no seed", hint);
        }
        DeValue::Array(values) if !is_few(values.len(), most, value, reader) => {}
        DeValue::Array(values) => {
            let (mut seeds, mut seen) = (Vec::new(), BTreeSet::new());
            for value in values {
                let Some(seed) = read_seed(value, reader) else { continue };
                if !seen.insert(seed) {
                    reader.problem(value.span(), format!("seed {seed} is listed twice"), "leave one out");
                }
                seeds.push(seed);
            }
            if !seeds.is_empty() {
                return Seeds::List(seeds);
            }
        }
        DeValue::Integer(_) => return Seeds::One(read_seed(value, reader).unwrap_or(1)),
        _ => match reader.text(value).as_deref().map(seed_range) {
            Some(Ok(seeds)) => {
                let count = seeds.end() - seeds.start() + 1;
                if is_few(usize::try_from(count).unwrap_or(usize::MAX), most, value, reader) {
                    return Seeds::Range(seeds);
                }
            }
            Some(Err(problem)) => reader.problem(value.span(), problem, hint),
            None => {}
        },
    }
    Seeds::One(1)
}

/// Reads the seeds of a campaign's flights: as [`read_seeds`], or `"5.."` for all seeds from 5 on.
fn read_flight_seeds(value: &Value<'_>, reader: &mut Reader<'_, '_>) -> FlightSeeds {
    if let Some(first) = first_of_all(value) {
        return FlightSeeds::From(first);
    }
    match read_seeds(value, MAX_SEEDS as usize, reader) {
        Seeds::One(seed) => FlightSeeds::List(vec![seed]),
        Seeds::Range(seeds) => FlightSeeds::Range(seeds),
        Seeds::List(seeds) => FlightSeeds::List(seeds),
        Seeds::Given(seeds) => FlightSeeds::List(seeds.to_vec()),
    }
}

/// Returns the first seed of `"5.."`.
fn first_of_all(value: &Value<'_>) -> Option<u64> {
    value.get_ref().as_str()?.trim().strip_suffix("..")?.trim().parse().ok()
}

/// Returns `true` if the count is at most `max`; otherwise notes a problem.
fn is_few(count: usize, max: usize, value: &Value<'_>, reader: &mut Reader<'_, '_>) -> bool {
    if count > max {
        let hint = format!("allowed: {max}; take fewer, or add --max-flights {count}");
        reader.problem(value.span(), format!("there are {count} seeds"), hint);
    }
    count <= max
}

/// The seeds of a case, not yet expanded.
enum Seeds<'s> {
    One(u64),
    Range(RangeInclusive<u64>),
    List(Vec<u64>),
    Given(&'s [u64]),
}

impl Seeds<'_> {
    fn count(&self) -> usize {
        self.iter().size_hint().0
    }

    fn iter(&self) -> Box<dyn Iterator<Item = u64> + '_> {
        match self {
            Self::One(seed) => Box::new(std::iter::once(*seed)),
            Self::Range(seeds) => Box::new(seeds.clone()),
            Self::List(seeds) => Box::new(seeds.iter().copied()),
            Self::Given(seeds) => Box::new(seeds.iter().copied()),
        }
    }
}

fn read_seed(value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Option<u64> {
    let number = reader.integer(value)?;
    let seed = u64::try_from(number).ok();
    if seed.is_none() {
        reader.problem(value.span(), format!("{number} is not a seed"), "write 1, 2 and so on");
    }
    seed
}

/// Reads a range of seeds: `1..5`, both included.
///
/// # Errors
/// Returns the mistake in the text.
pub fn seed_range(text: &str) -> Result<RangeInclusive<u64>, String> {
    let (from, to) = text.split_once("..").unwrap_or((text, text));
    let number = |text: &str| text.trim().parse::<u64>().map_err(|_| format!("{text} is not a seed"));
    let (from, to) = (number(from)?, number(to)?);
    if from > to || to - from >= MAX_SEEDS {
        return Err(format!("{text} is not a range of 1 to {MAX_SEEDS} seeds"));
    }
    Ok(from..=to)
}
