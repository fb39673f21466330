//! Checked flights as sentences.

use super::{CheckedFlight, Summary, complaint};
use crate::scenario::{Margin, Outcome};
use crate::telemetry::quantity::shown;

/// The least number of flights of a case for which the spread of their numbers is reported.
const MANY: usize = 20;

/// Returns the lines of a flight. A flight that passed has one line. Otherwise the lines give the observed behaviour
/// and the command that opens the worst moment.
pub fn flight_lines(flight: &CheckedFlight) -> Vec<String> {
    let mark = match flight.passed() {
        true if flight.is_skipped() => "–",
        true => "✓",
        false => "✗",
    };
    let title = flight.title();
    let first = match (flight.passed(), flight.tightest()) {
        (true, Some(tightest)) => match tightest.outcome.margin() {
            Some(margin) => format!(
                "{mark} {title}: {}, tightest: {} ({}, {:.0} % left)",
                flight.result,
                tightest.label,
                margin.shown(),
                100.0 * margin.verdict.share()
            ),
            None => format!("{mark} {title}: {}", flight.result),
        },
        (true, None) if flight.is_skipped() && flight.result.is_empty() => {
            format!("{mark} {title}: not flown")
        }
        (true, None) => format!("{mark} {title}: {}", flight.result),
        (false, _) if flight.result.is_empty() => format!("{mark} {title}"),
        (false, _) => format!("{mark} {title}: {}, {}", flight.result, flight.reason),
    };
    let mut lines = vec![format!("{first}{}", skipped(flight))];
    lines.extend(flight.problem.iter().map(|problem| format!("    {problem}")));
    for judgement in flight.failures() {
        lines.push(format!("    line {}: {}", judgement.line, complaint(judgement)));
        if let Outcome::Failed { at: Some(at), .. } = judgement.outcome {
            lines.extend(flight.open_command(at).map(|open| format!("      {open}")));
        }
    }
    lines
}

/// Returns the number of expectations that were not judged and the reason, as the end of a line.
fn skipped(flight: &CheckedFlight) -> String {
    let needed = flight.judgements.iter().filter_map(|judgement| match judgement.outcome {
        Outcome::Skipped(needed) => Some(needed),
        Outcome::Met(_) | Outcome::Failed { .. } | Outcome::NeverJudged(_) => None,
    });
    needed.max().map_or_else(String::new, |needed| {
        let (skipped, all) = (flight.skipped(), flight.judgements.len());
        format!("; {skipped} of {all} expectations not judged, {}", needed.missing())
    })
}

fn counted(expectations: usize) -> String {
    if expectations == 1 { "1 expectation".to_owned() } else { format!("{expectations} expectations") }
}

/// Returns the spread of the numbers of each expectation, for cases with many flights.
fn spreads(summary: &Summary) -> Vec<String> {
    let mut lines = Vec::new();
    let mut first = 0;
    for case in summary.cases() {
        let all = case.flights;
        let flights = &summary.flights[first..first + all];
        first += all;
        if all < MANY {
            continue;
        }
        lines.push(format!("{}, {all} flights:", case.name));
        let labels = flights.first().map_or(&[][..], |flight| flight.judgements.as_slice());
        for label in labels.iter().map(|judgement| judgement.label.as_str()) {
            let mut margins: Vec<Margin> = flights
                .iter()
                .flat_map(|flight| flight.judgements.iter().filter(|judgement| judgement.label == label))
                .filter_map(|judgement| judgement.outcome.margin().copied())
                .collect();
            margins.sort_by(|a, b| a.verdict.share().total_cmp(&b.verdict.share()));
            // The tightest twentieth is beyond the 95th percentile.
            if let (Some(worst), Some(tight)) = (margins.first(), margins.get(margins.len() / 20)) {
                let tight = shown(tight.verdict.value, tight.verdict.dimension);
                lines.push(format!("    {label}: worst {}, 95th percentile {tight}", worst.shown()));
            }
        }
    }
    lines
}

/// Returns the last lines of a run.
pub fn summary_lines(summary: &Summary) -> Vec<String> {
    let mut lines = Vec::new();
    for case in summary.cases().iter().filter(|case| case.flights > 1 && case.has_failures()) {
        lines.push(format!("{}: {} of {}", case.name, case.passed, case.flights));
    }
    lines.extend(spreads(summary));
    for compared in &summary.compared {
        let mark = match &compared.judgement.outcome {
            Outcome::Met(_) => "✓",
            Outcome::Skipped(_) => "–",
            Outcome::Failed { .. } | Outcome::NeverJudged(_) => "✗",
        };
        match compared.judgement.outcome.margin() {
            Some(margin) => lines.push(format!(
                "{mark} {}: {} ({}, {:.0} % left)",
                compared.title(),
                compared.judgement.label,
                margin.shown(),
                100.0 * margin.verdict.share()
            )),
            None => lines.push(format!("{mark} {}: {}", compared.title(), complaint(&compared.judgement))),
        }
    }
    let flown = summary.flown_s();
    let flights = if summary.flights.len() == 1 { "flight" } else { "flights" };
    let nothing = if summary.is_skipped() { "nothing was judged: " } else { "" };
    let mut last =
        format!("{nothing}{} of {} {flights} passed", summary.passed_flights(), summary.flights.len());
    let failed = summary.compared.iter().filter(|compared| compared.judgement.outcome.is_failure()).count();
    if failed > 0 {
        last.push_str(&format!(", {failed} comparisons failed"));
    }
    match summary.skipped() {
        (0, 0) => {}
        (0, expectations) => last.push_str(&format!(", {} not judged", counted(expectations))),
        (flights, expectations) => {
            last.push_str(&format!(", {flights} not judged at all, {} not judged", counted(expectations)));
        }
    }
    if summary.flights.len() < summary.wanted {
        last.push_str(&format!(", {} were not flown", summary.wanted - summary.flights.len()));
    }
    if summary.flights.is_empty() {
        last.push_str(&format!("; nothing was flown in {:.2} s", summary.wall_s));
    } else {
        last.push_str(&format!(
            "; {flown:.1} s flown in {:.2} s ({:.0}x real time)",
            summary.wall_s,
            flown / summary.wall_s.max(1e-6)
        ));
    }
    if summary.left_out > 0 {
        let slow = if summary.left_out == 1 {
            "1 slow scenario"
        } else {
            &format!("{} slow scenarios", summary.left_out)
        };
        last.push_str(&format!("; {slow} left out (--slow)"));
    }
    lines.push(last);
    lines
}
