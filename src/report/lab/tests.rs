use super::*;
use crate::report::compare::Track;
use crate::scenario::{Better, Judgement, Outcome};

/// Returns a flight with this value of a measure and these properties, `true` = kept.
fn flight(seed: u64, value: f64, kept: &[(&str, bool)]) -> CheckedFlight {
    let judgements = kept.iter().map(|(label, is_kept)| Judgement {
        label: (*label).to_owned(),
        line: 0,
        outcome: match is_kept {
            true => Outcome::Met(None),
            false => Outcome::Failed { sentence: format!("{label} is not true"), at: None, guard: None },
        },
    });
    CheckedFlight {
        scenario: "lab-landing".to_owned(),
        file: "lab-landing".to_owned(),
        seed,
        seeds: 20,
        hash: value.to_bits(),
        flown_s: 40.0,
        is_remote: true,
        firmware_options: Some(" --firmware new.elf".to_owned()),
        measures: vec![("touchdown_speed_mps".to_owned(), value)],
        judgements: judgements.collect(),
        ..CheckedFlight::default()
    }
}

/// Returns the answer about flights with these values before and after.
fn lab(values: &[(f64, f64)]) -> Lab {
    let flights = (1..).zip(values).map(|(seed, (before, after))| LabFlight {
        base: Some(flight(seed, *before, &[])),
        head: flight(seed, *after, &[]),
    });
    answer(flights.collect())
}

fn answer(flights: Vec<LabFlight>) -> Lab {
    let measures: Vec<LabMeasure> = common().collect();
    let wanted = flights.len();
    Lab::new((Some("old.elf".to_owned()), "new.elf".to_owned()), &measures, flights, wanted, 10.0)
}

#[test]
fn a_landing_that_is_faster_in_all_flights_is_worse() {
    let lab =
        lab(&(0..20).map(|n| (0.5 + 0.01 * f64::from(n), 0.9 + 0.012 * f64::from(n))).collect::<Vec<_>>());
    assert!(lab.is_worse());
    let [finding] = &lab.findings[..] else { panic!("{:?}", lab.findings) };
    assert_eq!((finding.kind, finding.agreeing, finding.differing), (Kind::Worse, 20, 20));
    assert!((finding.difference - 0.419).abs() < 1e-9 && finding.p < 1e-4, "{finding:?}");
    let text = lab.text();
    assert!(
        text.contains("worse: speed at the touchdown 0.59 → 1.01 m/s (+0.42, 20 of 20 flights)"),
        "{text}"
    );
    assert!(text.contains("betadeck open lab-landing --seed 20 --at boot+0.00 --firmware new.elf"), "{text}");
    assert!(text.lines().count() <= 10, "{text}");
    insta::assert_snapshot!(lab.markdown(Some("betadeck lab --base old.elf --head new.elf")));
}

#[test]
fn two_copies_of_one_build_do_not_differ() {
    let lab = lab(&(0..20).map(|n| (f64::from(n), f64::from(n))).collect::<Vec<_>>());
    assert!(!lab.is_worse());
    assert!(
        lab.text().contains("No difference: all flights are the same to the last bit."),
        "{}",
        lab.text()
    );
}

#[test]
fn noise_in_both_directions_and_differences_that_nobody_notices_are_no_change() {
    let noise = (0..20).map(|n| (0.5, if n % 2 == 0 { 0.9 } else { 0.1 } + 0.001 * f64::from(n)));
    assert!(lab(&noise.collect::<Vec<_>>()).findings.is_empty());
    let small = (0..20).map(|n| (0.5, 0.52 + 0.0001 * f64::from(n)));
    assert!(lab(&small.collect::<Vec<_>>()).findings.is_empty());
    let few = (0..4).map(|n| (0.5, 0.9 + 0.01 * f64::from(n)));
    assert!(lab(&few.collect::<Vec<_>>()).findings.is_empty(), "four flights say nothing");
}

#[test]
fn a_change_in_a_part_of_the_flights_counts_by_that_part() {
    let part = (0..40).map(|n| (0.5, if n < 12 { 0.9 + 0.01 * f64::from(n) } else { 0.5 }));
    let lab = lab(&part.collect::<Vec<_>>());
    assert!(lab.text().contains("12 of 12 flights, 28 are equal"), "{}", lab.text());
}

#[test]
fn a_change_that_shows_only_in_some_flights_counts_although_the_others_differ_a_little() {
    let values = (0..200).map(|n| {
        let noise = if n % 2 == 0 { 0.001 } else { -0.001 };
        (5.0, if n < 120 { 5.0 + noise * f64::from(n + 1) / 100.0 } else { 6.5 + 0.001 * f64::from(n) })
    });
    let lab = lab(&values.collect::<Vec<_>>());
    assert!(lab.is_worse() && lab.findings[0].difference > 0.3, "{:?}", lab.findings);
}

#[test]
fn a_clear_change_in_all_flights_comes_before_a_larger_one_in_a_few_and_before_what_is_better() {
    let flights = (1..=40_u64).map(|seed| {
        let by = 0.001 * seed as f64;
        let few = if seed <= 10 { 3.0 + by } else { 1.0 };
        let measures = |values: [f64; 4]| {
            let keys = ["overshoot_m 0", "ring_radius_m 1", "alt_error_m 0", "touchdown_distance_m"];
            keys.map(str::to_owned).into_iter().zip(values).collect()
        };
        let one = |values| CheckedFlight { measures: measures(values), ..flight(seed, values[1], &[]) };
        LabFlight { base: Some(one([1.0, 2.0, 4.0, 4.0])), head: one([few, 4.0 + by, 4.5 + by, 0.5 + by]) }
    });
    let lab = answer(flights.collect());
    let titles: Vec<&str> = lab.findings.iter().map(|finding| finding.measure.title.as_str()).collect();
    assert_eq!(
        titles,
        [
            "radius of an ORBIT",
            "overshoot at a waypoint",
            "altitude error at a waypoint",
            "touchdown beside the LAND point"
        ]
    );
}

#[test]
fn a_property_that_is_broken_in_all_its_flights_comes_before_one_that_is_broken_in_more_of_many() {
    let pair = |seed: u64| LabFlight {
        base: Some(flight(seed, 1.0, &[("keeps the tilt", true)])),
        head: flight(seed, 1.001, &[("keeps the tilt", seed > 5)]),
    };
    let rth = |seed: u64| LabFlight {
        base: Some(flight(seed, 1.0, &[("RTH comes home", true)])),
        head: flight(seed, 1.001, &[("RTH comes home", false)]),
    };
    let lab = answer((1..=20).map(pair).chain((21..=23).map(rth)).collect());
    let labels: Vec<&str> = lab.shown().map(|broken| broken.label.as_str()).collect();
    assert_eq!(labels, ["RTH comes home", "keeps the tilt"]);
}

#[test]
fn the_answer_names_a_broken_property_before_a_measure_that_only_changed_and_keeps_room_for_both() {
    let flights = (1..=20_u64).map(|seed| {
        let by = 0.001 * seed as f64;
        let one = |radius: f64, kept: bool| {
            let measures = vec![("ring_radius_m 1".to_owned(), radius)];
            CheckedFlight { measures, ..flight(seed, radius, &[("stays inside the fence", kept)]) }
        };
        LabFlight { base: Some(one(2.0, true)), head: one(4.0 + by, false) }
    });
    let text = answer(flights.collect()).text();
    let lines: Vec<&str> = text.lines().filter(|line| !line.contains("betadeck open")).collect();
    assert!(lines[2].starts_with("  worse: stays inside the fence"), "{text}");
    assert!(lines[3].starts_with("  changed: radius of an ORBIT"), "{text}");
}

#[test]
fn a_waypoint_that_only_one_build_reached_is_left_out() {
    let measures =
        |values: &[(&str, f64)]| values.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect();
    let flights = (1..=20).map(|seed| {
        let by = 0.001 * seed as f64;
        let base = CheckedFlight {
            measures: measures(&[("overshoot_m 0", 1.0), ("overshoot_m 1", 9.0)]),
            ..flight(seed, 1.0, &[])
        };
        let head =
            CheckedFlight { measures: measures(&[("overshoot_m 0", 2.0 + by)]), ..flight(seed, 1.0, &[]) };
        LabFlight { base: Some(base), head }
    });
    let lab = answer(flights.collect());
    let finding = &lab.findings[0];
    assert!(finding.kind == Kind::Worse && (finding.difference - 1.0).abs() < 0.05, "{finding:?}");
}

#[test]
fn a_property_that_only_one_build_was_judged_by_says_nothing_about_the_change() {
    let problem = CheckedFlight { problem: Some("not configured".to_owned()), ..flight(1, 1.0, &[]) };
    let pair = |seed| LabFlight {
        base: Some(CheckedFlight { seed, ..problem.clone() }),
        head: flight(seed, 1.0, &[("stays inside the fence", false)]),
    };
    assert!(!answer(vec![pair(1), pair(2)]).is_worse());
}

#[test]
fn a_smaller_value_is_better_or_worse_as_the_measure_says() {
    let kind = |better: Option<Better>, sign: f64| {
        let measure = LabMeasure { better, ..common().find(|one| one.key == "touchdown_speed_mps").unwrap() };
        let flights = (1..=20).map(|seed| LabFlight {
            base: Some(flight(seed, 1.0, &[])),
            head: flight(seed, 1.0 + sign * (0.4 + 0.01 * seed as f64), &[]),
        });
        finding::all(&[measure], &flights.collect::<Vec<_>>()).0[0].kind
    };
    assert_eq!(kind(Some(Better::Less), -1.0), Kind::Better);
    assert_eq!(kind(Some(Better::More), -1.0), Kind::Worse);
    assert_eq!(kind(Some(Better::More), 1.0), Kind::Better);
    assert_eq!(kind(None, 1.0), Kind::Changed);
}

#[test]
fn a_property_that_the_change_broke_is_worse_if_it_is_more_than_chance() {
    let fence = "stays inside the fence";
    let pair = |seed: u64, before: bool, after: bool| LabFlight {
        base: Some(flight(seed, 1.0, &[(fence, before)])),
        head: flight(seed, 1.001, &[(fence, after)]),
    };
    let broken = answer(vec![pair(1, true, false), pair(2, true, true), pair(3, true, false)]);
    assert!(broken.is_worse());
    let text = broken.text();
    assert!(text.contains("2 flights break a property that they kept before"), "{text}");
    assert!(
        text.contains(
            "worse: stays inside the fence: before 0 → 2 of 3 flights, 2 newly; lab-landing · seed 1"
        ),
        "{text}"
    );
    // One flight more and one fewer is chance.
    let turned = answer(vec![pair(1, true, false), pair(2, false, true), pair(3, true, true)]);
    assert!(!turned.is_worse());
    assert!(
        turned.text().contains("fails now: stays inside the fence: before 1 → 1 of 3 flights, 1 newly"),
        "{}",
        turned.text()
    );
    let mended = answer(vec![pair(1, false, true), pair(2, false, true)]);
    assert!(!mended.is_worse() && !mended.text().contains("fence"), "{}", mended.text());
}

#[test]
fn a_build_alone_is_judged_by_the_properties() {
    let one = |seed: u64, kept: bool| LabFlight {
        base: None,
        head: flight(seed, 1.0, &[("it does not crash", kept)]),
    };
    let alone = |flights: Vec<LabFlight>| {
        let measures: Vec<LabMeasure> = common().collect();
        Lab::new((None, "new.elf".to_owned()), &measures, flights, 2, 10.0)
    };
    let crashed = alone(vec![one(1, true), one(2, false)]);
    assert!(crashed.is_worse() && crashed.findings.is_empty());
    let text = crashed.text();
    assert!(text.contains("1 property and 0 expectations of scenarios were not met."), "{text}");
    assert!(
        text.contains(
            "broken: it does not crash: 1 of 2 flights; lab-landing · seed 2: it does not crash is not"
        ),
        "{text}"
    );
    assert!(!alone(vec![one(1, true)]).is_worse());
    let of_scenario = LabFlight { base: None, head: flight(3, 1.0, &[("COMPLETE in time", false)]) };
    let listed = alone(vec![of_scenario]);
    assert!(!listed.is_worse() && listed.text().contains("broken: COMPLETE in time"), "{}", listed.text());
    assert!(alone(Vec::new()).text().contains("Nothing was flown."));
}

#[test]
fn a_flight_that_could_not_be_prepared_is_a_broken_property() {
    let failed = CheckedFlight { problem: Some("it does not answer".to_owned()), ..flight(1, 1.0, &[]) };
    let pair = |seed| LabFlight {
        base: Some(flight(seed, 1.0, &[])),
        head: CheckedFlight { seed, ..failed.clone() },
    };
    let lab = answer(vec![pair(1), pair(2)]);
    assert!(lab.is_worse() && lab.text().contains(ANSWERS), "{}", lab.text());
}

#[test]
fn the_json_has_all_flights_and_the_same_numbers() {
    let lab = lab(&(0..20).map(|n| (0.5, 0.9 + 0.01 * f64::from(n))).collect::<Vec<_>>());
    let json: serde_json::Value = serde_json::from_str(&lab.json()).unwrap();
    assert_eq!(json["flights"].as_array().unwrap().len(), 20);
    assert_eq!(json["measures"][0]["kind"], "worse");
    assert_eq!(json["worse"], true);
    assert_eq!(json["flights"][0]["base"]["measures"]["touchdown_speed_mps"], 0.5);
}

#[test]
fn every_common_measure_is_one_that_flights_have() {
    use crate::report::compare::Measure;
    let keys: Vec<&str> = [
        Measure::Flown,
        Measure::LegSpeed(0),
        Measure::CornerSpeed(0),
        Measure::CrossTrackRms(0),
        Measure::CrossTrackMax(0),
        Measure::Overshoot(0),
        Measure::LegAltitude(0),
        Measure::AltitudeError(0),
        Measure::NoseError(0),
        Measure::RingRadius(0),
        Measure::RingRate(0),
        Measure::HoldDistance(0),
        Measure::SinkRate,
        Measure::TouchdownSpeed,
        Measure::TouchdownDistance,
        Measure::DisarmDelay,
        Measure::TiltMax,
        Measure::YawRateMax,
    ]
    .map(|measure| measure.key().0)
    .to_vec();
    let common: Vec<String> = common().map(|measure| measure.key).collect();
    assert_eq!(common, keys);
    assert!(measures_of(&crate::report::route::Route { points: Vec::new() }, &Track::default()).is_empty());
}
