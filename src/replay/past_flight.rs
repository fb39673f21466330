//! The interface to a flight that is over.

use std::sync::Arc;

use super::{Curve, Overview};
use crate::signals::SimTime;
use crate::telemetry::Snapshot;

/// A flight at an instant.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moment {
    pub snapshot: Snapshot,
    /// The values of all series, in the order of [`Overview::series`]; NaN for an unknown one.
    pub values: Vec<f64>,
}

/// A request for a part of some series.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvesRequest {
    /// Indices into [`Overview::series`].
    pub series: Vec<usize>,
    pub from: SimTime,
    pub to: SimTime,
    /// The number of steps of each curve. A flight may give fewer.
    pub steps: usize,
}

/// A flight that is over. Errors are sentences for people.
pub trait PastFlight: Send {
    /// Returns the whole flight for a display.
    fn overview(&self) -> Arc<Overview>;

    /// Returns the flight at an instant. Before the first record it is the first, after the last one the last.
    ///
    /// # Errors
    /// Returns an error if the record can no longer be read.
    fn at(&mut self, time: SimTime) -> Result<Moment, String>;

    /// Returns the curves of a part of the flight, in the order of the request.
    ///
    /// # Errors
    /// Returns an error if the record can no longer be read.
    fn curves(&mut self, request: &CurvesRequest) -> Result<Vec<Curve>, String>;
}

/// Receives the share of a record that was read, 0…1. Returns `false` to stop the reading.
pub type Progress<'p> = &'p mut dyn FnMut(f64) -> bool;

/// The flights of a file. Errors are sentences for people.
pub trait PastFlights: Send {
    /// Returns the name of the file, safe to print.
    fn name(&self) -> &str;

    /// Reads the file, before anything else is asked; a second call does nothing. Returns `false` if the progress stopped
    /// it.
    ///
    /// # Errors
    /// Returns an error if the file has no flight that can be read.
    fn read(&mut self, progress: Progress<'_>) -> Result<bool, String>;

    /// Returns the number of flights, also of those that cannot be shown.
    fn count(&self) -> usize;

    /// Returns sentences about the file as a whole.
    fn notices(&self) -> Vec<String>;

    /// Opens a flight, numbered from zero.
    ///
    /// # Errors
    /// Returns an error if it cannot be shown.
    fn open(&mut self, number: usize) -> Result<Box<dyn PastFlight>, String>;
}
