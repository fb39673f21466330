//! The flight of a case: a headless flight, its inputs at their instants, and the record.

mod flight_hash;
mod inputs;
mod log;
mod recorder;

use super::expression::{Evaluator, Lookups, Search};
use super::happening::{EventName, Happening};
use super::insight::Insight;
use super::trace::Trace;
use crate::flight::{Flight, FlightEnd, FlightResult};
use crate::scenario::air::Air;
use crate::scenario::case::Case;
use crate::signals::SimTime;
use crate::telemetry::{Event, FirmwareProfile, FlightTruth};
use crate::vehicle::Vehicle;
pub use flight_hash::FlightHash;
use inputs::Inputs;
use recorder::Recorder;

/// A finished flight of a case.
#[derive(Debug, Clone)]
pub struct Flown {
    /// The record of the flight.
    pub trace: Trace,
    /// The result: one of [`RESULTS`](super::happening::RESULTS).
    pub result: String,
    /// The reason as a sentence.
    pub reason: String,
    /// The time at which the flight ended; the record may go on.
    pub ended_at: SimTime,
    /// The knowledge that the flight controller gave.
    pub reported: Insight,
    /// The kind of its firmware, if it is known.
    pub firmware: Option<FirmwareProfile>,
    /// The truth about the plan at the end of the flight.
    pub truth: FlightTruth,
    /// Simulated seconds from the engagement (or boot, if there was none) to the end.
    pub flown_s: f64,
}

/// A flight of a case in progress.
#[derive(Debug)]
pub struct CaseFlight<'a> {
    case: &'a Case,
    flight: Flight,
    inputs: Inputs<'a>,
    recorder: Recorder,
    ends: Option<Search<'a>>,
    /// What the inputs and the end have looked up.
    lookups: Lookups,
    end: Option<FlightEnd>,
    /// The word for the result and the reason, if the scenario ended the flight.
    stopped: Option<(&'static str, String)>,
    is_over: bool,
}

impl<'a> CaseFlight<'a> {
    /// Prepares the flight of a case in an air, at boot.
    ///
    /// # Errors
    /// Returns a sentence if the vehicle cannot be created or a mode that the pilot needs has no switch.
    pub fn new(case: &'a Case, air: &Air) -> Result<Self, String> {
        let mut setup = case.setup_in(air);
        setup.stored.plan = setup.plan.plan.clone();
        let (vehicle, _) = setup.build().map_err(|error| error.to_string())?;
        Self::from_vehicle(case, vehicle)
    }

    /// Prepares the flight for a vehicle that is at home with the plan of the case.
    ///
    /// # Errors
    /// Returns a sentence if a mode that the pilot needs has no switch.
    pub fn from_vehicle(case: &'a Case, vehicle: Vehicle) -> Result<Self, String> {
        let recorder = Recorder::new(&vehicle, case.setup.plan.plan.clone(), case.sample_hz);
        let flight = if case.pilot {
            Flight::new(vehicle, &case.options)
                .map_err(|refusal| format!("{refusal}: the pilot needs one; set it with an aux line"))?
        } else {
            Flight::go_on(vehicle, &case.options)
        };
        Ok(Self {
            case,
            flight,
            inputs: Inputs::new(&case.inputs),
            recorder,
            ends: case.ends.as_ref().map(Search::new),
            lookups: Lookups::default(),
            end: None,
            stopped: None,
            is_over: false,
        })
    }

    /// Returns the vehicle.
    pub fn vehicle(&self) -> &Vehicle {
        self.flight.vehicle()
    }

    /// Returns the vehicle, for recorders.
    pub fn vehicle_mut(&mut self) -> &mut Vehicle {
        self.flight.vehicle_mut()
    }

    /// Returns the vehicle in its state after the flight.
    pub fn into_vehicle(self) -> Vehicle {
        self.flight.into_vehicle()
    }

    /// Returns the flight without its record, its timed inputs and its own end.
    pub fn into_flight(self) -> Flight {
        self.flight
    }

    /// Returns the record so far.
    pub fn trace(&self) -> &Trace {
        &self.recorder.trace
    }

    /// Flies to the end.
    pub fn fly(mut self) -> Flown {
        while !self.is_over {
            self.prepare();
            self.tick(|_| {});
        }
        self.finish()
    }

    /// Returns `true` if the flight and the time to watch after it are over.
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Carries out the inputs that are due before the next tick.
    pub fn prepare(&mut self) {
        if self.inputs.is_due(self.flight.vehicle().time()) {
            let (trace, names) = (&mut self.recorder.trace, self.case.parameters.as_slice());
            self.inputs.carry_out(self.flight.vehicle_mut(), trace, (names, &self.lookups));
        }
    }

    /// Flies one tick and reports its events to `report`.
    pub fn tick(&mut self, mut report: impl FnMut(Event)) {
        let recorder = &mut self.recorder;
        let end = self.flight.tick(|event| {
            recorder.note(&event);
            report(event);
        });
        if let Some(end) = end
            && self.end.is_none()
        {
            self.recorder.note_end(&end);
            self.end = Some(end);
        }
        if self.recorder.after_tick(&self.flight) {
            let names = self.case.parameters.as_slice();
            self.inputs.look(&Evaluator::in_flight(&self.recorder.trace, names, &self.lookups));
            self.check_end(self.flight.vehicle().time());
        }
    }

    /// Ends the record if it is time.
    fn check_end(&mut self, now: SimTime) {
        if let Some(end) = &self.end {
            let is_lost = matches!(end.verdict.result, FlightResult::Diverged);
            let watched_s = now.seconds_since(end.time);
            self.is_over = is_lost || watched_s >= self.case.watch_s && self.ends.is_none();
        }
        let names = self.case.parameters.as_slice();
        if let Some(search) = &mut self.ends
            && let Some(due) =
                search.advance(&Evaluator::in_flight(&self.recorder.trace, names, &self.lookups))
            && now.0 as i64 >= due
        {
            self.is_over = true;
            self.stop("stopped", "the scenario ended the flight");
        }
        if !self.is_over && self.recorder.trace.seconds(now) >= self.case.time_limit_s {
            self.is_over = true;
            let limit = self.case.time_limit_s;
            let doing = match (self.end.is_some(), self.ends.is_some()) {
                (_, true) => "its end did not come",
                (true, false) => "still watched",
                (false, false) => "not over",
            };
            let after = if self.recorder.trace.engaged_at.is_some() { "the engagement" } else { "boot" };
            self.stop("timeout", &format!("{doing} {limit} s after {after}"));
        }
    }

    fn stop(&mut self, word: &'static str, reason: &str) {
        if self.end.is_none() || word == "timeout" {
            self.stopped = Some((word, reason.to_owned()));
        }
        if self.end.is_none() {
            let now = self.flight.vehicle().time();
            self.recorder
                .trace
                .happenings
                .push(Happening::event(now, EventName::End, &[word]).saying(reason));
        }
    }

    /// Ends the record, and returns its hash: equal for flights that are the same to the last bit.
    pub fn hash(&mut self) -> u64 {
        self.recorder.finish(&self.flight);
        self.recorder.trace.hash()
    }

    /// Returns the finished flight.
    pub fn finish(mut self) -> Flown {
        self.recorder.finish(&self.flight);
        let firmware = self.flight.vehicle().controller().profile();
        let end = self.end.unwrap_or_else(|| self.flight.interrupt("the scenario ended the flight"));
        let FlightEnd { verdict, truth, flown_s, time: ended_at } = end;
        let (result, reason) = match self.stopped {
            Some((word, reason)) => (word.to_owned(), reason),
            None => (verdict.result.to_string(), verdict.reason),
        };
        let Recorder { trace, reported, .. } = self.recorder;
        Flown { trace, result, reason, ended_at, reported, firmware, truth, flown_s }
    }
}
