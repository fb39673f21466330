//! Campaigns as a whole: from a scenario's text to flights, and from records to an answer.

use super::*;
use crate::plan::format::{PlanFile, report};
use crate::scenario::{Files, Flights, Request, read_request};

struct NoFiles;

impl Files for NoFiles {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        Err(format!("cannot open {name}"))
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        Err(format!("cannot open {name}"))
    }
}

const PLAN: &str = "format = 1\n[plan]\nbuiltin = \"land\"\n";

fn campaign(more: &str) -> Campaign {
    let text = if more.starts_with("seeds") {
        more.replacen('\n', &format!("\n{PLAN}"), 1)
    } else {
        format!("{PLAN}{more}")
    };
    let flights = Flights::OfCampaign { is_drawn: false };
    let request = Request { file: "test.toml", text: &text, seeds: None, max_flights: 10_000, flights };
    let scenario =
        read_request(&request, &mut NoFiles).unwrap_or_else(|errors| panic!("{}", report(&errors)));
    Campaign::new(scenario, None, None).unwrap()
}

/// Returns an input of a flight as text.
fn input(campaign: &Campaign, number: u64, name: &str) -> String {
    let flight = campaign.flight(number).unwrap();
    let found = flight.inputs.iter().find(|(known, _)| known == name);
    found.map_or_else(String::new, |(_, value)| value.to_string())
}

#[test]
fn adding_an_input_does_not_change_the_others() {
    for design in ["monte-carlo", "latin-hypercube", "sobol"] {
        let with = |more: &str| {
            campaign(&format!(
                "[vary]\nwind = 'weibull(6, 2)@0..360'\nmass_pct = '+- 3'\n{more}[campaign]\ndesign = '{design}'\nflights = 50\n"
            ))
        };
        let few = with("");
        let many = with(
            "airframe = ['iris', 'five-inch']\nthrust_pct = '+- 3'\n[vary.settings]\nap_max_angle = '20..40'\n[vary.faults]\n'gps-loss,6' = '1..9'\n",
        );
        for number in 1..=50 {
            for name in ["wind_mps", "wind_from_deg", "mass_pct"] {
                assert_eq!(input(&few, number, name), input(&many, number, name), "{design} {number} {name}");
            }
        }
    }
}

#[test]
fn a_flight_has_the_values_of_its_inputs() {
    let campaign = campaign(
        "[vary]\nwind = '6+-2@250+-20'\nmass_pct = '5'\nturbulence = ['light']\ntakeoff_m = '3..8'\n[vary.settings]\nap_max_angle = '20..40'\n[vary.world]\ngps = ['urban']\n[vary.faults]\n'gps-loss,6' = '1..9'\n",
    );
    assert_eq!(campaign.count(), 1000);
    let flight = campaign.flight(17).unwrap();
    assert_eq!(flight.air.seed, 17, "each flight has its own seed");
    let number = |name: &str| -> f64 { input(&campaign, 17, name).parse().unwrap() };
    let world = &flight.case.setup.world;
    assert!((flight.air.wind.speed_mps - number("wind_mps")).abs() < 1e-12);
    assert!((world.airframe.mass_kg - 0.53 * 1.05).abs() < 1e-12);
    assert_eq!(input(&campaign, 17, "turbulence"), "light");
    assert!((flight.case.options.takeoff_m - number("takeoff_m")).abs() < 1e-12);
    let settings = flight.case.setup.configuration().unwrap().0.settings;
    assert!((settings.number("ap_max_angle") as f64 - number("ap_max_angle")).abs() < 1e-12);
    assert_eq!(world.switches.gps.to_string(), "urban");
    assert_eq!(world.faults[0].to_string(), format!("gps-loss@{},6", number("gps-loss,6_at_s")));
    assert_eq!(campaign.flight(0).map(|flight| flight.number), None);
    assert_eq!(campaign.flight(1001).map(|flight| flight.number), None);
}

#[test]
fn a_grid_flies_every_combination_once() {
    let campaign = campaign(
        "seeds = '1..2'\n[[case]]\nname = 'a'\n[[case]]\nname = 'b'\n[vary]\nwind = ['calm', '5@270', '5@90']\ngust_mps = '0..4'\n[campaign]\ndesign = 'grid'\nlevels = 2\n",
    );
    assert_eq!(campaign.count(), 2 * 3 * 2 * 2);
    let mut seen: Vec<String> = (1..=campaign.count())
        .map(|number| {
            let flight = campaign.flight(number).unwrap();
            let inputs: Vec<String> =
                flight.inputs.iter().map(|(name, value)| format!("{name}={value}")).collect();
            format!("{} {}", flight.air.seed, inputs.join(" "))
        })
        .collect();
    assert_eq!(seen[0], "1 case=a gust_mps=1 wind_mps=0 wind_from_deg=0");
    assert_eq!(seen[1], "2 case=a gust_mps=1 wind_mps=0 wind_from_deg=0", "the seeds change first");
    assert_eq!(seen[23], "2 case=b gust_mps=3 wind_mps=5 wind_from_deg=90");
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), 24);
}

#[test]
fn the_flights_of_a_file_of_check_are_those_that_check_flies() {
    let campaign = campaign(
        "seeds = '4..6'\n[vary]\nwind = ['calm', '5@270']\nsettings = ['ap_max_angle = 20', 'ap_max_angle = 30']\n",
    );
    assert_eq!((campaign.count(), campaign.design()), (12, None));
    let flight = campaign.flight(12).unwrap();
    assert_eq!((flight.air.seed, flight.case.name.as_str()), (6, "ap_max_angle = 30, wind 5@270"));
    let inputs: Vec<String> = flight.inputs.iter().map(|(name, value)| format!("{name}={value}")).collect();
    assert_eq!(inputs, ["ap_max_angle=30", "wind_mps=5", "wind_from_deg=270"]);
}

#[test]
fn a_grid_of_another_size_than_asked_for_is_refused() {
    let text = format!("{PLAN}[vary]\nwind = ['calm', '5@270']\n[campaign]\nflights = 5\n");
    let flights = Flights::OfCampaign { is_drawn: true };
    let request = Request { file: "test.toml", text: &text, seeds: None, max_flights: 10, flights };
    let scenario = read_request(&request, &mut NoFiles).unwrap();
    let problem = Campaign::new(scenario, None, None).unwrap_err();
    assert_eq!(problem, "the grid has 2 flights, not 5: leave the number out, or choose another design");
}

/// Returns the sentence that refuses the flights of a campaign, if they are equal.
fn equal_flights(text: &str, count: u64) -> Option<String> {
    let text = format!("{text}\n{PLAN}");
    let flights = Flights::OfCampaign { is_drawn: true };
    let request = Request { file: "test.toml", text: &text, seeds: None, max_flights: 10, flights };
    let scenario =
        read_request(&request, &mut NoFiles).unwrap_or_else(|errors| panic!("{}", report(&errors)));
    Campaign::new(scenario, Some(count), None).unwrap().refuse_equal_flights().err()
}

#[test]
fn twenty_flights_in_which_nothing_varies_are_refused_with_the_option_that_helps() {
    let one = "nothing varies: the 20 flights would be one and the same flight: ";
    let seeds = format!("{one}fly other seeds, --seeds 1..20, or vary an input");
    assert_eq!(equal_flights("seeds = 1", 20), Some(seeds.clone()));
    assert_eq!(equal_flights("vary = { wind = '5@270' }\nseeds = 1", 20), Some(seeds));
    let few = equal_flights("seeds = '1..4'", 20).unwrap();
    assert!(
        few.starts_with("only 4 of the 20 flights would differ: ") && few.contains("--seeds 1..20"),
        "{few}"
    );
    let calm = equal_flights("air = { noise = 'none' }\nseeds = '1..'", 20).unwrap();
    assert!(calm.starts_with(&format!("{one}a seed changes nothing without noise")), "{calm}");
    for (text, count) in [
        ("seeds = 1", 1),
        ("seeds = '1..'", 20),
        ("seeds = '3..22'", 20),
        ("", 20),
        ("vary = { mass_pct = '+- 3' }\nseeds = 1", 20),
        ("vary = { wind = '5@0..360' }\nair = { noise = 'none' }\nseeds = 1", 20),
        ("air = { noise = 'none', wind = '{seed % 9}@270' }", 20),
    ] {
        assert_eq!(equal_flights(text, count), None, "{text}");
    }
}

/// Returns the record of a flight with these inputs.
fn record(number: u64, side: Side, fails: bool, inputs: &[(&str, f64)]) -> Record {
    let campaign = campaign("");
    let mut record = Record::not_flown(&campaign.flight(1).unwrap(), side, String::new());
    record.number = number;
    record.problem = None;
    record.standing = if fails { Standing::Failed } else { Standing::Passed };
    record.result = if fails { "missed" } else { "complete" }.to_owned();
    record.inputs =
        inputs.iter().map(|(name, value)| ((*name).to_owned(), InputValue::Number(*value))).collect();
    record
}

fn builder(goals: &str, wanted: u64, has_two_sides: bool) -> AnswerBuilder {
    let campaign = campaign(&format!("[campaign]\nexpect = [{goals}]\n"));
    AnswerBuilder::new(campaign.scenario(), wanted, has_two_sides)
}

#[test]
fn a_planted_cause_is_the_first_that_is_named() {
    let points = crate::design::Points { design: crate::design::Design::MonteCarlo, seed: 3, count: 400 };
    let unit = |name: &str, number| points.unit(name, None, number);
    let mut builder = builder("", 400, false);
    for number in 1..=400 {
        let wind = 12.0 * unit("wind", number);
        // Above 9 m/s half of the flights fail, below one in fifty.
        let fails = unit("fate", number) < if wind > 9.0 { 0.5 } else { 0.02 };
        let inputs =
            [("mass_pct", unit("mass", number)), ("wind_mps", wind), ("gust_mps", unit("gust", number))];
        builder.add(&record(number, Side::A, fails, &inputs));
    }
    let causes = builder.answer().causes;
    let first = &causes.of_failures[0];
    assert_eq!(first.input, "wind_mps");
    assert!(first.is_real && first.rho.unwrap() > 0.3, "{first:?}");
    let Rule::Above(threshold) = first.split.rule else { panic!("{first:?}") };
    assert!((8.0..10.0).contains(&threshold), "{threshold}");
    assert!(causes.of_failures[1..].iter().all(|cause| !cause.is_real), "{causes:?}");
}

#[test]
fn goals_are_judged_on_all_flights() {
    let mut builder =
        builder("'success >= 90 %', 'success >= 90 % with 95 % confidence', 'max(time) <= 9 s'", 20, false);
    for number in 1..=20 {
        builder.add(&record(number, Side::A, number == 7, &[]));
    }
    let answer = builder.answer();
    let outcomes: Vec<GoalOutcome> = answer.goals.iter().map(|goal| goal.outcome).collect();
    assert_eq!(outcomes, [GoalOutcome::Met, GoalOutcome::Failed, GoalOutcome::Unknown]);
    assert!(!answer.is_met() && answer.is_whole());
    let worst: Vec<u64> = answer.worst.iter().map(|worst| worst.number).collect();
    assert_eq!(worst, [7], "flights that passed without a margin are neither tight nor wide");
    assert_eq!(answer.results, [("complete".to_owned(), 19), ("missed".to_owned(), 1)]);
}

#[test]
fn two_sides_are_compared_flight_by_flight() {
    let mut builder = builder("", 60, true);
    for number in 1..=60 {
        for side in [Side::A, Side::B] {
            let fails = side == Side::A && number % 4 == 0;
            let mut record = record(number, side, fails, &[]);
            let better = if side == Side::B { 0.5 } else { 0.0 };
            record.metrics = vec![("cross_track".to_owned(), number as f64 / 10.0 - better)];
            builder.add(&record);
        }
    }
    let answer = builder.answer();
    let versus = answer.versus.unwrap();
    assert_eq!((versus.pairs, versus.only_a, versus.only_b), (60, 0, 15));
    assert!(versus.success.is_real());
    let cross_track = &versus.metrics[0];
    assert!((cross_track.difference + 0.5).abs() < 1e-9 && cross_track.significance.unwrap().is_real());
    assert_eq!((answer.flown, answer.success.passed), (60, 45), "the answer is that of side A");
}

#[test]
fn flights_that_could_not_be_flown_are_neither_successes_nor_failures() {
    let mut builder = builder("", 40, false);
    for number in 1..=40 {
        let mut record = record(number, Side::A, false, &[("inertia_pct", number as f64 - 20.0)]);
        if number % 10 < 3 {
            record.standing = Standing::NotFlown;
            record.result = String::new();
            record.problem = Some(format!("airframe iris: too strong: use at most {}.5 N·s/m", number + 20));
        }
        builder.add(&record);
    }
    let answer = builder.answer();
    let Success { passed, judged, not_flown, .. } = answer.success;
    assert_eq!((passed, judged, not_flown), (28, 28, 12));
    let first = "airframe iris: too strong: use at most 21.5 N·s/m".to_owned();
    assert_eq!(answer.not_flown, [(first, 12)], "one reason with other numbers in each flight");
    assert_eq!((answer.causes.flights, answer.causes.failures), (28, 0));
    assert!(answer.worst.is_empty() && answer.is_whole() && !answer.is_met());
    assert_eq!(answer.results[1], ("not flown".to_owned(), 12));
}

#[test]
fn a_flight_that_cannot_be_flown_is_known_before_the_start() {
    let campaign = campaign("[vary]\nmass_pct = '600..800'\n[campaign]\nflights = 5\n");
    let problem = campaign.flight(1).unwrap().impossible().unwrap();
    assert!(problem.starts_with("airframe iris: omega_max_rads gives"), "{problem}");
    let flies = super::tests::campaign("[vary]\ninertia_pct = '-20..20'\n[campaign]\nflights = 50\n");
    assert!((1..=50).all(|number| flies.flight(number).unwrap().impossible().is_none()));
}

#[test]
fn equal_complaints_are_counted_and_the_result_is_said_once() {
    let mut builder = builder("", 30, false);
    for number in 1..=30 {
        let mut record = record(number, Side::A, number > 5, &[]);
        record.result = "crashed".to_owned();
        record.reason = format!("the craft crashed: it hit the ground sinking at {number}.1 m/s");
        record.failures = vec![format!(
            "result complete: the flight should end complete, it ended crashed: {}",
            record.reason
        )];
        builder.add(&record);
    }
    let answer = builder.answer();
    let worst = &answer.worst[0];
    assert_eq!(worst.alike, 25);
    assert_eq!(
        worst.complaint,
        format!("the craft crashed: it hit the ground sinking at {}.1 m/s", worst.number)
    );
    assert!(answer.worst.iter().all(|other| other.is_like(worst)));
}

#[test]
fn crashes_that_differ_in_the_sign_of_a_number_are_alike() {
    let mut builder = builder("", 4, false);
    for (number, roll) in (1..).zip(["-4", "4", "−12", "+3.5"]) {
        let mut record = record(number, Side::A, true, &[]);
        record.result = "crashed".to_owned();
        record.reason =
            format!("the craft crashed: it hit the ground in APPROACHING, roll {roll}°, pitch 11°");
        record.failures = vec![record.reason.clone()];
        builder.add(&record);
    }
    assert_eq!(builder.answer().worst[0].alike, 4);
}
