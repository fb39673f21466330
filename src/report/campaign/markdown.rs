//! The answer of a campaign as Markdown, for a pull request.

use super::sentences::{found, not_flown, success};
use super::{Reported, shown};
use crate::campaign::GoalOutcome;
use crate::report::markdown::{cell, code, line};

/// Returns the answer.
pub fn answer_markdown(reported: &Reported<'_>) -> String {
    let answer = reported.answer;
    let word = if answer.is_met() { "✅" } else { "❌" };
    let mut text = format!("### {word} {}\n\n", line(&success(reported)));
    for reason in not_flown(answer) {
        text.push_str(&format!("- {}\n", line(&reason)));
    }
    if !answer.not_flown.is_empty() {
        text.push('\n');
    }
    if !answer.goals.is_empty() {
        text.push_str("| goal | found |\n| --- | --- |\n");
        for judged in &answer.goals {
            let mark = match judged.outcome {
                GoalOutcome::Met => "✅",
                GoalOutcome::Failed => "❌",
                GoalOutcome::Unknown => "–",
            };
            text.push_str(&format!("| {mark} {} | {} |\n", cell(&judged.goal.label), cell(&found(judged))));
        }
        text.push('\n');
    }
    if !answer.distributions.is_empty() {
        text.push_str("| metric | median | 5 % | 95 % | least | greatest |\n| --- | ---: | ---: | ---: | ---: | ---: |\n");
        for distribution in &answer.distributions {
            let value = |value| shown::value(&distribution.of, value);
            text.push_str(&format!(
                "| {} | {} | {} | {} | {} | {} |\n",
                cell(&distribution.of.name),
                value(distribution.median),
                value(distribution.p5),
                value(distribution.p95),
                value(distribution.least),
                value(distribution.greatest)
            ));
        }
        text.push('\n');
    }
    for cause in answer.causes.of_failures.iter().filter(|cause| cause.is_real).take(3) {
        text.push_str(&format!(
            "- **{}**: {}\n",
            line(&shown::rule(&cause.input, &cause.split.rule)),
            shown::split(&cause.split)
        ));
    }
    if let Some(versus) = &answer.versus {
        text.push_str(&format!(
            "- {} flights succeeded only with A, {} only with B (McNemar, p = {})\n",
            versus.only_a,
            versus.only_b,
            shown::probability(versus.success.p)
        ));
        for metric in &versus.metrics {
            let p = metric.significance.map_or_else(String::new, |significance| {
                format!(" ({}, p = {})", significance.test, shown::probability(significance.p))
            });
            text.push_str(&format!(
                "- {}: B − A {} in the median{p}\n",
                line(&metric.of.name),
                shown::value(&metric.of, metric.difference)
            ));
        }
    }
    let failed: Vec<_> = answer.worst.iter().filter(|worst| !worst.has_passed).cloned().collect();
    if !failed.is_empty() {
        text.push_str("\n#### The worst flights\n\n");
    }
    for alike in shown::alike(&failed) {
        let [worst, others @ ..] = alike.as_slice() else { continue };
        text.push_str(&format!(
            "- **{}** {}\n",
            shown::flight_name(reported, worst),
            line(&shown::complaint(worst))
        ));
        text.extend(shown::open_command(reported, worst).map(|command| format!("  - {}\n", code(&command))));
        text.extend(shown::others(reported, worst, others).map(|more| format!("  - {more}\n")));
    }
    text
}
