//! The waypoints of a flight against what is allowed.

use super::FlightReport;
use crate::plan::WaypointType;
use crate::telemetry::{ParkedTruth, PlanSource, WaypointTruth};

/// A waypoint, or the craft that is parked at the end.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) struct MarginRow {
    /// The waypoint with its type, and its plan if it is not the user's.
    pub(in crate::report) name: String,
    /// Seconds after the engagement; empty for the end.
    pub(in crate::report) at: String,
    /// How it is measured, in a word or two.
    pub(in crate::report) rule: &'static str,
    pub(in crate::report) miss: Margin,
    pub(in crate::report) altitude: Margin,
}

/// A measured distance and its limit, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct Margin {
    /// `None` = not measured.
    value: Option<f64>,
    /// `None` = not judged.
    allowed: Option<f64>,
}

impl Margin {
    /// Returns the distance as text; empty if there is none.
    pub(in crate::report) fn value(&self) -> String {
        self.value.map_or_else(String::new, |value| format!("{:.2}", value + 0.0))
    }

    /// Returns the limit as text.
    pub(in crate::report) fn allowed(&self) -> String {
        self.value.and(self.allowed).map_or_else(String::new, |allowed| format!("{allowed:.1}"))
    }

    /// Returns the share of the limit that is left: `93 %`.
    pub(in crate::report) fn left(&self) -> String {
        self.share().map_or_else(String::new, |share| format!("{:.0} %", 100.0 * share))
    }

    /// Returns the class of the cell.
    pub(in crate::report) fn class(&self) -> &'static str {
        match self.share() {
            Some(share) if share < 0.0 => "failed",
            Some(_) => "passed",
            None => "",
        }
    }

    fn share(&self) -> Option<f64> {
        let (value, allowed) = self.value.zip(self.allowed)?;
        Some((allowed - value.abs()) / allowed.max(1e-3))
    }
}

/// Returns a row for each flown waypoint, and one for a craft that is parked at the end.
pub(in crate::report) fn rows(report: &FlightReport) -> Vec<MarginRow> {
    let truth = &report.truth;
    let waypoints = truth.waypoints.iter().flat_map(|waypoint| waypoint_rows(report, waypoint));
    waypoints.chain(truth.parked.iter().map(|parked| parked_row(report, parked))).collect()
}

/// Returns the row of a waypoint, and one for the wait before a landing.
fn waypoint_rows(report: &FlightReport, waypoint: &WaypointTruth) -> Vec<MarginRow> {
    let WaypointTruth { source, wp, kind, miss_m, alt_error_m, hold_max_m, radius_m, at } = *waypoint;
    let (of, tolerance_m) = match source {
        PlanSource::Stored => ("", report.tolerance_m),
        // Plans of the firmware are not judged.
        PlanSource::Rth => (" of the return home", None),
        PlanSource::Emergency => (" of the emergency landing", None),
    };
    let rule = match kind {
        WaypointType::Hold => "held within",
        WaypointType::Land => "touched down at",
        WaypointType::Takeoff => "climbed within",
        WaypointType::Flyby if radius_m <= 0.0 => "turned outside its radius by",
        _ => "passed at",
    };
    let allowed = tolerance_m.map(|tolerance_m| radius_m + tolerance_m);
    let row = MarginRow {
        name: format!("WP{wp} {kind}{of}"),
        at: format!("{:.1}", report.record.seconds(at)),
        rule,
        miss: Margin { value: Some(miss_m), allowed },
        altitude: Margin { value: alt_error_m, allowed: tolerance_m },
    };
    let waited = hold_max_m.filter(|_| kind == WaypointType::Land).map(|waited_m| MarginRow {
        rule: "waited within",
        miss: Margin { value: Some(waited_m), allowed },
        altitude: Margin { value: None, allowed: None },
        ..row.clone()
    });
    waited.into_iter().chain([row]).collect()
}

fn parked_row(report: &FlightReport, parked: &ParkedTruth) -> MarginRow {
    let ParkedTruth { wp, kind, distance_m, alt_error_m, radius_m, .. } = *parked;
    let tolerance_m = report.tolerance_m;
    MarginRow {
        name: format!("WP{wp} {kind}, at the end"),
        at: String::new(),
        rule: "parked at",
        miss: Margin { value: distance_m, allowed: tolerance_m.map(|tolerance_m| radius_m + tolerance_m) },
        altitude: Margin { value: Some(alt_error_m), allowed: tolerance_m },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signals::SimTime;
    use crate::telemetry::FlightTruth;

    fn waypoint(source: PlanSource, miss_m: f64) -> WaypointTruth {
        WaypointTruth {
            source,
            wp: 2,
            kind: WaypointType::Flyover,
            miss_m,
            alt_error_m: Some(-3.0),
            hold_max_m: None,
            radius_m: 2.0,
            at: SimTime(4_000_000),
        }
    }

    #[test]
    fn the_radius_and_the_tolerance_are_allowed() {
        let truth = FlightTruth {
            waypoints: vec![waypoint(PlanSource::Stored, 3.0), waypoint(PlanSource::Rth, 30.0)],
            ..FlightTruth::default()
        };
        let report = FlightReport { truth, tolerance_m: Some(10.0), ..FlightReport::default() };
        let rows = rows(&report);
        let texts = |margin: &Margin| (margin.value(), margin.allowed(), margin.left(), margin.class());
        assert_eq!(texts(&rows[0].miss), ("3.00".into(), "12.0".into(), "75 %".into(), "passed"));
        assert_eq!(texts(&rows[0].altitude), ("-3.00".into(), "10.0".into(), "70 %".into(), "passed"));
        assert_eq!(texts(&rows[1].miss), ("30.00".into(), String::new(), String::new(), ""));
        assert_eq!(rows[1].name, "WP2 FLYOVER of the return home");
        let beyond = Margin { value: Some(15.0), allowed: Some(12.0) };
        assert_eq!(texts(&beyond), ("15.00".into(), "12.0".into(), "-25 %".into(), "failed"));
    }
}
