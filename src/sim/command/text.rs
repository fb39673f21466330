//! World commands as text, in the words of the command line: `wind=5@270`, `fault=motor,,2:0.8`, `end=motor:2`.

use std::fmt;
use std::str::FromStr;

use crate::sim::config::Noise;
use crate::sim::fault::{Fault, MAX_TIME_S, ScheduledFault};
use crate::sim::switches::{SWITCHES, Switches};
use crate::sim::value_text::{ParseError, number_in};
use crate::sim::wind::Wind;
use crate::telemetry::Turbulence;
use crate::text::did_you_mean;

use super::WorldCommand;

/// One word that a command can begin with: name, form of its value, meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CommandWord {
    /// The word.
    pub name: &'static str,
    /// Form of the value after the `=`; empty if there is none.
    pub value: &'static str,
    /// A description for people.
    pub help: &'static str,
}

/// All words except the switches, which use their own names.
pub const COMMAND_WORDS: [CommandWord; 9] = [
    CommandWord { name: "wind", value: "SPEED@FROM or calm", help: "the mean wind changes over two seconds" },
    CommandWord { name: "gust", value: "SPEED", help: "random gusts of this strength; 0 for none" },
    CommandWord { name: "gust-now", value: "SPEED@FROM", help: "one gust now" },
    CommandWord { name: "turbulence", value: "none, light, moderate, severe", help: "level of turbulence" },
    CommandWord { name: "noise", value: "real, none", help: "sensor errors" },
    CommandWord { name: "gps-rate", value: "1 to 20", help: "GPS solutions a second" },
    CommandWord {
        name: "fault",
        value: "NAME[,FOR][,VALUE] now, NAME@T[,FOR][,VALUE] at its time",
        help: "a fault",
    },
    CommandWord { name: "end", value: "NAME, NAME:MOTOR or all", help: "ends faults" },
    CommandWord { name: "reset", value: "", help: "the craft is back at home, undamaged and charged" },
];

impl WorldCommand {
    /// Reads a command from text. `=` or a space separates the word from its value.
    ///
    /// # Errors
    /// Fails if the word is unknown or the value is not allowed.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        let text = text.trim();
        let error = |problem: String| ParseError::new("world command", text, problem);
        let (word, value) = text.split_once(['=', ' ']).unwrap_or((text, ""));
        let value = value.trim();
        Ok(match word {
            "wind" => Self::SetWind(value.parse()?),
            "gust" => Self::SetGust(number_in("gust speed", value, 0.0, Wind::MAX_MPS).map_err(error)?),
            "gust-now" => Self::GustNow(value.parse()?),
            "turbulence" => Self::SetTurbulence(Turbulence::parse(value)?),
            "noise" => Self::SetNoise(Noise::parse(value)?),
            "gps-rate" => {
                let rate = number_in("rate", value, 1.0, 20.0).map_err(error)?;
                if rate.fract() != 0.0 {
                    return Err(error(format!("rate {rate} is not a whole number")));
                }
                Self::SetGpsRate(rate as u8)
            }
            "fault" if value.contains('@') && starts_with_time(value) => Self::Schedule(value.parse()?),
            "fault" => fault_now(value)?,
            "end" if value == "all" => Self::ClearFaults,
            "end" => Self::FaultOff(value.parse()?),
            "reset" if value.is_empty() => Self::ResetToHome,
            "reset" => return Err(error("reset has no value".to_owned())),
            _ if SWITCHES.iter().any(|switch| switch.name == word) => {
                let switch = format!("{word}={value}");
                Switches::default().set(&switch)?;
                Self::SetSwitch(switch)
            }
            _ => {
                let words = || COMMAND_WORDS.iter().map(|w| w.name).chain(SWITCHES.iter().map(|s| s.name));
                let hint = did_you_mean::suffix(word, words());
                let all: Vec<&str> = words().collect();
                return Err(error(format!("there is no {word:?}{hint}; there are {}", all.join(", "))));
            }
        })
    }
}

impl fmt::Display for WorldCommand {
    /// Writes the form that [`Self::parse`] reads.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SetWind(wind) => write!(f, "wind {wind}"),
            Self::SetGust(size) => write!(f, "gust {size}"),
            Self::GustNow(wind) => write!(f, "gust-now {wind}"),
            Self::SetTurbulence(level) => write!(f, "turbulence {level}"),
            Self::SetNoise(noise) => write!(f, "noise {noise}"),
            Self::SetSwitch(switch) => f.write_str(switch),
            Self::SetGpsRate(rate) => write!(f, "gps-rate {rate}"),
            Self::FaultOn(fault, for_s) => {
                let for_s = for_s.map_or_else(String::new, |for_s| for_s.to_string());
                match (for_s.as_str(), fault.to_string().as_str()) {
                    ("", "") => write!(f, "fault {}", fault.name()),
                    (for_s, "") => write!(f, "fault {},{for_s}", fault.name()),
                    (for_s, value) => write!(f, "fault {},{for_s},{value}", fault.name()),
                }
            }
            Self::FaultOff(key) => write!(f, "end {key}"),
            Self::ClearFaults => f.write_str("end all"),
            Self::Schedule(fault) => write!(f, "fault {fault}"),
            Self::ResetToHome => f.write_str("reset"),
        }
    }
}

/// Returns `true` if the first separator after the name is the one of a time.
fn starts_with_time(value: &str) -> bool {
    value.find(['@', ',', ':']).is_some_and(|place| value[place..].starts_with('@'))
}

/// Reads `NAME`, `NAME,FOR`, `NAME,FOR,VALUE`, `NAME,,VALUE` or `NAME:VALUE`.
fn fault_now(text: &str) -> Result<WorldCommand, ParseError> {
    if let Some((name, value)) = text.split_once(':').filter(|(name, _)| !name.contains(',')) {
        return Ok(WorldCommand::FaultOn(Fault::parse(name, Some(value))?, None));
    }
    let mut parts = text.splitn(3, ',');
    let name = parts.next().unwrap_or_default();
    let duration = parts.next().unwrap_or_default();
    let fault = Fault::parse(name, parts.next())?;
    if duration.is_empty() {
        return Ok(WorldCommand::FaultOn(fault, None));
    }
    // The rules are the same as for a fault with a time.
    let scheduled = ScheduledFault::from_str(&format!("{name}@0,{duration},{fault}"))?;
    let for_s = scheduled.for_s.map(|seconds| seconds.min(MAX_TIME_S));
    Ok(WorldCommand::FaultOn(scheduled.fault, for_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> WorldCommand {
        WorldCommand::parse(text).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn every_word_makes_its_command() {
        let weak = Fault::parse("motor", Some("2:0.8")).unwrap();
        for (text, command) in [
            ("wind=5@270", WorldCommand::SetWind("5@270".parse().unwrap())),
            ("wind calm", WorldCommand::SetWind(Wind::CALM)),
            ("gust=3", WorldCommand::SetGust(3.0)),
            ("gust-now=8@0", WorldCommand::GustNow("8@0".parse().unwrap())),
            ("turbulence=light", WorldCommand::SetTurbulence(Turbulence::Light)),
            ("noise=none", WorldCommand::SetNoise(Noise::None)),
            ("gps-rate=5", WorldCommand::SetGpsRate(5)),
            ("wind_profile=flat", WorldCommand::SetSwitch("wind_profile=flat".to_owned())),
            ("fault=gps-loss", WorldCommand::FaultOn(Fault::GpsLoss, None)),
            ("fault gps-loss,6", WorldCommand::FaultOn(Fault::GpsLoss, Some(6.0))),
            ("fault=motor:2:0.8", WorldCommand::FaultOn(weak, None)),
            ("fault=motor,,2:0.8", WorldCommand::FaultOn(weak, None)),
            ("fault=motor,3,2:0.8", WorldCommand::FaultOn(weak, Some(3.0))),
            ("fault=gps-glitch:30@90", WorldCommand::FaultOn(Fault::GpsGlitch(30.0, 90.0), None)),
            ("fault=teleport,,1,2,3", WorldCommand::FaultOn(Fault::Teleport([1.0, 2.0, 3.0]), None)),
            ("fault=gps-loss@20,6", WorldCommand::Schedule("gps-loss@20,6".parse().unwrap())),
            ("end=motor:2", WorldCommand::FaultOff(weak.key())),
            ("end=gps-loss", WorldCommand::FaultOff(Fault::GpsLoss.key())),
            ("end=all", WorldCommand::ClearFaults),
            ("reset", WorldCommand::ResetToHome),
        ] {
            assert_eq!(parse(text), command, "{text}");
            assert_eq!(parse(&command.to_string()), command, "{text}");
        }
    }

    #[test]
    fn errors_say_what_is_allowed() {
        for (text, part) in [
            ("wnd=5@270", "did you mean wind?"),
            ("wind_profil=flat", "did you mean wind_profile?"),
            ("wind=5", "the direction it blows from is missing"),
            ("gust=99", "allowed are 0 to 60"),
            ("gps-rate=2.5", "not a whole number"),
            ("fault=gps-los", "did you mean gps-loss?"),
            ("fault=push,2,1,up", "has no duration"),
            ("fault=gps-loss,x", "duration FOR x is not a number"),
            ("end=motor:7", "7 is not a motor"),
            ("end=gps-loss:2", "not a fault of one motor"),
            ("wind_profile=round", "log, flat"),
            ("reset=1", "reset has no value"),
            ("", "there are wind, gust"),
        ] {
            let error = WorldCommand::parse(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    proptest::proptest! {
        #[test]
        fn any_text_is_read_or_refused_without_panic(text in ".{0,40}", word in 0usize..COMMAND_WORDS.len()) {
            let _ = WorldCommand::parse(&text);
            let _ = WorldCommand::parse(&format!("{}={text}", COMMAND_WORDS[word].name));
        }
    }
}
