//! `[vary]` with distributions, and `[campaign]`.

use super::{NoFiles, STANDING, problems};
use betadeck_core::design::Design;
use betadeck_core::plan::format::{PlanError, PlanFile};
use betadeck_core::scenario::{
    Change, Files, FlightSeeds, Flights, NumberInput, Request, Scenario, Spread, Tolerance, read_request,
};

/// A reader with one table of winds.
struct Winds;

impl Files for Winds {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        Err(format!("cannot open {name}"))
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        match name {
            "rose.csv" => Ok("from_deg,0..4\n0,1\n180,3\n".to_owned()),
            _ => Err(format!("cannot open {name}")),
        }
    }
}

fn read_as(text: &str, is_drawn: bool) -> Result<Scenario, Vec<PlanError>> {
    let flights = Flights::OfCampaign { is_drawn };
    let request = Request { file: "test.toml", text, seeds: None, max_flights: 100, flights };
    read_request(&request, &mut Winds)
}

fn campaign(more: &str) -> Scenario {
    let text = format!("{STANDING}{more}");
    read_as(&text, false).unwrap_or_else(|errors| panic!("{}", betadeck_core::plan::format::report(&errors)))
}

/// Returns the problems of a campaign, each with its hint.
fn mistakes(more: &str) -> Vec<String> {
    let errors = read_as(&format!("{STANDING}{more}"), false).unwrap_err();
    errors.iter().map(|error| format!("{} | {}", error.headline(), error.hint)).collect()
}

#[test]
fn every_kind_of_input_is_read() {
    let scenario = campaign(
        "[vary]
wind = '6+-2@250+-20'
gust_mps = '0..4'
turbulence = ['none', 'light']
noise = ['real']
airframe = ['iris', 'five-inch']
takeoff_m = [10, 20]
heading_deg = '0..360'
rate_hz = [500, 1000]
mass_pct = '+- 3'
battery_pct = '-20..0'
[vary.world]
gps = ['open', 'urban']
turbulence_scale = '0.5..2'
[vary.settings]
ap_max_velocity = '400..900'
ap_max_angle = [20, 25]
[vary.faults]
'gps-loss,6' = '5..40'
'motor,,2:0.8' = [3, 9.5]
",
    );
    let spec = scenario.campaign.unwrap();
    assert_eq!(spec.design, Design::MonteCarlo);
    let names: Vec<&str> = spec.inputs.iter().map(|input| input.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "airframe",
            "ap_max_angle",
            "ap_max_velocity",
            "battery_pct",
            "gps",
            "gps-loss,6_at_s",
            "gust_mps",
            "heading_deg",
            "mass_pct",
            "motor,,2:0.8_at_s",
            "noise",
            "rate_hz",
            "takeoff_m",
            "turbulence",
            "turbulence_scale",
            "wind",
        ]
    );
    let spread = |name: &str| spec.inputs.iter().find(|input| input.name == name).unwrap().spread.clone();
    assert!(matches!(spread("wind"), Spread::Wind { .. }));
    let Spread::Number(NumberInput::Tolerance(Tolerance::Mass), mass) = spread("mass_pct") else { panic!() };
    assert_eq!(mass.to_string(), "0 +- 3 in -90..900");
    let Spread::Choice(angles) = spread("ap_max_angle") else { panic!() };
    assert_eq!(angles[1].change, Change::Setting("ap_max_angle = 25".to_owned()));
    let Spread::Number(fault, _) = spread("gps-loss,6_at_s") else { panic!() };
    let Change::Fault(scheduled) = fault.change(12.5) else { panic!() };
    assert_eq!(scheduled.to_string(), "gps-loss@12.5,6");
    let Spread::Choice(times) = spread("motor,,2:0.8_at_s") else { panic!() };
    let Change::Fault(scheduled) = &times[1].change else { panic!() };
    assert_eq!(scheduled.to_string(), "motor@9.5,,2:0.8");
}

#[test]
fn a_rose_comes_from_a_file() {
    let spec = campaign("[vary]\nwind = 'table rose.csv'\n").campaign.unwrap();
    assert!(matches!(spec.inputs[0].spread, Spread::Table(_)));
    assert_eq!(
        mistakes("[vary]\nwind = 'table none.csv'\n"),
        ["test.toml:10:8: none.csv: cannot open none.csv | "]
    );
}

#[test]
fn the_campaign_table_has_the_design_and_the_goals() {
    let scenario = campaign(
        "[[measure]]
name = 'lap'
time = 'boot -> last_sample'
[campaign]
design = 'sobol'
flights = 512
seed = 7
levels = 3
expect = ['success >= 99 % with 95 % confidence', 'p95(lap) <= 4 s']
",
    );
    let spec = scenario.campaign.unwrap();
    assert_eq!((spec.design, spec.flights, spec.seed, spec.levels), (Design::Sobol, Some(512), 7, 3));
    let labels: Vec<(&str, usize)> = spec.goals.iter().map(|goal| (goal.label.as_str(), goal.line)).collect();
    assert_eq!(labels, [("success >= 99 % with 95 % confidence", 17), ("p95(lap) <= 4 s", 17)]);
    assert_eq!(spec.airs[0].1, FlightSeeds::From(1), "each flight has a seed of its own");
}

#[test]
fn seeds_are_a_first_one_a_list_or_a_range() {
    let seeds = |line: &str| {
        let text = format!("seeds = {line}\n{STANDING}[campaign]\nflights = 5\n");
        read_as(&text, false).unwrap().campaign.unwrap().airs[0].1.clone()
    };
    assert_eq!(seeds("'5..'"), FlightSeeds::From(5));
    assert_eq!(seeds("3"), FlightSeeds::List(vec![3]));
    assert_eq!(seeds("'1..200'"), FlightSeeds::Range(1..=200));
    assert_eq!(seeds("[1, 7]"), FlightSeeds::List(vec![1, 7]));
}

#[test]
fn a_file_of_check_is_a_campaign_of_the_same_flights() {
    let text = format!(
        "seeds = '1..3'\n{}",
        STANDING.replace("'none'", "'real'").replace("\"none\"\n", "\"real\"\n")
    )
    .replace("pilot = \"real\"", "pilot = \"none\"");
    let text = format!("{text}[vary]\nwind = ['calm', '5@270']\n");
    let listed = read_as(&text, false).unwrap();
    assert!(listed.campaign.is_none());
    let flights: Vec<usize> = listed.cases.iter().map(|case| case.airs.len()).collect();
    assert_eq!(flights, [3, 3]);
    assert_eq!(listed.cases[1].varied, [("wind".to_owned(), "5@270".to_owned())]);
    let drawn = read_as(&text, true).unwrap();
    assert_eq!((drawn.cases.len(), drawn.campaign.unwrap().design), (1, Design::Grid));
}

#[test]
fn check_refuses_a_campaign_and_names_the_command() {
    for more in ["[vary]\ngust_mps = '0..4'\n", "[campaign]\nflights = 5\n"] {
        let text = format!("{STANDING}{more}");
        let errors = betadeck_core::scenario::read("test.toml", &text, None, &mut NoFiles).unwrap_err();
        assert_eq!(errors[0].message, "this is a campaign");
        assert_eq!(errors[0].hint, "fly it with betadeck campaign test.toml");
    }
}

#[test]
fn mistakes_are_reported_at_their_place_with_a_way_out() {
    for (more, wanted) in [
        ("gust_mps = '0..80'", "test.toml:10:12: 0..80 is out of range | allowed: 0 to 60"),
        ("wind = '6+-2'", "test.toml:10:8: the direction it blows from is missing | write \"6+-2@250+-20\""),
        ("wind = ['x@3']", "test.toml:10:9: speed x is not a number"),
        ("turbulence = 'light'", "test.toml:10:14: a list is expected here | write [\"…\", \"…\"]"),
        (
            "turbulence = ['ligth']",
            "test.toml:10:15: allowed are none, light, moderate, severe; did you mean light?",
        ),
        ("mass_pct = '+- x'", "test.toml:10:12: \"x\" is not a number"),
        ("rate_hz = [1500]", "test.toml:10:12: 1500 Hz is not a step rate | allowed: 400, 500"),
        ("gust_mps = []", "test.toml:10:1: 0 values cannot be combined"),
        ("mass = 3", "test.toml:10:1: mass is not a key of vary"),
        (
            "[vary.settings]\nap_max_velocty = '4..9'",
            "test.toml:11:18: ap_max_velocty is not a setting | write a list",
        ),
        (
            "[vary.settings]\nap_max_angle = '20..99'",
            "test.toml:11:16: 20..99 is out of range | allowed: 10 to 70",
        ),
        (
            "[vary.settings]\nap_max_angle = [99]",
            "test.toml:11:17: ap_max_angle 99 is out of range | allowed: 10 to 70",
        ),
        (
            "[vary.world]\nturbulence_scale = '0..90'",
            "test.toml:11:20: 90 is out of range; allowed are 0 to 10",
        ),
        (
            "[vary.faults]\n'gps-los' = '0..9'",
            "test.toml:11:13: there is no fault \"gps-los\"; did you mean gps-loss?",
        ),
        ("[vary.faults]\n'stall' = '0..9'", "test.toml:11:11: stall needs an external simulator"),
    ] {
        let found =
            mistakes(&format!("[vary]\n{more}\n").replace("[vary]\n[vary.", "[vary]\n\n[vary.").replacen(
                "[vary]\n\n",
                "[campaign]\n",
                usize::from(more.starts_with('[')),
            ));
        assert!(found.iter().any(|found| found.starts_with(wanted)), "{wanted}\n{found:#?}");
    }
}

#[test]
fn mistakes_of_the_campaign_table_are_reported() {
    for (more, wanted) in [
        (
            "design = 'sobal'",
            "test.toml:10:10: sobal is not a design; did you mean sobol? | allowed: grid, monte-carlo, latin-hypercube, sobol",
        ),
        ("flights = 0", "test.toml:10:11: 0 is out of range | allowed: 1 to 10000000"),
        (
            "expect = 'p95(touchdwn) <= 2 m'",
            "test.toml:10:10: touchdwn is not a metric or a measure | did you mean touchdown?",
        ),
        ("goal = 3", "test.toml:10:1: goal is not a key of campaign"),
    ] {
        let found = mistakes(&format!("[campaign]\n{more}\n"));
        assert!(found.iter().any(|found| found.starts_with(wanted)), "{wanted}\n{found:#?}");
    }
}

#[test]
fn a_tolerance_is_given_in_one_place() {
    let text = STANDING.replace("[craft]\n", "[craft]\nmass_pct = 5\n");
    let errors = read_as(&format!("{text}[vary]\nmass_pct = '+- 3'\n"), false).unwrap_err();
    assert_eq!(errors[0].message, "mass_pct is in [craft] and in [vary]");
}

#[test]
fn the_craft_takes_differences_from_its_airframe_faults_and_sticks() {
    let text = STANDING
        .replace("[craft]\n", "[craft]\nmass_pct = 10\nbattery_pct = -50\nsticks = ['aux2=1000@20,5']\n")
        .replace("[air]\n", "[air]\nfaults = ['gps-loss@20,6', 'motor@5,,2:0.9']\n");
    let scenario = betadeck_core::scenario::read("test.toml", &text, None, &mut NoFiles).unwrap();
    let setup = &scenario.cases[0].setup;
    let airframe = &setup.world.airframe;
    assert!((airframe.mass_kg - 0.583).abs() < 1e-9 && (airframe.battery.capacity_ah - 1.65).abs() < 1e-9);
    assert_eq!((setup.world.faults.len(), setup.stick_inputs.len()), (2, 1));
    let text = STANDING.replace("[air]\n", "[air]\nfaults = ['gps-loss']\n");
    assert!(problems(&text)[0].starts_with("test.toml:8:11: the time is missing"), "{:?}", problems(&text));
}

#[test]
fn a_flight_can_be_given_up_some_time_after_boot() {
    let text = format!("timeout_s = 2\n{STANDING}");
    let scenario = betadeck_core::scenario::read("test.toml", &text, None, &mut NoFiles).unwrap();
    let case = &scenario.cases[0];
    let flown = betadeck_core::scenario::CaseFlight::new(case, &case.airs[0]).unwrap().fly();
    assert_eq!((flown.result.as_str(), flown.ended_at.as_secs_f64().round()), ("timeout", 2.0));
}

#[test]
fn an_iris_with_moments_of_inertia_twenty_per_cent_off_flies_and_lands() {
    for percent in [-20.0, 20.0] {
        let text = format!(
            "format = 1\n[plan]\nwaypoints = [\"0 40.4635 -79.5182 500 0 LAND 0 NONE\"]\n[craft]\nairframe = \"iris\"\ntakeoff_m = 5\ninertia_pct = {percent}\n"
        );
        let scenario = betadeck_core::scenario::read("test.toml", &text, None, &mut NoFiles)
            .unwrap_or_else(|errors| panic!("{}", betadeck_core::plan::format::report(&errors)));
        let case = &scenario.cases[0];
        let flown = betadeck_core::scenario::CaseFlight::new(case, &case.airs[0]).unwrap().fly();
        assert_eq!(flown.result, "complete", "{percent}: {}", flown.reason);
    }
}
