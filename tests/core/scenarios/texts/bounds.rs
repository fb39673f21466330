//! Scenarios that are too large: refused with a sentence before they use too much time or memory.

use super::{NoFiles, STANDING, hints, problems};
use betadeck_core::plan::Waypoint;
use betadeck_core::plan::format::{PlanError, PlanFile};
use betadeck_core::scenario::{Files, Flights, Request, read, read_request};

/// Returns a comparison with a sum of this many altitudes.
fn sum(terms: usize) -> String {
    format!("{} <= 9 m", vec!["altitude"; terms].join(" + "))
}

fn cases(count: usize) -> String {
    (0..count).map(|number| format!("[[case]]\nname = 'c{number}'\n")).collect()
}

fn expectations(count: usize) -> String {
    (0..count).map(|number| format!("[[expect]]\nmax = 'altitude <= {number} m'\n")).collect()
}

#[track_caller]
fn assert_refused(text: &str, wanted: &str, hint: &str) {
    let problems = problems(text);
    assert!(
        problems.iter().any(|problem| problem == wanted),
        "{wanted}\n{:#?}",
        &problems[..problems.len().min(5)]
    );
    let hints = hints(text);
    assert!(hints.contains(hint), "{hint}\n{}", &hints[..hints.len().min(500)]);
}

#[test]
fn an_expression_of_12_000_terms_is_refused_at_the_first_term_too_many() {
    for terms in [1001, 8000, 12_000] {
        let text = format!("{STANDING}[[expect]]\nmax = \"{}\"\n", sum(terms));
        let column = "max = \"".len() + 1000 * "altitude + ".len() + 1;
        assert_refused(
            &text,
            &format!("test.toml:10:{column}: this expression has too many terms"),
            "allowed: 1000 terms; use measures for parts of it",
        );
    }
    // The bound is a term, too.
    let text = format!("{STANDING}[[expect]]\nmax = \"{}\"\n", sum(999));
    assert!(read("test.toml", &text, None, &mut NoFiles).is_ok());
}

#[test]
fn terms_of_every_kind_are_counted() {
    for (key, term, join) in [
        ("always", "altitude < 9 m", " and "),
        ("always", "armed", " or "),
        ("always", "state HOLDING", " or "),
        ("always", "mode ARM", " or "),
        ("always", "flying rth", " or "),
        ("max", "2", " * "),
        ("max", "distance(home)", " + "),
        ("event", "ARM", " "),
        ("states", "...", ", "),
        ("states", "ARRIVED 0", ", "),
    ] {
        let mut text = vec![term; 2000].join(join);
        if key == "max" {
            text.push_str(" <= 9 m");
        }
        let words_of = if key == "event" { "mode " } else { "" };
        let text = format!("{STANDING}[[expect]]\n{key} = '{words_of}{text}'\n");
        let reported = problems(&text).join("\n");
        assert!(
            reported.contains("this expression has too many terms"),
            "{key} {term}: {}",
            &reported[..reported.len().min(300)]
        );
    }
}

#[test]
fn a_rate_of_a_rate_counts_twice_for_it_is_worked_out_twice() {
    let nested = |depth: usize| {
        let (open, close) = ("rate(".repeat(depth), ")".repeat(depth));
        let left = format!("{open}altitude{close} / {open}altitude{close}");
        problems(&format!("{STANDING}[[expect]]\nmax = '{left} <= x'\n")).join("\n")
    };
    assert!(nested(5).contains("x is not a signal or a measure"), "{}", nested(5));
    assert!(nested(15).contains("this expression has too many terms"), "{}", nested(15));
}

#[test]
fn parentheses_that_are_read_as_a_condition_first_do_not_double_the_work_at_each_level() {
    // Each parenthesis could hold a condition until its end is read.
    let mut inner = vec!["altitude"; 900].join(" + ");
    for _ in 0..7 {
        inner = format!("(since(when {inner} <= 9 m)) / 1 s * 1 m");
    }
    let reported = problems(&format!("{STANDING}[[expect]]\nmax = '({inner}) <= 9 m'\n")).join("\n");
    assert!(reported.contains("this is nested too deeply"), "{reported}");
}

#[test]
fn six_hundred_cases_with_six_hundred_expectations_are_refused() {
    let text = format!("{STANDING}{}{}", expectations(600), cases(600));
    assert_refused(
        &text,
        "test.toml:9:1: the 600 cases have 360000 expectations together",
        "allowed: 50000; assign each to its cases with cases = [\"NAME\"], or make several scenarios of it",
    );
    let values: Vec<String> = (0..30).map(|wind| format!("'{wind}@0'")).collect();
    let vary = format!("[vary]\nwind = [{}]\ntakeoff_m = [{}]\n", values.join(","), vec!["5"; 30].join(","));
    assert_refused(
        &format!("{STANDING}{vary}{}", expectations(60)),
        "test.toml:12:1: the 900 cases have 54000 expectations together",
        "allowed: 50000",
    );
}

#[test]
fn expectations_that_name_their_case_count_for_it_only() {
    let mut text = format!("{STANDING}{}", cases(300));
    for number in 0..300 {
        text.push_str(&format!("[[expect]]\ncases = ['c{number}']\nmax = 'altitude <= 9 m'\n"));
    }
    let scenario = read("test.toml", &text, None, &mut NoFiles).expect("300 cases with one each");
    assert!(
        scenario.cases.iter().all(|case| case.expectations.len() == 2),
        "its own, and that of the result"
    );
    let last = scenario.cases[299].expectations[1].line;
    assert_eq!(last, text.lines().count());
}

#[test]
fn seeds_cases_and_lists_without_end_are_refused() {
    let noisy = STANDING.replace("noise = \"none\"", "noise = \"real\"");
    for seeds in [format!("[{}]", vec!["1"; 150_000].join(",")), "'1..150000'".to_owned()] {
        assert_refused(
            &format!("seeds = {seeds}\n{noisy}"),
            "test.toml:1:9: there are 150000 seeds",
            "allowed: 10000; take fewer, or add --max-flights 150000",
        );
    }
    assert_refused(
        &format!("{STANDING}{}", cases(1001)),
        "test.toml:9:1: the scenario has 1001 cases",
        "allowed: 1000",
    );
    assert_refused(
        &format!("{STANDING}{}", expectations(1001)),
        "test.toml:9:1: there are 1001 expectations in one list",
        "allowed: 1000",
    );
    let parameters: String = (0..1001).map(|number| format!("p{number} = '1 m'\n")).collect();
    assert_refused(
        &format!("{STANDING}[parameters]\n{parameters}"),
        "test.toml:9:1: there are 1001 parameters in one list",
        "allowed: 1000",
    );
    let compares = "[[compare]]\nthat = '1 = 1'\n".repeat(1001);
    assert_refused(
        &format!("{STANDING}{compares}"),
        "test.toml:9:1: there are 1001 comparisons in one list",
        "allowed: 1000",
    );
}

#[test]
fn more_than_ten_thousand_flights_are_read_only_when_they_were_asked_for() {
    let noisy = STANDING.replace("noise = \"none\"", "noise = \"real\"");
    let text = format!("seeds = '1..6000'\n{noisy}[[case]]\nname = 'a'\n[[case]]\nname = 'b'\n");
    assert_refused(
        &text,
        "test.toml:1:9: the scenario has 12000 flights",
        "allowed: 10000; take fewer seeds or cases, or add --max-flights 12000",
    );
    let request = Request {
        file: "test.toml",
        text: &text,
        seeds: None,
        max_flights: 12_000,
        flights: Flights::Listed,
    };
    let scenario = read_request(&request, &mut NoFiles).expect("as many as asked for");
    assert_eq!(scenario.cases.iter().map(|case| case.airs.len()).sum::<usize>(), 12_000);
}

#[test]
fn a_hundred_cases_of_a_hundred_thousand_flights_are_not_made_before_they_are_refused() {
    let noisy = STANDING.replace("noise = \"none\"", "noise = \"real\"");
    let text = format!("seeds = '1..10000'\n{noisy}{}", cases(100));
    assert_refused(&text, "test.toml:1:9: the scenario has 1000000 flights", "add --max-flights 1000000");
}

#[test]
fn terms_of_all_cases_together_are_bounded() {
    let long = format!("[[expect]]\nmax = \"{}\"\n", sum(999));
    let text = format!("{STANDING}{}{}", long.repeat(40), cases(100));
    let reported = problems(&text);
    let sentence = "the expressions of all cases together have more than 1000000 terms";
    assert!(reported.len() == 1 && reported[0].ends_with(&format!(":7: {sentence}")), "{reported:?}");
    assert!(hints(&text).contains("shorten them, or make several scenarios of it"));
}

#[test]
fn a_wind_is_a_short_text() {
    let text = format!(
        "seeds = '1..10000'\n{}",
        STANDING.replace("[air]\n", &format!("[air]\nwind = '{}'\n", "{seed}".repeat(50_000)))
    );
    assert_refused(&text, "test.toml:9:8: this wind has 300000 characters", "allowed: 200");
}

#[test]
fn a_name_is_a_short_text() {
    for part in ["[[case]]\n", "[[input]]\nat = 'armed'\ndo = 'rc cut'\n", "[[measure]]\nmax = 'altitude'\n"]
    {
        let text = format!("{STANDING}{part}name = '{}'\n", "x".repeat(101));
        let reported = problems(&text).join("\n");
        assert!(reported.contains("this name has 101 characters"), "{part}: {reported}");
    }
}

/// Files of settings and plans that count how often they are read.
struct CountedFiles {
    text: String,
    reads: usize,
}

impl Files for CountedFiles {
    fn plan(&mut self, _: &str) -> Result<PlanFile, String> {
        self.reads += 1;
        let mut file = PlanFile::default();
        file.plan.waypoints.push(Waypoint::default());
        Ok(file)
    }

    fn text(&mut self, _: &str) -> Result<String, String> {
        self.reads += 1;
        Ok(self.text.clone())
    }
}

#[test]
fn a_file_that_many_cases_name_is_read_once_and_kept_as_often_as_memory_allows() {
    let with_file = STANDING
        .replace("[craft]\n", "[craft]\nsettings_file = 'mine.txt'\n")
        .replace("builtin = \"square\"", "file = 'plan.toml'");
    let mut files = CountedFiles { text: "# nothing\n".repeat(100), reads: 0 };
    let text = format!("{with_file}{}", cases(100));
    assert!(read("test.toml", &text, None, &mut files).is_ok());
    assert_eq!(files.reads, 2, "the plan and the settings");
    let mut files = CountedFiles { text: format!("# {}\n", "x".repeat(1000)).repeat(1000), reads: 0 };
    let errors = read("test.toml", &text, None, &mut files).expect_err("100 MB of settings");
    let reported: Vec<String> = errors.iter().map(PlanError::headline).collect();
    assert_eq!(
        reported,
        ["test.toml:6:17: the settings and lines of all cases together have more than 64 MiB"]
    );
}
