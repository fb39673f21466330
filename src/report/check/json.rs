//! Checked flights as JSON lines: one object for each flight, one for each comparison, and one at the end.

use serde_json::{Map, Value, json};

use super::{CaseCount, CheckedFlight, Compared, Summary};
use crate::scenario::{Judgement, Outcome};
use crate::signals::SimTime;

/// Returns the line of a flight.
pub fn flight_line(flight: &CheckedFlight) -> String {
    let expectations: Vec<Value> =
        flight.judgements.iter().map(|judgement| expectation(judgement, Some(flight))).collect();
    let measures: Map<String, Value> =
        flight.measures.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    json!({
        "t": flight.ended_at.as_secs_f64(),
        "event": "flight",
        "scenario": flight.scenario,
        "file": flight.file,
        "case": flight.case,
        "seed": flight.seed,
        "repetition": flight.repetition,
        "passed": flight.passed(),
        "skipped": flight.skipped(),
        "result": flight.result,
        "reason": flight.reason,
        "problem": flight.problem,
        "engaged_s": flight.engaged_at.map(SimTime::as_secs_f64),
        "flown_s": flight.flown_s,
        "wall_s": flight.wall_s,
        "hash": format!("{:016x}", flight.hash),
        "tightest": flight.tightest().map(|tightest| tightest.label.as_str()),
        "expectations": expectations,
        "measures": measures,
    })
    .to_string()
}

/// Returns the lines of the comparisons, and the last line of a run.
pub fn summary_line(summary: &Summary) -> Vec<String> {
    let mut lines: Vec<String> = summary.compared.iter().map(compared_line).collect();
    let cases: Vec<Value> = summary
        .cases()
        .into_iter()
        .map(|CaseCount { name, passed, skipped, flights }| {
            json!({"case": name, "passed": passed, "skipped": skipped, "flights": flights})
        })
        .collect();
    let (skipped_flights, skipped) = summary.skipped();
    lines.push(
        json!({
            "event": "summary",
            "passed": summary.passed(),
            "flights": summary.flights.len(),
            "flights_passed": summary.passed_flights(),
            "flights_wanted": summary.wanted,
            "flights_skipped": skipped_flights,
            "skipped": skipped,
            "slow_left_out": summary.left_out,
            "cases": cases,
            "flown_s": summary.flown_s(),
            "wall_s": summary.wall_s,
        })
        .to_string(),
    );
    lines
}

fn compared_line(compared: &Compared) -> String {
    json!({
        "event": "comparison",
        "scenario": compared.scenario,
        "variant": compared.variant,
        "seed": compared.seed,
        "expectation": expectation(&compared.judgement, None),
    })
    .to_string()
}

fn expectation(judgement: &Judgement, flight: Option<&CheckedFlight>) -> Value {
    let mut object = Map::new();
    object.insert("expectation".to_owned(), json!(judgement.label));
    object.insert("line".to_owned(), json!(judgement.line));
    match &judgement.outcome {
        Outcome::Met(margin) => {
            object.insert("outcome".to_owned(), json!("met"));
            if let Some(margin) = margin {
                let verdict = &margin.verdict;
                let finite = |number: f64| number.is_finite().then_some(number);
                object.insert("value".to_owned(), json!(verdict.value));
                object.insert("low".to_owned(), json!(finite(verdict.low)));
                object.insert("high".to_owned(), json!(finite(verdict.high)));
                object.insert("margin_share".to_owned(), json!(verdict.share()));
                object.insert("t".to_owned(), json!(margin.time.as_secs_f64()));
            }
        }
        Outcome::Failed { sentence, at, guard } => {
            object.insert("outcome".to_owned(), json!("failed"));
            object.insert("sentence".to_owned(), json!(sentence));
            object.insert("guard".to_owned(), json!(guard));
            object.insert("t".to_owned(), json!(at.map(SimTime::as_secs_f64)));
            if let (Some(at), Some(flight)) = (at, flight)
                && let Some(open) = flight.open_command(*at)
            {
                object.insert("open".to_owned(), json!(open));
            }
        }
        Outcome::NeverJudged(why) => {
            object.insert("outcome".to_owned(), json!("never_judged"));
            object.insert("sentence".to_owned(), json!(why));
        }
        Outcome::Skipped(needed) => {
            object.insert("outcome".to_owned(), json!("skipped"));
            object.insert("sentence".to_owned(), json!(needed.missing()));
        }
    }
    Value::Object(object)
}
