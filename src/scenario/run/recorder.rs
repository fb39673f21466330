//! Records a flight tick by tick.

use super::log::Log;
use crate::flight::{Flight, FlightEnd};
use crate::plan::FlightPlan;
use crate::scenario::happening::{EventName, Happening};
use crate::scenario::insight::Insight;
use crate::scenario::sampling::sample;
use crate::scenario::trace::Trace;
use crate::signals::SimTime;
use crate::telemetry::Event;
use crate::vehicle::Vehicle;

/// The record of a flight in progress.
#[derive(Debug)]
pub(super) struct Recorder {
    pub(super) trace: Trace,
    /// The knowledge that the flight controller gave.
    pub(super) reported: Insight,
    log: Log,
    sample_us: u64,
    sampled_at: Option<SimTime>,
    /// The altitude at the start of the flight, m.
    start_m: f64,
    /// `true` if the flight had a happening since the last tick.
    has_news: bool,
}

impl Recorder {
    /// Creates an empty record for a vehicle at home.
    pub(super) fn new(vehicle: &Vehicle, plan: FlightPlan, sample_hz: f64) -> Self {
        let step_us = vehicle.step_us();
        Self {
            trace: Trace::new(plan, vehicle.local_frame().copied()),
            reported: if vehicle.embedded().is_some() { Insight::Inner } else { Insight::Telemetry },
            log: Log::default(),
            sample_us: ((1e6 / sample_hz).round() as u64).div_ceil(step_us).max(1) * step_us,
            sampled_at: None,
            start_m: vehicle.truth_view().map_or(0.0, |truth| truth.alt),
            has_news: false,
        }
    }

    /// Records an event of the vehicle.
    pub(super) fn note(&mut self, event: &Event) {
        let before = self.trace.happenings.len();
        self.log.note(event, &mut self.trace);
        self.has_news |= self.trace.happenings.len() != before;
    }

    /// Records the end of the flight. The record may go on.
    pub(super) fn note_end(&mut self, end: &FlightEnd) {
        let word = end.verdict.result.to_string();
        let happening = Happening::event(end.time, EventName::End, &[&word]).saying(&end.verdict.reason);
        self.trace.happenings.push(happening);
        self.has_news = true;
    }

    /// Takes a sample if one is due. Returns `true` if this tick brought a sample or a happening.
    pub(super) fn after_tick(&mut self, flight: &Flight) -> bool {
        self.trace.engaged_at = flight.engaged_at().or(self.trace.engaged_at);
        let is_sample = flight.vehicle().time().0.is_multiple_of(self.sample_us);
        if is_sample {
            self.sample(flight.vehicle());
        }
        std::mem::take(&mut self.has_news) || is_sample
    }

    /// Ends the record. The last happenings need a sample.
    pub(super) fn finish(&mut self, flight: &Flight) {
        if self.sampled_at.is_some_and(|at| at < flight.vehicle().time()) {
            self.sample(flight.vehicle());
        }
    }

    fn sample(&mut self, vehicle: &Vehicle) {
        let sample = sample(vehicle, self.trace.engaged_at, self.start_m);
        if let Some(nav) = vehicle.controller().nav() {
            self.reported = self.reported.max(Insight::Mission);
            if nav.engaged {
                self.trace.note_guards(sample.time, nav.state, nav.wp, &nav.guards);
            }
        }
        self.sampled_at = Some(sample.time);
        self.trace.samples.push(sample);
    }
}
