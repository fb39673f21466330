//! The page of a run of scenarios.

mod flights;
mod summary;

use askama::Template;

use super::page::Page;
use super::{MAX_BYTES, text};
use crate::report::check::{CheckedFlight, Summary};
use crate::report::flight::{FlightReport, Verdict};
use flights::Flights;
use summary::Case;

/// The greatest size of the table of all expectations, bytes.
const MAX_SUMMARY: usize = 400_000;

/// The page of a run, which grows by a part a flight.
#[derive(Debug, Default)]
pub struct CheckPage {
    flights: Flights,
}

#[derive(Debug, Template)]
#[template(path = "report/check.html")]
struct Body<'a> {
    cases: Vec<Case>,
    left_out: Option<String>,
    flights: Vec<&'a str>,
    flights_left_out: Option<String>,
}

impl CheckPage {
    /// Adds the part about a flight, if there is room for it. Failed flights come first in the page.
    pub fn add(&mut self, flight: &CheckedFlight, report: &FlightReport) {
        self.flights.add(flight, report);
    }

    /// Returns the page. `program` is the name of this program with its version.
    pub fn html(&self, summary: &Summary, command: Option<&str>, program: &str) -> String {
        let (cases, all_cases) = summary::cases(summary, MAX_SUMMARY);
        let left_out = all_cases - cases.len();
        let left_out =
            (left_out > 0).then(|| format!("{left_out} further cases are left out of this table."));
        let (verdict, title) = (verdict(summary), title(summary));
        let frame = |body: &str| {
            let mut page = Page::new("Scenarios flown by betadeck", &title, &verdict, body, program);
            page.command = command.and_then(text::command);
            page.note = "Times are simulated seconds after the autopilot engaged, or after boot if it did not. Places and \
                         altitudes are true unless they are called an estimate.";
            page.html()
        };
        let mut body = Body { cases, left_out, flights: Vec::new(), flights_left_out: Some(String::new()) };
        let empty = frame(&rendered(&body)).len() + 200;
        body.flights = self.flights.fitting(MAX_BYTES.saturating_sub(empty));
        let shown = body.flights.len();
        body.flights_left_out = (shown < summary.flights.len()).then(|| {
            format!(
                "{shown} of {} flights are shown, the failed ones first: a report is at most {} MB.",
                summary.flights.len(),
                MAX_BYTES / 1_000_000
            )
        });
        frame(&rendered(&body))
    }
}

fn rendered(body: &Body<'_>) -> String {
    // Writing to a string does not fail.
    body.render().unwrap_or_default()
}

/// Returns the names of the scenarios, or their number if there are many.
fn title(summary: &Summary) -> String {
    const MOST: usize = 4;
    let mut names: Vec<&str> = summary.flights.iter().map(|flight| flight.scenario.as_str()).collect();
    names.dedup();
    match names.len() {
        0 => "Scenarios".to_owned(),
        1..=MOST => text::line(&names.join(", ")),
        count => format!("{count} scenarios"),
    }
}

/// Returns the verdict on the run.
fn verdict(summary: &Summary) -> Verdict {
    let (passed, word) = match summary.passed() {
        _ if summary.is_skipped() => (None, "nothing was judged"),
        true => (Some(true), "passed"),
        false => (Some(false), "failed"),
    };
    let reason = format!(
        "{} of {} flights passed; {:.1} s flown",
        summary.passed_flights(),
        summary.wanted,
        summary.flown_s()
    );
    Verdict { passed, word: word.to_owned(), reason }
}
