//! A flight for tests of reports: a climb, a leg to the north-east, and a landing, in light wind.

use nalgebra::Vector2;

use super::{FlightReport, ReportedSettings, Verdict};
use crate::geo::{LatLon, LocalFrame};
use crate::plan::feature::{Feature, Shape, Vertex, Zone};
use crate::plan::{Altitude, FlightPlan, Waypoint, WaypointType};
use crate::report::record::{Boot, FlightRecord, RecordedSample, Transition};
use crate::report::route::Route;
use crate::signals::SimTime;
use crate::telemetry::signal::{Signal, SignalValues};
use crate::telemetry::snapshot::{SettingsView, WindView, WorldView};
use crate::telemetry::{
    FlightTruth, Guard, GuardName, GuardOp, NavState, PlanSource, TransitionReason, WaypointTruth,
};

/// Seconds of the flight.
const FLOWN_S: u32 = 60;

fn frame() -> LocalFrame {
    LocalFrame::new(40.4635, -79.5182, 300.0)
}

fn position(north_m: f64, east_m: f64) -> LatLon {
    let (lat_deg, lon_deg, _) = frame().to_geodetic(nalgebra::Vector3::new(east_m, north_m, 0.0));
    LatLon::from_degrees(lat_deg, lon_deg)
}

fn at(seconds: f64) -> SimTime {
    SimTime::from_secs_f64(seconds)
}

/// Returns a report about a plan of this name over a field of this name.
pub(in crate::report) fn report(name: &str, field: &str) -> FlightReport {
    let mut plan = FlightPlan::default();
    for (north_m, kind) in [(80.0, WaypointType::Flyover), (0.0, WaypointType::Land)] {
        plan.waypoints.push(Waypoint {
            position: position(north_m, north_m / 2.0),
            altitude: Altitude::above_home(20.0),
            kind,
            ..Waypoint::default()
        });
    }
    let ring = [(20.0, -30.0), (60.0, -30.0), (60.0, -5.0)];
    let vertex = |(north_m, east_m)| Vertex { position: position(north_m, east_m), altitude_m: f32::NAN };
    let field = Feature {
        name: field.to_owned(),
        shape: Shape::Area(vec![ring.map(vertex).into()]),
        zone: Some(Zone::Exclusion),
    };
    FlightReport {
        kind: "Flight of a plan".to_owned(),
        name: name.to_owned(),
        verdict: Verdict {
            passed: Some(true),
            word: "complete".to_owned(),
            reason: format!("mission complete, {name} is over"),
        },
        facts: vec![("firmware".to_owned(), "embedded".to_owned())],
        record: record(),
        route: Some(Route::new(&plan, &frame(), &SettingsView::default())),
        fence_m: Some(150.0),
        frame: Some(frame()),
        backdrop: vec![field],
        ground: vec![(at(10.0), 0.0), (at(70.0), 4.0)],
        truth: truth(),
        tolerance_m: Some(10.0),
        flown_s: Some(f64::from(FLOWN_S)),
        settings: Some(ReportedSettings::Changed(vec![["ap_max_angle", "25", "50"].map(str::to_owned)])),
        command: Some(format!("betadeck fly '{name}' --wind 3@270")),
    }
}

fn record() -> FlightRecord {
    let sample = |tenth: u32| {
        let time = f64::from(tenth) / 10.0;
        let share = (time / f64::from(FLOWN_S) * std::f64::consts::PI).sin();
        let mut values = SignalValues::UNKNOWN;
        let ne = Vector2::new(80.0 * share, 40.0 * share);
        for (signal, value) in [
            (Signal::North, ne.x),
            (Signal::East, ne.y),
            (Signal::Altitude, 20.0 * share),
            (Signal::EstAltitude, 20.0 * share + 0.3),
            (Signal::Battery, 12.6 - 0.01 * time),
            (Signal::Wind, 3.0 + (time / 4.0).sin()),
        ] {
            values.set(signal, value);
        }
        let state = if time < 40.0 { NavState::Approaching } else { NavState::Landing };
        RecordedSample { time: at(10.0 + time), values, state: Some(state), modes: None }
    };
    let guard = Guard::new(GuardName::Arrival, 1.9, GuardOp::AtMost, 2.0);
    let transition = |seconds, from, to, wp, kind, reason, guard| Transition {
        time: at(10.0 + seconds),
        from,
        to,
        wp,
        kind: Some(kind),
        reason,
        guard,
    };
    FlightRecord {
        samples: (0..=10 * FLOWN_S).map(sample).collect(),
        transitions: vec![
            transition(
                0.0,
                NavState::Idle,
                NavState::Approaching,
                0,
                WaypointType::Flyover,
                TransitionReason::Reset,
                None,
            ),
            transition(
                40.0,
                NavState::Approaching,
                NavState::Landing,
                1,
                WaypointType::Land,
                TransitionReason::Arrival,
                Some(guard),
            ),
        ],
        sentences: vec![(at(3.0), "Armed.".to_owned()), (at(70.0), "Disarmed: landed.".to_owned())],
        engaged_at: Some(at(10.0)),
        touchdown_at: Some(at(69.0)),
        boot: Some(Boot { seed: 7, rate_hz: 1000, airframe: "iris".to_owned() }),
        world: Some(WorldView {
            wind: Some(WindView { speed_mps: 3.0, from_deg: 270.0 }),
            gust_mps: 1.0,
            noise: true,
            ..WorldView::default()
        }),
        ..FlightRecord::default()
    }
}

fn truth() -> FlightTruth {
    let waypoint = |wp, kind, miss_m, seconds| WaypointTruth {
        source: PlanSource::Stored,
        wp,
        kind,
        miss_m,
        alt_error_m: (kind != WaypointType::Land).then_some(-0.4),
        hold_max_m: None,
        radius_m: 2.0,
        at: at(10.0 + seconds),
    };
    FlightTruth {
        waypoints: vec![
            waypoint(0, WaypointType::Flyover, 0.83, 30.0),
            waypoint(1, WaypointType::Land, 0.1, 59.0),
        ],
        parked: None,
        battery_used_pct: Some(4.23),
    }
}
