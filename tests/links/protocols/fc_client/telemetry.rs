//! Compares the decoded telemetry of a flight with the state of the firmware itself.

use betadeck::fc::client::{Answer, Ask};
use betadeck::fc::polling::{Poll, Schedule};
use betadeck::fc::telemetry::{Mission, MissionPhase, Observation, Origin};
use betadeck::firmware::Firmware;
use betadeck::firmware::config::Configuration;
use betadeck::flight::FlightSetup;
use betadeck::msp::code;
use betadeck::plan::format::{self, Format};
use betadeck::telemetry::snapshot::{CraftView, EstimateView};
use betadeck::telemetry::{Mode, NavState};
use betadeck::vehicle::{Vehicle, VehicleCommand};

use crate::protocols::fc_client::board::{Bench, Manners};

const MESSAGES: [u16; 11] = [
    code::BOXIDS,
    code::STATUS_EX,
    code::ATTITUDE,
    code::ALTITUDE,
    code::RAW_GPS,
    code::COMP_GPS,
    code::BATTERY_STATE,
    code::RC,
    code::MOTOR,
    code::MODE_RANGES,
    code::MODE_RANGES_EXTRA,
];

fn vehicle() -> Vehicle {
    let text = include_str!("../../../../plans/square.toml");
    let plan = format::parse("square.toml", text, Format::Toml).unwrap();
    let stored = Configuration { plan: plan.plan.clone(), ..Configuration::default() };
    let (mut vehicle, _) = FlightSetup { plan, stored, ..FlightSetup::default() }.build().unwrap();
    vehicle.apply(&VehicleCommand::StartPilot(10.0)).accepted().unwrap();
    vehicle
}

fn run(vehicle: &mut Vehicle, seconds: f64) {
    for _ in 0..(seconds * 1000.0) as usize {
        vehicle.tick();
    }
}

fn observe(bench: &mut Bench, firmware: &Firmware, observation: &mut Observation) -> Mission {
    bench.board.firmware = firmware.clone();
    for code in MESSAGES {
        let payload = bench.msp(code).unwrap();
        assert!(observation.take(code, &payload), "{code}");
    }
    let status = bench.ask(Ask::MessageLine("waypoint status".to_owned()));
    let Answer::Line { text, failed: false, .. } = status else { panic!("{status:?}") };
    Mission::parse(&text).unwrap_or_else(|| panic!("{text}"))
}

/// Asserts that the two values differ by at most `step`. It allows half a step of the wire's resolution and
/// values that are cut and not rounded.
fn assert_near(reported: Option<f64>, own: Option<f64>, step: f64, what: &str) {
    assert_eq!(reported.is_some(), own.is_some(), "{what}: {reported:?}, {own:?}");
    if let (Some(reported), Some(own)) = (reported, own) {
        assert!((reported - own).abs() <= step, "{what}: {reported}, {own}");
    }
}

fn assert_craft(reported: &CraftView, firmware: &Firmware) {
    let own = &CraftView { mode_ranges: Some(firmware.mode_ranges()), ..firmware.craft_view() };
    let whole = |view: &CraftView| {
        (
            (view.armed, view.modes, view.arming_blocked_by, view.gps_fix, view.sats),
            (view.channels, view.mode_ranges.clone(), view.battery_cells, view.rc_link),
        )
    };
    assert_eq!(whole(reported), whole(own));
    let position = |view: &CraftView| view.gps.map(|gps| gps.position);
    assert_eq!(position(reported), position(own));
    assert_near(reported.gps.map(|gps| gps.alt_amsl_m), own.gps.map(|gps| gps.alt_amsl_m), 0.5, "altitude");
    assert_near(reported.battery_v, own.battery_v, 0.006, "battery V");
    assert_near(reported.battery_a, own.battery_a, 0.006, "battery A");
    assert_near(reported.battery_mah, own.battery_mah, 0.6, "battery mAh");
    for (reported, own) in std::iter::zip(reported.motors.expect("reported"), own.motors.expect("its own")) {
        assert_near(Some(reported), Some(own), 0.0011, "motor");
    }
}

fn assert_estimate(reported: &EstimateView, own: &EstimateView) {
    assert_near(reported.roll_deg, own.roll_deg, 0.051, "roll");
    assert_near(reported.pitch_deg, own.pitch_deg, 0.051, "pitch");
    let turn = reported.heading_deg.unwrap() - own.heading_deg.unwrap();
    assert!(((turn + 180.0).rem_euclid(360.0) - 180.0).abs() <= 0.51, "heading {reported:?}, {own:?}");
    // The shown values are smoothed. Places are those of the GPS and not of the filter.
    assert_near(reported.alt, own.alt, 1.0, "altitude");
    assert_near(reported.climb_mps, own.climb_mps, 0.6, "climb");
    assert_near(reported.n, own.n, 3.0, "north");
    assert_near(reported.e, own.e, 3.0, "east");
    assert_near(
        reported.ground_speed_mps,
        own.ground_speed_mps.filter(|_| reported.n.is_some()),
        1.5,
        "speed",
    );
}

#[test]
fn a_flight_that_is_reported_is_the_flight_that_is_flown() {
    let mut vehicle = vehicle();
    let mut bench = Bench::new(Manners::default());
    let mut observation = Observation::default();
    let mut seen = Vec::new();
    for second in 0..70 {
        run(&mut vehicle, 1.0);
        let firmware = vehicle.embedded().unwrap().clone();
        let mission = observe(&mut bench, &firmware, &mut observation);
        let (reported, own) = (observation.craft_view(), firmware.craft_view());
        assert_craft(&reported, &firmware);
        let origin = firmware.origin().map(|position| Origin { position, alt_amsl_m: 300.0 });
        let estimate = observation.estimate_view(origin);
        if own.has_fix() {
            assert_estimate(&estimate, &firmware.estimate_view());
        }
        if let (Some(reported), Some(own)) = (reported.home, own.home) {
            let (distance_m, _) = betadeck::geo::distance_bearing(reported, own);
            assert!(distance_m < 1.0, "home is {distance_m} m off");
        }
        let nav = firmware.nav();
        let phase = mission.phase.clone().unwrap();
        match nav.state {
            NavState::Idle => assert!(matches!(phase, MissionPhase::Inactive { .. }), "{phase:?}"),
            state => {
                assert_eq!(phase, MissionPhase::Flying(state), "{second}");
                assert_eq!((mission.waypoint, mission.count), (Some(nav.wp), Some(nav.count)));
                assert_near(mission.distance_m, nav.distance_m, 0.006, "distance");
                let bearing = nav.bearing_rad.unwrap().to_degrees();
                let turn = (mission.bearing_deg.unwrap() - bearing + 180.0).rem_euclid(360.0) - 180.0;
                assert!(turn.abs() <= 0.51, "{turn}");
                assert_near(mission.eta_s, nav.eta_s, 0.51, "eta");
                let flown = firmware.active_plan().unwrap();
                let positions: Vec<_> = mission.waypoints.iter().map(|waypoint| waypoint.position).collect();
                let wanted: Vec<_> = flown.waypoints.iter().map(|waypoint| waypoint.position).collect();
                assert_eq!(positions, wanted);
            }
        }
        seen.push((own.is_armed(), observation.is_active(Mode::Autopilot), reported.home.is_some()));
    }
    for what in [(false, false, false), (true, false, true), (true, true, true)] {
        assert!(seen.contains(&what), "{what:?}");
    }
}

#[test]
fn everything_that_is_polled_is_answered_and_understood() {
    let mut vehicle = vehicle();
    run(&mut vehicle, 6.0);
    let mut bench = Bench::new(Manners::default());
    bench.board.firmware = vehicle.embedded().unwrap().clone();
    let mut schedule = Schedule::new(None);
    let mut observation = Observation::default();
    for _ in 0..40 {
        let Some(poll) = schedule.next(true, bench.now) else {
            bench.tick();
            continue;
        };
        let answer = bench.ask(poll.ask());
        schedule.answered(poll, &answer);
        match (poll, answer) {
            (Poll::Message(code), Answer::Msp(Some(payload))) => {
                assert!(observation.take(code, &payload), "{code}");
            }
            (Poll::Mission, Answer::Line { text, .. }) => assert!(Mission::parse(&text).is_some()),
            other => panic!("{other:?}"),
        }
    }
    assert_craft(&observation.craft_view(), &bench.board.firmware);
}
