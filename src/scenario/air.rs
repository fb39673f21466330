//! The air of a case before its seed is known: a wind may depend on the seed.

use std::collections::BTreeMap;

use super::expression::{Cursor, Number, Scope};
use crate::sim::{Noise, ParseError, Wind};
use crate::telemetry::Turbulence;
use crate::telemetry::quantity::Dimension;

/// The longest wind with its `{…}`, characters. The wind is read once for each seed.
const MAX_WIND: usize = 200;

/// The air and the sensors of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Air {
    /// Seed of all randomness.
    pub seed: u64,
    /// The mean wind.
    pub wind: Wind,
    /// Size of random gusts, m/s.
    pub gust_mps: f64,
    /// Level of turbulence.
    pub turbulence: Turbulence,
    /// Sensor errors on or off.
    pub noise: Noise,
}

/// The text of a wind: `5@270`, or with the seed in it, `{seed % 9}@{37 * seed % 360}`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WindText(String);

/// A mistake in the text of a wind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WindProblem {
    /// The problem, as a part of a sentence.
    pub message: String,
    /// The replacement, for the message; may be empty.
    pub hint: String,
}

impl WindText {
    /// Takes a text.
    ///
    /// # Errors
    /// Fails if it is too long.
    pub fn new(text: String) -> Result<Self, WindProblem> {
        let length = text.chars().count();
        if length > MAX_WIND {
            let message = format!("this wind has {length} characters");
            return Err(WindProblem { message, hint: format!("allowed: {MAX_WIND}") });
        }
        Ok(Self(text))
    }

    /// Returns `true` if the wind may differ from seed to seed.
    pub fn has_seed(&self) -> bool {
        self.0.contains('{')
    }

    /// Returns the wind of a seed.
    ///
    /// # Errors
    /// Returns the mistake in the text.
    pub fn of_seed(&self, seed: u64) -> Result<Wind, WindProblem> {
        let filled = fill(&self.0, seed).map_err(|message| WindProblem {
            message,
            hint: "write {seed % 9}@{37 * seed % 360}".to_owned(),
        })?;
        filled.parse().map_err(|error: ParseError| WindProblem {
            message: error.problem().to_owned(),
            hint: String::new(),
        })
    }
}

/// The air of the flights of a case, apart from their seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct AirTemplate {
    /// The mean wind; `None` = calm.
    pub wind: Option<WindText>,
    /// Size of random gusts, m/s.
    pub gust_mps: f64,
    /// Level of turbulence.
    pub turbulence: Turbulence,
    /// Sensor errors on or off.
    pub noise: Noise,
}

impl AirTemplate {
    /// Returns the air of a seed.
    ///
    /// # Errors
    /// Returns the mistake in the text of the wind.
    pub fn of_seed(&self, seed: u64) -> Result<Air, WindProblem> {
        let wind = self.wind.as_ref().map_or(Ok(Wind::CALM), |wind| wind.of_seed(seed))?;
        let Self { gust_mps, turbulence, noise, .. } = *self;
        Ok(Air { seed, wind, gust_mps, turbulence, noise })
    }

    /// Returns `true` if flights with different seeds differ.
    pub fn is_random(&self) -> bool {
        self.noise != Noise::None
            || self.gust_mps > 0.0
            || self.turbulence != Turbulence::None
            || self.wind.as_ref().is_some_and(WindText::has_seed)
    }
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
        let (number, _) = scope.read_number(&mut cursor).map_err(|error| error.message)?;
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
