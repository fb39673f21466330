//! Checked scenarios as text: sentences, JSON lines, JUnit and Markdown.

mod json;
mod junit;
mod markdown;
mod sentences;

use crate::scenario::{Insight, Judgement, Outcome};
use crate::signals::SimTime;
use crate::telemetry::FirmwareProfile;

pub use json::{flight_line, summary_line};
pub use junit::junit;
pub use markdown::markdown;
pub use sentences::{flight_lines, summary_lines};

/// The file name of a scenario that came from standard input; the screen cannot read it again.
pub const STANDARD_INPUT: &str = "standard input";

/// A flight that was flown and judged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CheckedFlight {
    /// Name of the scenario.
    pub scenario: String,
    /// The file name as the user gave it.
    pub file: String,
    /// Name of the case; empty if there is only one.
    pub case: String,
    /// The name that the file gives the case.
    pub base: String,
    pub variant: String,
    /// Seed of all randomness.
    pub seed: u64,
    /// The number of seeds of the case.
    pub seeds: usize,
    /// `true` if the user gave the seed, which may not be in the file.
    pub seed_is_given: bool,
    /// The number of the repetition, from 0.
    pub repetition: u32,
    /// The reason why the flight cannot be judged or trusted.
    pub problem: Option<String>,
    /// The result of the flight.
    pub result: String,
    /// The reason as a sentence.
    pub reason: String,
    /// The judgements of the expectations.
    pub judgements: Vec<Judgement>,
    /// Numbers taken from the flight.
    pub measures: Vec<(String, f64)>,
    pub engaged_at: Option<SimTime>,
    /// The time at which the flight ended.
    pub ended_at: SimTime,
    pub flown_s: f64,
    /// The duration in seconds of wall time.
    pub wall_s: f64,
    /// Equal for flights that are the same to the last bit.
    pub hash: u64,
    /// The kind of its firmware, if it is known.
    pub firmware: Option<FirmwareProfile>,
    /// The knowledge that the flight controller gave.
    pub reported: Insight,
    /// `true` if a remote flight controller flew.
    pub is_remote: bool,
    /// The options of `betadeck open` that choose the firmware or its laws, with a blank before each. Without them a flight of
    /// a remote flight controller cannot be opened.
    pub firmware_options: Option<String>,
}

impl CheckedFlight {
    /// Returns `true` if no expectation failed.
    pub fn passed(&self) -> bool {
        self.problem.is_none() && !self.judgements.iter().any(|judgement| judgement.outcome.is_failure())
    }

    /// Returns the number of expectations that need more than the flight controller reports.
    pub fn skipped(&self) -> usize {
        self.judgements.iter().filter(|judgement| is_skipped(judgement)).count()
    }

    /// Returns `true` if no expectation was judged, because all of them need more than the flight controller reports.
    pub fn is_skipped(&self) -> bool {
        self.problem.is_none() && !self.judgements.is_empty() && self.judgements.iter().all(is_skipped)
    }

    /// Returns the expectations that were not met.
    pub fn failures(&self) -> impl Iterator<Item = &Judgement> {
        self.judgements.iter().filter(|judgement| judgement.outcome.is_failure())
    }

    /// Returns the expectation with the smallest margin, as a share of its allowed range.
    pub fn tightest(&self) -> Option<&Judgement> {
        let share = |judgement: &Judgement| judgement.outcome.margin().map(|margin| margin.verdict.share());
        self.judgements
            .iter()
            .filter(|judgement| share(judgement).is_some())
            .min_by(|a, b| share(a).unwrap_or(1.0).total_cmp(&share(b).unwrap_or(1.0)))
    }

    /// Returns the title: `guide-7 · crosswind · seed 3`.
    pub fn title(&self) -> String {
        let mut title = self.scenario.clone();
        if !self.case.is_empty() {
            title.push_str(&format!(" · {}", self.case));
        }
        if self.tells_seed() {
            title.push_str(&format!(" · seed {}", self.seed));
        }
        if self.repetition > 0 {
            title.push_str(&format!(" · repetition {}", self.repetition + 1));
        }
        title
    }

    fn tells_seed(&self) -> bool {
        self.seeds > 1 || self.seed_is_given
    }

    /// Returns a time for people: seconds after the engagement, or after boot if there was none.
    pub fn seconds(&self, time: SimTime) -> f64 {
        time.as_secs_f64() - self.engaged_at.map_or(0.0, SimTime::as_secs_f64)
    }

    /// Returns the command that opens an instant of the flight in the screen; `None` for a remote flight controller that
    /// cannot be started in the same way.
    pub fn open_command(&self, time: SimTime) -> Option<String> {
        let firmware = match (self.is_remote, &self.firmware_options) {
            (false, options) => options.as_deref().unwrap_or_default(),
            (true, options) => options.as_deref()?,
        };
        let case =
            if self.case.is_empty() { String::new() } else { format!(" --case {}", shell_word(&self.case)) };
        let seed = if self.tells_seed() { format!(" --seed {}", self.seed) } else { String::new() };
        let boot = if self.engaged_at.is_some() { "" } else { "boot+" };
        let file = if self.file == STANDARD_INPUT { "FILE".to_owned() } else { shell_word(&self.file) };
        Some(format!("betadeck open {file}{case}{seed} --at {boot}{:.2}{firmware}", self.seconds(time)))
    }
}

/// Returns a text as one shell word, with quotes if needed.
pub fn shell_word(text: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_./,:@%+=-".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// A judged comparison of several flights.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Name of the scenario.
    pub scenario: String,
    /// The file name as the user gave it.
    pub file: String,
    pub variant: String,
    /// The seed of all the flights.
    pub seed: u64,
    /// The judgement of the comparison.
    pub judgement: Judgement,
}

impl Compared {
    /// Returns the title: `guide-2 · noise real · seed 3`.
    pub fn title(&self) -> String {
        let variant = if self.variant.is_empty() { String::new() } else { format!(" · {}", self.variant) };
        format!("{}{variant} · seed {}", self.scenario, self.seed)
    }
}

/// The counts of the flights of a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseCount {
    /// The name: `guide-7 · crosswind`.
    pub name: String,
    pub passed: usize,
    /// The number of flights without a judgement.
    pub skipped: usize,
    pub flights: usize,
}

impl CaseCount {
    /// Returns `true` if a flight failed.
    pub fn has_failures(&self) -> bool {
        self.passed + self.skipped < self.flights
    }
}

/// All flights of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// The flights, in their order.
    pub flights: Vec<CheckedFlight>,
    /// The judged comparisons of several flights.
    pub compared: Vec<Compared>,
    /// The number of requested flights.
    pub wanted: usize,
    /// The number of slow scenarios that were left out.
    pub left_out: usize,
    /// The duration in seconds of wall time.
    pub wall_s: f64,
}

impl Summary {
    pub fn new(
        flights: Vec<CheckedFlight>,
        compared: Vec<Compared>,
        wanted: usize,
        left_out: usize,
        wall_s: f64,
    ) -> Self {
        Self { flights, compared, wanted, left_out, wall_s }
    }

    /// Returns `true` if all requested flights were flown, something was judged and no expectation failed.
    pub fn passed(&self) -> bool {
        self.flights.len() == self.wanted
            && !self.is_skipped()
            && self.flights.iter().all(CheckedFlight::passed)
            && !self.compared.iter().any(|compared| compared.judgement.outcome.is_failure())
    }

    /// Returns the number of flights that passed, without those that had no judgement.
    pub fn passed_flights(&self) -> usize {
        self.flights.iter().filter(|flight| flight.passed() && !flight.is_skipped()).count()
    }

    /// Returns the number of flights without a judgement, and of skipped expectations in all flights.
    pub fn skipped(&self) -> (usize, usize) {
        let flights = self.flights.iter().filter(|flight| flight.is_skipped()).count();
        let compared = self.compared.iter().filter(|compared| is_skipped(&compared.judgement)).count();
        (flights, compared + self.flights.iter().map(CheckedFlight::skipped).sum::<usize>())
    }

    /// Returns the simulated seconds of all flights.
    pub fn flown_s(&self) -> f64 {
        self.flights.iter().map(|flight| flight.flown_s).sum()
    }

    /// Returns `true` if there are flights but no judgement.
    pub fn is_skipped(&self) -> bool {
        !self.flights.is_empty()
            && self.flights.iter().all(CheckedFlight::is_skipped)
            && self.compared.iter().all(|compared| is_skipped(&compared.judgement))
    }

    /// Returns the cases in their order, each with the counts of its seeds and repetitions.
    pub fn cases(&self) -> Vec<CaseCount> {
        let mut cases: Vec<CaseCount> = Vec::new();
        let mut file = "";
        for flight in &self.flights {
            let name = if flight.case.is_empty() {
                flight.scenario.clone()
            } else {
                format!("{} · {}", flight.scenario, flight.case)
            };
            let skipped = usize::from(flight.is_skipped());
            let passed = usize::from(flight.passed()) - skipped;
            match cases.last_mut() {
                Some(known) if known.name == name && file == flight.file => {
                    known.passed += passed;
                    known.skipped += skipped;
                    known.flights += 1;
                }
                _ => cases.push(CaseCount { name, passed, skipped, flights: 1 }),
            }
            file = &flight.file;
        }
        cases
    }
}

fn is_skipped(judgement: &Judgement) -> bool {
    matches!(judgement.outcome, Outcome::Skipped(_))
}

/// Returns the observed behaviour against the expected one, as one sentence.
pub fn complaint(judgement: &Judgement) -> String {
    match &judgement.outcome {
        Outcome::Met(_) => format!("{}: met", judgement.label),
        Outcome::Failed { sentence, guard: None, .. } => format!("{}: {sentence}", judgement.label),
        Outcome::Failed { sentence, guard: Some(guard), .. } => {
            format!("{}: {sentence}; {guard}", judgement.label)
        }
        Outcome::NeverJudged(why) => format!("{}: never judged, {why}", judgement.label),
        Outcome::Skipped(needed) => format!("{}: not judged, {}", judgement.label, needed.missing()),
    }
}

#[cfg(test)]
mod tests;
