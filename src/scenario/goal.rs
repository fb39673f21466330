//! The goals of a campaign: expectations about all its flights together.

mod read;

use super::metric::Metric;
use crate::telemetry::quantity::{Dimension, shown};
pub(super) use read::read_goal;

/// An expectation about all flights of a campaign: `p95(touchdown) <= 2 m`.
#[derive(Debug, Clone, PartialEq)]
pub struct Goal {
    /// The text in the file.
    pub label: String,
    /// Line in the file, from 1.
    pub line: usize,
    /// The number.
    pub subject: Subject,
    /// Its allowed values.
    pub limit: GoalLimit,
    /// The confidence with which the bound of the interval is compared, 0…1; `None` = the estimate itself is compared.
    pub confidence: Option<f64>,
}

/// A number of a campaign.
#[derive(Debug, Clone, PartialEq)]
pub enum Subject {
    /// The share of the flights that met their expectations.
    Success,
    /// The share of the flights with this result.
    Share(String),
    /// A statistic of a number that each flight has.
    Statistic(GoalStatistic, Quantity),
}

/// A number that each flight has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quantity {
    /// The name of a metric or of a measure.
    pub name: String,
    /// The dimension of the number.
    pub dimension: Dimension,
}

/// A way to make one number of those of all flights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GoalStatistic {
    /// The value below which this share of the flights lies, 0…1.
    Quantile(f64),
    /// The mean.
    Mean,
    /// The smallest value.
    Min,
    /// The greatest value.
    Max,
}

/// The allowed values of a number of a campaign, in SI units and shares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoalLimit {
    /// The limit.
    pub value: f64,
    /// `true` if greater values are allowed, `false` if smaller ones are.
    pub is_least: bool,
    /// `true` if the value itself is not allowed.
    pub is_strict: bool,
}

impl GoalLimit {
    /// Returns `true` if a number is allowed.
    pub fn allows(&self, number: f64) -> bool {
        match (self.is_least, self.is_strict) {
            (true, false) => number >= self.value,
            (true, true) => number > self.value,
            (false, false) => number <= self.value,
            (false, true) => number < self.value,
        }
    }
}

impl Subject {
    /// Returns the dimension of the number.
    pub fn dimension(&self) -> Dimension {
        match self {
            Self::Success | Self::Share(_) => Dimension::NONE,
            Self::Statistic(_, quantity) => quantity.dimension,
        }
    }

    /// Returns `true` if the number is a share.
    pub fn is_share(&self) -> bool {
        match self {
            Self::Success | Self::Share(_) => true,
            Self::Statistic(_, quantity) => Metric::find(&quantity.name).is_some_and(Metric::is_share),
        }
    }

    /// Returns a value for people: shares as per cent.
    pub fn shown(&self, value: f64) -> String {
        if self.is_share() { percent(value) } else { shown(value, self.dimension()) }
    }
}

/// Returns a share as per cent, with as many decimals as tell it from 0 and 100 %.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let distance = percent.abs().min((100.0 - percent).abs());
    let decimals = match distance {
        0.0 => 0,
        distance if distance < 0.0095 => 4,
        distance if distance < 0.095 => 3,
        distance if distance < 0.95 => 2,
        _ => 1,
    };
    format!("{percent:.decimals$} %")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_near_the_ends_keep_their_difference() {
        for (share, text) in
            [(0.0, "0 %"), (1.0, "100 %"), (0.9873, "98.7 %"), (0.9999, "99.990 %"), (0.00005, "0.0050 %")]
        {
            assert_eq!(percent(share), text);
        }
    }

    #[test]
    fn limits_are_strict_or_not() {
        let limit = |is_least, is_strict| GoalLimit { value: 2.0, is_least, is_strict };
        assert!(limit(false, false).allows(2.0) && !limit(false, true).allows(2.0));
        assert!(limit(true, false).allows(2.0) && !limit(true, true).allows(2.0));
        assert!(!limit(true, false).allows(1.9) && !limit(false, false).allows(f64::NAN));
    }
}
