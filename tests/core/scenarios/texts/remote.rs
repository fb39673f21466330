//! Flights of remote firmware: what is judged of them.

use super::*;
use betadeck_core::scenario::{BuiltinFiles, BuiltinScenario, SCENARIOS, skip};
use betadeck_core::telemetry::FirmwareProfile;

/// Returns the outcomes of the expectations of one flight for each level of knowledge.
fn judged_by<const N: usize>(reported: [Insight; N], expectations: &str) -> [Vec<Outcome>; N] {
    let scenario = scenario(&format!("{STANDING}{expectations}"));
    let case = &scenario.cases[0];
    let mut flown = CaseFlight::new(case, &case.airs[0]).unwrap().fly();
    assert_eq!(flown.reported, Insight::Inner);
    reported.map(|reported| {
        flown.reported = reported;
        judge(case, &flown).0.into_iter().map(|judgement| judgement.outcome).collect()
    })
}

#[test]
fn what_a_flight_controller_does_not_tell_is_skipped_and_the_rest_judged() {
    use Insight::{Inner, Mission, Telemetry, Truth};
    let expected = [
        (Mission, "result = 'stopped'"),
        (Truth, "always = 'altitude < 1 m and on_ground'\nfrom = 'boot'"),
        (Truth, "max = 'distance(wp 0) < 1 km'\nfrom = 'boot'"),
        (Truth, "no_event = 'touchdown'\nfrom = 'boot'"),
        (Telemetry, "never = 'armed or mode AUTOPILOT'\nfrom = 'boot'"),
        (Telemetry, "no_event = 'mode AUTOPILOT on'\nfrom = 'boot'"),
        (Telemetry, "never = 'fix'\nfrom = 'boot'"),
        (Truth, "that = 'rate(altitude) = 0 +- 1 m/s'\nat = '1 s after when boot_time > 1 s'"),
        (Mission, "never = 'state ORBITING 0'\nfrom = 'boot'"),
        (Mission, "no_event = 'engaged'\nfrom = 'boot'"),
        (Inner, "no_event = 'engage_refused'\nfrom = 'boot'"),
        (Inner, "always = 'throttle < 2100 us and speed < 9 m/s'\nfrom = 'boot'"),
        (Inner, "no_event = 'disarmed CRASH_PROTECTION'\nfrom = 'boot'"),
    ];
    let text: String = expected.iter().map(|(_, text)| format!("[[expect]]\n{text}\n")).collect();
    let reported = [Telemetry, Mission, Inner];
    for (reported, outcomes) in std::iter::zip(reported, judged_by(reported, &text)) {
        for ((needed, expectation), outcome) in
            std::iter::zip(expected, outcomes.into_iter().rev().take(13).rev())
        {
            let is_right =
                if needed > reported { outcome == Outcome::Skipped(needed) } else { outcome.is_met() };
            assert!(is_right, "{expectation} of {reported:?}: {outcome:?}");
        }
    }
}

#[test]
fn an_expectation_for_one_kind_of_firmware_is_judged_for_no_other() {
    let text = format!(
        "{STANDING}[[expect]]\nfirmware = 'master'\nresult = 'landed'\n\
         [[expect]]\nfirmware = 'guide'\nalways = 'altitude < 1 m'\nfrom = 'boot'\n\
         [[expect]]\nalways = 'on_ground'\nfrom = 'boot'\n"
    );
    let scenario = scenario(&text);
    let case = &scenario.cases[0];
    let mut flown = CaseFlight::new(case, &case.airs[0]).unwrap().fly();
    assert_eq!(flown.firmware, Some(FirmwareProfile::Guide));
    let mut judged = |firmware| -> Vec<(String, bool)> {
        flown.firmware = firmware;
        judge(case, &flown).0.into_iter().map(|one| (one.label, one.outcome.is_met())).collect()
    };
    let met = |label: &str| (label.to_owned(), true);
    let usual = "result stopped or complete or landed";
    let guide = [met(usual), met("always altitude < 1 m, from boot"), met("always on_ground, from boot")];
    assert_eq!(judged(Some(FirmwareProfile::Guide)), guide);
    let master = [("result landed".to_owned(), false), met("always on_ground, from boot")];
    assert_eq!(judged(Some(FirmwareProfile::Master)), master);
    assert_eq!(judged(None), [met("always on_ground, from boot")]);
    let unknown = format!("{STANDING}[[expect]]\nfirmware = 'mastr'\nalways = 'on_ground'\n");
    assert_eq!(
        problems(&unknown),
        ["test.toml:10:12: mastr is not a kind of firmware; did you mean master?"]
    );
}

#[test]
fn a_flight_whose_input_waited_for_an_unreported_value_is_not_judged() {
    use Insight::{Mission, Telemetry};
    let text = "[[input]]\nat = 'engaged'\ndo = 'wind 5@270'\n\
                [[expect]]\nalways = 'altitude < 1 m'\nfrom = 'boot'\n";
    let [unreported, reported] = judged_by([Telemetry, Mission], text);
    assert_eq!(unreported.last(), Some(&Outcome::Skipped(Mission)));
    // With its instant known, the input is judged as not carried out. That judgement comes after the expectations.
    assert_eq!(reported.len(), unreported.len() + 1);
    assert!(
        reported[reported.len() - 2].is_met()
            && matches!(reported[reported.len() - 1], Outcome::NeverJudged(_)),
        "{reported:?}"
    );
}

#[test]
fn a_measure_of_an_unreported_value_is_left_out_and_its_expectations_skipped() {
    let text = "[[measure]]\nname = 'high'\nmax = 'throttle'\nfrom = 'boot'\n[[measure]]\nname = 'double'\n\
                value = 'high * 2'\n[[measure]]\nname = 'wide'\nmax = 'speed'\nfrom = 'boot'\n\
                [[expect]]\nthat = 'double > 0 us'\n[[expect]]\nthat = 'wide < 1 m/s'\n";
    let [outcomes] = judged_by([Insight::Mission], text);
    assert_eq!(outcomes[outcomes.len() - 2], Outcome::Skipped(Insight::Inner));
    assert!(outcomes.last().unwrap().is_met());
}

#[test]
fn a_flight_whose_inputs_only_the_embedded_firmware_takes_is_not_flown() {
    let with = |input: &str| scenario(&format!("{STANDING}[[input]]\nat = 'boot'\ndo = '{input}'\n"));
    let skipped = |input: &str| skip(&with(input).cases[0]);
    assert_eq!(skipped("wind 5@270"), None);
    assert_eq!(skipped("switch AUTOPILOT on"), None);
    assert_eq!(skipped("fault gps-loss,6"), None);
    assert_eq!(skipped("end mag-off"), None);
    assert!(skipped("fault mag-off").is_some() && skipped("fault mag-bias@3,,20").is_some());
    assert!(skipped("fault battery,,-1").is_some());
    let judgements = skipped("hold here").unwrap();
    assert!(!judgements.is_empty());
    assert!(judgements.iter().all(|judgement| judgement.outcome == Outcome::Skipped(Insight::Inner)));
}

#[test]
fn most_of_the_built_in_scenarios_can_be_flown_with_a_remote_firmware() {
    let guide: Vec<&BuiltinScenario> =
        SCENARIOS.iter().filter(|scenario| scenario.name.starts_with("guide-")).collect();
    assert_eq!(guide.len(), 8);
    let flown = guide.iter().filter(|builtin| {
        let read = read(builtin.name, builtin.text, None, &mut BuiltinFiles);
        let scenario = read.unwrap_or_else(|errors| panic!("{}", report(&errors)));
        scenario.cases.iter().any(|case| skip(case).is_none())
    });
    assert!(flown.count() >= 6);
}
