//! The whole answer as JSON.

use serde_json::{Map, Value, json};

use super::broken::seen;
use super::{Broken, Finding, Lab, LabFlight};
use crate::report::check::CheckedFlight;

/// Returns the object.
pub(super) fn object(lab: &Lab) -> String {
    json!({
        "base": lab.base,
        "head": lab.head,
        "worse": lab.is_worse(),
        "verdict": lab.verdict(),
        "flights_wanted": lab.wanted,
        "measures_compared": lab.compared,
        "wall_s": lab.wall_s,
        "measures": lab.findings.iter().map(|found| finding(lab, found)).collect::<Vec<_>>(),
        "properties": lab.broken.iter().map(|found| broken(lab, found)).collect::<Vec<_>>(),
        "flights": lab.flights.iter().map(flight).collect::<Vec<_>>(),
    })
    .to_string()
}

fn finding(lab: &Lab, finding: &Finding) -> Value {
    json!({
        "measure": finding.measure.title,
        "unit": finding.measure.unit,
        "kind": finding.kind.to_string(),
        "before": finding.typical[0],
        "after": finding.typical[1],
        "difference": finding.difference,
        "agreeing": finding.agreeing,
        "differing": finding.differing,
        "flights": finding.pairs,
        "p": finding.p,
        "open": lab.open(finding),
    })
}

fn broken(lab: &Lab, broken: &Broken) -> Value {
    let example = broken.example().and_then(|index| lab.flights.get(index));
    json!({
        "property": broken.label,
        "worse": broken.is_worse(),
        "judged": broken.judged,
        "broken": broken.flights.len(),
        "broken_before": broken.before,
        "newly_broken": broken.newly.len(),
        "mended": broken.mended.len(),
        "sentence": example.map(|flight| seen(&flight.head, &broken.label).0),
        "open": lab.open_broken(broken),
    })
}

fn flight(flight: &LabFlight) -> Value {
    json!({
        "scenario": flight.head.scenario,
        "case": flight.head.case,
        "seed": flight.head.seed,
        "identical": flight.is_identical(),
        "base": flight.base.as_ref().map(side),
        "head": side(&flight.head),
    })
}

fn side(flight: &CheckedFlight) -> Value {
    let measures: Map<String, Value> =
        flight.measures.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    json!({
        "result": flight.result,
        "reason": flight.reason,
        "problem": flight.problem,
        "hash": format!("{:016x}", flight.hash),
        "flown_s": flight.flown_s,
        "failed": flight.failures().map(|judgement| judgement.label.as_str()).collect::<Vec<_>>(),
        "measures": measures,
    })
}
