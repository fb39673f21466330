//! Records the true positions of a craft.

use nalgebra::Vector2;

use crate::events::{Event, SessionEvent};
use crate::flight::{Flight, FlightEnd};
use crate::report::compare::{Landing, Track};
use crate::report::route::TrackSample;
use crate::runner::Subscriber;
use crate::signals::SimTime;
use crate::telemetry::EventKind;
use crate::vehicle::Vehicle;

/// The interval between two samples, µs.
const INTERVAL_US: u64 = 50_000;

/// A track during its flight.
#[derive(Debug)]
pub(super) struct Recorder {
    track: Track,
    /// Altitude of the craft on the ground at home, m.
    standing_m: f64,
    /// The time at which the pilot switched the autopilot on. A remote firmware reports its engagement later than it
    /// engages.
    switched_at: Option<SimTime>,
    was_switching: bool,
    /// The speed of the touchdown since the last look, m/s.
    touched_down: Option<f64>,
}

impl Recorder {
    /// Creates a recorder for a craft on the ground at home, in the air of this seed.
    pub(super) fn new(vehicle: &Vehicle, seed: u64) -> Self {
        let standing_m = vehicle.truth().map_or(0.0, |truth| truth.pos_enu.z);
        Self {
            track: Track { seed, ..Track::default() },
            standing_m,
            switched_at: None,
            was_switching: false,
            touched_down: None,
        }
    }

    /// Returns the track of a finished flight.
    pub(super) fn finish(self, flight: &Flight, end: FlightEnd) -> Track {
        let Some(engaged_at) = flight.engaged_at() else {
            let result = end.verdict.result.to_string();
            return Track { seed: self.track.seed, result, reason: end.verdict.reason, ..Track::default() };
        };
        let begin = self.switched_at.unwrap_or(engaged_at);
        Track {
            result: end.verdict.result.to_string(),
            reason: end.verdict.reason,
            flown_s: Some(end.time.seconds_since(begin)),
            ..self.track
        }
    }
}

impl Subscriber<Flight> for Recorder {
    fn event(&mut self, event: &Event) {
        if let SessionEvent::Vehicle(EventKind::Touchdown { impact_mps, .. }) = event.kind {
            self.touched_down = Some(impact_mps);
        }
    }

    fn after_tick(&mut self, flight: &Flight) {
        let touched_down = self.touched_down.take();
        let vehicle = flight.vehicle();
        let now = vehicle.time();
        let switching = vehicle.transmitter().pilot_doing() == Some("engaging");
        if switching
            && !std::mem::replace(&mut self.was_switching, switching)
            && flight.engaged_at().is_none()
        {
            // Starts again after a refusal.
            self.switched_at = Some(now);
            self.track.samples.clear();
        }
        self.was_switching = switching;
        let begin = self.switched_at.or(flight.engaged_at());
        let (Some(begin), Some(truth)) = (begin, vehicle.truth()) else { return };
        let (time_s, ne) = (now.seconds_since(begin), Vector2::new(truth.pos_enu.y, truth.pos_enu.x));
        if touched_down.is_some() {
            let landing = Landing { time_s, ne, impact_mps: touched_down, disarmed_after_s: None };
            self.track.touchdown = Some(landing);
        }
        if let Some(landing) = &mut self.track.touchdown
            && vehicle.controller().armed() == Some(false)
        {
            landing.disarmed_after_s.get_or_insert(time_s - landing.time_s);
        }
        if now.0.is_multiple_of(INTERVAL_US) {
            let (alt_m, attitude) = (truth.pos_enu.z - self.standing_m, Some(truth.into()));
            self.track.samples.push(TrackSample { time_s, ne, alt_m, attitude });
        }
    }
}
