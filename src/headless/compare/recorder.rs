//! Records the true positions of a craft.

use nalgebra::Vector2;

use crate::events::{Event, SessionEvent};
use crate::flight::{Flight, FlightEnd};
use crate::report::compare::Track;
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
    /// `true` if the craft touched the ground since the last look.
    touched_down: bool,
}

impl Recorder {
    /// Creates a recorder for a craft on the ground at home, in the air of this seed.
    pub(super) fn new(vehicle: &Vehicle, seed: u64) -> Self {
        let standing_m = place(vehicle).map_or(0.0, |(_, alt_m)| alt_m);
        Self {
            track: Track { seed, ..Track::default() },
            standing_m,
            switched_at: None,
            was_switching: false,
            touched_down: false,
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
        self.touched_down |= matches!(event.kind, SessionEvent::Vehicle(EventKind::Touchdown { .. }));
    }

    fn after_tick(&mut self, flight: &Flight) {
        let touched_down = std::mem::take(&mut self.touched_down);
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
        let (Some(begin), Some((ne, alt_m))) = (begin, place(vehicle)) else { return };
        let time_s = now.seconds_since(begin);
        if touched_down {
            self.track.touchdown = Some((time_s, ne));
        }
        if now.0.is_multiple_of(INTERVAL_US) {
            self.track.samples.push(TrackSample { time_s, ne, alt_m: alt_m - self.standing_m });
        }
    }
}

/// Returns the position north and east of home and above it, m.
fn place(vehicle: &Vehicle) -> Option<(Vector2<f64>, f64)> {
    let position = vehicle.truth()?.pos_enu;
    Some((Vector2::new(position.y, position.x), position.z))
}
