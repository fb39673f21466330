//! The configuration of a world at boot, with the parsers of the command-line values.

use std::sync::Arc;

use strum::VariantNames;

use super::airframe::Airframe;
use super::error::WorldError;
use super::fault::ScheduledFault;
use super::switches::Switches;
use super::value_text::ParseError;
use super::wind::Wind;
use crate::telemetry::Turbulence;
use crate::terrain::Tiles;
use crate::text::did_you_mean;

mod home;

pub use home::Home;

/// The step rates that a world accepts, Hz. Each divides a hundredth of a second into whole steps.
pub const STEP_RATES_HZ: [u32; 6] = [400, 500, 1000, 2000, 4000, 8000];

/// Everything that a [`World`](super::World) needs to know at boot.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldConfig {
    /// The craft.
    pub airframe: Airframe,
    /// Place and heading at boot.
    pub home: Home,
    /// Steps per second, one of [`STEP_RATES_HZ`].
    pub rate_hz: u32,
    /// Seed of all randomness.
    pub seed: u64,
    /// Sensor errors on or off.
    pub noise: Noise,
    /// The mean wind.
    pub wind: Wind,
    /// Strength of random gusts, m/s; 0 for none.
    pub gust_mps: f64,
    /// Level of turbulence.
    pub turbulence: Turbulence,
    /// Rare switches.
    pub switches: Switches,
    /// Scheduled faults.
    pub faults: Vec<ScheduledFault>,
    /// Elevation tiles for the ground `terrain`.
    pub terrain: Option<Arc<Tiles>>,
}

impl Default for WorldConfig {
    /// Returns an `iris` in calm air at the default home, 1 kHz, seed 1, real noise.
    fn default() -> Self {
        Self {
            airframe: Airframe::iris(),
            home: Home::default(),
            rate_hz: 1000,
            seed: 1,
            noise: Noise::Real,
            wind: Wind::CALM,
            gust_mps: 0.0,
            turbulence: Turbulence::None,
            switches: Switches::default(),
            faults: Vec::new(),
            terrain: None,
        }
    }
}

/// Returns the length of a step at a rate, µs.
///
/// # Errors
/// Fails if the rate is not one of [`STEP_RATES_HZ`].
pub fn step_us(rate_hz: u32) -> Result<u64, WorldError> {
    if STEP_RATES_HZ.contains(&rate_hz) {
        Ok(1_000_000 / u64::from(rate_hz))
    } else if rate_hz < STEP_RATES_HZ[0] {
        Err(WorldError::StepTooLong(rate_hz))
    } else {
        Err(WorldError::OddRate(rate_hz))
    }
}

/// Sensor errors on or off.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, strum::EnumString, strum::VariantNames,
)]
#[strum(serialize_all = "lowercase")]
pub enum Noise {
    /// Typical hobby-grade sensors: noise, bias, drift, latency and time to the first fix.
    #[default]
    Real,
    /// Exact values without delay.
    None,
}

impl Noise {
    /// Returns the level with this name.
    ///
    /// # Errors
    /// Fails if there is none.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        text.parse().map_err(|_| one_of("noise", text, Self::VARIANTS))
    }
}

impl Turbulence {
    /// Returns the level with this name.
    ///
    /// # Errors
    /// Fails if there is none.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        text.parse().map_err(|_| one_of("turbulence", text, Self::VARIANTS))
    }

    /// Returns the wind at 20 ft for the level, kt: 15, 30 and 45 kt as in MIL-F-8785C.
    pub fn wind_at_20ft_kt(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Light => 15.0,
            Self::Moderate => 30.0,
            Self::Severe => 45.0,
        }
    }
}

pub(super) fn one_of(what: &'static str, text: &str, names: &[&'static str]) -> ParseError {
    let hint = did_you_mean::suffix(text, names.iter().copied());
    ParseError::new(what, text, format!("allowed are {}{hint}", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_suggested() {
        assert_eq!(Turbulence::parse("light"), Ok(Turbulence::Light));
        let error = Turbulence::parse("sever").unwrap_err().to_string();
        assert_eq!(
            error,
            "turbulence \"sever\": allowed are none, light, moderate, severe; did you mean severe?"
        );
        assert_eq!(Noise::parse("none"), Ok(Noise::None));
    }

    #[test]
    fn long_steps_are_refused_with_the_reason() {
        assert_eq!(step_us(8000), Ok(125));
        assert!(step_us(399).unwrap_err().to_string().contains("2.5 ms"));
        assert!(step_us(1500).unwrap_err().to_string().contains("choose 400, 500, 1000"));
    }
}
