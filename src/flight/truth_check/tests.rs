use super::*;
use crate::plan::estimate::{ReturnFlight, ReturnMode, TouchdownThrottle};
use crate::plan::{Altitude, Waypoint, WaypointType};
use crate::signals::SimTime;
use crate::telemetry::{GuardName, GuardOp};

const SETTINGS: SettingsView = SettingsView {
    profile: crate::telemetry::FirmwareProfile::Guide,
    arrival_radius_m: 5.0,
    hold_radius_m: 2.0,
    orbit_radius_m: 10.0,
    figure8_width_m: 20.0,
    fence_m: None,
    max_angle_deg: 25.0,
    max_velocity_mps: 10.0,
    max_turn_rate_dps: 3.0,
    climb_mps: 5.0,
    landing_mps: 0.5,
    landing_alt_m: 4.0,
    min_nav_alt_m: 5.0,
    buildup_deg: 8.0,
    position_p: 30.0,
    return_flight: ReturnFlight { mode: ReturnMode::Highest, climb_m: 10.0, fixed_m: 30.0 },
    touchdown_throttle: TouchdownThrottle { hover_us: 1275.0, threshold_us: 100.0, min_us: 1100.0 },
    hover_stick_us: 1500,
    raised_stick_us: 1300,
    sink_stick_us: None,
};

/// A check of a plan with one waypoint of this kind, 20 m above the origin of the frame.
struct Bench {
    check: TruthCheck,
    frame: LocalFrame,
    kind: WaypointType,
    craft: CraftTruth,
}

impl Bench {
    fn new(kind: WaypointType) -> Self {
        let craft = CraftTruth {
            time: SimTime::ZERO,
            ne: Vector2::new(-50.0, 0.0),
            alt_m: 20.0,
            speed_mps: 5.0,
            stick_override: false,
            climbing: false,
        };
        let mut bench =
            Self { check: TruthCheck::new(10.0), frame: LocalFrame::new(40.0, -79.0, 300.0), kind, craft };
        bench.plan(PlanSource::Stored);
        bench
    }

    fn plan(&mut self, source: PlanSource) {
        let mut plan = Box::<FlightPlan>::default();
        let position = LatLon::from_degrees(40.0, -79.0);
        plan.waypoints.push(Waypoint {
            position,
            kind: self.kind,
            altitude: Altitude::above_home(20.0),
            ..Waypoint::default()
        });
        self.follow(&NavEvent::Plan { source, plan });
    }

    fn follow(&mut self, event: &NavEvent) {
        self.check.follow(event, &self.craft, &SETTINGS, &self.frame);
    }

    fn enter(&mut self, to: NavState, reason: TransitionReason, guard: Option<Guard>) {
        self.enter_at(to, reason, guard, LatLon::from_degrees(40.0, -79.0));
    }

    fn enter_at(&mut self, to: NavState, reason: TransitionReason, guard: Option<Guard>, target: LatLon) {
        self.follow(&NavEvent::State {
            from: NavState::Idle,
            to,
            wp: 0,
            kind: Some(self.kind),
            reason,
            guard,
            target,
            target_alt_m: 20.0,
        });
    }

    fn fly_to(&mut self, north_m: f64) {
        self.craft.ne.x = north_m;
        self.craft.time.0 += 1_000_000;
        self.check.look(&self.craft);
    }

    fn waypoints(&self) -> Vec<WaypointTruth> {
        self.check.truth(&self.craft, None).waypoints
    }
}

#[test]
fn a_waypoint_that_the_firmware_does_not_show_is_not_measured() {
    let mut bench = Bench::new(WaypointType::Flyover);
    let state = |to| NavEvent::State {
        from: NavState::Idle,
        to,
        wp: 2,
        kind: None,
        reason: TransitionReason::Advance,
        guard: None,
        target: LatLon::default(),
        target_alt_m: 0.0,
    };
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    for to in [NavState::Approaching, NavState::Arrived, NavState::Complete] {
        bench.follow(&state(to));
        bench.fly_to(-10.0);
    }
    assert_eq!(bench.waypoints(), []);
}

#[test]
fn a_flyover_is_measured_at_its_closest_and_a_flyby_from_its_turn_radius() {
    let turn = Guard { name: GuardName::TurnRadius, value: 5.0, limit: 5.5, op: GuardOp::AtMost };
    for (kind, reason, miss_m, radius_m) in [
        (WaypointType::Flyover, TransitionReason::Plane, 7.0, 5.0),
        (WaypointType::Flyby, TransitionReason::TurnRadius, 1.5, 0.0),
        (WaypointType::Flyby, TransitionReason::Arrival, 7.0, 5.0),
    ] {
        let mut bench = Bench::new(kind);
        bench.enter(NavState::Approaching, TransitionReason::Reset, None);
        for north_m in [-30.0, -7.0, -8.0] {
            bench.fly_to(north_m);
        }
        bench.enter(NavState::Arrived, reason, Some(turn));
        let truth = bench.waypoints()[0];
        assert!((truth.miss_m - miss_m).abs() < 1e-9 && truth.at == SimTime(2_000_000), "{truth:?}");
        assert!((truth.radius_m - radius_m).abs() < 1e-9 && truth.alt_error_m == Some(0.0), "{truth:?}");
    }
}

#[test]
fn a_flyby_of_a_firmware_that_tells_no_turn_radius_is_measured_from_that_of_its_speed() {
    let mut bench = Bench::new(WaypointType::Flyby);
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    for north_m in [-30.0, -7.0] {
        bench.fly_to(north_m);
    }
    bench.enter(NavState::Arrived, TransitionReason::Arrival, None);
    let truth = bench.waypoints()[0];
    assert!(truth.miss_m <= 7.0 && truth.radius_m == 0.0, "{truth:?}");
}

#[test]
fn a_waypoint_that_is_left_by_a_command_does_not_count() {
    let mut bench = Bench::new(WaypointType::Hold);
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    bench.enter(NavState::Arrived, TransitionReason::Arrival, None);
    bench.enter(NavState::Holding, TransitionReason::Hold, None);
    bench.fly_to(80.0);
    assert!((bench.waypoints()[0].miss_m - 80.0).abs() < 1e-9, "reported while it lasts");
    bench.enter(NavState::Approaching, TransitionReason::SetCurrent, None);
    assert!(bench.waypoints().is_empty());
    bench.enter(NavState::Holding, TransitionReason::Hold, None);
    bench.fly_to(80.0);
    bench.plan(PlanSource::Rth);
    bench.enter(NavState::Approaching, TransitionReason::ReturnHome, None);
    assert!(bench.waypoints().is_empty());
}

#[test]
fn a_hold_by_command_is_not_one_of_the_waypoint() {
    let mut bench = Bench::new(WaypointType::Hold);
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    bench.fly_to(60.0);
    bench.enter(NavState::Holding, TransitionReason::HoldHere, None);
    bench.fly_to(80.0);
    assert!(bench.waypoints().is_empty());
    bench.enter(NavState::Approaching, TransitionReason::Resume, None);
    bench.fly_to(1.0);
    bench.enter(NavState::Arrived, TransitionReason::Arrival, None);
    bench.enter(NavState::Holding, TransitionReason::Hold, None);
    bench.fly_to(1.0);
    assert!((bench.waypoints()[0].miss_m - 1.0).abs() < 1e-9);
}

#[test]
fn the_last_run_of_a_waypoint_counts() {
    let mut bench = Bench::new(WaypointType::Flyover);
    for closest_m in [40.0, 3.0] {
        bench.plan(PlanSource::Stored);
        bench.enter(NavState::Approaching, TransitionReason::Resume, None);
        bench.fly_to(closest_m);
        bench.enter(NavState::Arrived, TransitionReason::Plane, None);
    }
    let misses: Vec<f64> = bench.waypoints().iter().map(|waypoint| waypoint.miss_m.round()).collect();
    assert_eq!(misses, [3.0]);
}

#[test]
fn what_the_pilot_flies_past_does_not_count() {
    let mut bench = Bench::new(WaypointType::Flyover);
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    bench.fly_to(-40.0);
    bench.craft.stick_override = true;
    bench.fly_to(0.0);
    bench.enter(NavState::Arrived, TransitionReason::Plane, None);
    assert!(bench.waypoints().is_empty());
}

#[test]
fn a_landing_after_a_wait_tells_both() {
    let mut bench = Bench::new(WaypointType::Land);
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    bench.enter(NavState::Holding, TransitionReason::Loiter, None);
    bench.fly_to(4.0);
    bench.enter(NavState::Landing, TransitionReason::HoldTime, None);
    bench.fly_to(1.0);
    bench.enter(NavState::Complete, TransitionReason::Touchdown, None);
    let truth = bench.waypoints()[0];
    assert!((truth.miss_m - 1.0).abs() < 1e-9 && truth.alt_error_m.is_none(), "{truth:?}");
    assert!(truth.hold_max_m.is_some_and(|waited| (waited - 4.0).abs() < 1e-9), "{truth:?}");
}

#[test]
fn a_landing_that_starts_again_elsewhere_after_an_outage_is_measured_from_the_place_in_the_plan() {
    let mut bench = Bench::new(WaypointType::Land);
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    bench.enter(NavState::Landing, TransitionReason::Land, None);
    bench.enter(NavState::Idle, TransitionReason::GivenUp(crate::telemetry::AbortReason::GpsLost), None);
    bench.fly_to(74.0);
    let blown_to = LatLon::from_degrees(40.0 + 74.0 / 111_319.5, -79.0);
    bench.enter_at(NavState::Landing, TransitionReason::Resume, None, blown_to);
    bench.enter_at(NavState::Complete, TransitionReason::Touchdown, None, blown_to);
    let truth = bench.check.truth(&bench.craft, None);
    assert!((truth.waypoints[0].miss_m - 74.0).abs() < 0.5, "{truth:?}");
    assert!(
        bench.check.worst_miss(&truth).is_some_and(|reported| reported.contains("the craft touched down 7"))
    );
}

#[test]
fn a_craft_parked_at_the_end_is_reported_with_its_speed() {
    let mut bench = Bench::new(WaypointType::Flyover);
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    bench.enter(NavState::Arrived, TransitionReason::Arrival, None);
    bench.enter(NavState::Complete, TransitionReason::Advance, None);
    bench.fly_to(33.0);
    let truth = bench.check.truth(&bench.craft, None);
    let parked = truth.parked.unwrap();
    assert!(parked.distance_m.is_some_and(|distance| (distance - 33.0).abs() < 1e-9), "{parked:?}");
    assert!((parked.speed_mps - 5.0).abs() < 1e-9);
    assert!(
        bench.check.worst_miss(&truth).is_some_and(|reported| reported.contains("33.0 m off at the end"))
    );
}

/// Returns the altitude error of a hold at 20 m with a tolerance of 10 m, for the altitudes of each second.
fn held(altitudes_m: &[f64]) -> f64 {
    let mut bench = Bench::new(WaypointType::Hold);
    bench.craft.alt_m = altitudes_m[0];
    bench.enter(NavState::Approaching, TransitionReason::Reset, None);
    bench.fly_to(0.0);
    bench.enter(NavState::Arrived, TransitionReason::Arrival, None);
    bench.enter(NavState::Holding, TransitionReason::Hold, None);
    for &alt_m in altitudes_m {
        bench.craft.alt_m = alt_m;
        bench.fly_to(0.0);
    }
    bench.waypoints()[0].alt_error_m.expect("an altitude error")
}

#[test]
fn a_hold_counts_its_altitude_from_half_the_tolerance_on() {
    assert!((held(&[16.0, 5.0, 20.0]) + 15.0).abs() < 1e-9, "it was at its altitude and fell");
    assert!(held(&[12.0, 9.0, 20.0]).abs() < 1e-9, "it was still on its way up");
}
