//! The answer in about ten lines.

use super::broken::seen;
use super::{Broken, Finding, Lab};

/// The most lines of findings, and of broken properties.
const LINES: usize = 8;

/// Returns the answer.
pub(super) fn answer(lab: &Lab) -> String {
    let mut lines = vec![format!("{}: {}", lab.title(), lab.flown()), lab.verdict()];
    let broken: Vec<&Broken> = lab.shown().collect();
    // Broken properties get at least half of the lines if there are so many.
    let of_findings = lab.findings.len().min(LINES - broken.len().min(LINES / 2));
    for finding in lab.findings.iter().take(of_findings) {
        lines.push(format!("  {}", line(finding)));
        lines.extend(lab.open(finding).map(|open| format!("      {open}")));
    }
    for broken in broken.iter().take(LINES - of_findings) {
        lines.push(format!("  {}", broken_line(lab, broken)));
        lines.extend(lab.open_broken(broken).map(|open| format!("      {open}")));
    }
    let left = lab.findings.len() + broken.len() - of_findings - broken.len().min(LINES - of_findings);
    if left > 0 {
        lines.push(format!("  and {left} more: --markdown and --html show all"));
    }
    lines.push(String::new());
    lines.join("\n")
}

/// Returns a finding: `worse: speed at the touchdown 0.52 → 0.93 m/s (+0.41, 20 of 20 flights)`.
pub(super) fn line(finding: &Finding) -> String {
    let Finding { measure, kind, typical: [base, head], difference, agreeing, differing, pairs, .. } =
        finding;
    let unit = if measure.unit.is_empty() { String::new() } else { format!(" {}", measure.unit) };
    let all = if pairs == differing { String::new() } else { format!(", {} are equal", pairs - differing) };
    format!(
        "{kind}: {} {base:.2} → {head:.2}{unit} ({difference:+.2}, {agreeing} of {differing} flights{all})",
        measure.title
    )
}

/// Returns a broken property with its flights and what was seen.
pub(super) fn broken_line(lab: &Lab, broken: &Broken) -> String {
    let example = broken.example().and_then(|index| lab.flights.get(index));
    let (title, sentence) = example.map_or_else(Default::default, |flight| {
        (flight.head.title(), seen(&flight.head, &broken.label).0.to_owned())
    });
    let (all, now) = (broken.judged, broken.flights.len());
    let label = &broken.label;
    match lab.base {
        None => format!("broken: {label}: {now} of {all} flights; {title}: {sentence}"),
        Some(_) => {
            let word = if broken.is_worse() { "worse" } else { "fails now" };
            let newly = broken.newly.len();
            format!(
                "{word}: {label}: before {} → {now} of {all} flights, {newly} newly; {title}: {sentence}",
                broken.before
            )
        }
    }
}
