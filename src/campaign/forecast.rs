//! Go or no-go: the share of flights that complete with charge to spare.

use super::answer::{Answer, AnswerBuilder};
use super::record::{Record, Standing};
use crate::scenario::{Scenario, percent};

/// The metric with the charge that is left, as a share of the charge at the start.
const LEFT: &str = "battery_left";
/// The input with the difference of the charge at the start from a full battery, per cent. Without it the battery is full.
const CHARGE: &str = "battery_pct";

/// The forecast so far.
#[derive(Debug, Clone)]
pub struct Forecast {
    builder: AnswerBuilder,
    reserve: f64,
    short_of_charge: u64,
    least_left: Option<f64>,
}

/// The answer of a forecast.
#[derive(Debug, Clone, PartialEq)]
pub struct ForecastAnswer {
    pub answer: Answer,
    /// The charge that had to be left, as a share of the battery's capacity.
    pub reserve: f64,
    /// The number of flights that completed with too little charge.
    pub short_of_charge: u64,
    /// The least charge that was left, as a share of the battery's capacity.
    pub least_left: Option<f64>,
}

impl Forecast {
    /// The usual number of flights.
    pub const FLIGHTS: u64 = 100;
    /// The usual charge that must be left, as a share of the capacity.
    pub const RESERVE: f64 = 0.2;
    /// The usual share of successes for go.
    pub const GO_FROM: f64 = 0.95;

    /// Returns the forecast of no flights. `reserve` is the charge that must be left, as a share of the capacity.
    pub fn new(scenario: &Scenario, wanted: u64, reserve: f64) -> Self {
        let builder = AnswerBuilder::new(scenario, wanted, false);
        Self { builder, reserve, short_of_charge: 0, least_left: None }
    }

    /// Adds a flight. One that passed with less than the reserve counts as failed.
    pub fn add(&mut self, mut record: Record) {
        let drawn = record.inputs.iter().find(|(name, _)| name == CHARGE);
        let charge_pct = drawn.and_then(|(_, value)| value.number()).unwrap_or(0.0);
        // The metric is a share of the charge at the start.
        let left = record.metric(LEFT).map(|left| left * (1.0 + charge_pct / 100.0));
        if let Some(left) = left {
            self.least_left = Some(self.least_left.map_or(left, |least| least.min(left)));
            if record.standing == Standing::Passed && left <= self.reserve {
                self.short_of_charge += 1;
                record.standing = Standing::Failed;
                record.failures.push(format!(
                    "only {} of the battery is left, more than {} is wanted",
                    percent(left),
                    percent(self.reserve)
                ));
            }
        }
        self.builder.add(&record);
    }

    /// Returns the answer of the flights so far.
    pub fn answer(&self) -> ForecastAnswer {
        ForecastAnswer {
            answer: self.builder.answer(),
            reserve: self.reserve,
            short_of_charge: self.short_of_charge,
            least_left: self.least_left,
        }
    }
}

impl ForecastAnswer {
    /// Returns `true` if at least this share of the flights succeeded, and all of them were flown.
    pub fn is_go(&self, from: f64) -> bool {
        self.answer.is_whole()
            && self.answer.success.not_flown == 0
            && self.answer.success.share().is_some_and(|share| share >= from)
    }
}
