//! The parts about single flights.

use askama::Template;

use super::summary::Row;
use crate::report::check::CheckedFlight;
use crate::report::flight::{Detail, FlightReport, Verdict};
use crate::report::html::{MAX_BYTES, flight, text};
use crate::scenario::{Judgement, Outcome};
use crate::signals::SimTime;

/// The parts so far.
#[derive(Debug, Default)]
pub(super) struct Flights {
    failed: Parts,
    passed: Parts,
    /// The number of flights so far.
    count: usize,
}

/// Parts of one kind, with at most as many bytes as a page.
#[derive(Debug, Default)]
struct Parts {
    parts: Vec<String>,
    bytes: usize,
}

#[derive(Debug, Template)]
#[template(path = "report/checked.html")]
struct Part {
    title: String,
    verdict: Verdict,
    is_open: bool,
    rows: Vec<FlightRow>,
    part: String,
}

/// An expectation of a flight.
#[derive(Debug)]
struct FlightRow {
    label: String,
    seen: String,
    at: String,
    left: String,
    class: &'static str,
    /// The command that shows the worst moment.
    open: Option<String>,
}

impl Flights {
    /// Adds a flight, if a page can have room for it.
    pub(super) fn add(&mut self, flight: &CheckedFlight, report: &FlightReport) {
        self.count += 1;
        let parts = if flight.passed() { &mut self.passed } else { &mut self.failed };
        if parts.bytes < MAX_BYTES {
            let part = part(flight, report, &format!("flight-{}", self.count));
            parts.bytes += part.len();
            parts.parts.push(part);
        }
    }

    /// Returns the first parts with at most so many bytes, those of failed flights first.
    pub(super) fn fitting(&self, most_bytes: usize) -> Vec<&str> {
        let mut bytes = 0;
        let all = self.failed.parts.iter().chain(&self.passed.parts);
        all.map(String::as_str)
            .take_while(|part| {
                bytes += part.len() + 1;
                bytes <= most_bytes
            })
            .collect()
    }
}

fn part(flight: &CheckedFlight, report: &FlightReport, id: &str) -> String {
    let passed = (!flight.is_skipped()).then(|| flight.passed());
    let word = if flight.result.is_empty() { "not flown" } else { &flight.result };
    let reason = flight.problem.as_deref().unwrap_or(&flight.reason);
    let part = Part {
        title: text::line(&flight.title()),
        verdict: Verdict { passed, word: text::line(word), reason: text::line(reason) },
        is_open: passed == Some(false),
        rows: flight.judgements.iter().map(|judgement| row(flight, judgement)).collect(),
        part: flight::part(report, id, 3, Detail::SHORT),
    };
    // Writing to a string does not fail.
    part.render().unwrap_or_default()
}

fn row(flight: &CheckedFlight, judgement: &Judgement) -> FlightRow {
    let at = match &judgement.outcome {
        Outcome::Met(margin) => margin.map(|margin| margin.time),
        Outcome::Failed { at, .. } => *at,
        Outcome::NeverJudged(_) | Outcome::Skipped(_) => None,
    };
    let open = |at: SimTime| {
        let command = flight.open_command(at).filter(|_| judgement.outcome.is_failure())?;
        text::command(&command).map(str::to_owned)
    };
    let Row { label, seen, left, class, .. } = Row::of(judgement);
    FlightRow {
        label,
        seen,
        at: at.map_or_else(String::new, |at| format!("{:.2}", flight.seconds(at))),
        left,
        class,
        open: at.and_then(open),
    }
}
