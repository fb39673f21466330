//! The pictures of a flight.

mod charts;
mod map;

pub(in crate::report) use map::ground;

use super::{Detail, FlightReport, look};
use crate::report::plot::{Picture, StateBar, Stay};
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

/// Returns the bar of the states; `None` if none is known.
fn states(report: &FlightReport, id: &str, time: (f64, f64)) -> Option<Figure> {
    let record = &report.record;
    let (from, to) = time;
    let first = record.transitions.first()?;
    let (colour, name) = look(Some(first.from));
    let mut stays = vec![Stay { from, to: from, name, colour, label: String::new() }];
    for transition in &record.transitions {
        let at = record.seconds(transition.time).clamp(from, to);
        if let Some(before) = stays.last_mut() {
            before.to = at;
        }
        let (colour, name) = look(Some(transition.to));
        let label = transition.kind.map_or_else(String::new, |_| format!("WP{}", transition.wp));
        stays.push(Stay { from: at, to, name, colour, label });
    }
    let words: Vec<&str> = stays.iter().map(|stay| stay.name).collect();
    let description = format!("The states from {from:.0} s to {to:.0} s: {}.", shortened(&words));
    let picture = Picture::new(&format!("{id}-states"), "States of the autopilot", &description);
    Some(Figure {
        svg: StateBar { time, stays }.svg(&picture),
        title: "States.".to_owned(),
        caption: format!("All charts: {}.", seconds_from(report)),
        is_wide: true,
    })
}

/// Returns the meaning of the times.
fn seconds_from(report: &FlightReport) -> &'static str {
    if report.record.engaged_at.is_some() { "seconds after the engagement" } else { "seconds after boot" }
}

/// Returns the first words of a list that may be long.
fn shortened(words: &[&str]) -> String {
    const MOST: usize = 40;
    let shown = words.iter().take(MOST).copied().collect::<Vec<_>>().join(", ");
    if words.len() > MOST { format!("{shown} …") } else { shown }
}
