//! `docs/headless.md` against the code: every event of the JSON lines with its fields in their order, and the sample.

use std::collections::BTreeSet;

use betadeck::events::{EndpointAddresses, Event, SessionEvent};
use betadeck::geo::LatLon;
use betadeck::plan::{FlightPlan, Waypoint, WaypointType};
use betadeck::report::{End, json};
use betadeck::signals::SimTime;
use betadeck::telemetry::{
    AbortReason, BatteryAlarm, CannotHold, CrashCause, DisarmReason, EventKind, FailsafeProcedure, FaultKind,
    FaultValue, FenceAction, FirmwareEvent, FirmwareNotice, FlightTruth, Guard, GuardName, GuardOp,
    ModeFlags, NavEvent, NavState, PlanSource, Refusal, RxLossPolicy, Snapshot, TransitionReason,
    VehicleNotice, WaypointTruth,
};

/// Returns one event of each kind.
fn one_of_each() -> Vec<SessionEvent> {
    let mut plan = Box::<FlightPlan>::default();
    plan.waypoints.push(Waypoint::default());
    let guard = Guard { name: GuardName::Arrival, value: 4.0, limit: 5.0, op: GuardOp::AtMost };
    let nav = [
        NavEvent::Plan { source: PlanSource::Stored, plan },
        NavEvent::State {
            from: NavState::Approaching,
            to: NavState::Arrived,
            wp: 1,
            kind: Some(WaypointType::Hold),
            reason: TransitionReason::Arrival,
            guard: Some(guard),
            target: LatLon::new(1, 2),
            target_alt_m: 3.0,
        },
        NavEvent::Climbing(true),
        NavEvent::Limited { tilt_rad: 0.5 },
        NavEvent::Geofence { distance_m: 101.0, limit_m: 100.0, action: FenceAction::Rth },
        NavEvent::CannotHold { on: true, deviation: CannotHold::default() },
        NavEvent::Refused(Refusal::Aborted(AbortReason::Flyaway)),
        NavEvent::Disarm,
    ];
    let firmware = [
        FirmwareEvent::GpsFix { sats: 7 },
        FirmwareEvent::GpsLost { sats: 2 },
        FirmwareEvent::Armed,
        FirmwareEvent::Disarmed(DisarmReason::Landing),
        FirmwareEvent::Mode(ModeFlags::NONE),
        FirmwareEvent::RxLoss,
        FirmwareEvent::RxRecovered,
        FirmwareEvent::Failsafe { policy: RxLossPolicy::Land, stage: 2, procedure: FailsafeProcedure::Land },
        FirmwareEvent::HeadingDoubt { on: true, error_deg: 58.0 },
        FirmwareEvent::TiltDoubt { on: true, error_deg: 10.0 },
        FirmwareEvent::Battery { state: BatteryAlarm::Warning, cell_v: 3.49 },
        FirmwareEvent::Notice(FirmwareNotice::ArmAssisted),
    ];
    let firmware = firmware.into_iter().chain(nav.map(FirmwareEvent::Nav)).map(EventKind::Firmware);
    let vehicle = [
        EventKind::Boot { seed: 1, rate_hz: 1000, airframe: "iris".to_owned(), live: false },
        EventKind::Fault {
            kind: FaultKind::Motor,
            on: true,
            value: FaultValue::Motor { motor: 2, value: 0.8 },
        },
        EventKind::Contact { impact_mps: 0.5 },
        EventKind::Touchdown { impact_mps: 0.5, peak_mps2: 20.0 },
        EventKind::Crash { cause: CrashCause::HullContact },
        EventKind::BatteryEmpty { cell_v: 2.9 },
        EventKind::Notice(VehicleNotice::BackHome),
    ];
    let session = [
        SessionEvent::Endpoints(EndpointAddresses::default()),
        SessionEvent::Branch { number: 1, left: SimTime(2) },
        SessionEvent::Notice("a notice".to_owned()),
    ];
    firmware.chain(vehicle).map(SessionEvent::Vehicle).chain(session).collect()
}

/// Returns the end of a flight with one waypoint.
fn an_end() -> End {
    let waypoint = WaypointTruth {
        source: PlanSource::Stored,
        wp: 0,
        kind: WaypointType::Hold,
        miss_m: 1.0,
        alt_error_m: Some(-0.5),
        hold_max_m: Some(1.0),
        radius_m: 2.0,
        at: SimTime(1),
    };
    End {
        result: "complete".to_owned(),
        reason: "it is".to_owned(),
        truth: FlightTruth { waypoints: vec![waypoint], parked: None, battery_used_pct: Some(3.0) },
        flown_s: 1.0,
        wall_s: 1.0,
        hash: Some(1),
    }
}

/// Returns the name on the page. A new kind of event fails to compile here: it needs a row there and an event above.
fn name(kind: &SessionEvent) -> Option<&'static str> {
    match kind {
        SessionEvent::Vehicle(kind) => vehicle_name(kind),
        SessionEvent::Endpoints(_) => Some("doors"),
        SessionEvent::Branch { .. } => Some("branch"),
        SessionEvent::Notice(_)
        | SessionEvent::Warning(_)
        | SessionEvent::ArmingBlocked(_)
        | SessionEvent::Replay(_)
        | SessionEvent::Simulator(_)
        | SessionEvent::Remote(_) => Some("notice"),
        SessionEvent::FirstState { .. } | SessionEvent::FirstRc { .. } | SessionEvent::Restarted => None,
    }
}

fn vehicle_name(kind: &EventKind) -> Option<&'static str> {
    Some(match kind {
        EventKind::Boot { .. } => "boot",
        EventKind::Fault { .. } => "fault",
        EventKind::Contact { .. } => "contact",
        EventKind::Touchdown { .. } => "touchdown",
        EventKind::Crash { .. } => "crash",
        EventKind::BatteryEmpty { .. } => "battery",
        EventKind::Notice(_) => "notice",
        EventKind::Firmware(event) => match event {
            FirmwareEvent::GpsFix { .. } => "gps_fix",
            FirmwareEvent::GpsLost { .. } => "gps_lost",
            FirmwareEvent::Armed => "armed",
            FirmwareEvent::Disarmed(_) => "disarmed",
            FirmwareEvent::Mode(_) => "mode",
            FirmwareEvent::RxLoss => "rx_loss",
            FirmwareEvent::RxRecovered => "rx_recovered",
            FirmwareEvent::Failsafe { .. } => "failsafe",
            FirmwareEvent::HeadingDoubt { .. } => "heading_doubt",
            FirmwareEvent::TiltDoubt { .. } => "lean_doubt",
            FirmwareEvent::Battery { .. } => "battery",
            FirmwareEvent::Notice(_) => "notice",
            FirmwareEvent::Nav(event) => match event {
                NavEvent::Plan { .. } => "plan",
                NavEvent::State { .. } => "state",
                NavEvent::Climbing(_) => "climbing",
                NavEvent::Limited { .. } => "limited",
                NavEvent::Geofence { .. } => "geofence",
                NavEvent::CannotHold { .. } => "cannot_hold",
                NavEvent::Refused(_) => "engage_refused",
                NavEvent::Disarm => return None,
            },
        },
    })
}

/// Returns the rows of a table of the page. Each cell is the list of its names in backticks.
fn rows(table: &str) -> Vec<Vec<Vec<String>>> {
    let path = test_support::path("docs/headless.md");
    let page = std::fs::read_to_string(path).expect("docs/headless.md");
    let (_, rest) = page.split_once(&format!("<!-- {table} -->")).expect("the table");
    let (text, _) = rest.split_once(&format!("<!-- end of {table} -->")).expect("its end");
    let names = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    let rows = text.lines().filter(|line| line.starts_with("| `"));
    rows.map(|row| row.trim_matches('|').split(" | ").map(names).collect()).collect()
}

/// Panics unless the keys of a line are `t`, `event` and these fields, in this order.
#[track_caller]
fn check(line: &str, event: &str, fields: &[String]) {
    let value: serde_json::Value =
        serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"));
    assert_eq!(value["event"], event, "{line}");
    let object = value.as_object().expect("an object");
    let keys: BTreeSet<&str> = object.keys().map(String::as_str).collect();
    let expected = ["t", "event"].into_iter().chain(fields.iter().map(String::as_str));
    assert_eq!(keys, expected.clone().collect(), "{line}");
    let places: Vec<_> = expected.map(|key| line.find(&format!("\"{key}\":"))).collect();
    assert!(places.is_sorted(), "another order than on the page: {line}");
}

#[test]
fn every_event_is_on_the_page_with_its_fields() {
    let rows = rows("events");
    let row = |name: &str| {
        let found = rows.iter().find(|row| row[0] == [name]);
        found.unwrap_or_else(|| panic!("{name} is not on the page"))
    };
    let mut seen = BTreeSet::from(["end"]);
    for kind in one_of_each() {
        let expected = name(&kind);
        let line = json::event_line(&Event { time: SimTime(1_000_000), kind });
        assert_eq!(line.is_some(), expected.is_some(), "{expected:?}");
        if let (Some(line), Some(event)) = (line, expected) {
            check(&line, event, &row(event)[1]);
            seen.insert(event);
        }
    }
    let end = an_end();
    check(&json::end_line(SimTime(1), &end), "end", &row("end")[1]);
    let listed: BTreeSet<&str> = rows.iter().map(|row| row[0][0].as_str()).collect();
    assert_eq!(listed, seen, "the page has events that do not exist");
}

#[test]
fn the_nested_objects_are_as_the_page_says() {
    let rows = rows("events");
    let events = one_of_each().into_iter().filter_map(|kind| {
        let event = name(&kind).filter(|event| ["plan", "state"].contains(event))?;
        Some((event, json::event_line(&Event { time: SimTime(1), kind }).expect("a line")))
    });
    for (event, line) in events.chain([("end", json::end_line(SimTime(1), &an_end()))]) {
        let value: serde_json::Value = serde_json::from_str(&line).expect("an object");
        let nested = if event == "state" { &value["guard"] } else { &value["waypoints"][0] };
        let reported = &rows.iter().find(|row| row[0] == [event]).expect("the row")[2];
        let keys: Vec<&String> = nested.as_object().expect("an object").keys().collect();
        assert!(
            !keys.is_empty() && keys.iter().all(|key| reported.contains(key)),
            "{keys:?} in {reported:?}"
        );
    }
}

#[test]
fn the_sample_has_the_fields_of_the_page() {
    let fields: Vec<String> = rows("sample").into_iter().flat_map(|row| row[0].clone()).collect();
    assert_eq!(fields.len(), 32);
    check(&json::sample_line(&Snapshot::default()), "sample", &fields);
}
