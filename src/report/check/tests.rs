//! The output forms of a checked run.

use super::*;
use crate::scenario::expression::Verdict;
use crate::scenario::{Margin, Outcome};
use crate::telemetry::quantity::Dimension;

/// Returns a flight of a case with many seeds and with this greatest distance.
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

fn failed_flight(file: &str, case: &str) -> CheckedFlight {
    CheckedFlight {
        scenario: "square".to_owned(),
        file: file.to_owned(),
        case: case.to_owned(),
        seed: 7,
        seeds: 1,
        judgements: vec![Judgement {
            label: "speed in 1..2 m/s".to_owned(),
            line: 3,
            outcome: Outcome::Failed {
                sentence: "`set ap_max|x` [was] refused\\".to_owned(),
                at: Some(SimTime(2_000_000)),
                guard: None,
            },
        }],
        ..CheckedFlight::default()
    }
}

fn summary_of(flights: Vec<CheckedFlight>) -> Summary {
    let wanted = flights.len();
    Summary::new(flights, Vec::new(), wanted, 0, 1.0)
}

#[test]
fn the_command_that_opens_a_flight_can_be_pasted_into_a_shell() {
    for (file, case, command) in [
        ("a/b-1.toml", "", "betadeck open a/b-1.toml --at boot+2.00"),
        ("a b.toml", "calm", "betadeck open 'a b.toml' --case calm --at boot+2.00"),
        ("a;b$(x).toml", "pilot's", r"betadeck open 'a;b$(x).toml' --case 'pilot'\''s' --at boot+2.00"),
        (STANDARD_INPUT, "wind 5@270", "betadeck open FILE --case 'wind 5@270' --at boot+2.00"),
    ] {
        assert_eq!(failed_flight(file, case).open_command(SimTime(2_000_000)).as_deref(), Some(command));
    }
}

#[test]
fn a_seed_that_was_asked_for_is_in_the_title_and_in_the_command_that_opens_the_flight() {
    let flight = CheckedFlight { seed_is_given: true, ..failed_flight("a.toml", "") };
    assert_eq!(flight.title(), "square · seed 7");
    let command = flight.open_command(SimTime::ZERO);
    assert_eq!(command.as_deref(), Some("betadeck open a.toml --seed 7 --at boot+0.00"));
    let remote = CheckedFlight { is_remote: true, ..flight };
    assert_eq!(remote.open_command(SimTime::ZERO), None);
    let started = CheckedFlight { firmware_options: Some(" --firmware my.elf".to_owned()), ..remote };
    let command = started.open_command(SimTime::ZERO);
    assert_eq!(command.as_deref(), Some("betadeck open a.toml --seed 7 --at boot+0.00 --firmware my.elf"));
}

#[test]
fn files_whose_scenarios_have_one_name_are_testsuites_of_their_own() {
    let files = ["a.toml", "b.toml", "a.toml"];
    let summary = summary_of(files.map(|file| failed_flight(file, "")).to_vec());
    let text = junit(&summary);
    assert_eq!(text.matches("<testcase ").count(), 3, "{text}");
    assert_eq!(text.matches("<testsuite ").count(), 2, "{text}");
    assert!(text.contains("<testsuite name=\"square\" tests=\"2\" failures=\"2\""), "{text}");
    assert_eq!(summary.cases().len(), 3);
}

#[test]
fn what_was_said_is_no_markup_in_the_markdown_summary() {
    let text = markdown(&summary_of(vec![failed_flight("a`b.toml", "x|y")]));
    assert!(text.contains("| ❌ square · x\\|y |"), "{text}");
    assert!(text.contains(r"\`set ap\_max|x\` \[was\] refused\\"), "{text}");
    assert!(text.contains("`` betadeck open 'a`b.toml' --case 'x|y' --at boot+2.00 ``"), "{text}");
}

#[test]
fn skipped_expectations_are_counted_in_every_form() {
    let skipped = |label: &str| Judgement {
        label: label.to_owned(),
        line: 9,
        outcome: Outcome::Skipped(Insight::Inner),
    };
    let mut half = flight(1, 5.0);
    half.judgements.push(skipped("throttle < 1900 µs"));
    let whole = CheckedFlight {
        judgements: vec![skipped("a"), skipped("b")],
        result: String::new(),
        ..flight(2, 5.0)
    };
    assert!(half.passed() && !half.is_skipped() && whole.passed() && whole.is_skipped());
    assert!(
        flight_lines(&half)[0]
            .ends_with("; 1 of 2 expectations not judged, only the embedded firmware shows it")
    );
    assert_eq!(
        flight_lines(&whole)[0],
        "– a <b> & \"c\" | *d* · one, noise real · seed 2: not flown; 2 of 2 expectations not judged, only the embedded \
         firmware shows it"
    );
    let line: serde_json::Value = serde_json::from_str(&flight_line(&half)).unwrap();
    assert_eq!((&line["skipped"], &line["expectations"][1]["outcome"]), (&1.into(), &"skipped".into()));
    let summary = Summary::new(vec![half, whole], Vec::new(), 2, 0, 1.0);
    assert!(summary.passed());
    let last = summary_lines(&summary).pop().unwrap();
    assert!(
        last.starts_with("1 of 2 flights passed, 1 not judged at all, 3 expectations not judged; "),
        "{last}"
    );
    let xml = junit(&summary);
    assert!(xml.contains("tests=\"2\" failures=\"0\" skipped=\"1\""), "{xml}");
    assert!(
        xml.contains("<skipped message=\"a: not judged, only the embedded firmware shows it\"/>"),
        "{xml}"
    );
    assert!(xml.contains("<system-out>throttle &lt; 1900 µs: not judged, only"), "{xml}");
    let text = markdown(&summary);
    assert!(text.contains("| scenario | passed | not judged | tightest expectation | left |"), "{text}");
    assert!(text.contains("| 3 of 4 |"), "{text}");
    assert!(!markdown(&self::summary([1.0].into_iter())).contains("not judged"));
}

#[test]
fn scenarios_of_the_same_name_in_two_folders_have_class_names_of_their_own() {
    let of = |file: &str| CheckedFlight { file: file.to_owned(), ..failed_flight(file, "") };
    let classes = |files: &[&str]| -> Vec<String> {
        let xml = junit(&summary_of(files.iter().map(|file| of(file)).collect()));
        let names = xml.split("classname=\"").skip(1);
        names.filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())).collect()
    };
    assert_eq!(classes(&["calm/square.toml"]), ["square"], "one is named as before");
    assert_eq!(
        classes(&["calm/square.toml", "wind/square.toml"]),
        ["square (calm/square.toml)", "square (wind/square.toml)"]
    );
}

/// Returns a flight without a judgement.
fn unjudged(seed: u64) -> CheckedFlight {
    let outcome = Outcome::Skipped(Insight::Inner);
    let judgements = vec![Judgement { label: "throttle < 1900 µs".to_owned(), line: 9, outcome }];
    CheckedFlight { judgements, result: String::new(), ..flight(seed, 5.0) }
}

#[test]
fn a_flight_of_which_nothing_was_judged_has_not_passed_in_its_case() {
    let summary = summary_of(vec![flight(1, 5.0), unjudged(2), flight(3, 5.0)]);
    let [case] = &summary.cases()[..] else { panic!("{summary:?}") };
    assert_eq!((case.passed, case.skipped, case.flights), (2, 1, 3));
    assert!(!case.has_failures());
    let line = summary_line(&summary).pop().unwrap();
    let line: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert_eq!((&line["cases"][0]["passed"], &line["cases"][0]["skipped"]), (&2.into(), &1.into()));
    let text = markdown(&summary);
    assert!(text.contains("| ✅ ") && text.contains("| 2 of 3 | 1 of 3 |"), "{text}");
    assert_eq!(summary_lines(&summary).len(), 1, "no case failed: {:?}", summary_lines(&summary));
}

#[test]
fn a_run_of_which_nothing_was_judged_does_not_say_that_it_passed() {
    let summary = summary_of(vec![unjudged(1), unjudged(2)]);
    let text = markdown(&summary);
    assert!(text.starts_with("### – Nothing was judged\n"), "{text}");
    assert!(text.contains("| – a &lt;b>") && text.contains("| 0 of 2 |") && !text.contains('✅'), "{text}");
    let last = summary_lines(&summary).pop().unwrap();
    assert!(last.starts_with("nothing was judged: 0 of 2 flights passed, 2 not judged at all, "), "{last}");
    let failed = summary_of(vec![unjudged(1), flight(2, 11.0)]);
    assert!(markdown(&failed).starts_with("### ❌ Some flights failed"));
    assert_eq!(summary_lines(&failed)[0], "a <b> & \"c\" | *d* · one, noise real: 0 of 2");
}
