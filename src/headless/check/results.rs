//! The results of a run so far.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::headless::check::output::Output;
use crate::process::error::AppError;
use crate::report::check::CheckedFlight;
use crate::report::flight::FlightReport;

/// The finished flights, which are reported as they end.
pub(super) struct Results<'a> {
    output: Output,
    flights: Vec<CheckedFlight>,
    /// The number of requested flights.
    wanted: usize,
    /// `true` if the run stops at the first failure.
    fail_fast: bool,
    /// Set to stop further flights.
    stop: &'a AtomicBool,
    /// The reason why flights can no longer be reported.
    problem: Option<AppError>,
}

impl<'a> Results<'a> {
    /// Creates empty results. `stop` is set to stop further flights.
    pub(super) fn new(output: Output, wanted: usize, fail_fast: bool, stop: &'a AtomicBool) -> Self {
        Self { output, flights: Vec::new(), wanted, fail_fast, stop, problem: None }
    }

    /// Adds a flight, the `done`th that is over. After a stop there are none: one that was already under way does not count.
    pub(super) fn flight(&mut self, flight: CheckedFlight, report: Option<Box<FlightReport>>, done: usize) {
        if self.stop.load(Ordering::Relaxed) {
            return;
        }
        if let Some(report) = report {
            self.output.report(&flight, *report);
        }
        if let Err(error) = self.output.flight(&flight, done, self.wanted) {
            self.problem.get_or_insert(error);
            self.stop.store(true, Ordering::Relaxed);
        }
        if self.fail_fast && !flight.passed() {
            self.stop.store(true, Ordering::Relaxed);
        }
        self.flights.push(flight);
    }

    /// Prints a sentence on standard error during the run.
    pub(super) fn tell(&mut self, sentence: &str) {
        self.output.tell(sentence);
    }

    /// Returns the flights, and the output for their summary.
    ///
    /// # Errors
    /// Returns the error with which a flight could not be reported.
    pub(super) fn finish(self) -> Result<(Output, Vec<CheckedFlight>), AppError> {
        match self.problem {
            Some(problem) => Err(problem),
            None => Ok((self.output, self.flights)),
        }
    }
}
