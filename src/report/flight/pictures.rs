//! The pictures of a flight.

mod charts;
mod map;

pub(in crate::report) use map::ground;

use super::{Detail, FlightReport, look};
use crate::report::plot::{Picture, StateBar, Stay};
use crate::report::record::FlightRecord;
use crate::signals::SimTime;

/// A picture with its caption.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::report) struct Figure {
    pub(in crate::report) svg: String,
    pub(in crate::report) title: String,
    pub(in crate::report) caption: String,
    /// `true` if it runs over time and must not become too narrow to read.
    pub(in crate::report) is_wide: bool,
}

/// Time before the arming that the pictures show, s.
const BEFORE_S: f64 = 2.0;

/// Returns the pictures of a flight. `id` begins their identifiers in the page.
pub(in crate::report) fn figures(report: &FlightReport, id: &str, detail: Detail) -> Vec<Figure> {
    let mut figures: Vec<Figure> = map::figure(report, id, detail).into_iter().collect();
    let Some(time) = time(report) else { return figures };
    figures.extend(states(report, id, time));
    figures.extend(charts::figures(report, id, time, detail));
    figures
}

/// Returns the first and the last time of the charts, s; `None` if there is nothing to draw.
fn time(report: &FlightReport) -> Option<(f64, f64)> {
    let record = &report.record;
    let (first, last) = (record.samples.first()?.time, record.samples.last()?.time);
    let armed = record.armed_at.map(|armed| armed.as_secs_f64() - BEFORE_S).map(SimTime::from_secs_f64);
    let from = record.seconds(armed.map_or(first, |armed| armed.max(first).min(last)));
    let to = record.seconds(last);
    (to - from > 0.1).then_some((from, to))
}

/// Returns the bar of the states, or of the modes of a flight without states; `None` if none is known.
fn states(report: &FlightReport, id: &str, time: (f64, f64)) -> Option<Figure> {
    let record = &report.record;
    let (mut stays, title) = match has_states(record) {
        true => (state_stays(record, time), "States"),
        false => (mode_stays(record, time), "Modes"),
    };
    stays.last_mut()?.to = time.1;
    let words: Vec<&str> = stays.iter().map(|stay| stay.name).collect();
    let (from, to) = time;
    let description = format!("{title} from {from:.0} s to {to:.0} s: {}.", shortened(&words));
    let picture = Picture::new(&format!("{id}-states"), &format!("{title} of the flight"), &description);
    Some(Figure {
        svg: StateBar { time, stays }.svg(&picture),
        title: format!("{title}."),
        caption: format!("All charts: {}.", seconds_from(report)),
        is_wide: true,
    })
}

/// Returns `true` if states of the autopilot are known.
fn has_states(record: &FlightRecord) -> bool {
    !record.transitions.is_empty() || record.samples.iter().any(|sample| sample.state.is_some())
}

/// Returns how a track is coloured, as the end of its description.
fn coloured(record: &FlightRecord) -> &'static str {
    match has_states(record) {
        true => ", coloured by the state of the autopilot",
        false if record.samples.iter().any(|sample| sample.modes.is_some()) => ", coloured by flight mode",
        false => "",
    }
}

fn state_stays(record: &FlightRecord, (from, to): (f64, f64)) -> Vec<Stay> {
    let Some(first) = record.transitions.first() else { return Vec::new() };
    let (colour, name) = look::of_state(first.from);
    let mut stays = vec![Stay { from, to: from, name, colour, label: String::new() }];
    for transition in &record.transitions {
        let at = record.seconds(transition.time).clamp(from, to);
        if let Some(before) = stays.last_mut() {
            before.to = at;
        }
        let (colour, name) = look::of_state(transition.to);
        let label = transition.kind.map_or_else(String::new, |_| format!("WP{}", transition.wp));
        stays.push(Stay { from: at, to, name, colour, label });
    }
    stays
}

fn mode_stays(record: &FlightRecord, (from, to): (f64, f64)) -> Vec<Stay> {
    let mut stays: Vec<Stay> = Vec::new();
    for sample in record.samples.iter().filter(|sample| sample.modes.is_some()) {
        let at = record.seconds(sample.time).clamp(from, to);
        let (colour, name) = look::of_sample(sample);
        match stays.last_mut() {
            Some(stay) if stay.name == name => continue,
            Some(stay) => stay.to = at,
            None => {}
        }
        stays.push(Stay { from: at, to, name, colour, label: name.to_owned() });
    }
    stays
}

/// Returns the meaning of the times.
fn seconds_from(report: &FlightReport) -> &'static str {
    match &report.record {
        record if record.begins_at.is_some() => "seconds after the record begins",
        record if record.engaged_at.is_some() => "seconds after the engagement",
        _ => "seconds after boot",
    }
}

/// Returns the first words of a list that may be long.
fn shortened(words: &[&str]) -> String {
    const MOST: usize = 40;
    let shown = words.iter().take(MOST).copied().collect::<Vec<_>>().join(", ");
    if words.len() > MOST { format!("{shown} …") } else { shown }
}
