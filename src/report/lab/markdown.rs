//! The whole answer as Markdown, for a pull request.

use super::Lab;
use crate::report::markdown::{cell, code, line};

/// Returns the document.
pub(super) fn markdown(lab: &Lab, command: Option<&str>) -> String {
    let mark = match lab.is_worse() {
        _ if lab.flights.is_empty() => "–",
        true => "❌",
        false => "✅",
    };
    let mut text =
        format!("### {mark} {}\n\n{}\n\n{}.\n", line(&lab.title()), line(&lab.verdict()), line(&lab.flown()));
    if !lab.findings.is_empty() {
        text.push_str(
            "\n| | measure | before | after | difference | flights | p | shown by |\n\
             | --- | --- | ---: | ---: | ---: | ---: | ---: | --- |\n",
        );
    }
    for finding in &lab.findings {
        let [before, after] = finding.typical;
        let command = lab.open(finding).map(|open| code(&open)).unwrap_or_default();
        text.push_str(&format!(
            "| {} | {} | {before:.2} | {after:.2} | {:+.2} {} | {} of {} | {:.1e} | {command} |\n",
            finding.kind,
            cell(&finding.measure.title),
            finding.difference,
            finding.measure.unit,
            finding.agreeing,
            finding.differing,
            finding.p
        ));
    }
    if lab.shown().next().is_some() {
        text.push('\n');
    }
    for broken in lab.shown() {
        let command = lab.open_broken(broken).map(|open| format!(" {}", code(&open))).unwrap_or_default();
        text.push_str(&format!("* {}{command}\n", line(&lab.broken_line(broken))));
    }
    if let Some(command) = command {
        text.push_str(&format!("\n{}\n", code(command)));
    }
    text
}
