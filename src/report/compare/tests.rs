use nalgebra::Vector2;

use super::*;
use crate::geo::LocalFrame;
use crate::plan::{Altitude, FlightPlan, HoldPattern, WaypointType};
use crate::report::route::{SampledAttitude, TrackSample};
use crate::telemetry::snapshot::SettingsView;

const LAT_DEG: f64 = 40.4635;
const LON_DEG: f64 = -79.5182;

fn frame() -> LocalFrame {
    LocalFrame::new(LAT_DEG, LON_DEG, 300.0)
}

fn settings() -> SettingsView {
    SettingsView {
        arrival_radius_m: 3.0,
        hold_radius_m: 5.0,
        orbit_radius_m: 20.0,
        ..SettingsView::default()
    }
}

/// Returns a plan of these places, m north and east of home, all at 10 m.
fn plan(places: &[(f64, f64, WaypointType)]) -> FlightPlan {
    let mut plan = FlightPlan::default();
    for (north, east, kind) in places {
        let (lat, lon, _) = frame().to_geodetic(nalgebra::Vector3::new(*east, *north, 0.0));
        plan.waypoints.push(crate::plan::Waypoint {
            position: crate::geo::LatLon::new((lat * 1e7).round() as i32, (lon * 1e7).round() as i32),
            altitude: Altitude::above_home(10.0),
            kind: *kind,
            ..crate::plan::Waypoint::default()
        });
    }
    plan
}

fn route(places: &[(f64, f64, WaypointType)]) -> Route {
    Route::new(&plan(places), &frame(), &settings())
}

/// Returns a track along straight lines between these places at 10 m/s, with ten samples a second, at 10 m.
fn track(places: &[(f64, f64)]) -> Track {
    let mut samples: Vec<TrackSample> = Vec::new();
    for ends in places.windows(2) {
        let [from, to] = [ends[0], ends[1]].map(|(north, east)| Vector2::new(north, east));
        let steps = ((to - from).norm() as usize).max(1);
        for step in 0..steps {
            let ne = from + (to - from) * (step as f64 / steps as f64);
            samples.push(TrackSample {
                time_s: samples.len() as f64 / 10.0,
                ne,
                alt_m: 10.0,
                attitude: None,
            });
        }
    }
    let end = samples.len() as f64 / 10.0;
    Track { samples, result: "complete".to_owned(), flown_s: Some(end), ..Track::default() }
}

fn value(found: &[(Measure, f64)], measure: Measure) -> f64 {
    found.iter().find(|(of, _)| *of == measure).unwrap_or_else(|| panic!("no {measure:?} in {found:?}")).1
}

fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value}, expected {expected}");
}

use WaypointType::{Flyover, Hold, Land};

#[test]
fn a_square_flown_with_an_overshoot_of_six_metres() {
    let route =
        route(&[(100.0, 0.0, Flyover), (100.0, 100.0, Flyover), (0.0, 100.0, Flyover), (0.0, 0.0, Land)]);
    let flown = track(&[
        (0.0, 0.0),
        (106.0, 0.0),
        (106.0, 20.0),
        (100.0, 30.0),
        (100.0, 100.0),
        (0.0, 100.0),
        (0.0, 0.0),
    ]);
    let found = measures(&route, &flown);
    assert_near(value(&found, Measure::TimeTo(0)), 9.9, 0.11);
    assert_near(value(&found, Measure::Overshoot(0)), 6.0, 0.01);
    assert_near(value(&found, Measure::CrossTrackMax(1)), 6.0, 0.6);
    assert_near(value(&found, Measure::CrossTrackMax(0)), 0.0, 0.01);
    assert_near(value(&found, Measure::Overshoot(1)), 0.0, 0.01);
    assert_near(value(&found, Measure::CrossTrackRms(2)), 0.0, 0.01);
    assert_near(value(&found, Measure::AltitudeError(3)), 0.0, 1e-9);
    assert!(!found.iter().any(|(measure, _)| matches!(measure, Measure::TouchdownDistance)));
}

#[test]
fn a_place_that_is_flown_twice_is_passed_in_the_order_of_the_plan() {
    let route =
        route(&[(50.0, 0.0, Flyover), (100.0, 0.0, Flyover), (50.0, 0.0, Flyover), (50.0, 80.0, Flyover)]);
    let flown = track(&[(0.0, 0.0), (100.0, 0.0), (50.0, 0.0), (50.0, 90.0)]);
    let found = measures(&route, &flown);
    for (wp, time) in [(0, 4.9), (1, 9.9), (2, 14.9), (3, 22.9)] {
        assert_near(value(&found, Measure::TimeTo(wp)), time, 0.11);
    }
    // The craft turns back on the spot at one waypoint, and flies on beyond the last one.
    assert_near(value(&found, Measure::Overshoot(1)), 0.0, 0.01);
    assert_near(value(&found, Measure::Overshoot(3)), 9.0, 1.01);
}

#[test]
fn what_was_not_reached_is_left_out() {
    let route = route(&[(50.0, 0.0, Flyover), (50.0, 300.0, Flyover), (0.0, 0.0, Land)]);
    let flown = track(&[(0.0, 0.0), (50.0, 0.0), (50.0, 100.0)]);
    let found = measures(&route, &flown);
    value(&found, Measure::TimeTo(0));
    let beyond = |measure: &Measure| {
        matches!(measure, Measure::TimeTo(1 | 2) | Measure::CrossTrackMax(1 | 2) | Measure::Overshoot(1))
    };
    assert!(!found.iter().any(|(measure, _)| beyond(measure)), "{found:?}");
    assert_eq!(measures(&route, &Track::default()), []);
}

#[test]
fn an_orbit_is_reached_at_its_ring_and_left_from_it() {
    let mut plan = plan(&[(100.0, 0.0, Hold), (0.0, 0.0, Land)]);
    plan.waypoints[0].pattern = HoldPattern::Orbit;
    let route = Route::new(&plan, &frame(), &settings());
    let mut places = vec![(0.0, 0.0), (80.0, 0.0)];
    let ring = |degrees: f64| (100.0 - 20.0 * degrees.to_radians().cos(), 20.0 * degrees.to_radians().sin());
    places.extend((1..=36).map(|step| ring(f64::from(step) * 20.0)));
    places.extend([(0.0, 0.0)]);
    let mut flown = track(&places);
    flown.touchdown = Some(Landing {
        time_s: 40.0,
        ne: Vector2::new(3.0, 4.0),
        impact_mps: Some(0.5),
        disarmed_after_s: Some(1.5),
    });
    let found = measures(&route, &flown);
    assert_near(value(&found, Measure::TimeTo(0)), 7.9, 0.11);
    assert_near(value(&found, Measure::CrossTrackMax(1)), 0.0, 0.5);
    assert_near(value(&found, Measure::TouchdownDistance), 5.0, 0.01);
    assert_near(value(&found, Measure::TouchdownSpeed), 0.5, 1e-9);
    assert_near(value(&found, Measure::DisarmDelay), 1.5, 1e-9);
    // The chords of the track are inside the ring: 20° in six steps. It goes from south to east, counter-clockwise.
    assert_near(value(&found, Measure::RingError(0)), 0.15, 0.15);
    assert_near(value(&found, Measure::RingRate(0)), -20.0 / 0.6, 0.5);
    assert_near(value(&found, Measure::HomeDistance), 120.0, 1.0);
    assert!(!found.iter().any(|(measure, _)| matches!(measure, Measure::Overshoot(_))));
}

#[test]
fn a_nose_beside_the_course_a_tilt_and_a_drift_in_a_hold_are_measured() {
    let route = route(&[(100.0, 0.0, Hold), (0.0, 0.0, Land)]);
    let mut flown = track(&[(0.0, 0.0), (100.0, 0.0), (100.0, 2.5), (100.0, 0.0), (0.0, 0.0)]);
    assert!(!measures(&route, &flown).iter().any(|(measure, _)| matches!(measure, Measure::NoseError(_))));
    for sample in &mut flown.samples {
        let tilt_deg = if sample.time_s > 5.0 { 12.0 } else { 4.0 };
        // The way out goes north, the way back south.
        sample.attitude = Some(SampledAttitude { heading_deg: 350.0, tilt_deg });
    }
    let found = measures(&route, &flown);
    assert_near(value(&found, Measure::NoseError(0)), 10.0, 0.01);
    assert_near(value(&found, Measure::NoseError(1)), 170.0, 0.5);
    assert_near(value(&found, Measure::TiltMax), 12.0, 1e-9);
    assert_near(value(&found, Measure::HoldDistance(0)), 2.5, 1.0);
    assert!(!found.iter().any(|(measure, _)| matches!(measure, Measure::RingError(_))));
}

#[test]
fn the_speeds_of_legs_and_corners_the_yaw_and_the_sink_are_measured() {
    let route = route(&[(100.0, 0.0, Flyover), (100.0, 100.0, Flyover), (0.0, 0.0, Land)]);
    let mut flown = track(&[(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 0.0)]);
    let end_s = flown.samples.last().unwrap().time_s;
    for sample in &mut flown.samples {
        sample.alt_m = if sample.time_s > 4.0 { 9.5 } else { 20.0 };
        // From the tenth second on the nose turns by 30° a second.
        let heading_deg = (350.0 + 30.0 * (sample.time_s - 10.0).max(0.0)).rem_euclid(360.0);
        sample.attitude = Some(SampledAttitude { heading_deg, tilt_deg: 0.0 });
    }
    let found = measures(&route, &flown);
    assert_near(value(&found, Measure::LegSpeed(0)), 10.0, 1e-6);
    assert_near(value(&found, Measure::LegSpeed(2)), 10.0, 0.1);
    // In a corner of 90° the way over two samples is shorter by √2.
    assert_near(value(&found, Measure::CornerSpeed(0)), 10.0 / 2.0_f64.sqrt(), 0.01);
    assert_near(value(&found, Measure::LegAltitude(0)), 0.5, 1e-9);
    assert_near(value(&found, Measure::LegAltitude(1)), 0.5, 1e-9);
    assert_near(value(&found, Measure::YawRateMax), 30.0, 1e-6);
    assert!(!found.iter().any(|(measure, _)| *measure == Measure::SinkRate), "it has not landed");
    for step in 1..=100 {
        let sample = TrackSample { alt_m: 10.0 - 0.1 * f64::from(step), ..*flown.samples.last().unwrap() };
        flown.samples.push(TrackSample { time_s: end_s + 0.2 * f64::from(step), ..sample });
    }
    let time_s = end_s + 20.0;
    flown.touchdown = Some(Landing { time_s, ..Landing::from_disarming(time_s, Vector2::zeros()) });
    assert_near(value(&measures(&route, &flown), Measure::SinkRate), 0.5, 1e-6);
}

fn comparison(name: &str) -> Comparison {
    let route = route(&[(100.0, 0.0, Flyover), (100.0, 100.0, Flyover), (0.0, 0.0, Land)]);
    let straight = track(&[(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 0.0)]);
    let wide = |by: f64| track(&[(0.0, 0.0), (100.0 + by, 0.0), (100.0 + by, 100.0), (0.0, 0.0)]);
    let sides = [
        Side { name: "embedded".to_owned(), is_log: false, repeatable: true, flights: vec![straight] },
        Side { name: name.to_owned(), is_log: false, repeatable: false, flights: vec![wide(2.0), wide(4.0)] },
    ];
    Comparison::new("square", "calm, seed 1", route, sides)
}

#[test]
fn the_table_has_values_spreads_and_differences() {
    insta::assert_snapshot!(comparison("sitl.elf").text());
}

#[test]
fn the_table_for_a_pull_request_is_before_and_after() {
    insta::assert_snapshot!(comparison("sitl_*.elf").markdown(Some("betadeck compare square")));
}

#[test]
fn the_json_has_the_same_numbers() {
    let json: serde_json::Value = serde_json::from_str(&comparison("sitl.elf").json()).unwrap();
    assert_eq!(json["firmware"][1]["flights"].as_array().unwrap().len(), 2);
    let overshoot = json["measures"]
        .as_array()
        .unwrap()
        .iter()
        .find(|line| line["measure"] == "overshoot_m" && line["wp"] == 0)
        .unwrap();
    let near = |value: &serde_json::Value, expected| assert_near(value.as_f64().unwrap(), expected, 0.01);
    near(&overshoot["a"]["median"], 0.0);
    near(&overshoot["b"]["median"], 3.0);
    near(&overshoot["b"]["min"], 2.0);
    near(&overshoot["b"]["max"], 4.0);
    near(&overshoot["difference"], 3.0);
    assert_eq!(overshoot["beyond_spread"], true);
    let between = json["tracks_apart_rms_m"]["between"]["median"].as_f64().unwrap();
    assert!((1.0..4.0).contains(&between), "{between}");
}

/// Returns the mark of the overshoot at waypoint 0, for flights with these overshoots and seeds counted from 1.
fn mark(overshoots: [&[f64]; 2], repeatable: bool) -> Option<bool> {
    let route = route(&[(100.0, 0.0, Flyover), (100.0, 100.0, Flyover), (0.0, 0.0, Land)]);
    let flight = |(index, by): (usize, &f64)| {
        let places = [(0.0, 0.0), (100.0 + by, 0.0), (100.0 + by, 100.0), (0.0, 0.0)];
        Track { seed: index as u64 + 1, ..track(&places) }
    };
    let sides = overshoots.map(|of_side| Side {
        name: "x".to_owned(),
        is_log: false,
        repeatable,
        flights: of_side.iter().enumerate().map(flight).collect(),
    });
    let comparison = Comparison::new("square", "calm", route, sides);
    let row = comparison.rows.iter().find(|row| row.measure == Measure::Overshoot(0)).unwrap();
    row.is_beyond
}

#[test]
fn a_difference_is_marked_if_it_is_greater_than_the_spread_of_both() {
    assert_eq!(mark([&[2.0, 3.0, 4.0], &[5.5, 6.0, 6.5]], true), Some(true));
    assert_eq!(mark([&[2.0, 3.0, 4.0], &[4.0, 4.5, 5.0]], true), Some(false), "less than the spread of A");
    assert_eq!(mark([&[2.0, 2.0, 2.0], &[0.0, 4.0, 5.0]], true), Some(false), "less than the spread of B");
    assert_eq!(mark([&[2.0, 3.0], &[2.0, 3.0]], true), Some(false));
}

#[test]
fn without_a_spread_nothing_is_marked() {
    assert_eq!(mark([&[2.0], &[9.0]], true), None, "other seeds may differ");
    assert_eq!(mark([&[2.0], &[9.0, 10.0]], false), None, "A may fly differently the next time");
    assert_eq!(mark([&[2.0], &[9.0, 10.0]], true), Some(true), "A flies the same the next time");
}

#[test]
fn names_are_escaped_in_the_picture() {
    let svg = comparison("<b> & \"c\"").svg();
    assert!(svg.contains("B: &lt;b&gt; &amp; &quot;c&quot;</text>"), "{svg}");
    assert_eq!(svg.matches("stroke=\"#D55E00\" stroke-width=\"3\"").count(), 1, "the second flight is thin");
    assert!(svg.contains("WP0</text>") && svg.contains("WP2 LAND</text>") && svg.contains(" m</text>"));
    assert!(svg.contains("<title id=\"tracks-title\">square, calm, seed 1</title>"), "{svg}");
    // Every element is closed: there are as many ends as beginnings.
    assert_eq!(svg.matches('<').count(), svg.matches('>').count());
    assert!(svg.trim_end().ends_with("</svg>"));
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn flights_without_a_track_are_shown_all_the_same() {
    let refused = Track { result: "refused".to_owned(), reason: "no fix".to_owned(), ..Track::default() };
    let side = |name: &str| Side {
        name: name.to_owned(),
        is_log: false,
        repeatable: false,
        flights: vec![refused.clone()],
    };
    let comparison = Comparison::new("x", "calm", route(&[(9.0, 0.0, Flyover)]), [side("a"), side("b")]);
    assert!(comparison.text().contains("B: refused: no fix"), "{}", comparison.text());
    assert!(comparison.svg().contains("</svg>"));
}

#[test]
fn a_log_beside_its_simulation_is_called_measured_and_simulated() {
    let mut comparison = comparison("embedded");
    comparison.sides[0] = Side { name: "flight.bbl".to_owned(), is_log: true, ..comparison.sides[0].clone() };
    comparison.sides[0].flights[0].result = "logged".to_owned();
    assert!(comparison.is_complete() && comparison.incomplete().is_empty());
    let text = comparison.text();
    assert!(text.contains("A: flight.bbl, as logged\n"), "{text}");
    let markdown = comparison.markdown(None);
    assert!(markdown.contains("| measured (A: flight.bbl) | simulated (B: embedded) |"), "{markdown}");
    for output in [&text, &markdown] {
        assert!(output.contains("measured by its GPS") && !output.contains("firmware"), "{output}");
    }
}
