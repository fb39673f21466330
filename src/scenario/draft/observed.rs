//! Expectations made from an observed flight, with margins for the next flight.

use super::Block;
use super::toml_text::quoted;
use crate::math;
use crate::scenario::case::Statistic;
use crate::scenario::expression::Evaluator;
use crate::scenario::happening::{EventName, Field, Happening, HappeningKind};
use crate::scenario::run::Flown;
use crate::signals::SimTime;
use crate::telemetry::signal::Signal;
use crate::telemetry::{NavState, PlanSource};

/// The least tolerance of a time, s. The share below applies if it gives more.
const TIME_S: f64 = 1.5;
const TIME_SHARE: f64 = 0.05;

/// Returns expectations that the flight meets.
pub(super) fn expectations(flown: &Flown) -> Vec<Block> {
    let mut blocks = vec![vec![("result", quoted(&flown.result))]];
    if let Some(states) = states(flown) {
        blocks.push(vec![("states", quoted(&states))]);
    }
    blocks.extend(times(flown));
    blocks.extend(events(flown));
    blocks.extend(landing(flown));
    blocks.extend(bounds(flown));
    blocks
}

/// Returns all states since the first engagement.
fn states(flown: &Flown) -> Option<String> {
    let engaged = flown.trace.engaged_at?;
    let entered = |happening: &&Happening| {
        happening.time >= engaged && matches!(happening.kind, HappeningKind::State(_))
    };
    let names: Vec<String> = flown.trace.happenings.iter().filter(entered).map(ToString::to_string).collect();
    Some(names.join(", "))
}

/// Returns expectations for the times at which waypoints were reached and landings began.
fn times(flown: &Flown) -> Vec<Block> {
    let Some(engaged) = flown.trace.engaged_at else { return Vec::new() };
    let mut reported: Vec<String> = Vec::new();
    let mut blocks = Vec::new();
    for happening in &flown.trace.happenings {
        let HappeningKind::State(entered) = &happening.kind else { continue };
        let is_reported = matches!(entered.state, NavState::Arrived | NavState::Landing | NavState::Complete);
        let name = format!("{} {} of {}", entered.state, entered.wp, entered.source);
        if !is_reported || happening.time < engaged || reported.contains(&name) {
            continue;
        }
        let seconds = happening.time.seconds_since(engaged);
        let margin = TIME_S.max(TIME_SHARE * seconds);
        let within = format!("{:.1}..{:.1} s after engaged", (seconds - margin).max(0.0), seconds + margin);
        blocks.push(vec![("event", quoted(&name)), ("within", quoted(&within))]);
        reported.push(name);
    }
    blocks
}

/// Returns expectations for the other events: how often each one happened, and which ones did not happen.
fn events(flown: &Flown) -> Vec<Block> {
    const TOLD: [EventName; 9] = [
        EventName::Disarmed,
        EventName::Geofence,
        EventName::RxLoss,
        EventName::RxRecovered,
        EventName::GpsLost,
        EventName::Refused,
        EventName::Crash,
        EventName::Touchdown,
        EventName::Refusal,
    ];
    const MISSED: [EventName; 5] =
        [EventName::Crash, EventName::Geofence, EventName::RxLoss, EventName::GpsLost, EventName::Refusal];
    let mut names: Vec<(String, usize)> = Vec::new();
    let mut seen: Vec<EventName> = Vec::new();
    for happening in since_engagement(flown) {
        let HappeningKind::Event { name, .. } = &happening.kind else { continue };
        seen.push(*name);
        if TOLD.contains(name) {
            let text = happening.to_string();
            match names.iter_mut().find(|(known, _)| *known == text) {
                Some((_, count)) => *count += 1,
                None => names.push((text, 1)),
            }
        }
    }
    let happened =
        names.into_iter().map(|(name, count)| vec![("event", quoted(&name)), ("count", count.to_string())]);
    let missed = MISSED.into_iter().filter(|name| !seen.contains(name));
    happened.chain(missed.map(|name| vec![("no_event", quoted(name.info().name))])).collect()
}

/// Returns the happenings that count for an expectation without a window.
fn since_engagement(flown: &Flown) -> impl Iterator<Item = &Happening> {
    let from = flown.trace.engaged_at.unwrap_or(SimTime::ZERO);
    let to = flown.trace.end();
    flown.trace.happenings.iter().filter(move |happening| happening.time >= from && happening.time <= to)
}

/// Returns expectations for the place and the softness of the landing.
fn landing(flown: &Flown) -> Vec<Block> {
    let trace = &flown.trace;
    let find = |name: EventName| {
        since_engagement(flown).find(
            |happening| matches!(&happening.kind, HappeningKind::Event { name: known, .. } if *known == name),
        )
    };
    let Some(contact) = find(EventName::Touchdown) else { return Vec::new() };
    let mut blocks = Vec::new();
    if let Some(impact) = contact.field(Field::Impact) {
        let with = format!("impact <= {} m/s", above(impact, 0.2));
        blocks.push(vec![("event", quoted("touchdown")), ("with", quoted(&with))]);
    }
    let landed = trace.happenings.iter().rev().find_map(|happening| match &happening.kind {
        HappeningKind::State(entered) if entered.state == NavState::Landing => Some(*entered),
        _ => None,
    });
    let place = match landed {
        Some(entered) if entered.source == PlanSource::Stored => format!("wp {}", entered.wp),
        Some(entered) if entered.source == PlanSource::Rth => "home".to_owned(),
        Some(_) => "wp 0 of emergency".to_owned(),
        None => return blocks,
    };
    let target = match landed {
        Some(entered) if entered.source != PlanSource::Rth => {
            trace.waypoint(entered.wp, entered.source, contact.time)
        }
        _ => Some([0.0, 0.0]),
    };
    if let (Some(target), Some(index)) = (target, trace.index_at(contact.time.0 as i64)) {
        let [north, east] = trace.samples[index].place();
        let distance = math::hypot(north - target[0], east - target[1]);
        let that = format!("distance({place}) <= {} m", above(distance, 1.0));
        blocks.push(vec![("at", quoted("touchdown")), ("that", quoted(&that))]);
    }
    blocks
}

/// Returns bounds for distance and speed.
fn bounds(flown: &Flown) -> Vec<Block> {
    let trace = &flown.trace;
    if trace.engaged_at.is_none() {
        return Vec::new();
    }
    let from = trace.engaged_at.map_or(0, |time| time.0 as i64);
    let first = trace.index_at(from).unwrap_or(0);
    let greatest = |signal: Signal| {
        let values = trace.samples[first..].iter().map(|sample| sample.value(signal));
        values.filter(|value| !value.is_nan()).fold(f64::NEG_INFINITY, f64::max)
    };
    let mut blocks = vec![
        vec![("always", quoted(&format!("lean <= {} deg", above(greatest(Signal::Tilt), 3.0))))],
        vec![("always", quoted(&format!("speed <= {} m/s", above(greatest(Signal::Speed), 0.5))))],
        vec![("always", quoted(&format!("altitude <= {} m", above(greatest(Signal::Altitude), 1.0))))],
    ];
    let used = greatest(Signal::BatteryUsed);
    if used.is_finite() {
        blocks.push(vec![("always", quoted(&format!("battery_used <= {} %", above(100.0 * used, 2.0))))]);
    }
    blocks.extend(legs(flown));
    blocks
}

/// Returns bounds for the cross-track error on a straight leg that follows another straight leg.
fn legs(flown: &Flown) -> Vec<Block> {
    let trace = &flown.trace;
    // With several stored plans, the same index means a different waypoint in each plan.
    let mut stored =
        trace.plans.iter().filter(|known| known.source == PlanSource::Stored).map(|known| &known.plan);
    let Some(plan) = stored.next().filter(|first| stored.all(|other| other.waypoints == first.waypoints))
    else {
        return Vec::new();
    };
    let mut blocks = Vec::new();
    for (index, pair) in plan.waypoints.windows(2).enumerate() {
        let [before, after] = pair else { continue };
        if !before.kind.passes() || !after.kind.passes() {
            continue;
        }
        let line = format!("across(wp {index} -> wp {})", index + 1);
        let (from, until) =
            (format!("APPROACHING {} of stored", index + 1), format!("ARRIVED {} of stored", index + 1));
        if let Some(greatest) = greatest_between(&line, &from, &until, flown) {
            blocks.push(vec![
                ("from", quoted(&from)),
                ("until", quoted(&until)),
                ("max", quoted(&format!("abs({line}) <= {} m", above(greatest, 0.5)))),
            ]);
        }
    }
    blocks
}

/// Returns the greatest size of a number between two instants; `None` if one of them did not come.
fn greatest_between(number: &str, from: &str, until: &str, flown: &Flown) -> Option<f64> {
    use crate::scenario::expression::{Cursor, Scope};
    let waypoints = flown.trace.plans.first().map_or(0, |known| known.plan.waypoints.len());
    let scope = Scope { waypoints, ..Scope::default() };
    let (number, _) = scope.read_number(&mut Cursor::new(&format!("abs({number})"))).ok()?;
    let instant = |text: &str| scope.read_instant(&mut Cursor::new(text)).ok();
    let window = crate::scenario::case::Window { from: instant(from), until: instant(until) };
    let evaluator = Evaluator::new(&flown.trace, &[]);
    let value = crate::scenario::judge::statistic(&window, Statistic::Max, &number, &evaluator);
    value.filter(|value| value.is_finite())
}

/// Returns a bound above an observed value: a fifth more and at least `least` more, rounded up to a tenth.
fn above(seen: f64, least: f64) -> f64 {
    let bound = (1.2 * seen).max(seen + least);
    (bound * 10.0).ceil() / 10.0
}
