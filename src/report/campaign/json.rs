//! The answer of a campaign as one JSON object.

use serde_json::{Map, Value, json};

use super::{Reported, shown};
use crate::campaign::{Cause, GoalOutcome, JudgedGoal, Rule, Significance, Success, Versus};

/// Returns the answer.
pub fn answer_json(reported: &Reported<'_>) -> String {
    let answer = reported.answer;
    let results: Map<String, Value> =
        answer.results.iter().map(|(result, count)| (result.clone(), json!(count))).collect();
    let distributions: Map<String, Value> = answer
        .distributions
        .iter()
        .map(|distribution| {
            let value = json!({
                "unit": distribution.of.dimension.unit().map(|unit| unit.name),
                "count": distribution.count,
                "mean": distribution.mean,
                "min": distribution.least,
                "p5": distribution.p5,
                "median": distribution.median,
                "p95": distribution.p95,
                "max": distribution.greatest,
                "exact": distribution.is_exact,
            });
            (distribution.of.name.clone(), value)
        })
        .collect();
    let depends: Vec<Value> = answer
        .causes
        .of_metrics
        .iter()
        .map(|(metric, input, rho)| json!({"metric": metric, "input": input, "rank_correlation": rho}))
        .collect();
    let worst: Vec<Value> = answer
        .worst
        .iter()
        .map(|worst| {
            json!({
                "flight": worst.number,
                "side": reported.sides.as_ref().map(|_| worst.side.to_string()),
                "passed": worst.has_passed,
                "result": worst.result,
                "complaint": worst.complaint,
                "alike": worst.alike,
                "open": shown::open_command(reported, worst),
            })
        })
        .collect();
    let object = json!({
        "event": "answer",
        "name": reported.name,
        "version": reported.version,
        "design": reported.design,
        "shard": reported.shard.map(|shard| shard.to_string()),
        "flights": answer.flown,
        "flights_wanted": answer.wanted,
        "flown_s": answer.flown_s,
        "met": answer.is_met(),
        "success": success(&answer.success),
        "results": results,
        "not_flown": answer.not_flown.iter().map(|(reason, count)| json!({"reason": reason, "flights": count})).collect::<Vec<_>>(),
        "distributions": distributions,
        "causes": answer.causes.of_failures.iter().map(cause).collect::<Vec<_>>(),
        "causes_flights": answer.causes.flights,
        "depends": depends,
        "worst": worst,
        "versus": answer.versus.as_ref().map(|side| versus(reported, side)),
        "goals": answer.goals.iter().map(goal).collect::<Vec<_>>(),
    });
    object.to_string()
}

fn success(success: &Success) -> Value {
    json!({
        "share": success.share(),
        "passed": success.passed,
        "judged": success.judged,
        "skipped": success.skipped,
        "not_flown": success.not_flown,
        "low": success.low,
        "high": success.high,
        "confidence": 0.95,
    })
}

fn cause(cause: &Cause) -> Value {
    let split = &cause.split;
    let (operator, value) = match &split.rule {
        Rule::Above(threshold) => (">", json!(threshold)),
        Rule::AtMost(threshold) => ("<=", json!(threshold)),
        Rule::Is(word) => ("=", json!(word)),
    };
    json!({
        "input": cause.input,
        "operator": operator,
        "value": value,
        "failed_inside": split.inside.0,
        "flights_inside": split.inside.1,
        "failed_outside": split.outside.0,
        "flights_outside": split.outside.1,
        "gain_bits": split.gain,
        "p": split.p,
        "real": cause.is_real,
        "rank_correlation": cause.rho,
    })
}

fn versus(reported: &Reported<'_>, versus: &Versus) -> Value {
    let significance = |significance: &Significance| json!({"test": significance.test, "p": significance.p, "real": significance.is_real()});
    let metrics: Map<String, Value> = versus
        .metrics
        .iter()
        .map(|metric| {
            let value = json!({
                "median_a": metric.median_a,
                "median_b": metric.median_b,
                "difference": metric.difference,
                "significance": metric.significance.as_ref().map(significance),
            });
            (metric.of.name.clone(), value)
        })
        .collect();
    json!({
        "pairs": versus.pairs,
        "names": reported.sides,
        "a": success(&versus.a),
        "b": success(&versus.b),
        "only_a": versus.only_a,
        "only_b": versus.only_b,
        "significance": significance(&versus.success),
        "metrics": metrics,
    })
}

fn goal(judged: &JudgedGoal) -> Value {
    let outcome = match judged.outcome {
        GoalOutcome::Met => "met",
        GoalOutcome::Failed => "failed",
        GoalOutcome::Unknown => "unknown",
    };
    json!({
        "goal": judged.goal.label,
        "line": judged.goal.line,
        "outcome": outcome,
        "found": judged.found,
        "bound": judged.bound,
        "confidence": judged.goal.confidence,
    })
}
