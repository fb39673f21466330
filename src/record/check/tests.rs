//! The forms of a checked run.

use super::*;
use crate::scenario::expression::Verdict;
use crate::scenario::quantity::Dimension;
use crate::scenario::{Margin, Outcome};

/// A flight of a case with many seeds, whose greatest distance was this.
fn flight(seed: u64, distance_m: f64) -> CheckedFlight {
    let verdict = Verdict {
        value: distance_m,
        low: f64::NEG_INFINITY,
        high: 10.0,
        dimension: Dimension::LENGTH,
        strict: false,
    };
    let outcome = if verdict.holds() {
        Outcome::Met(Some(Margin { verdict, time: SimTime::ZERO }))
    } else {
        Outcome::Failed { sentence: "too far".to_owned(), at: Some(SimTime(3_000_000)), guard: None }
    };
    CheckedFlight {
        scenario: "a <b> & \"c\" | *d*".to_owned(),
        file: "it's here.toml".to_owned(),
        case: "one, noise real".to_owned(),
        seed,
        seeds: 40,
        result: "complete".to_owned(),
        reason: "mission complete".to_owned(),
        judgements: vec![Judgement { label: "distance(home) <= 10 m".to_owned(), line: 7, outcome }],
        engaged_at: Some(SimTime(1_000_000)),
        flown_s: 10.0,
        ..CheckedFlight::default()
    }
}

fn summary(distances: impl Iterator<Item = f64>) -> Summary {
    let flights: Vec<CheckedFlight> =
        distances.enumerate().map(|(seed, m)| flight(seed as u64 + 1, m)).collect();
    let wanted = flights.len();
    Summary::new(flights, Vec::new(), wanted, 2, 0.5)
}

#[test]
fn many_seeds_are_summed_up_with_their_worst_and_their_95th_percentile() {
    let lines = summary_lines(&summary((1..=40).map(|m| f64::from(m) * 0.2)));
    assert_eq!(
        lines,
        [
            "a <b> & \"c\" | *d* · one, noise real, 40 flights:",
            "    distance(home) <= 10 m: worst 8.00 m, at most 10.00 m, 95th percentile 7.60 m",
            "40 of 40 flights passed; 400.0 s flown in 0.50 s (800x real time); 2 slow scenarios left out (--slow)",
        ]
    );
}

#[test]
fn a_seed_that_fails_is_counted_and_its_worst_moment_can_be_opened() {
    let summary = summary([1.0, 11.0, 2.0].into_iter());
    let lines = summary_lines(&summary);
    assert_eq!(lines[0], "a <b> & \"c\" | *d* · one, noise real: 2 of 3");
    assert!(!summary.passed());
    assert_eq!(
        flight_lines(&summary.flights[1])[2],
        r"      betadeck open 'it'\''s here.toml' --case 'one, noise real' --seed 2 --at 2.00"
    );
}

#[test]
fn names_of_any_kind_survive_xml_and_markdown() {
    let summary = summary([1.0, 11.0].into_iter());
    let xml = junit(&summary);
    assert!(
        xml.contains("<testsuite name=\"a &lt;b&gt; &amp; &quot;c&quot; | *d*\" tests=\"2\" failures=\"1\""),
        "{xml}"
    );
    assert!(xml.contains("name=\"one, noise real seed 2\""), "{xml}");
    let table = markdown(&summary);
    assert!(table.contains("| ❌ a &lt;b> & \"c\" \\| \\*d\\* · one, noise real | 1 of 2 |"), "{table}");
}
