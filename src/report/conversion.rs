//! The loss report of a conversion: lines for people, or one JSON object.

use serde::Serialize;

use crate::plan::format::loss::{Finding, LossReport, Severity};
use crate::plan::format::{Format, PlanFile};

/// A conversion: from a file to a plan, and from the plan to another file.
#[derive(Debug)]
pub struct Conversion {
    /// `None` if the file could not be read.
    from: Option<Format>,
    to: Format,
    /// The number of items that were read; `None` if each waypoint is an item.
    read: Option<usize>,
    waypoints: usize,
    written: usize,
    /// The findings of both directions.
    losses: LossReport,
}

/// The JSON form. `format` is its version.
#[derive(Serialize)]
struct Object<'c> {
    format: u32,
    from: Option<String>,
    to: String,
    findings: &'c [Finding],
    summary: Summary,
}

#[derive(Serialize)]
struct Summary {
    items: usize,
    waypoints: usize,
    written: usize,
    refused: usize,
    lost: usize,
    changed: usize,
    assumed: usize,
    info: usize,
}

impl Conversion {
    /// Creates the report of a plan that was read from `from` and written as `to` with the losses `written`.
    pub fn new(from: Format, file: &PlanFile, to: Format, written: LossReport) -> Self {
        let mut losses = file.losses.clone();
        losses.findings.extend(written.findings);
        Self {
            from: Some(from),
            to,
            read: Some(file.losses.items).filter(|&items| items > 0),
            waypoints: file.plan.waypoints.len() + file.rest.len(),
            written: written.items,
            losses,
        }
    }

    /// Creates the report of a file that cannot be read, for the reason `why`.
    pub fn refused(to: Format, why: &str) -> Self {
        let mut losses = LossReport::default();
        // Without the quoted lines of the file and the carets below them.
        let is_quoted = |line: &str| {
            line.split_once(" |")
                .is_some_and(|(number, _)| number.trim().parse::<u32>().is_ok() || number.trim().is_empty())
        };
        let why: Vec<&str> = why.lines().filter(|line| !is_quoted(line)).collect();
        losses.add(Finding::new(Severity::Refused, "file", why.join("; ")));
        Self { from: None, to, read: None, waypoints: 0, written: 0, losses }
    }

    /// Returns the heaviest severity.
    pub fn worst(&self) -> Option<Severity> {
        self.losses.worst()
    }

    /// Returns one line for each finding, and the summary: `12 items → 11 waypoints → 13 items: 1 lost, 2 changed`.
    pub fn lines(&self) -> Vec<String> {
        let count = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
        let read = self.read.map(|items| count(items, "item") + " → ").unwrap_or_default();
        let written = match self.written {
            0 => String::new(),
            items => format!(" → {}", count(items, "item")),
        };
        let waypoints = count(self.waypoints, "waypoint");
        let summary = format!("{read}{waypoints}{written}: {}", self.losses.counts());
        self.losses.findings.iter().map(ToString::to_string).chain([summary]).collect()
    }

    /// Returns the report as one JSON object.
    pub fn json(&self) -> String {
        let count = |severity| self.losses.count(severity);
        let object = Object {
            format: 1,
            from: self.from.map(|from| from.to_string()),
            to: self.to.to_string(),
            findings: &self.losses.findings,
            summary: Summary {
                items: self.read.unwrap_or(self.waypoints),
                waypoints: self.waypoints,
                written: self.written,
                refused: count(Severity::Refused),
                lost: count(Severity::Lost),
                changed: count(Severity::Changed),
                assumed: count(Severity::Assumed),
                info: count(Severity::Info),
            },
        };
        serde_json::to_string(&object).unwrap_or_default()
    }
}
