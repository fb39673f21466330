//! `[air]` and `seeds`: the air of each flight of a case.

use super::Air;
use super::keys::AIR_KEYS;
use super::reader::{Layers, Reader};
use crate::plan::format::Value;
use crate::scenario::expression::{Cursor, Number, Scope, read_number};
use crate::scenario::quantity::Dimension;
use crate::sim::{Noise, Turbulence, Wind, WorldConfig};
use toml::de::DeValue;

/// Most seeds of a case.
const MAX_SEEDS: u64 = 10_000;

/// The air of each seed.
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
    let of_file = layers.value("seeds").map_or_else(|| vec![usual.seed], |value| read_seeds(value, reader));
    let mut seeds = layers.seeds.map_or(of_file, <[u64]>::to_vec);
    // Without anything random one flight is as good as many.
    let has_template =
        get("wind").and_then(|value| value.get_ref().as_str()).is_some_and(|text| text.contains('{'));
    if noise == Noise::None && gust_mps <= 0.0 && turbulence == Turbulence::None && !has_template {
        seeds.truncate(1);
    }
    seeds
        .into_iter()
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

/// A wind, with the seed put in for `{…}`.
fn read_wind(value: &Value<'_>, seed: u64, reader: &mut Reader<'_, '_>) -> Option<Wind> {
    let text = reader.text(value)?;
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

/// Puts numbers in the place of `{…}`, in which `seed` is known.
fn fill(text: &str, seed: u64) -> Result<String, String> {
    let mut filled = String::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('{') {
        let (inside, after) = behind.split_once('}').ok_or("the } is missing")?;
        let scope = Scope { names: vec![("seed".to_owned(), Dimension::NONE)], ..Scope::default() };
        let mut cursor = Cursor::new(inside);
        let (number, _) = read_number(&mut cursor, &scope).map_err(|error| error.message)?;
        cursor.finish().map_err(|error| error.message)?;
        let value = number_of_seed(&number, seed as f64).ok_or("only seed and numbers are known here")?;
        filled.push_str(before);
        filled.push_str(&value.to_string());
        rest = after;
    }
    Ok(filled + rest)
}

fn number_of_seed(number: &Number, seed: f64) -> Option<f64> {
    number.constant(&|name| (name == "seed").then_some(seed))
}

/// `seeds = 3`, `[1, 2]` or `"1..5"`.
fn read_seeds(value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Vec<u64> {
    let hint = "write seeds = 3, [1, 2, 3] or \"1..5\"";
    let seeds: Vec<u64> = match value.get_ref() {
        DeValue::Array(values) => {
            let mut seeds = Vec::new();
            for value in values {
                let Some(seed) = read_seed(value, reader) else { continue };
                if seeds.contains(&seed) {
                    reader.problem(value.span(), format!("seed {seed} is there twice"), "leave one out");
                }
                seeds.push(seed);
            }
            if seeds.is_empty() && !values.is_empty() {
                return vec![1];
            }
            seeds
        }
        DeValue::Integer(_) => return vec![read_seed(value, reader).unwrap_or(1)],
        _ => match reader.text(value).as_deref().map(seed_range) {
            Some(Ok(seeds)) => seeds.collect(),
            Some(Err(problem)) => {
                reader.problem(value.span(), problem, hint);
                return vec![1];
            }
            None => return vec![1],
        },
    };
    if seeds.is_empty() {
        reader.problem(value.span(), "there is no seed", hint);
        return vec![1];
    }
    seeds
}

fn read_seed(value: &Value<'_>, reader: &mut Reader<'_, '_>) -> Option<u64> {
    let number = reader.integer(value)?;
    let seed = u64::try_from(number).ok();
    if seed.is_none() {
        reader.problem(value.span(), format!("{number} is not a seed"), "write 1, 2 and so on");
    }
    seed
}

/// `1..5`, both included.
///
/// # Errors
/// What is wrong with it.
pub fn seed_range(text: &str) -> Result<std::ops::RangeInclusive<u64>, String> {
    let (from, to) = text.split_once("..").unwrap_or((text, text));
    let number = |text: &str| text.trim().parse::<u64>().map_err(|_| format!("{text} is not a seed"));
    let (from, to) = (number(from)?, number(to)?);
    if from > to || to - from >= MAX_SEEDS {
        return Err(format!("{text} is no range of 1 to {MAX_SEEDS} seeds"));
    }
    Ok(from..=to)
}
