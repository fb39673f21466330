//! The likeness of two firmwares: for each flight and measure the median and the spread of both, as a page.

use std::collections::BTreeMap;

use super::Lab;
use crate::math;

/// The values of one measure over the seeds of a case: those of the first firmware, and those of the second.
type Values = (Vec<f64>, Vec<f64>);

/// Returns the page. A measure is inside if the median of the first firmware lies between the least and the greatest value of
/// the second.
pub(super) fn page(lab: &Lab, command: Option<&str>) -> String {
    let mut groups: BTreeMap<(&str, String, &str), Values> = BTreeMap::new();
    for flight in &lab.flights {
        let Some(base) = &flight.base else { continue };
        let head = &flight.head;
        for (name, value) in &head.measures {
            let before = base.measures.iter().find(|(measured, _)| measured == name);
            let Some((_, before)) = before.filter(|(_, before)| before.is_finite() && value.is_finite())
            else {
                continue;
            };
            let group = groups.entry((&head.scenario, head.case.clone(), name)).or_default();
            group.0.push(*before);
            group.1.push(*value);
        }
    }
    let rows: Vec<Row> = groups.iter().map(|(key, values)| Row::new(key, values)).collect();
    let (first, second) = (lab.base.as_deref().unwrap_or_default(), lab.head.as_str());
    let inside = rows.iter().filter(|row| row.is_inside).count();
    let share = 100.0 * inside as f64 / rows.len().max(1) as f64;
    let mut text = format!(
        "# Likeness of {first} and {second}\n\n{} flights on each. The median of {first} lies between the least and the \
         greatest value of {second} in {inside} of {} measures ({share:.0} %).\n",
        lab.flights.len(),
        rows.len()
    );
    if let Some(command) = command {
        text.push_str(&format!("\nPrinted by\n\n```text\n{command}\n```\n"));
    }
    let results = results(lab);
    if !results.is_empty() {
        text.push_str(&format!(
            "\n## Other results\n\n| flight | {first} | {second} | seeds |\n| --- | --- | --- | --- |\n"
        ));
        for ((flight, before, after), seeds) in results {
            text.push_str(&format!("| {flight} | {before} | {after} | {seeds} |\n"));
        }
    }
    for scenario in rows.chunk_by(|one, other| one.scenario == other.scenario) {
        let Some(head) = scenario.first() else { continue };
        let inside = scenario.iter().filter(|row| row.is_inside).count();
        text.push_str(&format!(
            "\n## {}: {inside} of {} inside\n\n| case | measure | {first} | {second} | |\n| --- | --- | --- | --- | --- |\n",
            head.scenario,
            scenario.len()
        ));
        scenario.iter().for_each(|row| text.push_str(&row.line()));
    }
    text
}

/// Returns the flights that end in different ways, with the number of their seeds.
fn results(lab: &Lab) -> BTreeMap<(String, String, String), usize> {
    let mut different = BTreeMap::new();
    for flight in &lab.flights {
        let Some(base) = flight.base.as_ref().filter(|base| base.result != flight.head.result) else {
            continue;
        };
        let name = format!("{} {}", flight.head.scenario, flight.head.case);
        *different.entry((name, base.result.clone(), flight.head.result.clone())).or_default() += 1;
    }
    different
}

/// A line of the page.
struct Row {
    scenario: String,
    case: String,
    measure: String,
    /// The median, the least and the greatest value of both firmwares.
    first: [f64; 3],
    second: [f64; 3],
    is_inside: bool,
}

impl Row {
    fn new((scenario, case, measure): &(&str, String, &str), (first, second): &Values) -> Self {
        let (first, second) = (spread(first), spread(second));
        Self {
            scenario: (*scenario).to_owned(),
            case: case.clone(),
            measure: (*measure).to_owned(),
            first,
            second,
            is_inside: (second[1]..=second[2]).contains(&first[0]),
        }
    }

    fn line(&self) -> String {
        let Self { case, measure, first, second, is_inside, .. } = self;
        let values = |values: &[f64; 3]| {
            let [median, least, most] = values.map(|value| number(value, values[0]));
            format!("{median} ({least} … {most})")
        };
        let mark = if *is_inside { "" } else { "outside" };
        format!("| {case} | {measure} | {} | {} | {mark} |\n", values(first), values(second))
    }
}

/// Formats a number with about three digits of the size of another one.
fn number(value: f64, size: f64) -> String {
    let digits = 2 - math::log10(size.abs().max(0.01)).floor() as i32;
    format!("{value:.*}", digits.clamp(0, 2) as usize)
}

/// Returns the median, the least and the greatest of at least one value.
fn spread(values: &[f64]) -> [f64; 3] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |index: usize| sorted.get(index).copied().unwrap_or(f64::NAN);
    let middle = sorted.len() / 2;
    let median =
        if sorted.len() % 2 == 1 { at(middle) } else { 0.5 * (at(middle.saturating_sub(1)) + at(middle)) };
    [median, at(0), at(sorted.len().saturating_sub(1))]
}

#[cfg(test)]
mod tests {
    use super::super::LabFlight;
    use super::*;
    use crate::report::check::CheckedFlight;

    fn flight(result: &str, value: f64) -> CheckedFlight {
        CheckedFlight {
            scenario: "lab-plans".to_owned(),
            case: "square".to_owned(),
            result: result.to_owned(),
            measures: vec![("speed".to_owned(), value)],
            ..CheckedFlight::default()
        }
    }

    fn lab(pairs: &[(f64, f64)]) -> Lab {
        let flights = pairs
            .iter()
            .map(|&(before, after)| LabFlight {
                base: Some(flight("complete", before)),
                head: flight("complete", after),
            })
            .collect();
        Lab::new((Some("embedded".to_owned()), "new.elf".to_owned()), &[], flights, pairs.len(), 1.0)
    }

    #[test]
    fn a_median_within_the_spread_of_the_other_is_inside() {
        let page = page(&lab(&[(5.0, 4.0), (6.0, 5.5), (9.0, 7.0)]), None);
        assert!(page.contains("in 1 of 1 measures (100 %)"), "{page}");
        assert!(page.contains("| square | speed | 6.00 (5.00 … 9.00) | 5.50 (4.00 … 7.00) |  |"), "{page}");
    }

    #[test]
    fn a_median_beyond_it_is_named() {
        let page = page(&lab(&[(8.0, 4.0), (8.2, 5.5)]), None);
        assert!(page.contains("in 0 of 1 measures (0 %)") && page.contains("| outside |"), "{page}");
    }

    #[test]
    fn flights_that_end_otherwise_are_counted() {
        let mut lab = lab(&[(8.0, 4.0), (8.2, 5.5)]);
        lab.flights[1].head.result = "crashed".to_owned();
        assert!(page(&lab, None).contains("| lab-plans square | complete | crashed | 1 |"));
    }
}
