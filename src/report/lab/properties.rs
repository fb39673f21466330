//! Properties that every firmware keeps in every flight.

use crate::report::route::Route;
use crate::scenario::flag::Flag;
use crate::scenario::happening::{EventName, Happening, HappeningKind};
use crate::scenario::{Flown, Judgement, Outcome, Sample};
use crate::signals::SimTime;
use crate::telemetry::NavState;
use crate::telemetry::signal::Signal;
use crate::telemetry::snapshot::SettingsView;

/// The property that a flight without a problem keeps.
pub const ANSWERS: &str = "the firmware answers and takes its settings";

/// The other properties.
pub(super) const LABELS: [&str; 6] = [
    "it does not crash",
    "the flight ends",
    "it does not fly away",
    "it is disarmed after a landing",
    "it touches the ground only to land",
    "the tilt stays at ap_max_angle",
];

/// The tilt beyond `ap_max_angle` that a loop may overshoot, degrees.
const TILT_DEG: f64 = 5.0;
/// The distance from all legs at which a craft has flown away, m: the most that the monitors of a firmware allow.
const AWAY_M: f64 = 100.0;
/// The time on the ground after which a craft that has landed is disarmed, s.
const DISARMED_S: f64 = 15.0;
/// The time after an engagement or a change of state in which a contact with the ground may belong to what was before, s.
const SETTLED_S: f64 = 1.0;

/// Judges a flight by the properties. `settings` are those of its craft.
pub fn properties(flown: &Flown, route: &Route, settings: &SettingsView) -> Vec<Judgement> {
    let [crashes, ends, flies_away, disarms, touches, tilts] = LABELS;
    let mut judgements = vec![
        judgement(crashes, crash(flown)),
        judgement(ends, endless(flown)),
        judgement(flies_away, flyaway(flown, route)),
        judgement(disarms, armed_on_ground(flown)),
    ];
    if flown.trace.engaged_at.is_some() {
        judgements.push(judgement(touches, touch(flown)));
        judgements.push(judgement(tilts, tilt(flown, settings.max_angle_deg)));
    }
    judgements
}

/// Returns a judgement: met, or failed with a sentence at a time.
fn judgement(label: &str, failure: Option<(String, SimTime)>) -> Judgement {
    let outcome = match failure {
        None => Outcome::Met(None),
        Some((sentence, at)) => Outcome::Failed { sentence, at: Some(at), guard: None },
    };
    Judgement { label: label.to_owned(), line: 0, outcome }
}

fn events(flown: &Flown, wanted: EventName) -> impl DoubleEndedIterator<Item = &Happening> {
    flown.trace.happenings.iter().filter(
        move |happening| matches!(happening.kind, HappeningKind::Event { name, .. } if name == wanted),
    )
}

fn crash(flown: &Flown) -> Option<(String, SimTime)> {
    let crash = events(flown, EventName::Crash).next()?;
    Some((format!("it crashed at {}", flown.trace.shown_time(crash.time)), crash.time))
}

fn endless(flown: &Flown) -> Option<(String, SimTime)> {
    let is_endless = ["timeout", "diverged"].contains(&flown.result.as_str());
    is_endless.then(|| (format!("{}: {}", flown.result, flown.reason), flown.ended_at))
}

fn flyaway(flown: &Flown, route: &Route) -> Option<(String, SimTime)> {
    let distance = |sample: &Sample| route.distance_m(sample.place().into());
    let away = flown.trace.samples.iter().filter(|sample| distance(sample) > AWAY_M);
    let farthest = away.max_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    Some((format!("it was {:.0} m from the plan", distance(farthest)), farthest.time))
}

/// Returns the time at which a craft that lies on the ground after a touchdown should have been disarmed.
fn armed_on_ground(flown: &Flown) -> Option<(String, SimTime)> {
    let touchdown = events(flown, EventName::Touchdown).next_back()?;
    let late = SimTime::from_secs_f64(touchdown.time.as_secs_f64() + DISARMED_S);
    let after = || flown.trace.samples.iter().filter(|sample| sample.time >= touchdown.time);
    let lies = after().all(|sample| sample.has(Flag::OnGround));
    let armed = after().find(|sample| sample.time >= late && sample.has(Flag::Armed))?;
    lies.then(|| (format!("it is armed {DISARMED_S} s after the touchdown"), armed.time))
}

/// Returns the first contact with the ground in the middle of a mission.
fn touch(flown: &Flown) -> Option<(String, SimTime)> {
    let trace = &flown.trace;
    let contact = events(flown, EventName::Contact).find(|contact| {
        let is_flown = |time: SimTime| {
            let sample = trace.index_at(time.0 as i64).and_then(|index| trace.samples.get(index));
            sample.is_some_and(|sample| {
                sample.has(Flag::Engaged) && matches!(sample.state, NavState::Approaching | NavState::Holding)
            })
        };
        let before = SimTime::from_secs_f64(contact.time.as_secs_f64() - SETTLED_S);
        is_flown(contact.time) && is_flown(before)
    })?;
    Some((format!("it touched the ground at {}", trace.shown_time(contact.time)), contact.time))
}

/// Returns the greatest tilt beyond the limit, before a crash.
fn tilt(flown: &Flown, limit_deg: f64) -> Option<(String, SimTime)> {
    let tilt = |sample: &&Sample| sample.value(Signal::Tilt);
    let crashed = events(flown, EventName::Crash).next().map(|crash| crash.time);
    let engaged = flown.trace.samples.iter().filter(|sample| sample.has(Flag::Engaged));
    let flying = engaged.filter(|sample| crashed.is_none_or(|crashed| sample.time < crashed));
    let beyond = flying.filter(|sample| tilt(sample) > limit_deg + TILT_DEG);
    let worst = beyond.max_by(|a, b| tilt(a).total_cmp(&tilt(b)))?;
    Some((format!("{:.0}°, at most {limit_deg:.0}° + {TILT_DEG:.0}°", tilt(&worst)), worst.time))
}
