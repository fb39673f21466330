//! Valid expressions and mistakes in expressions.

use super::*;
use crate::geo::LatLon;
use crate::plan::{FlightPlan, Waypoint};
use crate::scenario::happening::{EventName, Happening};
use crate::scenario::trace::{Sample, Trace};
use crate::signals::SimTime;
use crate::telemetry::ModeFlags;
use crate::telemetry::signal::SignalValues;

/// A craft that flies north at 5 m/s and climbs at 1 m/s for ten seconds, with 100 samples a second; armed from 2 s on.
fn climb_to_the_north() -> Trace {
    let mut plan = FlightPlan::default();
    plan.waypoints.push(Waypoint { position: LatLon::new(404_640_403, -795_182_000), ..Waypoint::default() });
    let mut trace = Trace::new(plan, None);
    for tick in 0..=1000_u64 {
        let seconds = f64::from(tick as f32 * 0.01);
        let mut values = SignalValues::UNKNOWN;
        values.set(Signal::North, 5.0 * seconds);
        values.set(Signal::East, 3.0);
        values.set(Signal::Altitude, seconds);
        values.set(Signal::Heading, (350.0 + 10.0 * seconds) % 360.0);
        trace.samples.push(Sample {
            time: SimTime(tick * 10_000),
            values,
            flags: u16::from(seconds >= 2.0) << Flag::Armed as u8,
            state: NavState::Approaching,
            wp: 0,
            source: PlanSource::Stored,
            modes: ModeFlags::NONE,
            target_ne: [f32::NAN; 2],
        });
    }
    let at = |seconds: u64, name| Happening::event(SimTime(seconds * 1_000_000), name, &[]);
    trace.happenings = vec![at(2, EventName::Armed), at(4, EventName::Contact), at(7, EventName::Contact)];
    trace.engaged_at = Some(SimTime(3_000_000));
    trace
}

fn scope() -> Scope {
    Scope {
        names: BTreeMap::from([("bound".to_owned(), Dimension::LENGTH)]).into(),
        inputs: vec!["cut".to_owned()],
        waypoints: 3,
        fields: &[],
    }
}

/// Returns the value of a number at a time, s.
fn value(text: &str, seconds: f64) -> f64 {
    let trace = climb_to_the_north();
    let names = [("bound".to_owned(), 4.0)];
    let evaluator = Evaluator::new(&trace, &names);
    let mut cursor = Cursor::new(text);
    let (number, _) = scope().read_number(&mut cursor).unwrap_or_else(|error| panic!("{text}: {error:?}"));
    cursor.finish().unwrap();
    evaluator.number(&number, trace.index_at((seconds * 1e6) as i64).unwrap())
}

/// Returns `true` if a condition holds at a time, s.
fn holds(text: &str, seconds: f64) -> Option<bool> {
    let trace = climb_to_the_north();
    let names = [("bound".to_owned(), 4.0)];
    let evaluator = Evaluator::new(&trace, &names);
    let mut cursor = Cursor::new(text);
    let condition = scope().read_condition(&mut cursor).unwrap_or_else(|error| panic!("{text}: {error:?}"));
    cursor.finish().unwrap();
    evaluator.holds(&condition, trace.index_at((seconds * 1e6) as i64).unwrap())
}

/// Returns the time of an instant, s.
fn when(text: &str) -> Option<f64> {
    let trace = climb_to_the_north();
    let evaluator = Evaluator::new(&trace, &[]);
    let mut cursor = Cursor::new(text);
    let instant = scope().read_instant(&mut cursor).unwrap_or_else(|error| panic!("{text}: {error:?}"));
    cursor.finish().unwrap();
    evaluator.instant(&instant).map(|us| us as f64 * 1e-6)
}

/// Returns the mistake in a condition: the part of the text, the message and the hint.
fn complaint(text: &str) -> String {
    let mut cursor = Cursor::new(text);
    let result = scope().read_condition(&mut cursor).and_then(|_| cursor.finish());
    let error = result.expect_err(text);
    format!("[{}] {}; {}", &text[error.span], error.message, error.hint)
}

#[test]
fn numbers_have_the_value_that_a_pilot_would_work_out() {
    for (text, expected) in [
        ("altitude", 5.0),
        ("2 * altitude - 4 m", 6.0),
        ("-altitude + bound", -1.0),
        ("(altitude + 1 m) / 2", 3.0),
        ("abs(3 m - altitude)", 2.0),
        ("max(altitude, 700 cm)", 7.0),
        ("hypot(3 m, 4 m)", 5.0),
        ("wrap(350 deg)", -10.0),
        ("since(armed)", 3.0),
        ("at(altitude, 1 s after armed)", 3.0),
        ("rate(altitude)", 1.0),
        ("rate(north)", 5.0),
        ("distance(25 N 0 E)", 3.0),
        ("distance(home)", f64::hypot(25.0, 3.0)),
        ("bearing(25 N 0 E)", 90.0),
        ("apart(0 N 0 E, 30 N 40 E)", 50.0),
        ("along(0 N 0 E -> 10 N 0 E)", 25.0),
        ("across(0 N 0 E -> 10 N 0 E)", 3.0),
        ("past(0 N 0 E -> 10 N 0 E)", 15.0),
        ("distance(place at contact)", 5.0),
        ("20 m - 0.5 m/s * since(armed)", 18.5),
    ] {
        let value = value(text, 5.0);
        assert!((value - expected).abs() < 1e-3, "{text} = {value}");
    }
    // The nose turns past north by 10 degrees a second.
    assert!((value("rate(heading)", 1.05) - 10.0).abs() < 0.01);
}

#[test]
fn unknown_values_are_neither_true_nor_false() {
    assert!(value("cross_track", 5.0).is_nan());
    assert!(value("since(crash)", 5.0).is_nan());
    assert_eq!(holds("cross_track <= 2 m", 5.0), None);
    assert_eq!(holds("cross_track <= 2 m and altitude > 9 m", 5.0), Some(false));
    assert_eq!(holds("cross_track <= 2 m or altitude > 4 m", 5.0), Some(true));
}

#[test]
fn conditions_are_read_as_a_pilot_reads_them() {
    for (text, expected) in [
        ("altitude in 4..6 m", true),
        ("altitude = 5 +- 0.1 m", true),
        ("altitude = 5.2 m +- 0.1 m", false),
        ("altitude = 5.09 +- 0.1 m", true),
        ("altitude = 4.91 +- 0.1 m", true),
        ("altitude = 4.88 +- 0.1 m", false),
        ("altitude in 4.95..5.05 m", true),
        ("altitude in 5.05..6 m", false),
        ("altitude in 4..4.95 m", false),
        ("altitude < 5 m", false),
        ("altitude <= 5 m", true),
        ("armed", true),
        ("not armed", false),
        ("not (armed and altitude > 6 m)", true),
        ("(altitude + 1 m) >= 6 m", true),
        ("(altitude > 6 m or north > 20 m) and state APPROACHING 0", true),
        ("state APPROACHING 1", false),
        ("mode POS_HOLD or flying rth", false),
        ("waypoint = 2", false),
    ] {
        let expected = if text.starts_with("waypoint") { None } else { Some(expected) };
        assert_eq!(holds(text, 5.0), expected, "{text}");
    }
}

#[test]
fn instants_are_found() {
    for (text, expected) in [
        ("boot", Some(0.0)),
        ("armed", Some(2.0)),
        ("1.5 s after armed", Some(3.5)),
        ("500 ms before contact", Some(3.5)),
        ("second contact", Some(7.0)),
        ("last contact", Some(7.0)),
        ("nth 3 contact", None),
        ("contact after 1 s after contact", Some(7.0)),
        ("when altitude > 6 m", Some(6.01)),
        ("when armed", Some(2.0)),
        ("2 s after when north >= 10 m", Some(4.0)),
        ("when altitude > 6 m after armed", Some(6.01)),
        ("last_sample", Some(10.0)),
        ("crash", None),
    ] {
        let found = when(text);
        assert!(
            found.is_some() == expected.is_some()
                && (found.unwrap_or_default() - expected.unwrap_or_default()).abs() < 0.011,
            "{text}: {found:?}"
        );
    }
}

#[test]
fn what_is_wrong_is_named_with_what_is_allowed() {
    for (text, part) in [
        ("altitud <= 5 m", "[altitud] altitud is not a signal or a measure; did you mean altitude?"),
        ("altitude <= 5", "[5] the unit is missing: metres are compared; allowed: m, cm, km"),
        ("altitude <= 5 s", "[5 s] seconds do not fit: metres are compared; allowed: m, cm, km"),
        ("altitude + speed <= 5 m", "cannot be added; both sides need the same unit"),
        ("altitude = 5 m", "a tolerance is missing"),
        ("altitude in 6..4 m", "nothing is in this range"),
        ("altitude", "this number is not compared with anything; write <=, >="),
        ("altitude <= 5 m armed", "[armed] armed is not understood here"),
        ("distance(wp 3) <= 5 m", "[3] the plan has no waypoint 3; allowed: 0 to 2"),
        ("distance(wp) <= 5 m", "the number of a waypoint is expected here; write wp 2"),
        ("distance(5 m) <= 5 m", "N or S is expected here"),
        ("across(wp 0) <= 5 m", "-> is expected here; write the line as wp 0 -> wp 1"),
        ("sinse(armed) <= 5 s", "[sinse] sinse is not a function; did you mean since?"),
        ("since(contct) <= 5 s", "[contct] contct is not an event or a state; did you mean contact?"),
        (
            "since(disarmed LANDIN) <= 5 s",
            "[LANDIN] LANDIN is not a word for disarmed; did you mean LANDING?",
        ),
        ("since(ARRIVED 7) <= 5 s", "[7] the plan has no waypoint 7"),
        ("state ARIVED", "[ARIVED] ARIVED is not a state; did you mean ARRIVED?"),
        ("mode ALTHOL", "[ALTHOL] ALTHOL is not a mode; did you mean ALTHOLD?"),
        ("since(input cat) <= 5 s", "[cat] cat is not a word for input; did you mean cut?"),
        ("wrap(altitude) <= 5 m", "wrap is of an angle"),
        ("since(3 s after) <= 5 s", "[)] ) is not an event or a state"),
        ("since(3 s after", "the end is not an event or a state"),
        ("", "a number is expected here"),
    ] {
        let complaint = complaint(text);
        assert!(complaint.contains(part), "{text}: {complaint}");
    }
}

#[test]
fn deep_nesting_is_refused_not_followed() {
    let deep = format!("{}altitude{} <= 5 m", "abs(".repeat(500), ")".repeat(500));
    assert!(complaint(&deep).contains("nested too deeply"));
    let signs = format!("{}altitude <= 5 m", "-".repeat(100_000));
    assert!(complaint(&signs).contains("nested too deeply"));
    let parentheses = format!("{}armed", "(".repeat(60));
    assert!(!complaint(&parentheses).is_empty());
}

proptest::proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,60}") {
        let mut cursor = Cursor::new(&text);
        if let Err(error) = scope().read_condition(&mut cursor) {
            proptest::prop_assert!(text.get(error.span.clone()).is_some(), "{error:?}");
        }
        let mut cursor = Cursor::new(&text);
        if let Err(error) = scope().read_instant(&mut cursor) {
            proptest::prop_assert!(text.get(error.span.clone()).is_some(), "{error:?}");
        }
    }

    #[test]
    fn no_words_of_the_language_make_the_reader_panic(
        words in proptest::collection::vec(proptest::sample::select(vec![
            "altitude", "(", ")", "<=", "5 m", "..", "in", "and", "or", "not", "distance(", "wp 1", "->", "home", "since(",
            "after", "3 s", "ARRIVED 1", "of rth", "when", "armed", "+-", "=", "-", "*", "second", "place at", "at(", ",", "'",
        ]), 0..14)
    ) {
        let text = words.join(" ");
        let mut cursor = Cursor::new(&text);
        let _ = scope().read_condition(&mut cursor);
        let mut cursor = Cursor::new(&text);
        let _ = scope().read_instant(&mut cursor);
    }
}

/// Returns what an instant inside a condition is at each sample of the flight, and the number of conditions judged
/// for it.
fn during_the_flight(instant: &Instant, lookups: Option<&Lookups>) -> (Vec<Option<i64>>, usize) {
    let whole = climb_to_the_north();
    let mut trace = Trace { samples: Vec::new(), ..climb_to_the_north() };
    let mut judged = 0;
    let found = whole.samples.iter().map(|sample| {
        trace.samples.push(sample.clone());
        let evaluator = match lookups {
            None => Evaluator::new(&trace, &[]),
            Some(lookups) => Evaluator::in_flight(&trace, &[], lookups),
        };
        let found = evaluator.instant(instant);
        judged += evaluator.judged.get();
        found
    });
    (found.collect(), judged)
}

#[test]
fn nested_instants_cost_no_more_than_linear_time_in_flight_and_are_the_same() {
    let samples = climb_to_the_north().samples.len();
    for text in [
        "when altitude > 6 m",
        "when since(when altitude > 3 m) > 1 s",
        "when since(when since(when altitude > 3 m) > 0.5 s) > 0.5 s after when north >= 2 m",
        "when since(when since(when altitude > 3 m) > -1 s) > -0.5 s",
        "when distance(place at when altitude > 5 m) > 1 m",
        "second when at(altitude, when altitude > 2 m) < 3 m",
        "last when since(last when altitude > 3 m) > 1 s",
    ] {
        let mut cursor = Cursor::new(text);
        let Ok(instant) = scope().read_instant(&mut cursor) else { panic!("{text}") };
        let lookups = Lookups::default();
        let (found, judged) = during_the_flight(&instant, Some(&lookups));
        let (expected, again) = during_the_flight(&instant, None);
        assert_eq!(found, expected, "{text}");
        // A lookup begins again when an instant that it uses comes.
        assert!(judged <= 6 * samples, "{text}: {judged} conditions at {samples} samples");
        assert!(again >= 20 * samples || found.iter().flatten().count() > samples / 2, "{text}: {again}");
    }
}
