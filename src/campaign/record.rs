//! The record of a flight of a campaign: what is kept of it.

use super::flights::CampaignFlight;
use crate::scenario::{Flown, Judgement, Outcome, judge, metrics};
use crate::signals::SimTime;

/// The most sentences about failed expectations that are kept.
const MAX_FAILURES: usize = 5;
/// The longest sentence that is kept, characters.
const MAX_SENTENCE: usize = 400;

/// One of the two sides of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum Side {
    #[default]
    A,
    B,
}

/// The value of an input.
#[derive(Debug, Clone, PartialEq)]
pub enum InputValue {
    Number(f64),
    Word(String),
}

impl InputValue {
    /// Returns the number; `None` for a word.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Word(_) => None,
        }
    }

    /// Returns a text as a number if it is one.
    pub fn of(text: &str) -> Self {
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Self::Number(number),
            _ => Self::Word(text.to_owned()),
        }
    }
}

impl std::fmt::Display for InputValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Word(word) => f.write_str(word),
        }
    }
}

/// The judgement of a flight as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum Standing {
    Passed,
    Failed,
    /// Nothing could be judged, because the firmware reports too little.
    Skipped,
    /// The flight could not be flown, for the reason in [`Record::problem`]: it is neither a success nor a failure.
    #[strum(serialize = "not_flown")]
    NotFlown,
}

/// An instant of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Simulated seconds since the engagement, or since boot if there was none.
    pub seconds: f64,
    /// `true` if they count from boot.
    pub is_from_boot: bool,
}

/// A flight of a campaign after it was flown.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The number of the flight, from 1.
    pub number: u64,
    pub side: Side,
    pub seed: u64,
    pub inputs: Vec<(String, InputValue)>,
    pub standing: Standing,
    /// The reason why the flight could not be flown or trusted.
    pub problem: Option<String>,
    /// The result, such as `complete`; empty if it was not flown.
    pub result: String,
    /// The reason as a sentence.
    pub reason: String,
    /// The expectations that were not met, as sentences.
    pub failures: Vec<String>,
    /// The smallest margin of a met expectation, as a share of its allowed range.
    pub margin: Option<f64>,
    /// The worst instant; `None` = the end.
    pub worst_at: Option<Instant>,
    pub metrics: Vec<(String, f64)>,
    /// The simulated seconds of the record.
    pub flown_s: f64,
    /// Equal for flights that are the same to the last bit.
    pub hash: u64,
}

impl Record {
    /// Returns the record of a flight that was not flown, with the reason.
    pub fn not_flown(flight: &CampaignFlight, side: Side, problem: String) -> Self {
        Self {
            number: flight.number,
            side,
            seed: flight.air.seed,
            inputs: flight.inputs.clone(),
            standing: Standing::NotFlown,
            problem: Some(short(problem)),
            result: String::new(),
            reason: String::new(),
            failures: Vec::new(),
            margin: None,
            worst_at: None,
            metrics: Vec::new(),
            flown_s: 0.0,
            hash: 0,
        }
    }

    /// Judges a flown flight. `hash` is that of a remote firmware, which takes the place of the one of the record.
    pub fn of(flight: &CampaignFlight, side: Side, flown: &Flown, hash: Option<u64>) -> Self {
        let (judgements, measures) = judge(&flight.case, flown);
        let failed: Vec<&Judgement> =
            judgements.iter().filter(|judgement| judgement.outcome.is_failure()).collect();
        let is_skipped = !judgements.is_empty()
            && judgements.iter().all(|judgement| matches!(judgement.outcome, Outcome::Skipped(_)));
        let engaged = flown.trace.engaged_at;
        let instant = |at: SimTime| Instant {
            seconds: rounded(flown.trace.seconds(at)),
            is_from_boot: engaged.is_none(),
        };
        let worst_at = failed.iter().find_map(|judgement| match judgement.outcome {
            Outcome::Failed { at, .. } => at,
            _ => None,
        });
        let margins = judgements.iter().filter_map(|judgement| judgement.outcome.margin());
        let metrics = metrics(&flight.case, flown, &measures);
        Self {
            standing: match failed.is_empty() {
                false => Standing::Failed,
                true if is_skipped => Standing::Skipped,
                true => Standing::Passed,
            },
            problem: None,
            result: flown.result.clone(),
            reason: short(flown.reason.clone()),
            failures: failed.iter().take(MAX_FAILURES).map(|judgement| short(sentence(judgement))).collect(),
            margin: margins.map(|margin| rounded(margin.verdict.share())).reduce(f64::min),
            worst_at: worst_at.map(instant),
            metrics: metrics.into_iter().map(|(name, value)| (name, rounded(value))).collect(),
            flown_s: rounded(flown.trace.end().as_secs_f64()),
            hash: hash.unwrap_or_else(|| flown.trace.hash()),
            ..Self::not_flown(flight, side, String::new())
        }
    }

    /// Returns the record with a reason not to trust the flight, if there is one.
    pub fn with_problem(self, problem: Option<String>) -> Self {
        match problem {
            None => self,
            Some(problem) => Self { problem: Some(short(problem)), standing: Standing::Failed, ..self },
        }
    }

    /// Returns a metric; `None` if the flight has none.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.metrics.iter().find(|(known, _)| known == name).map(|&(_, value)| value)
    }

    /// Returns why it failed, as one sentence.
    pub fn complaint(&self) -> String {
        // An expectation of the result repeats the result and the reason.
        let of_result = format!("it ended {}: {}", self.result, self.reason);
        match (&self.problem, self.failures.first()) {
            (Some(problem), _) => problem.clone(),
            (None, Some(failure)) if !failure.ends_with(&of_result) => failure.clone(),
            _ => self.reason.clone(),
        }
    }

    /// Returns a key that is smaller for a worse flight: crashes come first, then flights that ended otherwise than planned,
    /// then failed expectations, then the tightest of those that passed.
    pub(super) fn badness(&self) -> (u8, f64) {
        let miss = || -self.metric("waypoint_miss").or_else(|| self.metric("cross_track")).unwrap_or(0.0);
        match (self.standing, self.result.as_str()) {
            (Standing::Passed, _) => (4, self.margin.unwrap_or(1.0)),
            (Standing::Skipped | Standing::NotFlown, _) => (5, 0.0),
            (Standing::Failed, "crashed" | "diverged") => (0, miss()),
            (Standing::Failed, "complete" | "stopped") => (3, miss()),
            (Standing::Failed, "missed") => (2, miss()),
            (Standing::Failed, _) => (1, miss()),
        }
    }
}

/// Returns an expectation that was not met, as a sentence.
fn sentence(judgement: &Judgement) -> String {
    match &judgement.outcome {
        Outcome::Failed { sentence, .. } => format!("{}: {sentence}", judgement.label),
        Outcome::NeverJudged(why) => format!("{}: never judged, {why}", judgement.label),
        Outcome::Met(_) | Outcome::Skipped(_) => judgement.label.clone(),
    }
}

fn short(sentence: String) -> String {
    if sentence.chars().count() <= MAX_SENTENCE {
        return sentence;
    }
    sentence.chars().take(MAX_SENTENCE - 1).chain(['…']).collect()
}

/// Returns a value with six decimals. A line then needs little room.
fn rounded(value: f64) -> f64 {
    let rounded = (value * 1e6).round() / 1e6;
    // −0 becomes 0.
    if rounded == 0.0 { 0.0 } else { rounded }
}
