//! The settings that command lines request of a flight controller.

use crate::plan::FlightPlan;
use crate::plan::format::{self, Format};

/// Words of lines that request no setting: saving, leaving, batches, reading.
const PASSED_OVER: [&str; 6] = ["save", "exit", "batch", "reboot", "get", "diff"];
/// Words of lines that select a profile. The profile of the settings that follow cannot be read back.
const PROFILES: [&str; 3] = ["profile", "rateprofile", "battery_profile"];

/// The request of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Wish {
    /// A setting has a value.
    Setting { line: String, name: String, value: String },
    /// A row of `aux`: its numbers, index first.
    Aux { line: String, row: Vec<u16> },
    /// A part of the plan.
    Plan { line: String },
    /// Something that cannot be read back.
    Other { line: String },
}

impl Wish {
    pub(super) fn line(&self) -> &str {
        match self {
            Self::Setting { line, .. }
            | Self::Aux { line, .. }
            | Self::Plan { line }
            | Self::Other { line } => line,
        }
    }

    /// Returns `true` if it concerns the same item as an earlier one.
    fn replaces(&self, earlier: &Self) -> bool {
        match (self, earlier) {
            (Self::Setting { name, .. }, Self::Setting { name: of, .. }) => name == of,
            (Self::Aux { row, .. }, Self::Aux { row: of, .. }) => row.first() == of.first(),
            _ => false,
        }
    }

    /// Returns `true` if its fulfilment cannot be read back.
    pub(super) fn cannot_be_read(&self) -> bool {
        matches!(self, Self::Other { .. })
    }
}

/// Parses the requested settings. A later line overrides an earlier one for the same item.
pub(super) fn wishes<L: AsRef<str>>(lines: impl IntoIterator<Item = L>) -> Vec<Wish> {
    let mut in_profile = false;
    let mut wishes = Vec::new();
    for line in lines {
        let line = line.as_ref();
        let line = line.split_once('#').map_or(line, |(code, _)| code).trim().to_owned();
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((&line, ""));
        let (word, rest) = (word.to_ascii_lowercase(), rest.trim());
        let is_look = word == "waypoint" && ["", "list", "status"].contains(&rest);
        if word.is_empty() || is_look || PASSED_OVER.contains(&word.as_str()) {
            continue;
        }
        in_profile |= PROFILES.contains(&word.as_str());
        let wish = match word.as_str() {
            "set" if !in_profile => match rest.split_once('=') {
                Some((name, value)) => {
                    let (name, value) = (name.trim().to_ascii_lowercase(), value.trim().to_owned());
                    Wish::Setting { line, name, value }
                }
                None => continue,
            },
            "aux" => match aux_row(rest).filter(|row| row.len() >= 5) {
                Some(row) => Wish::Aux { line, row },
                None => Wish::Other { line },
            },
            "waypoint" => Wish::Plan { line },
            _ => Wish::Other { line },
        };
        wishes.retain(|earlier| !wish.replaces(earlier));
        wishes.push(wish);
    }
    wishes
}

/// Parses the numbers after `aux`.
pub(super) fn aux_row(numbers: &str) -> Option<Vec<u16>> {
    numbers.split_ascii_whitespace().map(|number| number.parse().ok()).collect()
}

/// Returns the wanted plan; `None` if there is none, or if it cannot be parsed.
pub(super) fn plan(wishes: &[Wish]) -> Option<FlightPlan> {
    let lines: Vec<&str> =
        wishes.iter().filter(|wish| matches!(wish, Wish::Plan { .. })).map(Wish::line).collect();
    if lines.is_empty() {
        return None;
    }
    format::parse("the lines", &lines.join("\n"), Format::CliText).ok().map(|file| file.plan)
}
