//! A flight as Markdown for a pull request.

use super::{FlightReport, MarginRow, ReportedSettings, facts, margin_rows};
use crate::report::markdown::{cell, code, line};
use crate::report::record::Transition;
use crate::report::sentence;
use crate::telemetry::NavState;

/// The most rows of a table.
const MAX_ROWS: usize = 200;

/// Returns the verdict, the facts, the margins of the waypoints, the transitions, the changed settings and the command.
pub fn markdown(report: &FlightReport) -> String {
    let verdict = &report.verdict;
    let mut text = format!(
        "<!-- betadeck flight -->\n### {} {}: {}\n\n",
        verdict.emoji(),
        line(&report.name),
        line(&verdict.word)
    );
    if !verdict.reason.is_empty() {
        text.push_str(&format!("{}\n\n", line(&verdict.reason)));
    }
    let facts = facts(report);
    if !facts.is_empty() {
        let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        text.push_str(&row(facts.iter().map(|(name, _)| cell(name)).collect()));
        text.push_str(&row(facts.iter().map(|_| "---".to_owned()).collect()));
        text.push_str(&row(facts.iter().map(|(_, value)| cell(value)).collect()));
        text.push('\n');
    }
    text.push_str(&margins(&margin_rows(report)));
    text.push_str(&transitions(report));
    text.push_str(&report.settings.as_ref().map_or_else(String::new, settings));
    text.extend(report.command.as_ref().map(|command| format!("{}\n", code(command))));
    text
}

fn margins(rows: &[MarginRow]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut text =
        "| waypoint | at, s | measured | miss, m | allowed, m | left | altitude, m | allowed, m | left |\n\
                    | --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    for MarginRow { name, at, rule, miss, altitude } in rows.iter().take(MAX_ROWS) {
        let margin = |margin: &super::Margin| [margin.value(), margin.allowed(), margin.left()].join(" | ");
        text.push_str(&format!("| {name} | {at} | {rule} | {} | {} |\n", margin(miss), margin(altitude)));
    }
    text.push('\n');
    text
}

fn transitions(report: &FlightReport) -> String {
    let all = &report.record.transitions;
    if all.is_empty() {
        return String::new();
    }
    let mut text = format!(
        "<details><summary>{} transitions of the state machine</summary>\n\n| at, s | to | waypoint | why | guard |\n\
         | ---: | --- | --- | --- | --- |\n",
        all.len()
    );
    for transition in all.iter().take(MAX_ROWS) {
        let Transition { time, to, wp, kind, reason, guard, .. } = transition;
        let waypoint = kind.filter(|_| *to != NavState::Idle).map(|kind| format!("WP{wp} {kind}"));
        text.push_str(&format!(
            "| {:.1} | {to} | {} | {} | {} |\n",
            report.record.seconds(*time),
            waypoint.unwrap_or_default(),
            sentence::cause(*reason, *to),
            guard.as_ref().map_or_else(String::new, |guard| cell(&sentence::because(guard)))
        ));
    }
    text.push_str("\n</details>\n\n");
    text
}

fn settings(settings: &ReportedSettings) -> String {
    let lines: Vec<String> = match settings {
        ReportedSettings::Changed(changed) => {
            let line = |[name, value, default]: &[String; 3]| {
                format!("- {} (default {})\n", code(&format!("{name} = {value}")), code(default))
            };
            changed.iter().take(MAX_ROWS).map(line).collect()
        }
        ReportedSettings::Sent(sent) => {
            sent.iter().take(MAX_ROWS).map(|line| format!("- {}\n", code(line))).collect()
        }
        // There are hundreds, and only a page has room for them.
        ReportedSettings::Logged { .. } => Vec::new(),
    };
    match (settings, lines.is_empty()) {
        (_, true) | (ReportedSettings::Logged { .. }, _) => String::new(),
        (ReportedSettings::Changed(_), false) => {
            format!("Settings that differ from their defaults:\n\n{}\n", lines.concat())
        }
        (ReportedSettings::Sent(_), false) => {
            format!("Lines that the firmware got before the flight:\n\n{}\n", lines.concat())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::flight::fixture;

    #[test]
    fn a_flight_is_a_table_for_a_pull_request() {
        insta::assert_snapshot!(markdown(&fixture::report("square", "field")));
    }

    #[test]
    fn names_of_any_kind_survive() {
        let text = markdown(&fixture::report("a | *b* <img src=x> `c`\n# d", "field"));
        assert_eq!(text.lines().nth(1), Some("### ✅ a | \\*b\\* &lt;img src=x> \\`c\\` # d: complete"));
    }

    #[test]
    fn what_a_remote_firmware_got_is_listed() {
        let mut report = fixture::report("square", "field");
        report.settings = Some(ReportedSettings::Sent(vec!["set a = 1".to_owned()]));
        assert!(
            markdown(&report).contains("Lines that the firmware got before the flight:\n\n- `set a = 1`\n")
        );
    }
}
