//! The answer in about ten lines.

use super::broken::seen;
use super::{Broken, Finding, Kind, Lab};

/// The most lines of findings and broken properties.
const LINES: usize = 8;
const GROUPS: usize = 5;

/// Returns the answer.
pub(super) fn answer(lab: &Lab) -> String {
    let mut lines = vec![format!("{}: {}", lab.title(), lab.flown()), lab.verdict()];
    let groups = groups(lab);
    // Worse measures and worse properties get half of the lines each if there are so many.
    let mut shown = [0; GROUPS];
    for (most, group) in [(LINES / 2, 0..2), (LINES, 0..GROUPS)] {
        for at in group {
            let left = LINES - shown.iter().sum::<usize>();
            shown[at] += (groups[at].len() - shown[at]).min(most.saturating_sub(shown[at])).min(left);
        }
    }
    for (group, count) in groups.iter().zip(shown) {
        for (line, open) in group.iter().take(count) {
            lines.push(format!("  {line}"));
            lines.extend(open.iter().map(|open| format!("      {open}")));
        }
    }
    let left = groups.iter().map(Vec::len).sum::<usize>() - shown.iter().sum::<usize>();
    if left > 0 {
        lines.push(format!("  and {left} more: --markdown and --html show all"));
    }
    lines.push(String::new());
    lines.join("\n")
}

/// Returns the lines with their commands, in groups: worse measures, worse properties, changed measures, other properties,
/// better measures.
fn groups(lab: &Lab) -> [Vec<(String, Option<String>)>; GROUPS] {
    let measures = |kind: Kind| {
        let of_kind = lab.findings.iter().filter(move |finding| finding.kind == kind);
        of_kind.map(|finding| (line(finding), lab.open(finding))).collect()
    };
    let properties = |is_worse: bool| {
        let wanted = lab.shown().filter(move |broken| broken.is_worse() == is_worse);
        wanted.map(|broken| (broken_line(lab, broken), lab.open_broken(broken))).collect()
    };
    [
        measures(Kind::Worse),
        properties(true),
        measures(Kind::Changed),
        properties(false),
        measures(Kind::Better),
    ]
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
