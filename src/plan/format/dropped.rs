//! The values of private waypoints that the items of a file do not have.

use super::loss::{Finding, Severity};
use crate::plan::{Waypoint, WaypointType};

/// The reason of each finding.
const WHY: &str = "only the private data had it";

/// Returns a finding for each private waypoint whose values are not in the taken waypoints. Positions and altitudes are
/// not compared: items have them, and another program moves them on purpose.
pub(super) fn dropped(private: &[Waypoint], taken: &[Waypoint], severity: Severity) -> Vec<Finding> {
    let places = |waypoint: &&Waypoint| waypoint.kind.uses_position();
    let same_number = private.iter().filter(places).count() == taken.iter().filter(places).count();
    let mut rest: Vec<(usize, &Waypoint)> =
        taken.iter().enumerate().filter(|(_, waypoint)| places(waypoint)).collect();
    let mut findings = Vec::new();
    for (index, waypoint) in private.iter().enumerate() {
        let at = if !places(&waypoint) {
            if taken.iter().any(|other| values(other) == values(waypoint)) {
                continue;
            }
            None
        } else if same_number {
            Some(0)
        } else {
            let there = |other: &Waypoint| other.position == waypoint.position;
            let same = rest.iter().position(|(_, other)| there(other) && other.kind == waypoint.kind);
            same.or_else(|| rest.iter().position(|(_, other)| there(other)))
        };
        let Some(at) = at else {
            let from = format!("{} (WP {index} of the private data)", waypoint.kind);
            findings.push(Finding::new(severity, "waypoint", WHY).values(from, ""));
            continue;
        };
        let (number, other) = rest[at];
        rest.drain(..=at);
        let differs: Vec<(&str, String, String)> = values(waypoint)
            .into_iter()
            .zip(values(other))
            .filter(|(from, to)| from != to)
            .map(|((name, from), (_, to))| (name, from, to))
            .collect();
        if !differs.is_empty() {
            let names: Vec<&str> = differs.iter().map(|differs| differs.0).collect();
            let from: Vec<&str> = differs.iter().map(|differs| differs.1.as_str()).collect();
            let to: Vec<&str> = differs.iter().map(|differs| differs.2.as_str()).collect();
            let finding = Finding::new(severity, names.join(", "), WHY).at(number);
            findings.push(finding.values(from.join(", "), to.join(", ")));
        }
    }
    findings
}

fn values(waypoint: &Waypoint) -> [(&'static str, String); 5] {
    let pattern =
        if waypoint.kind == WaypointType::Hold { waypoint.pattern.to_string() } else { "NONE".into() };
    [
        ("type", waypoint.kind.to_string()),
        ("pattern", pattern),
        ("speed", format!("{} m/s", waypoint.speed.mps())),
        ("duration", format!("{} s", waypoint.duration.get())),
        ("yaw rate", format!("{} deg/s", waypoint.yaw_rate_dps)),
    ]
}
