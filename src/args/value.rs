//! Values of options, with the messages for invalid ones.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;

use crate::plan::format::{Format, setting_line};
use crate::sim::{Noise, ParseError, ScheduledFault, Switches, Wind, step_us};
use crate::telemetry::{FirmwareProfile, Turbulence};

/// A switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum OnOff {
    /// On.
    On,
    /// Off.
    Off,
}

impl OnOff {
    /// Returns `true` for on.
    pub fn is_on(self) -> bool {
        self == Self::On
    }
}

/// The source of the firmware's attitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum AttitudeChoice {
    /// Estimated from the sensors.
    Estimated,
    /// The simulator's truth.
    Truth,
}

/// The speed as a multiple of real time; infinite = as fast as the machine allows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speed(pub f64);

/// The slowest and the fastest allowed factor.
const SPEED_RANGE: std::ops::RangeInclusive<f64> = 0.05..=1000.0;

impl FromStr for Speed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("max") {
            return Ok(Self(f64::INFINITY));
        }
        match text.parse::<f64>() {
            Ok(factor) if SPEED_RANGE.contains(&factor) => Ok(Self(factor)),
            Ok(factor) if factor.is_finite() => {
                Err("allowed are 0.05 to 1000 times real time, or max".to_owned())
            }
            _ => Err("write a factor such as 2 (twice real time), or max".to_owned()),
        }
    }
}

/// A file to write, or `-` for standard output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum OutputFile {
    /// Standard output.
    Stdout,
    /// A file.
    File(PathBuf),
}

impl FromStr for OutputFile {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "" => Err("write a file name, or - for standard output".to_owned()),
            "-" => Ok(Self::Stdout),
            file => Ok(Self::File(file.into())),
        }
    }
}

/// Reads a finite number in a range.
fn bounded(text: &str, low: f64, high: f64, unit: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        Ok(value) if value.is_finite() => {
            Err(format!("{text} is out of range; allowed are {low} to {high} {unit}"))
        }
        _ => Err(format!("{text} is not a number; allowed are {low} to {high} {unit}")),
    }
}

/// Reads the seconds of simulated time until a flight is given up.
pub(super) fn timeout(text: &str) -> Result<f64, String> {
    bounded(text, 1.0, 1e6, "s")
}

/// Reads the altitude above home above which a waypoint gets a warning, m.
pub(super) fn max_altitude(text: &str) -> Result<f64, String> {
    bounded(text, 1.0, 10_000.0, "m")
}

/// Reads the clearance above the ground below which a leg gets a warning, m.
pub(super) fn clearance(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 1000.0, "m")
}

/// Reads the height of the pilot's climb, m.
pub(super) fn takeoff(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 500.0, "m")
}

/// Reads the allowed error of the true position, m.
pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 100_000.0, "m")
}

/// Reads a heading, degrees.
pub(super) fn heading(text: &str) -> Result<f64, String> {
    bounded(text, -360.0, 360.0, "degrees")
}

/// Reads the size of random gusts, m/s.
pub(super) fn gust(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, Wind::MAX_MPS, "m/s")
}

/// Reads the number of samples a second.
pub(super) fn samples(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 1000.0, "Hz")
}

/// Reads the number of points of a track a second.
pub(super) fn track_rate(text: &str) -> Result<f64, String> {
    bounded(text, 0.01, 50.0, "Hz")
}

/// Reads the number of steps a second.
pub(super) fn rate(text: &str) -> Result<u32, String> {
    let rate = text.parse().map_err(|_| format!("{text} is not a whole number of Hz"))?;
    step_us(rate).map(|_| rate).map_err(|error| error.to_string())
}

/// Reads the sensor noise.
pub(super) fn noise(text: &str) -> Result<Noise, ParseError> {
    Noise::parse(text)
}

/// Reads the level of turbulence.
pub(super) fn turbulence(text: &str) -> Result<Turbulence, ParseError> {
    Turbulence::parse(text)
}

/// Reads the name of a profile of the autopilot.
pub(super) fn profile(text: &str) -> Result<FirmwareProfile, &'static str> {
    text.parse().map_err(|_| "write guide or master")
}

/// Checks a switch of the world and returns it as text. The switches are joined later, in their order.
pub(super) fn world_switch(text: &str) -> Result<String, ParseError> {
    Switches::default().set(text).map(|()| text.to_owned())
}

/// Reads a fault, `NAME@T[,FOR][,VALUE]`.
pub(super) fn fault(text: &str) -> Result<ScheduledFault, String> {
    text.parse().map_err(|error: ParseError| error.problem().to_owned())
}

/// Reads the loss of the RC link at `T[,FOR]`.
pub(super) fn rx_loss(text: &str) -> Result<ScheduledFault, String> {
    fault(&format!("rx-loss@{text}"))
}

/// Reads the loss of the GPS at `T[,FOR]`.
pub(super) fn gps_loss(text: &str) -> Result<ScheduledFault, String> {
    fault(&format!("gps-loss@{text}"))
}

/// Reads a setting `NAME=VALUE` and returns it as `name = value`. The firmware that flies knows the valid names.
pub(super) fn setting(text: &str) -> Result<String, String> {
    setting_line(text).ok_or_else(|| "write NAME=VALUE, such as ap_max_angle=25".to_owned())
}

/// Reads the seed of all randomness.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| format!("{text} is not a seed; allowed are whole numbers from 0 to {}", u64::MAX))
}

/// The error for a map without a report.
pub(super) const BACKDROP_NEEDS_REPORT: &str = "--backdrop needs --report: it is the map under its track";

/// Reads the path of a file to write, which cannot be standard output.
pub(super) fn output_path(text: &str) -> Result<PathBuf, String> {
    match text {
        "" => Err("write a file name".to_owned()),
        "-" => Err("this goes to a file, not to standard output; write a file name".to_owned()),
        file => Ok(file.into()),
    }
}

/// An instant of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instant {
    /// Seconds after the first engagement.
    Engagement(f64),
    /// Seconds after boot.
    Boot(f64),
}

/// Reads an instant, `T` or `boot+T`.
pub(super) fn instant(text: &str) -> Result<Instant, String> {
    match text.strip_prefix("boot+") {
        Some(seconds) => bounded(seconds, 0.0, 1e9, "s").map(Instant::Boot),
        None => bounded(text, -1e9, 1e9, "s").map(Instant::Engagement),
    }
}

/// An instant of a recorded flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RecordInstant {
    /// Seconds since the first instant of the record.
    Start(f64),
    /// Seconds after boot, as the screen shows them.
    Boot(f64),
}

/// Reads an instant, `T` or `boot+T`.
pub(super) fn record_instant(text: &str) -> Result<RecordInstant, String> {
    match text.strip_prefix("boot+") {
        Some(seconds) => bounded(seconds, 0.0, 1e9, "s").map(RecordInstant::Boot),
        None => bounded(text, 0.0, 1e9, "s").map(RecordInstant::Start),
    }
}

/// Reads the number of a flight in a file, from 1.
pub(super) fn log_number(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "flights are counted from 1: write 1, 2 and so on".to_owned())
}

/// Reads the number of rows of a table a second.
pub(super) fn table_rate(text: &str) -> Result<f64, String> {
    bounded(text, 0.01, 50_000.0, "Hz")
}

/// Seeds of flights.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seeds(pub Vec<u64>);

/// Reads a time on the wall clock, s: `90`, `120s`, `10min`, `2h`.
pub(super) fn wall_time(text: &str) -> Result<f64, String> {
    let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let scale = match &text[number.len()..] {
        "" | "s" => 1.0,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return Err("write a time such as 120s, 10min or 2h".to_owned()),
    };
    let seconds =
        number.parse::<f64>().map_err(|_| "write a time such as 120s, 10min or 2h".to_owned())? * scale;
    let allowed = (1.0..=86_400.0).contains(&seconds);
    allowed.then_some(seconds).ok_or_else(|| "allowed are 1 s to 24 h".to_owned())
}

/// Reads seeds, `A..B`.
pub(super) fn seeds(text: &str) -> Result<Seeds, String> {
    crate::scenario::seed_range(text)
        .map(|seeds| Seeds(seeds.collect()))
        .map_err(|problem| format!("{problem}; write 1..20, both included"))
}

/// Reads an altitude above home, m.
pub(super) fn altitude(text: &str) -> Result<f64, String> {
    bounded(text, -20_000.0, 20_000.0, "m")
}

/// Reads a distance from a line, m.
pub(super) fn spacing(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 100_000.0, "m")
}

/// Reads a plan format.
pub(super) fn format(text: &str) -> Result<Format, String> {
    text.trim_start_matches('.').parse().map_err(|_| format!("allowed are {}", Format::names(false)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds() {
        assert_eq!("2.5".parse(), Ok(Speed(2.5)));
        assert_eq!("MAX".parse(), Ok(Speed(f64::INFINITY)));
        for wrong in ["0", "-1", "inf", "NaN", "fast", ""] {
            assert!(wrong.parse::<Speed>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn losses_are_faults() {
        assert_eq!(rx_loss("14").unwrap().to_string(), "rx-loss@14");
        assert_eq!(gps_loss("boot+20,6").unwrap().to_string(), "gps-loss@boot+20,6");
        assert!(gps_loss("soon").unwrap_err().starts_with("time T soon is not a number"));
        assert!(fault("motr@1").unwrap_err().starts_with("there is no fault \"motr\"; did you mean motor?"));
    }

    #[test]
    fn settings_are_normalised() {
        assert_eq!(setting("ap_max_angle=25"), Ok("ap_max_angle = 25".to_owned()));
        assert!(setting("ap_max_angle 25").is_err());
        assert_eq!(setting("ap_of_tomorrow=5"), Ok("ap_of_tomorrow = 5".to_owned()));
    }

    #[test]
    fn seeds_and_files_that_are_none() {
        assert_eq!(seed("18446744073709551615"), Ok(u64::MAX));
        for wrong in ["-1", "18446744073709551616", "x", ""] {
            assert!(seed(wrong).unwrap_err().contains("whole numbers from 0"), "{wrong}");
        }
        assert_eq!(output_path("./-"), Ok("./-".into()));
        assert!(output_path("-").unwrap_err().contains("not to standard output"));
        assert!(output_path("").is_err());
    }

    #[test]
    fn slow_rates_are_refused_with_the_reason() {
        assert_eq!(rate("4000"), Ok(4000));
        assert!(rate("100").unwrap_err().contains("2.5 ms"));
        assert!(rate("x").unwrap_err().contains("not a whole number"));
    }
}
