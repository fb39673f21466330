//! The result of a forecast.

use super::observer::{LegTime, WorstXte};
use super::path::PathPoint;
use crate::flight::FlightResult;

/// The flight of a forecast.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForecastKind {
    /// A plan, from home.
    PlanEstimate,
    /// The present flight as it is.
    LookAhead,
    /// The present flight with a failure.
    WhatIf,
    /// The present flight or a plan with other settings. The forecast itself is of one of the kinds above.
    SettingChange,
}

/// The end of a forecast's flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForecastEnd {
    /// An end of any headless flight.
    Flight(FlightResult),
    /// The flight does not end by itself.
    Endless,
    /// The craft never takes off.
    Grounded,
    /// The flight takes longer than a forecast follows.
    TooLong,
}

/// The end of a run, without the observations on the way.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ended {
    pub(super) kind: ForecastKind,
    pub(super) end: ForecastEnd,
    pub(super) reason: String,
    pub(super) time_s: f64,
}

/// A flight flown ahead of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// The kind of flight that was flown ahead of time.
    pub kind: ForecastKind,
    /// The end of the flight.
    pub end: ForecastEnd,
    /// Reason, as a sentence without its full stop.
    pub reason: String,
    /// Simulated time to the end, s. For a plan it counts from the engagement (from the start if there is none), else
    /// from now.
    pub time_s: f64,
    /// Charge drawn at the end since the battery was full, %.
    pub battery_used_pct: f64,
    /// Largest cross-track error on a leg of the plan, if one was flown along a line.
    pub worst_xte: Option<WorstXte>,
    /// Smallest distance to the fence from inside, m; negative outside; `None` without a fence or without a plan.
    pub fence_margin_m: Option<f64>,
    /// Time of each waypoint of the plan, with its hold, in flight order.
    pub legs: Vec<LegTime>,
    /// Horizontal distance of the craft between start and end, m.
    pub moved_m: f64,
    /// True path of the craft.
    pub path: Vec<PathPoint>,
    /// The same flight without the changed settings, of a forecast with other settings.
    pub unchanged: Option<Box<Self>>,
}

impl Forecast {
    /// Returns `true` if the plan is flown to its planned end.
    pub fn is_complete(&self) -> bool {
        self.end == ForecastEnd::Flight(FlightResult::Complete)
    }

    /// Returns the end in a line: `COMPLETE in 1:52, 41 % left`. `length` formats metres in the displayed unit.
    pub fn line(&self, length: impl Fn(f64) -> String) -> String {
        let (time, left) = (minutes(self.time_s), 100.0 - self.battery_used_pct);
        let left = format!("{left:.0} % left");
        let (moved, reason) = (length(self.moved_m), &self.reason);
        match self.end {
            ForecastEnd::Flight(FlightResult::Complete) => format!("COMPLETE in {time}, {left}"),
            ForecastEnd::Flight(FlightResult::Missed) => format!("COMPLETE in {time}, but missed: {reason}"),
            ForecastEnd::Flight(FlightResult::Landed) => {
                format!("{reason} in {time}, {moved} from here, {left}")
            }
            ForecastEnd::Flight(FlightResult::Aborted) => {
                format!("drifts {moved} in {time}, {left}: {reason}")
            }
            ForecastEnd::Flight(FlightResult::Crashed) => {
                format!("CRASHES in {time}, {moved} from here: {reason}")
            }
            ForecastEnd::Flight(_) => format!("ends in {time}, {moved} from here: {reason}"),
            ForecastEnd::Endless => format!("{reason}, {left} after {time}"),
            ForecastEnd::Grounded | ForecastEnd::TooLong => reason.clone(),
        }
    }
}

/// Returns minutes and seconds: `1:52`.
fn minutes(seconds: f64) -> String {
    // Never negative. A forecast never follows more than a day.
    let seconds = seconds.round() as u32;
    format!("{}:{:02}", seconds / 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minutes_are_short() {
        assert_eq!((minutes(111.6).as_str(), minutes(0.2).as_str()), ("1:52", "0:00"));
        assert_eq!(minutes(1800.0), "30:00");
    }
}
