//! Tests of whole scenarios: text in, judgements out.

mod allowance;
mod bounds;
mod campaign;
mod remote;

use betadeck_core::plan::format::{PlanError, PlanFile, report};
use betadeck_core::scenario::{
    CaseFlight, Files, Insight, Judgement, Outcome, Scenario, compare, judge, read,
};

/// A reader that finds no files.
struct NoFiles;

impl Files for NoFiles {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        Err(format!("cannot open {name}"))
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        Err(format!("cannot open {name}"))
    }
}

/// A craft on the ground for three seconds; expectations follow.
const STANDING: &str = "format = 1
ends = \"3 s after boot\"
[plan]
builtin = \"square\"
[craft]
pilot = \"none\"
[air]
noise = \"none\"
";

fn scenario(text: &str) -> Scenario {
    read("test.toml", text, None, &mut NoFiles).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

/// Returns the judgements of the first case; the one about the result comes first.
fn judged(text: &str) -> Vec<Judgement> {
    let scenario = scenario(text);
    let case = &scenario.cases[0];
    judge(case, &CaseFlight::new(case, &case.airs[0]).unwrap().fly()).0
}

/// Returns the outcome of this expectation for the craft on the ground.
fn outcome(expectation: &str) -> Outcome {
    judged(&format!("{STANDING}[[expect]]\n{expectation}\n")).pop().unwrap().outcome
}

/// Returns the problems of a text, each with its place.
fn problems(text: &str) -> Vec<String> {
    read("test.toml", text, None, &mut NoFiles).unwrap_err().iter().map(PlanError::headline).collect()
}

fn hints(text: &str) -> String {
    read("test.toml", text, None, &mut NoFiles)
        .unwrap_err()
        .iter()
        .map(|error| format!("{} | {}\n", error.message, error.hint))
        .collect()
}

#[test]
fn a_craft_at_rest_is_seen_to_be_at_rest() {
    for (expectation, met) in [
        ("always = 'altitude in -0.1..0.1 m and not armed'\nfrom = 'boot'", true),
        ("always = 'armed'\nfrom = 'boot'", false),
        ("never = 'speed > 0.1 m/s'\nfrom = 'boot'", true),
        ("never = 'on_ground'\nfrom = 'boot'", false),
        ("eventually = 'boot_time > 2 s'\nfrom = 'boot'", true),
        ("eventually = 'boot_time > 4 s'\nfrom = 'boot'", false),
        ("mostly = 'boot_time > 1 s'\nshare = 60\nfrom = 'boot'", true),
        ("mostly = 'boot_time > 2 s'\nshare = 60\nfrom = 'boot'", false),
        ("mean = 'boot_time = 1.5 +- 0.1 s'\nfrom = 'boot'", true),
        ("max = 'boot_time <= 2 s'\nfrom = 'boot'", false),
        ("that = 'boot_time = 2 +- 0.02 s'\nat = '2 s after boot'", true),
        ("no_event = 'armed'\nfrom = 'boot'", true),
        ("event = 'armed'\nfrom = 'boot'", false),
        ("result = 'stopped'", true),
        ("result = ['complete', 'landed']", false),
    ] {
        let outcome = outcome(expectation);
        assert_eq!(outcome.is_met(), met, "{expectation}: {outcome:?}");
        assert!(met || matches!(outcome, Outcome::Failed { .. }), "{expectation}: {outcome:?}");
    }
}

#[test]
fn what_was_never_judged_is_not_met() {
    for (expectation, part) in [
        ("that = 'altitude < 5 m'\nat = 'touchdown'", "its instant did not come"),
        (
            "that = 'lap < 5 s'\n[[measure]]\nname = 'lap'\ntime = 'ORBITING 0 -> ARRIVED 1'",
            "no lap was known at its instant",
        ),
        ("always = 'altitude < 5 m'\nfrom = 'ARRIVED 0'", "from which it holds did not come"),
        ("always = 'altitude < 5 m'\nuntil = 'ARRIVED 0'", "until which it holds did not come"),
        ("always = 'altitude < 5 m'\nfrom = '2 s after boot'\nuntil = '1 s after boot'", "before it begins"),
        ("always = 'cross_track < 5 m'\nfrom = 'boot'", "it was not known at any moment"),
        ("that = 'altitude < 5 m'\nat = '9 s after boot'", "after the end of the record"),
        ("that = 'altitude < 5 m'\nat = '9 s before input_refused'", "did not come"),
        ("that = 'altitude < 5 m'\nat = '9 s before when boot_time > 1 s'", "before boot"),
        ("always = 'altitude < 5 m'\nfrom = 'boot'\nuntil = '9 s after boot'", "the record at 3.00 s"),
        ("max = 'altitude < 5 m'\nfrom = 'boot'\nuntil = '9 s after boot'", "the record at 3.00 s"),
        ("no_event = 'crash'\nfrom = '5 s after boot'\nuntil = '9 s after boot'", "the record at 3.00 s"),
        ("event = 'armed'\ncount = 0\nfrom = 'boot'\nuntil = '9 s after boot'", "the record at 3.00 s"),
        ("states = 'COMPLETE'", "never engaged"),
        ("event = 'armed'\ncount = 0\nfrom = 'crash'", "did not come"),
    ] {
        let outcome = outcome(expectation);
        assert!(
            matches!(&outcome, Outcome::NeverJudged(why) if why.contains(part)),
            "{expectation}: {outcome:?}"
        );
    }
}

#[test]
fn a_failure_says_the_value_the_bound_and_the_worst_moment() {
    let Outcome::Failed { sentence, at, .. } = outcome("always = 'boot_time <= 2 s'\nfrom = 'boot'") else {
        panic!("not met")
    };
    assert!(
        sentence.starts_with("3.00 s, at most 2.00 s at 3.00 s after boot; outside for 33."),
        "{sentence}"
    );
    assert_eq!(at.map(betadeck_core::signals::SimTime::as_secs_f64), Some(3.0));
}

#[test]
fn inputs_act_at_their_instants_and_answers_can_be_expected() {
    let text = format!(
        "{STANDING}
[[input]]
name = 'ask'
at = '1 s after boot'
do = 'cli get ap_max_angle'
[[input]]
at = '0.5 s after input ask'
do = 'wind 5@270'
[[input]]
at = 'when boot_time > 1.2 s'
do = 'cli set ap_max_angel = 3'
[[input]]
at = '1 s after boot'
do = 'return home'
[[expect]]
event = \"reply 'ap_max_angle = '\"
within = '0.99..1.01 s after boot'
from = 'boot'
[[expect]]
always = 'wind <= 0.01 m/s'
from = 'boot'
until = '1.4 s after boot'
[[expect]]
event = \"input_refused 'ap_max_angel'\"
within = '1.2..1.23 s after boot'
from = 'boot'
[[expect]]
event = \"input_refused 'armed'\"
from = 'boot'
[[expect]]
that = 'wind > 1 m/s'
at = '2.9 s after boot'
"
    );
    for judgement in judged(&text) {
        assert!(judgement.outcome.is_met(), "{judgement:?}");
    }
}

#[test]
fn an_input_that_was_not_carried_out_fails_the_flight() {
    let last = |input: &str| judged(&format!("{STANDING}[[input]]\n{input}\n")).pop().unwrap();
    let judgement = last("at = '1 s after ARRIVED 1'\ndo = 'rc cut'");
    assert_eq!((judgement.label.as_str(), judgement.line), ("input rc cut", 11));
    assert!(matches!(judgement.outcome, Outcome::NeverJudged(_)), "{judgement:?}");
    let judgement = last("at = '1 s after boot'\ndo = 'cli set ap_max_angel = 3'");
    assert!(
        matches!(&judgement.outcome, Outcome::Failed { sentence, .. } if sentence.contains("ap_max_angel")),
        "{judgement:?}"
    );
    // A refusal that is expected is no failure.
    for expectation in
        ["event = 'input_refused'\nfrom = 'boot'", "event = \"input_refused 'ap_max'\"\nfrom = 'boot'"]
    {
        let text = format!(
            "{STANDING}[[input]]\nat = '1 s after boot'\ndo = 'cli set ap_max_angel = 3'\n[[expect]]\n{expectation}\n"
        );
        assert!(judged(&text).iter().all(|judgement| judgement.outcome.is_met()), "{expectation}");
    }
}

#[test]
fn an_event_outside_its_window_is_said_to_have_come_there() {
    let text = format!(
        "{STANDING}[[input]]\nname = 'gust'\nat = '1 s after boot'\ndo = 'wind 5@270'\n[[expect]]\nevent = 'input gust'\nfrom = '2.9 s after boot'\n"
    );
    let outcome = judged(&text).pop().unwrap().outcome;
    assert!(
        matches!(&outcome, Outcome::Failed { sentence, .. } if sentence.contains("did not happen from 2.90 s") && sentence.contains("but at")),
        "{outcome:?}"
    );
}

#[test]
fn nobody_can_wait_for_what_only_the_end_of_a_flight_shows() {
    for (instant, part) in [
        ("1 s before ARRIVED 0", "not known before it happens"),
        ("last ARRIVED 0", "the last one is not known"),
        ("last_sample", "the end of the record"),
        ("contact after 1 s before disarmed", "not known before it happens"),
    ] {
        let input = format!("{STANDING}[[input]]\nat = '{instant}'\ndo = 'hold here'");
        let ends = STANDING.replace("3 s after boot", instant);
        for (text, place) in [(input, "test.toml:10:6: "), (ends, "test.toml:2:8: ")] {
            let problems = problems(&text);
            assert!(problems.len() == 1 && problems[0].starts_with(place), "{instant}: {problems:?}");
            assert!(problems[0].contains(part), "{instant}: {problems:?}");
        }
    }
}

#[test]
fn numbers_and_names_that_cannot_be_meant_are_reported() {
    let long = "9".repeat(400);
    for (text, problem) in [
        ("[[expect]]\nalways = 'lean <= 80 deg'\nuntil = '99999999999999999999 s after boot'".to_owned(), "no flight is this long"),
        (format!("[[expect]]\nalways = 'altitude <= {long} m'"), "infinite"),
        ("[[expect]]\nalways = 'altitude <= 1 m / 0'".to_owned(), "infinite"),
        ("[parameters]\nbound = '1 m / 0'".to_owned(), "not known before the flight"),
        ("[[expect]]\nevent = 'armed'\ncount = -1".to_owned(), "-1 is not a count"),
        ("[[expect]]\nalways = 'armed'\ncases = []".to_owned(), "to no case"),
        ("[[measure]]\nname = 'a'\nmax = 'speed'\n[[measure]]\nname = 'a'\nmin = 'speed'".to_owned(), "measure or a parameter a exists already"),
        ("[parameters]\na = '1 m'\n[[measure]]\nname = 'a'\nmin = 'speed'".to_owned(), "measure or a parameter a exists already"),
        ("[[measure]]\nname = 'a'\nmax = 'speed'\nmin = 'speed'".to_owned(), "both max and min"),
        ("[[measure]]\nname = 'a'\nvalue = 'speed'\nfrom = 'boot'".to_owned(), "from has no meaning for value"),
        ("[[input]]\nname = 'a'\nat = 'boot'\ndo = 'rc cut'\n[[input]]\nname = 'a'\nat = 'boot'\ndo = 'rc restore'".to_owned(), "two inputs a"),
    ] {
        let problems = problems(&format!("{STANDING}{text}"));
        assert!(problems.len() == 1 && problems[0].contains(problem), "{text}: {problems:?}");
    }
    for (seeds, problem) in [
        ("[-1, 2]", "-1 is not a seed"),
        ("-3", "-3 is not a seed"),
        ("[2, 2]", "seed 2 is listed twice"),
        ("[]", "there is no seed"),
    ] {
        let problems = problems(&format!("seeds = {seeds}\n{STANDING}"));
        assert!(problems.len() == 1 && problems[0].contains(problem), "{seeds}: {problems:?}");
    }
}

#[test]
fn cases_vary_and_seeds_make_flights_and_measures_compare_them() {
    let text = format!(
        "{STANDING}
[vary]
wind = ['calm', '5@270', '{{seed % 3}}@90']
[[measure]]
name = 'air'
value = 'wind'
at = '2 s after boot'
[[case]]
name = 'slow'
seeds = '4..6'
[[case]]
name = 'fast'
seeds = [7]
[case.parameters]
bound = '2 m'
[[case.expect]]
always = 'altitude <= bound'
from = 'boot'
[[compare]]
that = 'fast.air - slow.air in -1..1 m/s'
"
    );
    let scenario = scenario(&text);
    let names: Vec<&str> = scenario.cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names[..2], ["slow, wind calm", "slow, wind 5@270"]);
    assert_eq!(names.len(), 6);
    // Without randomness one seed is enough, unless the wind follows the seed.
    let flights: Vec<usize> = scenario.cases.iter().map(|case| case.airs.len()).collect();
    assert_eq!(flights, [1, 1, 3, 1, 1, 1]);
    let winds: Vec<f64> = scenario.cases[2].airs.iter().map(|air| air.wind.speed_mps).collect();
    assert_eq!(winds, [1.0, 2.0, 0.0]);
    let names = [("fast.air".to_owned(), 3.0), ("slow.air".to_owned(), 2.5)];
    assert!(compare(&scenario.compares[0], &names, Insight::Inner).outcome.is_met());
    let names = [("fast.air".to_owned(), 3.0), ("slow.air".to_owned(), f64::NAN)];
    assert!(matches!(
        compare(&scenario.compares[0], &names, Insight::Inner).outcome,
        Outcome::NeverJudged(_)
    ));
}

#[test]
fn real_sensors_get_their_allowance_and_exact_ones_do_not() {
    let bounds = |noise: &str, exact: &str| {
        let text = format!(
            "format = 1\nends = '1 s after boot'\n[plan]\nbuiltin = 'land'\n[craft]\npilot = 'none'\n[air]\nnoise = '{noise}'\n\
             [allow]\nhorizontal_m = 1\nvertical_m = 0.5\nspeed_mps = 0.2\n[[expect]]\nfrom = 'boot'\n{exact}\n\
             always = 'altitude in 0..0.1 m and distance(home) <= 1 m and speed <= 1 m/s'\n"
        );
        format!("{:?}", scenario(&text).cases[0].expectations[1].expected).matches("Join").count()
    };
    assert_eq!(bounds("real", ""), 4);
    assert_eq!(bounds("real", "exact = true"), 0);
    assert_eq!(bounds("none", ""), 0);
}

#[test]
fn every_problem_of_a_file_is_reported_with_its_place() {
    let text = "format = 2
nmae = 'x'
[plan]
waypoints = ['40.4640403 -79.5182000 2000 500 FLYOVR 0 ORBIT']
[craft]
settings = ['ap_max_angel = 3']
[air]
wind = '5'
[[input]]
at = '5 s after ARRIVED 9'
do = 'stick pich 2000'
[[expect]]
always = 'altitude <= 5 s'
within = '1..2 s after engaged'
[[expect]]
[[expect]]
event = 'ARRIVED 0'
within = '5..2 s after engaged'
";
    assert_eq!(
        problems(text),
        [
            "test.toml:1:10: format 2 is not known",
            "test.toml:2:1: nmae is not a key of the scenario",
            "test.toml:4:14: FLYOVR is not a waypoint type",
            "test.toml:6:13: ap_max_angel is not a setting",
            "test.toml:8:8: the direction it blows from is missing; write SPEED@FROM, for example 5@270: 5 m/s blowing from the west, or calm",
            "test.toml:10:25: the plan has no waypoint 9",
            "test.toml:11:7: pich is not a channel; did you mean pitch? (roll, pitch, throttle, yaw, aux1 to aux12, or 1 to 16)",
            "test.toml:13:23: seconds do not fit: metres are compared",
            "test.toml:14:1: within has no meaning for always",
            "test.toml:15:1: the expectation is empty",
            "test.toml:18:11: this time ends before it begins",
        ]
    );
    let hints = hints(text);
    for part in
        ["did you mean name?", "did you mean FLYOVER?", "did you mean ap_max_angle?", "allowed: m, cm, km"]
    {
        assert!(hints.contains(part), "{part}\n{hints}");
    }
}

#[test]
fn a_missing_plan_and_an_unknown_case_are_reported() {
    let reported = |text: &str| problems(text).join("\n");
    assert!(reported("format = 1\n[plan]\nfile = 'no.toml'").contains("test.toml:3:8: cannot open no.toml"));
    assert!(
        reported("format = 1\n[plan]\nbuiltin = 'sqare'")
            .contains("no built-in plan sqare; did you mean square?")
    );
    assert!(reported("format = 1").contains("the scenario has no plan"));
    assert!(reported("[plan]\nbuiltin = 'square'").contains("format is missing"));
    let text = "format = 1\n[plan]\nbuiltin = 'square'\n[[case]]\nname = 'calm'\n[[expect]]\ncases = ['clam']\nresult = 'complet'";
    let reported = reported(text);
    assert!(reported.contains("test.toml:7:10: there is no case clam; did you mean calm?"), "{reported}");
    assert!(!reported.contains("complet is not"), "an expectation without its case is not read: {reported}");
    assert!(problems("format = 1\nx = [").len() == 1);
}

#[test]
fn more_samples_than_memory_should_hold_are_refused() {
    let reported =
        problems("format = 1\ntime_limit_s = 1000000\nsample_hz = 1000\n[plan]\nbuiltin = 'square'");
    assert_eq!(
        reported,
        ["test.toml:2:16: 1000000 s with 1000 samples a second are too many samples to keep"]
    );
}

#[test]
fn one_mistake_is_reported_once_however_many_cases_read_it() {
    let text = "format = 1\n[plan]\nbuiltin = 'square'\n[vary]\nwind = ['calm', '5@270', '8@270']\n[[expect]]\nalways = 'sped <= 5 m/s'";
    assert_eq!(problems(text), ["test.toml:7:11: sped is not a signal or a measure"]);
}

proptest::proptest! {
    #[test]
    fn no_text_makes_the_reader_of_files_panic(text in "\\PC{0,80}") {
        let _ = read("test.toml", &text, None, &mut NoFiles);
        let _ = read("test.toml", &format!("{STANDING}[[expect]]\nalways = {text}"), None, &mut NoFiles);
    }
}
