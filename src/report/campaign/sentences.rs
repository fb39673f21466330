//! The answer of a campaign as sentences.

use super::{Reported, shown};
use crate::campaign::{
    Answer, Causes, GoalOutcome, JudgedGoal, MetricDifference, Significance, Success, Summary, Versus,
};
use crate::scenario::percent;

/// The most causes that are named.
const CAUSES: usize = 3;
/// The most reasons that are named why flights could not be flown.
const REASONS: usize = 3;

/// Returns the answer.
pub fn answer_sentences(reported: &Reported<'_>) -> Vec<String> {
    let answer = reported.answer;
    let mut lines = vec![format!("{}.", success(reported))];
    lines.extend(results(answer));
    lines.extend(not_flown(answer));
    lines.extend(distributions(answer));
    lines.extend(touchdown(answer));
    lines.extend(causes(&answer.causes));
    lines.extend(worst(reported));
    if let Some(versus) = &answer.versus {
        lines.extend(comparison(reported, versus));
    }
    if !answer.goals.is_empty() {
        lines.push(String::new());
        lines.extend(answer.goals.iter().map(goal));
    }
    lines
}

/// Returns the number of flights with each result; `None` if all have the same.
pub(in crate::report) fn results(answer: &Answer) -> Option<String> {
    let results: Vec<String> =
        answer.results.iter().map(|(result, count)| format!("{count} {result}")).collect();
    (results.len() > 1).then(|| format!("Results: {}.", results.join(", ")))
}

/// Returns the reasons why flights could not be flown.
pub(in crate::report) fn not_flown(answer: &Answer) -> Vec<String> {
    // Those of both sides.
    let all: u64 = answer.not_flown.iter().map(|(_, count)| count).sum();
    let mut lines: Vec<String> = answer
        .not_flown
        .iter()
        .take(REASONS)
        .map(|(reason, count)| format!("Not flown, {count} of {all}: {reason}."))
        .collect();
    if answer.not_flown.len() > REASONS {
        lines.push(
            "Not flown, the others: for more reasons, in the file of the run (--out) or --csv.".to_owned(),
        );
    }
    lines
}

/// Returns the first sentence, without its full stop.
pub(super) fn success(reported: &Reported<'_>) -> String {
    let answer = reported.answer;
    let flights = if answer.flown == 1 { "1 flight".to_owned() } else { format!("{} flights", answer.flown) };
    let mut head = vec![reported.name.to_owned(), flights];
    head.extend(reported.design.clone());
    head.extend(reported.shard.map(|shard| format!("shard {shard}")));
    let head = head.join(", ");
    let unflown = match answer.wanted.saturating_sub(answer.flown) {
        0 => String::new(),
        rest => format!("; {rest} of {} were not flown", answer.wanted),
    };
    format!("{head}: {}{unflown}", share(&answer.success))
}

/// Returns the share of successful flights with its interval.
pub(in crate::report) fn share(success: &Success) -> String {
    let mut others = match success.skipped {
        0 => String::new(),
        skipped => format!("; {skipped} could not be judged"),
    };
    if success.not_flown > 0 {
        others.push_str(&format!("; {} could not be flown", success.not_flown));
    }
    let Some(share) = success.share() else { return format!("nothing was judged{others}") };
    let Success { passed, judged, low, high, .. } = *success;
    format!(
        "{} succeeded ({passed} of {judged}; {} to {} with 95 % confidence){others}",
        percent(share),
        percent(low),
        percent(high)
    )
}

/// Returns the table of distributions.
fn distributions(answer: &Answer) -> Vec<String> {
    if answer.distributions.is_empty() {
        return Vec::new();
    }
    let mut rows = vec![["", "median", "5 %", "95 %", "least", "greatest"].map(str::to_owned)];
    for distribution in &answer.distributions {
        let value = |value| shown::value(&distribution.of, value);
        rows.push([
            distribution.of.name.clone(),
            value(distribution.median),
            value(distribution.p5),
            value(distribution.p95),
            value(distribution.least),
            value(distribution.greatest),
        ]);
    }
    let mut lines = vec![String::new()];
    lines.extend(aligned(&rows));
    if answer.distributions.iter().any(|distribution| !distribution.is_exact) {
        lines.push(format!("Quantiles are within {} of themselves.", percent(Summary::ERROR)));
    }
    lines
}

/// Returns rows as lines with columns of equal width, the first one to the left.
fn aligned<const N: usize>(rows: &[[String; N]]) -> Vec<String> {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..N).map(width).collect();
    rows.iter()
        .map(|row| {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
                if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        })
        .collect()
}

pub(in crate::report) fn touchdown(answer: &Answer) -> Option<String> {
    let distribution = answer.distribution("touchdown")?;
    let value = |value| shown::value(&distribution.of, value);
    Some(format!(
        "Half of the landings are within {} of their place (CEP50), 95 % within {} (CEP95).",
        value(distribution.median),
        value(distribution.p95)
    ))
}

/// Returns what explains the failures, with an empty line before it.
pub(in crate::report) fn causes(causes: &Causes) -> Vec<String> {
    let mut lines = Vec::new();
    if causes.failures > 0 && causes.failures < causes.flights {
        lines.push(String::new());
        let real: Vec<_> = causes.of_failures.iter().filter(|cause| cause.is_real).take(CAUSES).collect();
        let failures = if causes.failures == 1 {
            "the failure".to_owned()
        } else {
            format!("the {} failures", causes.failures)
        };
        if real.is_empty() {
            let best = causes.of_failures.first().map_or_else(String::new, |cause| {
                format!(" The closest is {}.", shown::rule(&cause.input, &cause.split.rule))
            });
            lines.push(format!("No input explains {failures} better than chance.{best}"));
        } else {
            lines.push(format!("What explains {failures}:"));
        }
        for (number, cause) in (1..).zip(real) {
            let rho = cause.rho.map_or_else(String::new, |rho| format!("; rank correlation {rho:.2}"));
            lines.push(format!(
                "  {number}. {}: {}{rho}",
                shown::rule(&cause.input, &cause.split.rule),
                shown::split(&cause.split)
            ));
        }
    }
    for (metric, input, rho) in &causes.of_metrics {
        lines.push(format!("{metric} depends most on {input} (rank correlation {rho:.2})."));
    }
    lines
}

fn worst(reported: &Reported<'_>) -> Vec<String> {
    let worst = &reported.answer.worst;
    if worst.is_empty() {
        return Vec::new();
    }
    let all_passed = worst.iter().all(|worst| worst.has_passed);
    let title = if all_passed { "The tightest flights:" } else { "The worst flights:" };
    let mut lines = vec![String::new(), title.to_owned()];
    for alike in shown::alike(worst) {
        let [one, others @ ..] = alike.as_slice() else { continue };
        lines.push(format!("  {}: {}", shown::flight_name(reported, one), shown::complaint(one)));
        lines.extend(shown::open_command(reported, one).map(|command| format!("      {command}")));
        if let Some(more) = shown::others(reported, one, others) {
            lines.push(format!("      {more}"));
        }
    }
    if reported.run.is_none() {
        lines.push(
            "  (--out RUN.jsonl keeps the flights; betadeck open RUN.jsonl:N then shows flight N)".to_owned(),
        );
    }
    lines
}

/// Returns the comparison of two sides, with an empty line before it.
pub(in crate::report) fn comparison(reported: &Reported<'_>, versus: &Versus) -> Vec<String> {
    let [a, b] = reported.sides.clone().unwrap_or_else(|| ["A".to_owned(), "B".to_owned()]);
    let mut lines =
        vec![String::new(), format!("B ({b}) against A ({a}), {} pairs with the same inputs:", versus.pairs)];
    lines.push(format!("  A: {}", share(&versus.a)));
    lines.push(format!("  B: {}", share(&versus.b)));
    let p = shown::probability(versus.success.p);
    let verdict = match (versus.success.is_real(), versus.only_b > versus.only_a) {
        (true, true) => "B succeeds more often",
        (true, false) => "A succeeds more often",
        (false, _) => "this may be chance",
    };
    lines.push(format!(
        "  {} flights succeeded only with A, {} only with B: {verdict} (McNemar, p = {p}).",
        versus.only_a, versus.only_b
    ));
    lines.extend(versus.metrics.iter().map(|metric| format!("  {}", difference(metric))));
    lines
}

fn difference(metric: &MetricDifference) -> String {
    let value = |value| shown::value(&metric.of, value);
    let head = format!(
        "{}: median {} with A, {} with B",
        metric.of.name,
        value(metric.median_a),
        value(metric.median_b)
    );
    let sign = if metric.difference > 0.0 { "+" } else { "" };
    match metric.significance {
        None => format!("{head}; the same in every pair."),
        Some(significance) => {
            let Significance { p, test } = significance;
            let real = if significance.is_real() { "a real difference" } else { "this may be chance" };
            format!(
                "{head}; B − A {sign}{} in the median: {real} ({test}, p = {}).",
                value(metric.difference),
                shown::probability(p)
            )
        }
    }
}

/// Returns a judged goal as a line.
pub(super) fn goal(judged: &JudgedGoal) -> String {
    let mark = match judged.outcome {
        GoalOutcome::Met => "✓",
        GoalOutcome::Failed => "✗",
        GoalOutcome::Unknown => "–",
    };
    format!("{mark} {}: {}", judged.goal.label, found(judged))
}

/// Returns what was found for a goal.
pub(in crate::report) fn found(judged: &JudgedGoal) -> String {
    let subject = &judged.goal.subject;
    match (judged.found, judged.bound, judged.goal.confidence) {
        (None, ..) => "no flight has this number".to_owned(),
        (Some(found), Some(bound), Some(_)) => {
            format!("{} (the bound is {})", subject.shown(found), subject.shown(bound))
        }
        (Some(found), None, Some(_)) => {
            format!("{} (too few flights for this confidence)", subject.shown(found))
        }
        (Some(found), _, None) => subject.shown(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::{Side, Worst};

    /// Returns the lines of the worst flights, of which the last two fail for the same reason.
    fn lines() -> Vec<String> {
        let scenario = crate::scenario::BuiltinScenario::find("guide-1").unwrap();
        let request = crate::scenario::Request {
            file: scenario.name,
            text: scenario.text,
            seeds: None,
            max_flights: 100,
            flights: crate::scenario::Flights::Listed,
        };
        let scenario = crate::scenario::read_request(&request, &mut crate::scenario::BuiltinFiles).unwrap();
        let mut answer = crate::campaign::AnswerBuilder::new(&scenario, 40, false).answer();
        let worst = |number, result: &str, complaint: &str, alike| Worst {
            number,
            side: Side::A,
            result: result.to_owned(),
            complaint: complaint.to_owned(),
            at: None,
            alike,
            has_passed: false,
            margin: None,
        };
        answer.worst = vec![
            worst(7, "crashed", "the craft crashed: it hit the ground sinking at 3.1 m/s", 1),
            worst(9, "aborted", "mission given up: no fix for 20 s", 12),
            worst(4, "aborted", "mission given up: no fix for 21 s", 12),
        ];
        answer.success.not_flown = 3;
        answer.not_flown = vec![("airframe iris: too heavy".to_owned(), 3)];
        let reported = Reported {
            answer: &answer,
            name: "x",
            version: "0",
            design: None,
            run: Some("run.jsonl"),
            sides: None,
            shard: None,
        };
        answer_sentences(&reported)
    }

    #[test]
    fn equal_reasons_are_one_line_with_their_number() {
        let lines = lines();
        let at = lines.iter().position(|line| line == "The worst flights:").unwrap();
        assert_eq!(
            lines[at + 1..],
            [
                "  7: the craft crashed: it hit the ground sinking at 3.1 m/s",
                "      betadeck open run.jsonl:7",
                "  9: aborted, mission given up: no fix for 20 s",
                "      betadeck open run.jsonl:9",
                "      and 11 more like it, the worst of them 4",
            ]
        );
    }

    #[test]
    fn flights_that_could_not_be_flown_are_in_the_first_line() {
        let lines = lines();
        assert!(lines[0].contains("; 3 could not be flown"), "{}", lines[0]);
        assert!(lines.contains(&"Not flown, 3 of 3: airframe iris: too heavy.".to_owned()), "{lines:?}");
    }

    #[test]
    fn thresholds_have_three_digits() {
        for (value, text) in [
            (12.2705, "12.3"),
            (-4.6617, "-4.66"),
            (0.012_345, "0.0123"),
            (412.7, "413"),
            (1500.0, "1500"),
            (2.5, "2.5"),
        ] {
            assert_eq!(shown::number(value), text);
        }
    }
}
