//! The settings of a flight controller, as far as they were read, compared with the wanted ones.

use std::collections::{BTreeMap, VecDeque};

use super::report::Difference;
use super::wish::{self, Wish};
use crate::fc::same_value;
use crate::fc::telemetry::setting;
use crate::plan::FlightPlan;
use crate::plan::format::{self, Format};

/// Words in the output of `diff` that appear even without changes.
const NO_CHANGE: [&str; 10] = [
    "batch",
    "defaults",
    "board_name",
    "manufacturer_id",
    "mcu_id",
    "signature",
    "profile",
    "rateprofile",
    "battery_profile",
    "save",
];
/// The output for a plan without waypoints.
const NO_PLAN: &str = "waypoint clear";

/// A question about the settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Question {
    Setting(String),
    Aux,
    Plan,
    /// The differences from a fresh configuration.
    Changes,
}

impl Question {
    pub(super) fn line(&self) -> String {
        match self {
            Self::Setting(name) => format!("get {name}"),
            Self::Aux => "aux".to_owned(),
            Self::Plan => "waypoint list".to_owned(),
            Self::Changes => "diff".to_owned(),
        }
    }
}

/// Returns the questions that show if wishes are fulfilled, each once.
pub(super) fn questions(wishes: &[Wish]) -> VecDeque<Question> {
    let mut questions = VecDeque::new();
    for wish in wishes {
        let question = match wish {
            Wish::Setting { name, .. } => Question::Setting(name.clone()),
            Wish::Aux { .. } => Question::Aux,
            Wish::Plan { .. } => Question::Plan,
            Wish::Other { .. } => continue,
        };
        if !questions.contains(&question) {
            questions.push_back(question);
        }
    }
    questions
}

#[derive(Debug, Clone, Default)]
pub(super) struct Held {
    /// `None` for a setting that the firmware does not have.
    settings: BTreeMap<String, Option<String>>,
    aux: Vec<Vec<u16>>,
    plan: Option<FlightPlan>,
    /// `true` if the flight controller reported no differences from a fresh configuration.
    is_bare: bool,
}

impl Held {
    pub(super) fn learn(&mut self, question: Question, output: &str, failed: bool) {
        match question {
            Question::Setting(name) => {
                let value = setting(output, &name).filter(|_| !failed).map(str::to_owned);
                self.settings.insert(name, value);
            }
            Question::Aux => {
                let rows = output.lines().filter_map(|line| line.trim().strip_prefix("aux "));
                self.aux = rows.filter_map(wish::aux_row).collect();
            }
            Question::Changes => self.is_bare = !failed && tells_of_no_change(output),
            // Some releases print nothing if there is no plan.
            Question::Plan if failed => self.plan = None,
            Question::Plan if output.trim().is_empty() => self.plan = Some(FlightPlan::default()),
            Question::Plan => {
                self.plan = format::parse("the craft", output, Format::CliText).ok().map(|file| file.plan);
            }
        }
    }

    /// Returns `true` if it has reported that nothing was changed in its configuration.
    pub(super) fn is_bare(&self) -> bool {
        self.is_bare
    }

    /// Records that the firmware does not have this setting, as a line has shown.
    pub(super) fn is_unknown(&mut self, name: &str) {
        self.settings.insert(name.to_owned(), None);
    }

    /// Returns `true` if a wish is a setting that the firmware does not have.
    pub(super) fn has_not(&self, wish: &Wish) -> bool {
        matches!(wish, Wish::Setting { name, .. } if self.settings.get(name) == Some(&None))
    }

    /// Returns the settings among the wishes that the firmware does not have.
    pub(super) fn unknown(&self, wishes: &[Wish]) -> Vec<String> {
        let names = wishes.iter().filter(|wish| self.has_not(wish)).filter_map(|wish| match wish {
            Wish::Setting { name, .. } => Some(name.clone()),
            Wish::Aux { .. } | Wish::Plan { .. } | Wish::Other { .. } => None,
        });
        names.collect()
    }

    /// Returns the differences between the settings and the wishes.
    pub(super) fn differences(&self, wishes: &[Wish]) -> Vec<Difference> {
        let mut differences: Vec<Difference> = Vec::new();
        for wish in wishes.iter().filter(|wish| !self.has_not(wish)) {
            let held = match wish {
                Wish::Setting { name, value, .. } => {
                    let held = self.settings.get(name).cloned().flatten().unwrap_or_default();
                    (!same_value(&held, value)).then_some(held)
                }
                Wish::Aux { row, .. } => {
                    let held = self.aux.iter().find(|held| held.first() == row.first());
                    let is_same =
                        held.is_some_and(|held| std::iter::zip(held, row).all(|(held, row)| held == row));
                    (!is_same).then(|| held.map(|row| spaced(row)).unwrap_or_default())
                }
                Wish::Plan { .. } | Wish::Other { .. } => None,
            };
            differences.extend(held.map(|held| Difference { line: wish.line().to_owned(), held }));
        }
        if let Some(wanted) = wish::plan(wishes)
            && self.plan.as_ref() != Some(&wanted)
        {
            let held = match &self.plan {
                None => "none that can be read".to_owned(),
                Some(held) if held.waypoints.is_empty() => "no plan".to_owned(),
                Some(held) => format!("another plan of {} waypoints", held.waypoints.len()),
            };
            differences.push(Difference { line: "waypoint list".to_owned(), held });
        }
        differences
    }
}

/// Returns `true` if the output of `diff` has no line that changes anything.
fn tells_of_no_change(output: &str) -> bool {
    let lines = output.lines().map(|line| line.split_once('#').map_or(line, |(code, _)| code).trim());
    let mut changes = lines.filter(|line| {
        let word = line.split_ascii_whitespace().next();
        word.is_some_and(|word| !NO_CHANGE.contains(&word)) && *line != NO_PLAN
    });
    // A prompt alone is not an answer.
    output.contains(char::is_alphanumeric) && changes.next().is_none()
}

fn spaced(row: &[u16]) -> String {
    let numbers: Vec<String> = row.iter().map(ToString::to_string).collect();
    format!("aux {}", numbers.join(" "))
}
