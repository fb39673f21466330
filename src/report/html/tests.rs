use std::collections::BTreeSet;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::*;
use crate::report::check::{CheckedFlight, Summary};
use crate::report::compare::{Comparison, Side, Track};
use crate::report::flight::{FlightReport, ReportedSettings, fixture};
use crate::report::record::RecordedSample;
use crate::report::route::TrackSample;
use crate::scenario::{Judgement, Outcome};
use crate::signals::SimTime;
use crate::telemetry::signal::{SIGNALS, Signal, SignalValues};
use crate::telemetry::{Mode, ModeFlags};

const PROGRAM: &str = "betadeck 0.1.0";

/// A name that would be markup if it were not escaped.
const HOSTILE: &str = "</title><script>a('\"');</script><img src=x onerror=a()>&amp;";
/// A harmless name of the same length.
const HARMLESS: &str = "a long name that is only that, and as long as the other one!";

/// Returns the elements of a page in their order, and fails if it is not well-formed or needs something else.
pub(super) fn elements(page: &str) -> Vec<String> {
    let mut reader = Reader::from_str(page);
    reader.config_mut().check_end_names = true;
    let (mut elements, mut ids) = (Vec::new(), BTreeSet::new());
    let mut look = |element: &BytesStart<'_>| {
        let name = element.name().as_ref().to_owned();
        assert!(
            !["script", "img", "link", "iframe", "object", "use", "image"].contains(&name.as_str()),
            "{name}"
        );
        for attribute in element.attributes() {
            let attribute = attribute.expect("an attribute");
            let key = attribute.key.as_ref().to_owned();
            let value = attribute.value.clone().into_owned();
            assert!(!["src", "href", "xlink:href", "style"].contains(&key.as_str()), "{name} {key}");
            assert!(!key.starts_with("on") && !value.contains("url("), "{name} {key}={value}");
            assert!(key == "xmlns" || !value.contains("://"), "{name} {key}={value}");
            if key == "id" {
                assert!(ids.insert(value.clone()), "{value} is there twice");
            }
        }
        elements.push(name);
    };
    let mut depth = 0_i32;
    loop {
        match reader.read_event().expect("well-formed") {
            Event::Start(element) => {
                depth += 1;
                look(&element);
            }
            Event::Empty(element) => look(&element),
            Event::End(_) => depth -= 1,
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!(depth, 0);
    assert!(!page.contains("@import") && !page.contains("url("));
    elements
}

fn count(elements: &[String], name: &str) -> usize {
    elements.iter().filter(|element| *element == name).count()
}

#[test]
fn the_page_of_a_flight_is_one_well_formed_document_that_needs_nothing_else() {
    let page = flight_page(&fixture::report("square", "field"), PROGRAM);
    let elements = elements(&page);
    // Map, states, altitude, battery and wind; two dots in the table of states.
    assert_eq!(count(&elements, "svg"), 5 + 2);
    assert_eq!((count(&elements, "desc"), count(&elements, "figure")), (5, 5));
    for part in [
        "<h1>square</h1>",
        "✓ complete",
        "<dt>air</dt><dd>3.0 m/s from 270°, gusts 1.0 m/s</dd>",
        "<dt>battery</dt><dd>4.2 % used, lowest 12.0 V</dd>",
        "WP1 LAND</th><td class=\"number\">59.0</td><td>touched down at</td>",
        "<td class=\"number passed\">93 %</td>",
        "≤ 2.00 m</td><td class=\"number\">0.10 m</td>",
        "<code>ap_max_angle</code></th><td><code>25</code></td><td><code>50</code></td>",
        "<time>-7.0 s</time>Armed.",
        "betadeck fly &#39;square&#39; --wind 3@270",
        "10.0 s after boot",
    ] {
        assert!(page.contains(part), "{part} is not in the page");
    }
}

#[test]
fn a_flight_of_which_little_is_known_has_a_page_too() {
    let page = flight_page(&FlightReport { name: "LOG00001".to_owned(), ..FlightReport::default() }, PROGRAM);
    assert_eq!(count(&elements(&page), "svg"), 0);
}

#[test]
fn a_name_cannot_add_markup() {
    let page = |name: &str| {
        let mut report = fixture::report(name, name);
        report.record.sentences.push((SimTime(1), name.to_owned()));
        report.facts.push((name.to_owned(), name.to_owned()));
        report.settings = Some(ReportedSettings::Changed(vec![[(); 3].map(|()| name.to_owned())]));
        flight_page(&report, PROGRAM)
    };
    assert_eq!(HOSTILE.chars().count(), HARMLESS.chars().count());
    assert_eq!(elements(&page(HOSTILE)), elements(&page(HARMLESS)));
    assert_eq!(elements(&check_page(&[(HOSTILE, false)])), elements(&check_page(&[(HARMLESS, false)])));
    assert_eq!(elements(&comparison_page(HOSTILE, false)), elements(&comparison_page(HARMLESS, false)));
}

#[test]
fn half_an_hour_of_noise_fits_into_a_page() {
    let mut report = fixture::report("long", "field");
    let mut state = 1_u64;
    let mut noise = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from((state >> 40) as u32) / f64::from(1_u32 << 24)
    };
    report.record.samples = (0..18_000_u64)
        .map(|tenth| {
            let mut values = SignalValues::UNKNOWN;
            SIGNALS.iter().for_each(|info| values.set(info.signal, 200.0 * noise()));
            RecordedSample { time: SimTime(tenth * 100_000), values, state: None, modes: None }
        })
        .collect();
    let transition = report.record.transitions[1].clone();
    report.record.transitions = vec![transition; 4000];
    report.record.sentences = vec![(SimTime(5), "A long sentence. ".repeat(20)); 4000];
    let page = flight_page(&report, PROGRAM);
    assert!((100_000..=MAX_BYTES).contains(&page.len()), "{}", page.len());
    assert!(count(&elements(&page), "svg") > 8, "all pictures are there");
    assert!(page.contains("later transitions are left out"));
}

#[test]
fn a_log_whose_modes_change_all_the_time_fits_into_a_page() {
    let mut report = fixture::report("LOG00001.BFL", "field");
    report.record.transitions.clear();
    report.record.samples = (0..12_000_u32)
        .map(|tenth| {
            let mut values = SignalValues::UNKNOWN;
            values.set(Signal::North, 100.0 * f64::from(tenth / 10 % 7));
            values.set(Signal::East, f64::from(tenth % 10));
            let mut modes = ModeFlags::NONE;
            modes.set(Mode::Arm, true);
            modes.set(Mode::Angle, tenth % 2 == 0);
            let time = SimTime(u64::from(tenth) * 100_000);
            RecordedSample { time, values, state: None, modes: Some(modes) }
        })
        .collect();
    let others = (0..1000).map(|at| [format!("setting_{at}"), "1,2,3".repeat(50), String::new()]).collect();
    let changed = vec![["p_roll", "50", "45"].map(str::to_owned)];
    report.settings = Some(ReportedSettings::Logged { changed, others });
    let page = flight_page(&report, PROGRAM);
    assert!((100_000..=MAX_BYTES).contains(&page.len()), "{}", page.len());
    assert!(count(&elements(&page), "svg") >= 2, "the map and the modes are there");
    assert!(page.contains("<code>p_roll</code></th><td><code>50</code></td><td><code>45</code></td>"));
    assert!(page.contains("<summary>1000 more lines of the header</summary>"));
    assert!(page.contains("setting_1</code>") && page.contains("coloured by flight mode"));
}

fn checked(scenario: &str, passed: bool) -> CheckedFlight {
    let outcome = match passed {
        true => Outcome::Met(None),
        false => Outcome::Failed { sentence: scenario.to_owned(), at: Some(SimTime(3_000_000)), guard: None },
    };
    CheckedFlight {
        scenario: scenario.to_owned(),
        file: format!("{scenario}.toml"),
        result: "complete".to_owned(),
        judgements: vec![Judgement { label: scenario.to_owned(), line: 7, outcome }],
        engaged_at: Some(SimTime(1_000_000)),
        flown_s: 60.0,
        ..CheckedFlight::default()
    }
}

/// Returns the page of a run with these scenarios, and whether they passed.
fn check_page(scenarios: &[(&str, bool)]) -> String {
    let mut page = CheckPage::default();
    let flights: Vec<CheckedFlight> =
        scenarios.iter().map(|(scenario, passed)| checked(scenario, *passed)).collect();
    for flight in &flights {
        page.add(flight, &fixture::report("", "field"));
    }
    let wanted = flights.len();
    page.html(&Summary::new(flights, Vec::new(), wanted, 0, 1.0), Some("betadeck check"), PROGRAM)
}

#[test]
fn the_page_of_a_run_shows_the_failed_flights_first() {
    let page = check_page(&[("first", true), ("second", false)]);
    let at = |part: &str| page.find(part).unwrap_or_else(|| panic!("{part} is not in\n{page}"));
    elements(&page);
    assert!(at("<summary>✗ second</summary>") < at("<summary>✓ first</summary>"));
    assert!(page.contains("1 of 2 flights passed; 120.0 s flown"));
    assert!(page.contains("<code>betadeck open second.toml --at 2.00</code>"));
    assert!(!page.contains("flights are shown"));
}

#[test]
fn a_run_of_many_flights_fits_into_a_page() {
    let names: Vec<String> = (0..3000).map(|number| format!("scenario {number}")).collect();
    let scenarios: Vec<(&str, bool)> =
        names.iter().enumerate().map(|(index, name)| (name.as_str(), index != 2999)).collect();
    let page = check_page(&scenarios);
    assert!(page.len() <= MAX_BYTES, "{}", page.len());
    elements(&page);
    assert!(page.contains("<summary>✗ scenario 2999</summary>"), "the failed flight is shown");
    assert!(page.contains("of 3000 flights are shown") && page.contains("further cases are left out"));
}

/// Returns the page of two firmwares with this name, or of a log and its simulation.
fn comparison_page(name: &str, is_log: bool) -> String {
    let track = |by: f64| {
        let sample = |step: u32| TrackSample {
            time_s: f64::from(step),
            ne: nalgebra::Vector2::new(f64::from(step), by),
            alt_m: 10.0 + by,
            attitude: None,
        };
        Track {
            samples: (0..100).map(sample).collect(),
            result: "crashed".to_owned(),
            reason: name.to_owned(),
            flown_s: Some(100.0),
            ..Track::default()
        }
    };
    let side =
        |by, is_log| Side { name: name.to_owned(), is_log, repeatable: true, flights: vec![track(by)] };
    let report = fixture::report(name, name);
    let comparison =
        Comparison::new(name, "calm", report.route.expect("a route"), [side(0.0, is_log), side(3.0, false)]);
    let frame = report.frame.expect("a frame");
    compare_page(&comparison, (&report.backdrop, &frame), report.command.as_deref(), PROGRAM)
}

#[test]
fn the_page_of_a_log_and_its_simulation_says_how_each_is_measured() {
    let page = comparison_page("flight.bbl", true);
    for part in [
        "A log and its simulation by betadeck",
        "The track of the log by its GPS, and the true track of the simulated flight",
        "<li>B: crashed: flight.bbl</li>",
    ] {
        assert!(page.contains(part), "{part} is not in\n{page}");
    }
    assert!(!page.contains("firmware") && !page.contains("<li>A: "), "{page}");
}

#[test]
fn the_page_of_a_comparison_has_both_tracks_and_the_table() {
    let page = comparison_page("old.elf", false);
    assert_eq!(count(&elements(&page), "svg"), 2);
    for part in [
        "<th scope=\"col\" class=\"number\">A: old.elf</th>",
        "<td class=\"number\">crashed</td>",
        "<li>B: crashed: old.elf</li>",
        "tracks apart, RMS",
        "✗ not complete",
    ] {
        assert!(page.contains(part), "{part} is not in\n{page}");
    }
}
