//! The results of a sweep: the same flight with a fault at every second, as sentences, a map, JSON and a table.

mod drawn;
mod json;
mod table;

use strum::IntoEnumIterator as _;

use crate::flight::sweep::{Fate, SweepPoint};
use crate::sim::{FaultStart, ScheduledFault};
use crate::telemetry::quantity::{Dimension, shown};

pub use json::sweep_json;
pub use table::sweep_csv;

/// The results of a sweep with their names.
#[derive(Debug, Clone, Copy)]
pub struct SweptFlight<'a> {
    /// The name of the plan.
    pub name: &'a str,
    pub fault: ScheduledFault,
    /// The result and the reason of the flight without the fault; `None` if it was stopped before its end.
    pub without: Option<(&'a str, &'a str)>,
    /// The flights with the fault, in the order of their seconds.
    pub points: &'a [SweepPoint],
}

/// A time in which the fault has the same result.
struct Span<'a> {
    fate: Fate,
    points: &'a [SweepPoint],
}

impl SweptFlight<'_> {
    /// Returns the number of seconds with a fate.
    pub fn count(&self, fate: Fate) -> usize {
        self.points.iter().filter(|point| point.fate == fate).count()
    }

    /// Returns the fault without its time: `gps-loss,6`.
    pub(super) fn fault_name(&self) -> String {
        self.fault.timeless()
    }

    /// Returns the fault at a second.
    fn at(&self, second: u32) -> ScheduledFault {
        ScheduledFault { start: FaultStart::Engagement(f64::from(second)), ..self.fault }
    }

    /// Returns the fault at the second with the worst result; `None` if every flight ends at home.
    pub fn worst_fault(&self) -> Option<ScheduledFault> {
        self.worst().map(|worst| self.at(worst.second))
    }

    fn spans(&self) -> impl Iterator<Item = Span<'_>> {
        self.points
            .chunk_by(|a, b| a.fate == b.fate)
            .filter_map(|points| Some(Span { fate: points.first()?.fate, points }))
    }

    /// Returns the point to look at: the first one with the worst fate, or the one that ends farthest away.
    fn worst(&self) -> Option<&SweepPoint> {
        let fate = self.points.iter().map(|point| point.fate).max()?;
        let mut of_fate = self.points.iter().filter(|point| point.fate == fate);
        match fate {
            Fate::Home => None,
            Fate::Off => of_fate.max_by(|a, b| a.off_m.total_cmp(&b.off_m)),
            Fate::Lost => of_fate.next(),
        }
    }
}

/// A time in which the fault has the same fate, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SpanRow {
    /// Minutes and seconds: `0:20 to 0:29`.
    pub(super) time: String,
    pub(super) fate: String,
    /// The class of its cell: good, bad or neither.
    pub(super) class: &'static str,
    /// The greatest distance at the end; empty if the craft comes home.
    pub(super) off: String,
    /// The reason of the flight that ends there.
    pub(super) reason: String,
}

/// Returns the results as lines.
pub fn sweep_sentences(swept: &SweptFlight<'_>) -> Vec<String> {
    let mut lines = vec![
        format!(
            "{}, {} at every second of the flight ({} flights): {}.",
            swept.name,
            swept.fault_name(),
            swept.points.len(),
            summary(swept)
        ),
        without(swept),
        String::new(),
    ];
    lines.extend(span_rows(swept).iter().map(span_line));
    lines.push(String::new());
    lines.extend(drawn::timeline(swept.points));
    lines.push(String::new());
    lines.extend(drawn::map(swept.points));
    lines.push(String::new());
    lines.push(drawn::LEGEND.to_owned());
    lines.extend(swept.worst_fault().map(|fault| {
        format!("The worst second: betadeck fly or betadeck open with the same options and --fault {fault}")
    }));
    lines
}

/// Returns how often each fate comes.
pub(super) fn summary(swept: &SweptFlight<'_>) -> String {
    let counts: Vec<String> = Fate::iter().map(|fate| format!("{} {fate}", swept.count(fate))).collect();
    counts.join(", ")
}

/// Returns how the flight ends without the fault.
pub(super) fn without(swept: &SweptFlight<'_>) -> String {
    match swept.without {
        Some((result, reason)) => format!("Without the fault the flight ends {result}: {reason}."),
        None => "The flight was stopped before its end, so later seconds are missing.".to_owned(),
    }
}

/// Returns the times with the same fate.
pub(super) fn span_rows(swept: &SweptFlight<'_>) -> Vec<SpanRow> {
    swept.spans().map(|span| span_row(&span)).collect()
}

fn span_row(span: &Span<'_>) -> SpanRow {
    let seconds = |point: Option<&SweepPoint>| minutes(point.map_or(0, |point| point.second));
    let (first, last) = (seconds(span.points.first()), seconds(span.points.last()));
    let time = if first == last { first } else { format!("{first} to {last}") };
    let class = match span.fate {
        Fate::Home => "passed",
        Fate::Off => "",
        Fate::Lost => "failed",
    };
    let fate = span.fate.to_string();
    let worst = span.points.iter().max_by(|a, b| a.off_m.total_cmp(&b.off_m));
    let worst = worst.filter(|_| span.fate != Fate::Home);
    let up_to = if span.points.len() == 1 { "" } else { "up to " };
    let off =
        worst.map_or_else(String::new, |worst| format!("{up_to}{}", shown(worst.off_m, Dimension::LENGTH)));
    SpanRow { time, fate, class, off, reason: worst.map_or_else(String::new, |worst| worst.reason.clone()) }
}

fn span_line(row: &SpanRow) -> String {
    let SpanRow { time, fate, off, reason, .. } = row;
    if off.is_empty() {
        return format!("  {time:<13} {fate}");
    }
    format!("  {time:<13} {fate:<4}  {off} from home and from its LAND: {reason}")
}

/// Returns minutes and seconds: `1:52`.
fn minutes(second: u32) -> String {
    format!("{}:{:02}", second / 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::FlightResult;

    fn point(second: u32, fate: Fate, off_m: f64) -> SweepPoint {
        let (result, reason) = match fate {
            Fate::Home => (FlightResult::Complete, "mission complete"),
            Fate::Off => (FlightResult::Landed, "landed by an emergency landing"),
            Fate::Lost => (FlightResult::Crashed, "the craft crashed"),
        };
        let angle = f64::from(second) / 10.0;
        SweepPoint {
            second,
            place_enu: [30.0 * angle.sin(), 30.0 - 30.0 * angle.cos(), 10.0],
            fate,
            result,
            reason: reason.to_owned(),
            off_m,
            after_s: 12.5,
        }
    }

    fn points() -> Vec<SweepPoint> {
        (0..70)
            .map(|second| match second {
                20..=29 => point(second, Fate::Off, f64::from(second)),
                30 | 64 => point(second, Fate::Lost, 41.25),
                _ => point(second, Fate::Home, 0.3),
            })
            .collect()
    }

    fn swept(points: &[SweepPoint]) -> SweptFlight<'_> {
        SweptFlight {
            name: "square",
            fault: "gps-loss@0,6".parse().unwrap(),
            without: Some(("complete", "flown as planned")),
            points,
        }
    }

    #[test]
    fn a_sweep_says_when_the_fault_is_fatal_and_where() {
        insta::assert_snapshot!(sweep_sentences(&swept(&points())).join("\n"));
    }

    #[test]
    fn a_sweep_without_a_flight_has_no_map() {
        let lines = sweep_sentences(&SweptFlight { without: None, ..swept(&[]) });
        assert!(lines[0].ends_with("(0 flights): 0 home, 0 off, 0 lost."), "{}", lines[0]);
        assert!(!lines.iter().any(|line| line.contains("The worst second")));
    }

    #[test]
    fn json_and_table_have_each_second() {
        let points = points();
        let json: serde_json::Value = serde_json::from_str(&sweep_json(&swept(&points))).unwrap();
        assert_eq!(json["fault"], "gps-loss,6");
        assert_eq!(json["counts"], serde_json::json!({"home": 58, "off": 10, "lost": 2}));
        assert_eq!(json["seconds"].as_array().unwrap().len(), 70);
        assert_eq!(json["seconds"][30]["fate"], "lost");
        let table = String::from_utf8(sweep_csv(&points)).unwrap();
        assert_eq!(table.lines().count(), 71);
        assert!(table.contains("\n30,lost,crashed,41.25,"), "{table}");
    }
}
