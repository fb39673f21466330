//! The track of a recorded flight of a scenario.

use nalgebra::Vector2;

use super::{Landing, Track};
use crate::report::route::{SampledAttitude, TrackSample};
use crate::scenario::Flown;
use crate::scenario::happening::{EventName, Field, Happening, HappeningKind};
use crate::signals::SimTime;
use crate::telemetry::signal::Signal;

/// The interval between two samples of a track, µs.
const INTERVAL_US: u64 = 50_000;

/// Returns the track of a flight from its engagement on; from boot on if the autopilot did not engage.
pub fn flown_track(flown: &Flown, seed: u64) -> Track {
    let trace = &flown.trace;
    let begin = trace.engaged_at.unwrap_or(SimTime::ZERO);
    let time_s = |time: SimTime| time.seconds_since(begin);
    let standing_m = trace.samples.first().map_or(0.0, |first| first.value(Signal::Altitude));
    let kept = trace
        .samples
        .iter()
        .filter(|sample| sample.time >= begin && sample.time.0.is_multiple_of(INTERVAL_US));
    let samples: Vec<TrackSample> = kept
        .map(|sample| TrackSample {
            time_s: time_s(sample.time),
            ne: Vector2::from(sample.place()),
            alt_m: sample.value(Signal::Altitude) - standing_m,
            attitude: Some(SampledAttitude {
                heading_deg: sample.value(Signal::Heading),
                tilt_deg: sample.value(Signal::Tilt),
            }),
        })
        .collect();
    Track {
        seed,
        touchdown: touchdown(flown, begin),
        samples,
        result: flown.result.clone(),
        reason: flown.reason.clone(),
        flown_s: trace.engaged_at.map(|_| flown.flown_s),
    }
}

/// Returns the last touchdown after `begin`.
fn touchdown(flown: &Flown, begin: SimTime) -> Option<Landing> {
    let trace = &flown.trace;
    let is_event = |happening: &&Happening, name: EventName| matches!(happening.kind, HappeningKind::Event { name: found, .. } if found == name);
    let mut events = trace.happenings.iter().filter(|happening| happening.time >= begin);
    let touchdown = events.rfind(|happening| is_event(happening, EventName::Touchdown))?;
    let place = trace.samples.get(trace.index_at(touchdown.time.0 as i64)?)?.place();
    let mut disarmings = trace.happenings.iter().filter(|happening| is_event(happening, EventName::Disarmed));
    let disarmed = disarmings.find(|disarmed| disarmed.time >= touchdown.time);
    Some(Landing {
        time_s: touchdown.time.seconds_since(begin),
        ne: Vector2::from(place),
        impact_mps: touchdown.field(Field::Impact),
        disarmed_after_s: disarmed.map(|disarmed| disarmed.time.seconds_since(touchdown.time)),
    })
}
