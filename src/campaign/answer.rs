//! The answer of a campaign, from the records of its flights.

mod builder;
mod causes;
mod failures;
mod goals;
mod versus;

use crate::campaign::record::{Instant, Side};
use crate::scenario::Quantity;

pub use builder::AnswerBuilder;
pub use causes::{Cause, Causes};
pub use failures::{FailureClass, Scatter, ScatterPoint, Values};
pub use goals::{GoalOutcome, JudgedGoal};
pub use versus::{MetricDifference, Versus};

/// The answer of a campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The number of flights that were asked for.
    pub wanted: u64,
    /// The number of flights that are over, of one side.
    pub flown: u64,
    /// The simulated seconds of all flights.
    pub flown_s: f64,
    pub success: Success,
    /// The results with the number of flights of each, the most frequent first.
    pub results: Vec<(String, u64)>,
    /// The distributions of the metrics and measures.
    pub distributions: Vec<Distribution>,
    pub causes: Causes,
    /// The worst flights, the worst first.
    pub worst: Vec<Worst>,
    /// The reasons why flights could not be flown, with the number of flights of each, the most frequent first.
    pub not_flown: Vec<(String, u64)>,
    /// The comparison with the other side, if there is one.
    pub versus: Option<Versus>,
    /// The judged goals, in their order.
    pub goals: Vec<JudgedGoal>,
}

/// The share of flights that met all expectations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Success {
    pub passed: u64,
    /// The number of judged flights.
    pub judged: u64,
    /// The number of flights in which nothing could be judged.
    pub skipped: u64,
    /// The number of flights that could not be flown.
    pub not_flown: u64,
    /// Wilson's interval, with 95 % confidence.
    pub low: f64,
    pub high: f64,
}

impl Success {
    /// Returns the share; `None` if nothing was judged.
    pub fn share(&self) -> Option<f64> {
        (self.judged > 0).then(|| self.passed as f64 / self.judged as f64)
    }
}

/// The distribution of a number over the flights that have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    pub of: Quantity,
    pub count: u64,
    pub mean: f64,
    pub least: f64,
    pub p5: f64,
    pub median: f64,
    pub p95: f64,
    pub greatest: f64,
    /// `true` if the quantiles are exact; otherwise they are within [`Summary::ERROR`](super::Summary::ERROR).
    pub is_exact: bool,
    /// The quantiles in steps of a hundredth, from the least value to the greatest.
    pub curve: Vec<f64>,
    /// The number of values in each of [`CLASSES`](Self::CLASSES) classes of equal width.
    pub classes: Vec<u64>,
}

impl Distribution {
    /// The number of classes.
    pub const CLASSES: usize = 24;
}

/// One of the worst flights.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    pub number: u64,
    pub side: Side,
    pub result: String,
    /// What is wrong with it, as a sentence.
    pub complaint: String,
    /// The instant to look at; `None` = the end.
    pub at: Option<Instant>,
    /// The number of failed flights with the same complaint, its numbers apart, this one among them.
    pub alike: u64,
    /// `true` if it passed and is only the tightest.
    pub has_passed: bool,
    /// The least margin of a flight that passed, as a share of the allowed range.
    pub margin: Option<f64>,
}

impl Worst {
    /// Returns `true` if another flight failed for the same reason, its numbers apart.
    pub fn is_like(&self, other: &Self) -> bool {
        self.side == other.side
            && builder::alike(&self.result, &self.complaint)
                == builder::alike(&other.result, &other.complaint)
    }
}

impl Answer {
    /// Returns `true` if all wanted flights were flown.
    pub fn is_whole(&self) -> bool {
        self.flown == self.wanted
    }

    /// Returns `true` if every flight could be flown and no goal failed. Without goals, every judged flight must have
    /// passed.
    pub fn is_met(&self) -> bool {
        if self.success.not_flown > 0 {
            return false;
        }
        if self.goals.is_empty() {
            return self.success.judged > 0 && self.success.passed == self.success.judged;
        }
        self.goals.iter().all(|goal| goal.outcome == GoalOutcome::Met)
    }

    /// Returns the distribution of a metric or measure.
    pub fn distribution(&self, name: &str) -> Option<&Distribution> {
        self.distributions.iter().find(|distribution| distribution.of.name == name)
    }
}
