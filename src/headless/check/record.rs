//! Records the flight of a case for the page about the run.

use crate::events::Event;
use crate::headless::report;
use crate::report::flight::FlightReport;
use crate::runner::Subscriber;
use crate::scenario::{Case, CaseFlight, Flown};
use crate::vehicle::Vehicle;

/// The record of a flight, if there is a page about the run.
pub(super) struct Record(Option<Box<FlightReport>>);

impl Record {
    /// Begins the record of a flight of this case, if it is reported.
    pub(super) fn new(is_reported: bool, vehicle: &Vehicle, case: &Case) -> Self {
        let report = || Box::new(report::about(vehicle, "", &case.setup.plan.plan));
        Self(is_reported.then(report))
    }

    /// Returns the report about the finished flight.
    pub(super) fn finish(self, case: &Case, flown: &Flown) -> Option<Box<FlightReport>> {
        let mut report = self.0?;
        report.truth = flown.truth.clone();
        report.tolerance_m = case.pilot.then_some(case.options.tolerance_m);
        Some(report)
    }
}

impl Subscriber<CaseFlight<'_>> for Record {
    fn event(&mut self, event: &Event) {
        if let Some(report) = &mut self.0 {
            report.record.note(event);
        }
    }

    fn after_tick(&mut self, flight: &CaseFlight<'_>) {
        if let Some(report) = &mut self.0 {
            report::sample(&mut report.record, flight.vehicle());
        }
    }
}
