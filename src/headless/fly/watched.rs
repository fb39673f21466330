//! A flight that is watched for a while after its end, as `check` does, so that both give the same hash.

use crate::flight::{Flight, FlightEnd};
use crate::runner::Flying;
use crate::scenario::FlightHash;
use crate::telemetry::Event;
use crate::vehicle::Vehicle;

/// A flight with its hash, if that is wanted. Without a hash it is over at its end.
pub(super) struct WatchedFlight {
    flight: Flight,
    hash: Option<FlightHash>,
    end: Option<FlightEnd>,
}

impl WatchedFlight {
    pub(super) fn new(flight: Flight, hash: Option<FlightHash>) -> Self {
        Self { flight, hash, end: None }
    }

    pub(super) fn flight(&self) -> &Flight {
        &self.flight
    }

    /// Returns the end of the flight, also while it is watched.
    pub(super) fn end(&self) -> Option<&FlightEnd> {
        self.end.as_ref()
    }

    /// Returns the hash, if the flight was watched to the end.
    pub(super) fn hash(self) -> Option<u64> {
        Some(self.hash.filter(FlightHash::is_over)?.finish(&self.flight))
    }
}

impl Flying for WatchedFlight {
    type End = FlightEnd;

    fn vehicle(&self) -> &Vehicle {
        self.flight.vehicle()
    }

    fn vehicle_mut(&mut self) -> &mut Vehicle {
        self.flight.vehicle_mut()
    }

    fn tick(&mut self, mut report: impl FnMut(Event)) -> Option<FlightEnd> {
        let Some(hash) = &mut self.hash else {
            self.end = self.flight.tick(report);
            return self.end.clone();
        };
        let was_over = self.end.is_some();
        let end = self.flight.tick(|event| {
            hash.note(&event);
            if !was_over {
                report(event);
            }
        });
        if let Some(end) = end
            && !was_over
        {
            hash.note_end(&end);
            self.end = Some(end);
        }
        hash.after_tick(&self.flight);
        if hash.is_over() { self.end.clone() } else { None }
    }
}
