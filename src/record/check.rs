//! Checked scenarios as text: sentences, JSON lines, JUnit and Markdown.

mod json;
mod junit;
mod markdown;
mod sentences;

use crate::scenario::{Insight, Judgement, Outcome};
use crate::signals::SimTime;

pub use json::{flight_line, summary_line};
pub use junit::junit;
pub use markdown::markdown;
pub use sentences::{flight_lines, summary_lines};

/// What stands for the file of a scenario that was read from standard input; the screen cannot read it again.
pub const STANDARD_INPUT: &str = "standard input";

/// A flight that was flown and judged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CheckedFlight {
    /// Name of the scenario.
    pub scenario: String,
    /// Its file, as its user named it.
    pub file: String,
    /// Name of the case; empty when there is only one.
    pub case: String,
    /// The name that the file gives the case.
    pub base: String,
    pub variant: String,
    /// Seed of all randomness.
    pub seed: u64,
    /// Seeds of the case.
    pub seeds: usize,
    /// The seed was asked for: it may be none of the file's.
    pub seed_is_given: bool,
    /// Which flight of the same, from 0.
    pub repetition: u32,
    /// What keeps the flight from being judged, or from being believed.
    pub problem: Option<String>,
    /// How the flight ended.
    pub result: String,
    /// Why, as a sentence.
    pub reason: String,
    /// What became of the expectations.
    pub judgements: Vec<Judgement>,
    /// Numbers taken from the flight.
    pub measures: Vec<(String, f64)>,
    pub engaged_at: Option<SimTime>,
    /// When the flight ended.
    pub ended_at: SimTime,
    pub flown_s: f64,
    /// Seconds that it took.
    pub wall_s: f64,
    /// Equal for flights that are the same to the last bit.
    pub hash: u64,
    /// What was known of the flight controller.
    pub told: Insight,
}

impl CheckedFlight {
    /// Whether every expectation was met.
    pub fn passed(&self) -> bool {
        self.problem.is_none() && !self.judgements.iter().any(|judgement| judgement.outcome.is_failure())
    }

    /// Expectations that need what the flight controller does not tell.
    pub fn skipped(&self) -> usize {
        self.judgements.iter().filter(|judgement| is_skipped(judgement)).count()
    }

    /// Whether nothing of it was judged, for all that is expected needs what the flight controller does not tell.
    pub fn is_skipped(&self) -> bool {
        self.problem.is_none() && !self.judgements.is_empty() && self.judgements.iter().all(is_skipped)
    }

    /// The expectations that were not met.
    pub fn failures(&self) -> impl Iterator<Item = &Judgement> {
        self.judgements.iter().filter(|judgement| judgement.outcome.is_failure())
    }

    /// The expectation with the smallest margin, as a share of what it allows.
    pub fn tightest(&self) -> Option<&Judgement> {
        let share = |judgement: &Judgement| judgement.outcome.margin().map(|margin| margin.verdict.share());
        self.judgements
            .iter()
            .filter(|judgement| share(judgement).is_some())
            .min_by(|a, b| share(a).unwrap_or(1.0).total_cmp(&share(b).unwrap_or(1.0)))
    }

    /// `guide-7 · crosswind · seed 3`.
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

    /// A time as people read it: seconds after the engagement, or after boot when there was none.
    pub fn seconds(&self, time: SimTime) -> f64 {
        time.as_secs_f64() - self.engaged_at.map_or(0.0, SimTime::as_secs_f64)
    }

    /// The command that opens an instant of the flight in the screen.
    pub fn open_command(&self, time: SimTime) -> String {
        let case =
            if self.case.is_empty() { String::new() } else { format!(" --case {}", shell_word(&self.case)) };
        let seed = if self.tells_seed() { format!(" --seed {}", self.seed) } else { String::new() };
        let boot = if self.engaged_at.is_some() { "" } else { "boot+" };
        let file = if self.file == STANDARD_INPUT { "FILE".to_owned() } else { shell_word(&self.file) };
        format!("betadeck open {file}{case}{seed} --at {boot}{:.2}", self.seconds(time))
    }
}

/// A word as a shell takes it, whatever is in it.
fn shell_word(text: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_./,:@%+=-".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// What was expected of several flights together.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Name of the scenario.
    pub scenario: String,
    /// Its file, as its user named it.
    pub file: String,
    pub variant: String,
    /// The seed that all of them had.
    pub seed: u64,
    /// What became of it.
    pub judgement: Judgement,
}

impl Compared {
    /// `guide-2 · noise real · seed 3: all FLYBY is faster`.
    pub fn title(&self) -> String {
        let variant = if self.variant.is_empty() { String::new() } else { format!(" · {}", self.variant) };
        format!("{}{variant} · seed {}", self.scenario, self.seed)
    }
}

/// The flights of a case, counted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseCount {
    /// `guide-7 · crosswind`.
    pub name: String,
    pub passed: usize,
    /// Those of which nothing was judged.
    pub skipped: usize,
    pub flights: usize,
}

impl CaseCount {
    /// Whether one of them failed.
    pub fn has_failures(&self) -> bool {
        self.passed + self.skipped < self.flights
    }
}

/// All flights of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// The flights, in their order.
    pub flights: Vec<CheckedFlight>,
    /// What was expected of several together.
    pub compared: Vec<Compared>,
    /// Flights that were asked for.
    pub wanted: usize,
    /// Slow scenarios that were left out.
    pub left_out: usize,
    /// Seconds that it took.
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

    /// Whether everything that was asked for was flown and every expectation met.
    pub fn passed(&self) -> bool {
        self.flights.len() == self.wanted
            && self.flights.iter().all(CheckedFlight::passed)
            && !self.compared.iter().any(|compared| compared.judgement.outcome.is_failure())
    }

    /// Flights that passed, those of which nothing was judged not among them.
    pub fn passed_flights(&self) -> usize {
        self.flights.iter().filter(|flight| flight.passed() && !flight.is_skipped()).count()
    }

    /// Flights of which nothing was judged, and skipped expectations of all.
    pub fn skipped(&self) -> (usize, usize) {
        let flights = self.flights.iter().filter(|flight| flight.is_skipped()).count();
        let compared = self.compared.iter().filter(|compared| is_skipped(&compared.judgement)).count();
        (flights, compared + self.flights.iter().map(CheckedFlight::skipped).sum::<usize>())
    }

    /// Simulated seconds of all flights.
    pub fn flown_s(&self) -> f64 {
        self.flights.iter().map(|flight| flight.flown_s).sum()
    }

    /// Whether flights were flown or passed over and nothing of any was judged.
    pub fn is_skipped(&self) -> bool {
        !self.flights.is_empty()
            && self.flights.iter().all(CheckedFlight::is_skipped)
            && self.compared.iter().all(|compared| is_skipped(&compared.judgement))
    }

    /// The cases in their order, each with its seeds and repetitions counted.
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

/// What was seen instead of what was expected, as one sentence.
pub fn complaint(judgement: &Judgement) -> String {
    match &judgement.outcome {
        Outcome::Met(_) => format!("{}: met", judgement.label),
        Outcome::Failed { sentence, guard: None, .. } => format!("{}: {sentence}", judgement.label),
        Outcome::Failed { sentence, guard: Some(guard), .. } => {
            format!("{}: {sentence}; {guard}", judgement.label)
        }
        Outcome::NeverJudged(why) => format!("{}: never judged, {why}", judgement.label),
        Outcome::Skipped(needed) => format!("{}: skipped, {}", judgement.label, needed.missing()),
    }
}

#[cfg(test)]
mod tests;
