//! What the flights of a run have come to so far.

use std::sync::atomic::{AtomicBool, Ordering};

use super::output::Output;
use crate::app::AppError;
use crate::record::check::CheckedFlight;

/// The flights that are over, told as they end.
pub(super) struct Results<'a> {
    output: Output,
    flights: Vec<CheckedFlight>,
    /// Flights that were asked for.
    wanted: usize,
    /// The first that fails is the last.
    fail_fast: bool,
    /// Raised when no more are to be flown.
    stop: &'a AtomicBool,
    /// Why they cannot be told any more.
    problem: Option<AppError>,
}

impl<'a> Results<'a> {
    /// Of none yet. `stop` is raised when no more are to be flown.
    pub(super) fn new(output: Output, wanted: usize, fail_fast: bool, stop: &'a AtomicBool) -> Self {
        Self { output, flights: Vec::new(), wanted, fail_fast, stop, problem: None }
    }

    /// Takes a flight, the `done`th that is over.
    pub(super) fn flight(&mut self, flight: CheckedFlight, done: usize) {
        if let Err(error) = self.output.flight(&flight, done, self.wanted) {
            self.problem.get_or_insert(error);
            self.stop.store(true, Ordering::Relaxed);
        }
        if self.fail_fast && !flight.passed() {
            self.stop.store(true, Ordering::Relaxed);
        }
        self.flights.push(flight);
    }

    /// Tells on standard error what is to be known meanwhile.
    pub(super) fn tell(&mut self, sentence: &str) {
        self.output.tell(sentence);
    }

    /// Whether no more are to be flown.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// The flights, and where their summary goes.
    ///
    /// # Errors
    /// When they could not be told.
    pub(super) fn finish(self) -> Result<(Output, Vec<CheckedFlight>), AppError> {
        match self.problem {
            Some(problem) => Err(problem),
            None => Ok((self.output, self.flights)),
        }
    }
}
