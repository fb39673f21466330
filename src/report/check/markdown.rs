//! Checked flights as a Markdown summary for a pull request.

use super::{Summary, complaint};
use crate::report::markdown::{cell, code, line};
use crate::scenario::Outcome;

pub fn markdown(summary: &Summary) -> String {
    let word = match summary.passed() {
        _ if summary.is_skipped() => "– Nothing was judged",
        true => "✅ All flights passed",
        false => "❌ Some flights failed",
    };
    let (skipped_flights, skipped) = summary.skipped();
    // Only a remote flight controller causes skipped expectations.
    let with_skipped = skipped > 0;
    let reported = if with_skipped {
        format!(", {skipped_flights} not judged at all, {skipped} expectations not judged")
    } else {
        String::new()
    };
    let (title, line_below) = if with_skipped { ("| not judged ", "| --- ") } else { ("", "") };
    let mut text = format!(
        "### {word}\n\n{} of {} flights passed{reported}; {:.0} s flown in {:.1} s.\n\n| scenario | passed {title}| tightest expectation | left |\n| --- | --- {line_below}| --- | --- |\n",
        summary.passed_flights(),
        summary.wanted,
        summary.flown_s(),
        summary.wall_s
    );
    let mut index = 0;
    for case in summary.cases() {
        let (passed, all) = (case.passed, case.flights);
        let flights = &summary.flights[index..index + all];
        index += all;
        let share = |flight: &super::CheckedFlight| {
            let margin = flight.tightest().and_then(|tightest| tightest.outcome.margin().copied());
            margin.map_or(f64::INFINITY, |margin| margin.verdict.share())
        };
        let tightest =
            flights.iter().min_by(|a, b| share(a).total_cmp(&share(b))).and_then(|flight| flight.tightest());
        let mark = match case.has_failures() {
            true => "❌",
            false if passed == 0 => "–",
            false => "✅",
        };
        let all_of = flights.iter().map(|flight| flight.judgements.len()).sum::<usize>();
        let skipped = flights.iter().map(super::CheckedFlight::skipped).sum::<usize>();
        let skipped = if with_skipped { format!("| {skipped} of {all_of} ") } else { String::new() };
        let (label, left) = match tightest.and_then(|tightest| Some((tightest, tightest.outcome.margin()?))) {
            Some((tightest, margin)) => (
                format!("{} ({})", tightest.label, margin.shown()),
                format!("{:.0} %", 100.0 * margin.verdict.share()),
            ),
            None => (String::new(), String::new()),
        };
        text.push_str(&format!(
            "| {mark} {} | {passed} of {all} {skipped}| {} | {left} |\n",
            cell(&case.name),
            cell(&label)
        ));
    }
    let failed: Vec<_> = summary.flights.iter().filter(|flight| !flight.passed()).collect();
    if !failed.is_empty() {
        text.push_str("\n#### Observed\n\n");
    }
    for flight in failed {
        text.push_str(&format!("- **{}**\n", line(&flight.title())));
        if let Some(problem) = &flight.problem {
            text.push_str(&format!("  - {}\n", line(problem)));
        }
        for judgement in flight.failures() {
            text.push_str(&format!("  - {}\n", line(&complaint(judgement))));
            if let Outcome::Failed { at: Some(at), .. } = judgement.outcome {
                text.extend(flight.open_command(at).map(|open| format!("    {}\n", code(&open))));
            }
        }
    }
    for compared in summary.compared.iter().filter(|compared| compared.judgement.outcome.is_failure()) {
        text.push_str(&format!(
            "- **{}**\n  - {}\n",
            line(&compared.title()),
            line(&complaint(&compared.judgement))
        ));
    }
    text
}
