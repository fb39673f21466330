//! The hash of a flight that has no scenario.

use super::recorder::Recorder;
use crate::flight::{Flight, FlightEnd, FlightResult};
use crate::plan::FlightPlan;
use crate::scenario::case::{SAMPLE_HZ, WATCH_S};
use crate::scenario::trace::TraceHasher;
use crate::signals::SimTime;
use crate::telemetry::Event;
use crate::vehicle::Vehicle;

/// The hash of a flight in progress. It is the one of a case with the same start and no inputs, which is watched for the
/// usual time after its end.
#[derive(Debug)]
pub struct FlightHash {
    recorder: Recorder,
    hasher: TraceHasher,
    /// The time from which the flight need not be watched any more.
    watched_at: Option<SimTime>,
    is_over: bool,
}

impl FlightHash {
    /// Begins the hash for a vehicle that is at home with its plan.
    pub fn new(vehicle: &Vehicle, plan: FlightPlan) -> Self {
        let recorder = Recorder::new(vehicle, plan, SAMPLE_HZ);
        Self { recorder, hasher: TraceHasher::default(), watched_at: None, is_over: false }
    }

    /// Adds an event of the vehicle.
    pub fn note(&mut self, event: &Event) {
        self.recorder.note(event);
    }

    /// Adds the end of the flight.
    pub fn note_end(&mut self, end: &FlightEnd) {
        self.recorder.note_end(end);
        let is_lost = end.verdict.result == FlightResult::Diverged;
        let watch = SimTime::from_secs_f64(if is_lost { 0.0 } else { WATCH_S });
        self.watched_at = Some(SimTime(end.time.0 + watch.0));
    }

    /// Adds the state after a tick, its events and its end.
    pub fn after_tick(&mut self, flight: &Flight) {
        if self.recorder.after_tick(flight) {
            let now = flight.vehicle().time();
            self.is_over = self.watched_at.is_some_and(|at| now >= at);
        }
        self.add_samples();
    }

    /// Returns `true` if the time to watch after the end is over.
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Returns the hash of the flight so far.
    pub fn finish(mut self, flight: &Flight) -> u64 {
        self.recorder.finish(flight);
        self.add_samples();
        self.hasher.finish(&self.recorder.trace.happenings)
    }

    /// Moves the new samples into the hash, so that a long flight needs no more memory than a short one.
    fn add_samples(&mut self) {
        self.recorder.trace.samples.drain(..).for_each(|sample| self.hasher.sample(&sample));
    }
}
