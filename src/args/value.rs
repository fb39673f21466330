//! Values of options, with the sentences for wrong ones.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use crate::did_you_mean;
use crate::flight::StickInput;
use crate::flight::setup::check_setting;
use crate::plan::format::{Format, setting_line};
use crate::signals::RC_CHANNELS;
use crate::sim::{Noise, ParseError, ScheduledFault, Switches, Turbulence, Wind, step_us};

/// A switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum OnOff {
    /// On.
    On,
    /// Off.
    Off,
}

impl OnOff {
    /// Whether it is on.
    #[must_use]
    pub fn is_on(self) -> bool {
        self == Self::On
    }
}

/// Where the firmware's attitude comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum AttitudeChoice {
    /// Estimated from the sensors.
    Estimated,
    /// The simulator's truth.
    Truth,
}

/// How many times faster than real time to run; infinite = as fast as the machine allows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speed(pub f64);

/// Slowest and fastest factor that can be asked for.
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

/// The names of the first channels, in wire order.
const STICKS: [&str; 4] = ["roll", "pitch", "throttle", "yaw"];

impl FromStr for StickInput {
    type Err = String;

    /// `CH=VALUE@T[,FOR]`: CH a name or a number from 1, VALUE in µs, T and FOR in seconds.
    fn from_str(text: &str) -> Result<Self, String> {
        let usage = "write CH=VALUE@T[,FOR], such as pitch=2000@30,2 or aux2=1000@boot+60";
        let (channel, rest) = text.split_once('=').ok_or(usage)?;
        let channel = channel_index(channel)?;
        let (value, times) = rest.split_once('@').ok_or(usage)?;
        let value_us = value
            .parse()
            .ok()
            .filter(|us| (750..=2250).contains(us))
            .ok_or_else(|| format!("value {value} is not a pulse length; allowed are 750 to 2250 µs"))?;
        let (start, for_s) =
            times.split_once(',').map_or((times, None), |(start, for_s)| (start, Some(for_s)));
        let from_boot = start.strip_prefix("boot+");
        Ok(Self {
            channel,
            value_us,
            at_s: seconds(from_boot.unwrap_or(start))?,
            for_s: for_s.map(seconds).transpose()?,
            from_boot: from_boot.is_some(),
        })
    }
}

impl fmt::Display for StickInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let channel = usize::from(self.channel);
        match STICKS.get(channel) {
            Some(name) => f.write_str(name)?,
            None => write!(f, "aux{}", channel - STICKS.len() + 1)?,
        }
        let from_boot = if self.from_boot { "boot+" } else { "" };
        write!(f, "={}@{from_boot}{}", self.value_us, self.at_s)?;
        self.for_s.map_or(Ok(()), |for_s| write!(f, ",{for_s}"))
    }
}

/// A channel by name (`roll`, `aux2`) or number from 1.
fn channel_index(text: &str) -> Result<u8, String> {
    let name = text.to_ascii_lowercase();
    let number = |digits: &str, first: usize| {
        digits.parse::<usize>().ok().filter(|&n| n > 0).map(|n| n - 1 + first).filter(|&n| n < RC_CHANNELS)
    };
    let index = STICKS.iter().position(|&stick| stick == name).or_else(|| match name.strip_prefix("aux") {
        Some(digits) => number(digits, STICKS.len()),
        None => number(&name, 0),
    });
    index.and_then(|index| u8::try_from(index).ok()).ok_or_else(|| {
        let guess = did_you_mean::suffix(&name, STICKS);
        format!("{text} is not a channel{guess} (roll, pitch, throttle, yaw, aux1 to aux12, or 1 to 16)")
    })
}

/// A number of seconds from zero up.
fn seconds(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 1e9, "s")
}

/// A finite number in a range.
fn bounded(text: &str, low: f64, high: f64, unit: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        Ok(value) if value.is_finite() => {
            Err(format!("{text} is out of range; allowed are {low} to {high} {unit}"))
        }
        _ => Err(format!("{text} is not a number; allowed are {low} to {high} {unit}")),
    }
}

/// Seconds of simulated time until a flight is given up.
pub(super) fn timeout(text: &str) -> Result<f64, String> {
    bounded(text, 1.0, 1e6, "s")
}

/// Metres of the pilot's climb.
pub(super) fn takeoff(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 500.0, "m")
}

/// Metres that truth may be off.
pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 100_000.0, "m")
}

/// A heading, degrees.
pub(super) fn heading(text: &str) -> Result<f64, String> {
    bounded(text, -360.0, 360.0, "degrees")
}

/// Size of random gusts, m/s.
pub(super) fn gust(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, Wind::MAX_MPS, "m/s")
}

/// Samples a second.
pub(super) fn samples(text: &str) -> Result<f64, String> {
    bounded(text, 0.0, 1000.0, "Hz")
}

/// Steps a second.
pub(super) fn rate(text: &str) -> Result<u32, String> {
    let rate = text.parse().map_err(|_| format!("{text} is not a whole number of Hz"))?;
    step_us(rate).map(|_| rate).map_err(|error| error.to_string())
}

/// Sensor noise.
pub(super) fn noise(text: &str) -> Result<Noise, ParseError> {
    Noise::parse(text)
}

/// Level of turbulence.
pub(super) fn turbulence(text: &str) -> Result<Turbulence, ParseError> {
    Turbulence::parse(text)
}

/// A switch of the world, checked and kept as text: they are put together in their order.
pub(super) fn world_switch(text: &str) -> Result<String, ParseError> {
    Switches::default().set(text).map(|()| text.to_owned())
}

/// A fault, `NAME@T[,FOR][,VALUE]`.
pub(super) fn fault(text: &str) -> Result<ScheduledFault, String> {
    text.parse().map_err(|error: ParseError| error.problem().to_owned())
}

/// The loss of the RC link at `T[,FOR]`.
pub(super) fn rx_loss(text: &str) -> Result<ScheduledFault, String> {
    fault(&format!("rx-loss@{text}"))
}

/// The loss of the GPS at `T[,FOR]`.
pub(super) fn gps_loss(text: &str) -> Result<ScheduledFault, String> {
    fault(&format!("gps-loss@{text}"))
}

/// A setting that the craft takes, `NAME=VALUE`, kept as `name = value`.
pub(super) fn setting(text: &str) -> Result<String, String> {
    let line = setting_line(text).ok_or("write NAME=VALUE, such as ap_max_angle=25")?;
    let (name, value) = line.split_once(" = ").unwrap_or((&line, ""));
    check_setting(name, value).map(|()| line.clone()).map_err(|fault| fault.to_string())
}

/// The seed of all randomness.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| format!("{text} is not a seed; allowed are whole numbers from 0 to {}", u64::MAX))
}

/// A file to write that cannot be standard output.
pub(super) fn output_path(text: &str) -> Result<PathBuf, String> {
    match text {
        "" => Err("write a file name".to_owned()),
        "-" => Err("this goes to a file, not to standard output; write a file name".to_owned()),
        file => Ok(file.into()),
    }
}

/// A plan format.
pub(super) fn format(text: &str) -> Result<Format, String> {
    text.trim_start_matches('.')
        .parse()
        .map_err(|_| format!("allowed are toml and txt ({})", Format::endings()))
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
    fn sticks_read_and_print() {
        for text in ["roll=1000@0", "pitch=2000@30,2", "aux2=1000@boot+60.5", "aux12=2000@1"] {
            assert_eq!(text.parse::<StickInput>().unwrap().to_string(), text);
        }
        assert_eq!("6=2000@1".parse::<StickInput>().unwrap().channel, 5);
        assert_eq!("AUX1=2000@1".parse::<StickInput>().unwrap().channel, 4);
    }

    #[test]
    fn wrong_sticks_say_why() {
        for (text, part) in [
            ("roll", "write CH=VALUE@T[,FOR]"),
            ("foo=x@3", "foo is not a channel"),
            ("foo=", "foo is not a channel"),
            ("roll=1500", "write CH=VALUE@T[,FOR]"),
            ("rol=1500@1", "did you mean roll?"),
            ("aux13=1500@1", "is not a channel"),
            ("0=1500@1", "is not a channel"),
            ("17=1500@1", "is not a channel"),
            ("roll=5@1", "allowed are 750 to 2250"),
            ("roll=1500@x", "x is not a number"),
            ("roll=1500@1,-2", "-2 is out of range"),
            ("roll=1500@nan", "nan is not a number"),
        ] {
            let error = text.parse::<StickInput>().unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
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
        assert_eq!(
            setting("ap_max_angle=999").unwrap_err(),
            "ap_max_angle 999 is out of range; allowed: 10 to 70"
        );
        assert!(setting("ap_max_angel=9").unwrap_err().contains("did you mean ap_max_angle?"));
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
