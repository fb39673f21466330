//! The options of `forecast`.

use std::path::PathBuf;
use std::str::FromStr;

use super::value::{self, OutputFile};
use super::{MissionArgs, help};
use crate::plan::format::HomePosition;
use crate::telemetry::Turbulence;

/// The options of `forecast`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct ForecastArgs {
    /// The plan: a built-in name or a file, - for standard input
    pub plan: String,

    /// The wind: SPEED@FROM with its spread, such as 6+-2@250+-20, or the file of a wind rose or a forecast (table FILE)
    /// [default: calm]
    #[arg(long, value_name = "WIND", allow_hyphen_values = true, help_heading = "Air")]
    pub wind: Option<String>,

    /// Strength of random gusts, m/s [default: 0]
    #[arg(long, value_name = "SPEED", allow_negative_numbers = true, value_parser = value::gust, help_heading = "Air")]
    pub gust: Option<f64>,

    /// Turbulence: none, light, moderate, severe [default: none]
    #[arg(long, value_name = "LEVEL", value_parser = value::turbulence, help_heading = "Air")]
    pub turbulence: Option<Turbulence>,

    /// A rare switch of the simulated world, such as battery_sag=on; repeatable
    #[arg(long, value_name = "NAME=VALUE", value_parser = value::world_switch, long_help = help::world_switches(), help_heading = "Air")]
    pub world: Vec<String>,

    /// Airframe: iris, five-inch, or a TOML file [default: iris]
    #[arg(long, value_name = "NAME|FILE", help_heading = "Craft")]
    pub airframe: Option<String>,

    /// Place of the craft at boot: degrees, degrees, metres above sea level [default: as fly]
    #[arg(long, value_name = "LAT,LON[,AMSL]", allow_hyphen_values = true, help_heading = "Craft")]
    pub home: Option<HomePosition>,

    /// CLI lines that are applied at boot as if typed
    #[arg(long, value_name = "FILE", help_heading = "Craft")]
    pub settings: Option<PathBuf>,

    /// The charge at the start, per cent of the battery's capacity, such as 92% or 90+-5% [default: 100%]
    #[arg(long, value_name = "PERCENT", help_heading = "Craft")]
    pub battery: Option<Charge>,

    /// The charge that must be left at the end, per cent of the battery's capacity [default: 20]
    #[arg(long, value_name = "PERCENT", value_parser = percent, help_heading = "Answer")]
    pub reserve: Option<f64>,

    /// The share of successful flights from which on the answer is go, per cent [default: 95]
    #[arg(long, value_name = "PERCENT", value_parser = percent, help_heading = "Answer")]
    pub go_from: Option<f64>,

    /// Writes the answer as one JSON object; - is standard output, in place of the sentence
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,

    /// Writes a report as one HTML file: the answer, distributions, what explains the failures
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub report: Option<PathBuf>,

    /// Number of flights [default: 100]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000), help_heading = "How")]
    pub flights: Option<u64>,

    /// Seed of the first flight [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value::seed, help_heading = "How")]
    pub seed: Option<u64>,

    /// Number of flights at the same time [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), help_heading = "How")]
    pub jobs: Option<u32>,

    /// The flight and the judgement of the plan.
    #[command(flatten)]
    pub mission: MissionArgs,
}

/// The charge of a battery with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Charge {
    pub percent: f64,
    /// The standard deviation, per cent; 0 = the charge is certain.
    pub deviation: f64,
}

impl FromStr for Charge {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim().trim_end_matches('%');
        let parts = text.split_once("+-").or_else(|| text.split_once('±'));
        let (charge, deviation) = parts.unwrap_or((text, "0"));
        let number = |text: &str| {
            text.trim().parse::<f64>().ok().filter(|value| value.is_finite()).ok_or_else(|| {
                format!("{text:?} is not a number; write the charge in per cent, such as 92% or 90+-5%")
            })
        };
        // Messages repeat the text: a number such as 1e308 would have hundreds of digits.
        let (percent, spread) = (number(charge)?, number(deviation)?);
        if !(10.0..=100.0).contains(&percent) {
            return Err(format!("{} % is out of range: 10 to 100 are allowed", charge.trim()));
        }
        if !(0.0..=30.0).contains(&spread) {
            return Err(format!(
                "a deviation of {} % is out of range: 0 to 30 are allowed",
                deviation.trim()
            ));
        }
        Ok(Self { percent, deviation: spread })
    }
}

/// Reads a share in per cent, with or without its sign.
fn percent(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim().parse::<f64>();
    number
        .ok()
        .filter(|value| (0.0..=100.0).contains(value))
        .ok_or_else(|| format!("{text:?} is not a share: 0 to 100 per cent are allowed"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_charge_is_a_share_with_or_without_its_spread() {
        for (text, percent, deviation) in
            [("92%", 92.0, 0.0), ("92", 92.0, 0.0), ("90+-5%", 90.0, 5.0), ("90 ± 5 %", 90.0, 5.0)]
        {
            assert_eq!(text.parse(), Ok(Charge { percent, deviation }), "{text}");
        }
        for text in ["", "full", "5%", "101%", "NaN", "90+-50", "90+-"] {
            assert!(text.parse::<Charge>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_charge_out_of_range_is_refused_in_one_line() {
        for text in ["90+-1e308%", "1e308%", "-1e308", "90+--1e308"] {
            let error = text.parse::<Charge>().expect_err("refused");
            assert!(error.len() < 80 && error.contains("1e308") && error.contains("are allowed"), "{error}");
        }
    }
}
