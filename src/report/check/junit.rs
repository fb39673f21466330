//! Checked flights as a JUnit file: one testsuite for each scenario, one testcase for each case and seed. Scenarios of
//! the same name in several files have the file in their class names.

use super::{CheckedFlight, Compared, Summary, complaint, is_skipped};
use crate::report::xml::escaped;
use crate::scenario::Outcome;

pub fn junit(summary: &Summary) -> String {
    // The scenarios of two files may have the same name.
    let mut scenarios: Vec<(&str, &str)> = Vec::new();
    for flight in &summary.flights {
        let scenario = (flight.scenario.as_str(), flight.file.as_str());
        if !scenarios.contains(&scenario) {
            scenarios.push(scenario);
        }
    }
    let failures = summary.flights.iter().filter(|flight| !flight.passed()).count()
        + summary.compared.iter().filter(|compared| compared.judgement.outcome.is_failure()).count();
    let tests = summary.flights.len() + summary.compared.len();
    let skipped = summary.flights.iter().filter(|flight| flight.is_skipped()).count()
        + summary.compared.iter().filter(|compared| is_skipped(&compared.judgement)).count();
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"betadeck\" tests=\"{tests}\" failures=\"{failures}\" skipped=\"{skipped}\" time=\"{:.3}\">\n",
        summary.wall_s
    );
    for &(scenario, file) in &scenarios {
        let class = match scenarios.iter().filter(|(other, _)| *other == scenario).count() {
            1 => scenario.to_owned(),
            _ => format!("{scenario} ({file})"),
        };
        let flights: Vec<&CheckedFlight> = summary
            .flights
            .iter()
            .filter(|flight| (flight.scenario.as_str(), flight.file.as_str()) == (scenario, file))
            .collect();
        let compared: Vec<&Compared> = summary
            .compared
            .iter()
            .filter(|compared| (compared.scenario.as_str(), compared.file.as_str()) == (scenario, file))
            .collect();
        let failed = flights.iter().filter(|flight| !flight.passed()).count()
            + compared.iter().filter(|compared| compared.judgement.outcome.is_failure()).count();
        let skipped = flights.iter().filter(|flight| flight.is_skipped()).count()
            + compared.iter().filter(|compared| is_skipped(&compared.judgement)).count();
        let time: f64 = flights.iter().map(|flight| flight.wall_s).sum();
        text.push_str(&format!(
            "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{failed}\" skipped=\"{skipped}\" time=\"{time:.3}\">\n",
            escaped(scenario),
            flights.len() + compared.len()
        ));
        flights.iter().for_each(|flight| text.push_str(&testcase(&class, flight)));
        compared.iter().for_each(|compared| text.push_str(&comparison(&class, compared)));
        text.push_str("  </testsuite>\n");
    }
    text.push_str("</testsuites>\n");
    text
}

fn testcase(class: &str, flight: &CheckedFlight) -> String {
    let case = if flight.case.is_empty() { "flight" } else { &flight.case };
    let repetition =
        if flight.repetition > 0 { format!(" repetition {}", flight.repetition + 1) } else { String::new() };
    let head = format!(
        "    <testcase classname=\"{}\" name=\"{} seed {}{repetition}\" time=\"{:.3}\"",
        escaped(class),
        escaped(case),
        flight.seed,
        flight.wall_s
    );
    if flight.is_skipped() {
        let why = flight.judgements.first().map(complaint).unwrap_or_default();
        return format!("{head}>\n      <skipped message=\"{}\"/>\n    </testcase>\n", escaped(&why));
    }
    if flight.passed() && flight.skipped() > 0 {
        let skipped: Vec<String> =
            flight.judgements.iter().filter(|one| is_skipped(one)).map(complaint).collect();
        let out = escaped(&skipped.join("\n"));
        return format!("{head}>\n      <system-out>{out}</system-out>\n    </testcase>\n");
    }
    if flight.passed() {
        return format!("{head}/>\n");
    }
    let mut lines: Vec<String> = flight.problem.iter().cloned().collect();
    lines.extend(flight.failures().map(complaint));
    let open = flight.open_command(flight.ended_at);
    failure(&head, &lines, open.as_deref())
}

fn comparison(class: &str, compared: &Compared) -> String {
    let variant = if compared.variant.is_empty() { String::new() } else { format!("{}, ", compared.variant) };
    let head = format!(
        "    <testcase classname=\"{}\" name=\"{} ({}seed {})\" time=\"0\"",
        escaped(class),
        escaped(&compared.judgement.label),
        escaped(&variant),
        compared.seed
    );
    match &compared.judgement.outcome {
        Outcome::Met(_) => return format!("{head}/>\n"),
        Outcome::Skipped(needed) => {
            let why = escaped(needed.missing());
            return format!("{head}>\n      <skipped message=\"{why}\"/>\n    </testcase>\n");
        }
        Outcome::Failed { .. } | Outcome::NeverJudged(_) => {}
    }
    failure(&head, &[complaint(&compared.judgement)], None)
}

fn failure(head: &str, lines: &[String], open: Option<&str>) -> String {
    let message = lines.first().map_or("", String::as_str);
    let mut body = lines.join("\n");
    if let Some(open) = open {
        body.push_str(&format!("\n{open}"));
    }
    format!(
        "{head}>\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n",
        escaped(message),
        escaped(&body)
    )
}
