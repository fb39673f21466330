//! A channel that is forced to a value for a while, and its text form.

use std::fmt;
use std::str::FromStr;

use crate::signals::{RC_CHANNELS, SimTime};
use crate::text::did_you_mean;

/// A channel that is forced to a value for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickInput {
    /// Channel index, 0…15.
    pub channel: u8,
    /// Value, µs.
    pub value_us: u16,
    /// Begin in seconds, counted from boot or from the engagement; see `from_boot`.
    pub at_s: f64,
    /// Duration, s; `None` lasts to the end.
    pub for_s: Option<f64>,
    /// `true` if `at_s` counts from boot instead of from the engagement.
    pub from_boot: bool,
}

impl StickInput {
    pub(super) fn is_active(&self, now: SimTime, engaged_at: Option<SimTime>) -> bool {
        let origin = if self.from_boot { Some(SimTime::ZERO) } else { engaged_at };
        origin.is_some_and(|origin| {
            let t = now.as_secs_f64() - origin.as_secs_f64();
            t >= self.at_s && self.for_s.is_none_or(|length| t < self.at_s + length)
        })
    }
}

/// The names of the first channels in wire order.
const STICKS: [&str; 4] = ["roll", "pitch", "throttle", "yaw"];

impl FromStr for StickInput {
    type Err = String;

    /// Reads `CH=VALUE@T[,FOR]`: CH is a name or a number from 1, VALUE in µs, T and FOR in seconds.
    fn from_str(text: &str) -> Result<Self, String> {
        let usage = "write CH=VALUE@T[,FOR], such as pitch=2000@30,2 or aux2=1000@boot+60";
        let (channel, rest) = text.split_once('=').ok_or(usage)?;
        let channel = channel_index(channel)?;
        let (value, times) = rest.split_once('@').ok_or(usage)?;
        let value_us = pulse_us(value)?;
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
        let from_boot = if self.from_boot { "boot+" } else { "" };
        write!(f, "{}={}@{from_boot}{}", channel_name(self.channel), self.value_us, self.at_s)?;
        self.for_s.map_or(Ok(()), |for_s| write!(f, ",{for_s}"))
    }
}

/// Reads a channel by name (`roll`, `aux2`) or number from 1. Returns its index from 0.
///
/// # Errors
/// Fails with the permitted values.
pub fn channel_index(text: &str) -> Result<u8, String> {
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

/// Returns the name of a channel from its index: `roll`, `aux2`.
pub fn channel_name(index: u8) -> String {
    let index = usize::from(index);
    STICKS.get(index).map_or_else(|| format!("aux{}", index + 1 - STICKS.len()), |&name| name.to_owned())
}

/// Reads the pulse length of a channel, µs.
///
/// # Errors
/// Fails with the permitted values.
pub fn pulse_us(text: &str) -> Result<u16, String> {
    text.parse()
        .ok()
        .filter(|us| (750..=2250).contains(us))
        .ok_or_else(|| format!("value {text} is not a pulse length; allowed are 750 to 2250 µs"))
}

/// Reads a number of seconds, at least zero.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1e9).contains(&value) => Ok(value),
        Ok(value) if value.is_finite() => {
            Err(format!("{text} is out of range; allowed are 0 to 1000000000 s"))
        }
        _ => Err(format!("{text} is not a number; allowed are 0 to 1000000000 s")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
