//! `[air]` and `seeds`: the air of each flight of a case.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use super::Air;
use super::keys::AIR_KEYS;
use super::reader::{Layers, Reader};
use crate::plan::format::{TomlTable, Value};
use crate::scenario::expression::{Cursor, Number, Scope, read_number};
use crate::sim::{Noise, Wind, WorldConfig};
use crate::telemetry::Turbulence;
use crate::telemetry::quantity::Dimension;
use toml::de::DeValue;

/// The most seeds of a case.
const MAX_SEEDS: u64 = 1_000_000;
/// The longest wind with its `{…}`, characters. The wind is read once for each seed.
const MAX_WIND: usize = 200;

/// Returns the air of each seed.
pub(super) fn read(layers: &Layers<'_, '_>, reader: &mut Reader<'_, '_>) -> Vec<Air> {
    let section = layers.tables("air", reader);
    for table in &section {
        reader.refuse_unknown(table, AIR_KEYS);
    }
    let usual = WorldConfig::default();
    let get = |key| layers.of_section(&section, key);
    let gust_mps = reader.number_in(get("gust_mps"), 0.0, Wind::MAX_MPS, "m/s").unwrap_or(usual.gust_mps);
    let turbulence =
        word(get("turbulence"), reader, |text| Turbulence::parse(text).map_err(|e| e.problem().to_owned()));
    let noise = word(get("noise"), reader, |text| Noise::parse(text).map_err(|e| e.problem().to_owned()));
    let noise = noise.unwrap_or(usual.noise);
    let turbulence = turbulence.unwrap_or_default();
    let seeds_value = layers.value("seeds");
    let of_file = seeds_value.map_or_else(
        || Seeds::One(usual.seed),
        |value| {
            // Replaced seeds are not flown, so any number of them is allowed.
            let most = if layers.seeds.is_some() { usize::MAX } else { reader.max_flights };
            read_seeds(value, most, reader)
        },
    );
    let seeds = layers.seeds.map_or(of_file, Seeds::Given);
    // Without randomness one flight is enough.
    let has_template =
        get("wind").and_then(|value| value.get_ref().as_str()).is_some_and(|text| text.contains('{'));
    let is_random = noise != Noise::None || gust_mps > 0.0 || turbulence != Turbulence::None || has_template;
    let wanted = if is_random { seeds.count() } else { 1 };
    let place = seeds_value.map(toml::Spanned::span).or(layers.case.map(TomlTable::span)).unwrap_or(0..0);
    // Too many flights are reported after all cases are counted. They are not created.
    let made = if reader.take_flights(wanted, place) { wanted } else { 1 };
    seeds
        .iter()
        .take(made)
        .map(|seed| {
            let wind = get("wind").and_then(|value| read_wind(value, seed, reader)).unwrap_or(usual.wind);
            Air { seed, wind, gust_mps, turbulence, noise }
        })
        .collect()
}

fn word<T>(
    value: Option<&Value<'_>>,
    reader: &mut Reader<'_, '_>,
    parse: impl Fn(&str) -> Result<T, String>,
) -> Option<T> {
    let value = value?;
    let text = reader.text(value)?;
    parse(&text).map_err(|problem| reader.problem(value.span(), problem, "")).ok()
}

/// Reads a wind and puts the seed in the place of `{…}`.
fn read_wind(value: &Value<'_>, seed: u64, reader: &mut Reader<'_, '_>) -> Option<Wind> {
    let text = reader.text(value)?;
    let length = text.chars().count();
    if length > MAX_WIND {
        let message = format!("this wind has {length} characters");
        reader.problem(value.span(), message, format!("allowed: {MAX_WIND}"));
        return None;
    }
    let filled = match fill(&text, seed) {
        Ok(filled) => filled,
        Err(problem) => {
            reader.problem(value.span(), problem, "write {seed % 9}@{37 * seed % 360}");
            return None;
        }
    };
    filled
        .parse()
        .map_err(|error: crate::sim::ParseError| reader.problem(value.span(), error.problem().to_owned(), ""))
        .ok()
}

/// Puts numbers in the place of `{…}`, which may use `seed`.
fn fill(text: &str, seed: u64) -> Result<String, String> {
    let mut filled = String::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('{') {
        let (inside, after) = behind.split_once('}').ok_or("the } is missing")?;
        let scope = Scope {
            names: BTreeMap::from([("seed".to_owned(), Dimension::NONE)]).into(),
            ..Scope::default()
        };
        let mut cursor = Cursor::new(inside);
        let (number, _) = read_number(&mut cursor, &scope).map_err(|error| error.message)?;
        cursor.finish().map_err(|error| error.message)?;
        let value = number_of_seed(&number, seed as f64).ok_or("only seed and numbers are allowed here")?;
        filled.push_str(before);
        filled.push_str(&value.to_string());
        rest = after;
    }
    Ok(filled + rest)
}

fn number_of_seed(number: &Number, seed: f64) -> Option<f64> {
    number.constant(&|name| (name == "seed").then_some(seed))
}

/// Reads `seeds = 3`, `[1, 2]` or `"1..5"`.
/// At most `most` seeds are allowed.
fn read_seeds<'s>(value: &Value<'_>, most: usize, reader: &mut Reader<'_, '_>) -> Seeds<'s> {
    let hint = "write seeds = 3, [1, 2, 3] or \"1..5\"";
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
