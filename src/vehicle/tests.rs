//! Tests of the vehicle.

use std::sync::Arc;

use super::*;
use crate::firmware::cli::CliMode;
use crate::geo::LatLon;
use crate::pilot::StickInput;
use crate::sim::{Fault, WorldCommand};
use crate::telemetry::{FirmwareProfile, TransitionReason};

fn config() -> VehicleConfig {
    VehicleConfig {
        world: WorldConfig::default(),
        firmware: FirmwareOptions::default(),
        configuration: Configuration::default(),
        live: false,
    }
}

fn vehicle() -> Vehicle {
    Vehicle::new(config()).unwrap()
}

fn run(vehicle: &mut Vehicle, until_s: f64) {
    while vehicle.time().as_secs_f64() < until_s {
        vehicle.tick();
    }
}

/// Runs a CLI line. Returns `true` if it is refused.
fn is_refused(vehicle: &mut Vehicle, session: CliSession, line: &str) -> bool {
    match vehicle.apply(&VehicleCommand::line(session, line)) {
        Answer::Now(Reply::Line(said)) => said.failed,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_session_of_the_command_line_keeps_its_state_until_it_ends() {
    let mut vehicle = vehicle();
    let client = CliSession::Client(1);
    for session in [client, CliSession::Console] {
        assert!(!is_refused(&mut vehicle, session, "batch start"));
    }
    assert!(is_refused(&mut vehicle, client, "nonsense"));
    assert!(!is_refused(&mut vehicle, CliSession::Console, "batch end"), "the other batch has not failed");
    assert!(is_refused(&mut vehicle.clone(), client, "batch end"), "a copy continues");
    for end in [
        VehicleCommand::EndCli(client),
        VehicleCommand::BeginCli(client, CliMode::Framed),
        VehicleCommand::EndAllCli,
    ] {
        let mut vehicle = vehicle.clone();
        vehicle.apply(&end);
        assert!(!is_refused(&mut vehicle, client, "batch end"), "{end:?}");
    }
    let single = CliSession::Single(CliMode::Interactive);
    assert!(!is_refused(&mut vehicle, single, "batch start") && is_refused(&mut vehicle, single, "nonsense"));
    assert!(!is_refused(&mut vehicle, single, "batch end"), "each line is a session of its own");
}

#[test]
fn lost_events_are_reported() {
    let mut vehicle = vehicle();
    for _ in 0..100 {
        // Refused because the craft is not armed.
        assert!(vehicle.apply(&VehicleCommand::ReturnHome).accepted().is_err());
    }
    vehicle.tick();
    let mut notices = Vec::new();
    vehicle.drain_events(|event| {
        if let EventKind::Notice(notice) = event.kind {
            notices.push(notice.to_string());
        }
    });
    assert_eq!(notices, ["Too many events of the firmware came between two steps; lost: the last 36."]);
}

#[test]
fn after_a_reset_faults_and_sticks_count_from_the_next_engagement() {
    counts_from_the_next_engagement(vehicle());
    counts_from_the_next_engagement(Vehicle::with_external_physics(config()).unwrap());
}

fn counts_from_the_next_engagement(mut vehicle: Vehicle) {
    let input = StickInput { channel: 0, value_us: 1900, at_s: 0.5, for_s: Some(0.2), from_boot: false };
    vehicle.apply(&VehicleCommand::HoldChannel(input));
    vehicle.apply(&WorldCommand::parse("fault=gps-loss@0.5").unwrap().into()).accepted().unwrap();
    for engaged_s in [1.0, 3.0] {
        run(&mut vehicle, engaged_s);
        assert_eq!(vehicle.engaged_at(), None);
        let engaged = NavEvent::State {
            from: NavState::Idle,
            to: NavState::Approaching,
            wp: 0,
            kind: None,
            reason: TransitionReason::Reset,
            guard: None,
            target: LatLon::default(),
            target_alt_m: 0.0,
        };
        vehicle.note_nav_event(&engaged, vehicle.time());
        run(&mut vehicle, engaged_s + 0.4);
        let stick = |vehicle: &Vehicle| {
            let facts = vehicle.controller.pilot_facts(vehicle.time());
            vehicle.transmitter.clone().frame(&facts, vehicle.engaged_at()).unwrap().channels[0]
        };
        assert_eq!((stick(&vehicle), vehicle.snapshot().world.faults.len()), (1500, 0));
        run(&mut vehicle, engaged_s + 0.6);
        assert_eq!((stick(&vehicle), vehicle.snapshot().world.faults.len()), (1900, 1));
        vehicle.apply(&VehicleCommand::ResetCraft);
    }
}

#[test]
fn a_craft_put_back_home_knows_nothing_of_the_fall() {
    let mut vehicle = vehicle();
    run(&mut vehicle, 4.0);
    vehicle.apply(&WorldCommand::FaultOn(Fault::Teleport([0.0, 0.0, 30.0]), None).into()).accepted().unwrap();
    // A slow tick, so that barometer and GPS have just reported.
    run(&mut vehicle, 5.0);
    vehicle.apply(&VehicleCommand::ResetCraft);
    run(&mut vehicle, 15.0);
    let estimate = vehicle.embedded().unwrap().altitude_m();
    assert!(estimate.abs() < 1.0, "{estimate}");
    let flags = vehicle.embedded().unwrap().arming_flags();
    assert!(!flags.has(crate::telemetry::ArmingFlag::Angle), "{flags:?}");
}

#[test]
fn of_a_vehicle_elsewhere_nothing_is_made_up() {
    let mut vehicle = Vehicle::elsewhere().unwrap();
    run(&mut vehicle, 1.0);
    let snapshot = vehicle.snapshot();
    assert_eq!((snapshot.truth, snapshot.origin, snapshot.nav), (None, None, None));
    assert_eq!(snapshot.craft, crate::telemetry::snapshot::CraftView::default());
    let mut events = 0;
    vehicle.drain_events(|_| events += 1);
    assert_eq!(events, 0);

    let place = LatLon::new(473_977_000, 85_456_000);
    vehicle.set_origin(LocalFrame::new(place.lat_deg(), place.lon_deg(), 488.0));
    let snapshot = vehicle.snapshot();
    assert_eq!((snapshot.origin, snapshot.truth), (Some(place), None), "a place is not the craft's");
}

#[test]
fn a_wind_that_the_program_adds_is_the_air_at_the_craft_and_of_its_copies() {
    let mut vehicle = vehicle();
    let wind = Vector3::new(3.0, -4.0, 1.0);
    vehicle.set_added_wind(wind).unwrap();
    run(&mut vehicle, 0.005);
    let begun = vehicle.truth().unwrap().wind_enu;
    assert!(begun.norm() < wind.norm(), "it comes in over a tick of the air: {begun}");
    let mut copy = vehicle.clone();
    for vehicle in [&mut vehicle, &mut copy] {
        run(vehicle, 0.05);
        assert!((vehicle.truth().unwrap().wind_enu - wind).norm() < 1e-12);
    }
    vehicle.apply(&VehicleCommand::ResetCraft);
    let mut again = vehicle.again(|_| ()).unwrap().unwrap();
    for refused in [Vector3::new(61.0, 0.0, 0.0), Vector3::new(f64::NAN, 0.0, 0.0)] {
        assert!(vehicle.set_added_wind(refused).is_err(), "{refused}");
        assert!(again.set_added_wind(refused).is_err(), "{refused}");
    }
    for vehicle in [&mut vehicle, &mut again] {
        run(vehicle, 0.1);
        assert!((vehicle.truth().unwrap().wind_enu - wind).norm() < 1e-12, "the air stays");
    }
    let mut external = Vehicle::with_external_physics(config()).unwrap();
    assert_eq!(external.set_added_wind(wind), Err(WorldError::Outside));
}

#[test]
fn a_remote_firmware_has_a_twin_with_its_settings_in_the_same_air_or_at_the_place_of_the_real_craft() {
    let mut configuration = Configuration::default();
    for (name, number) in [("ap_profile", 1), ("ap_max_angle", 33), ("align_mag", 2)] {
        configuration.settings.set_number(name, number).unwrap();
    }
    let telemetry =
        RemoteTelemetry { configuration: Some(Arc::new(configuration)), ..RemoteTelemetry::default() };
    let air = WorldConfig { wind: "5@270".parse().unwrap(), ..WorldConfig::default() };
    let mut simulated = Vehicle::with_remote_controller(air).unwrap();
    assert!(simulated.twin().unwrap().is_none(), "it has reported no settings");
    let mut real = Vehicle::elsewhere().unwrap();
    for vehicle in [&mut simulated, &mut real] {
        vehicle.remote_mut().unwrap().deliver_telemetry(telemetry.clone());
    }
    assert!(real.twin().unwrap().is_none(), "its place is unknown");
    real.set_origin(LocalFrame::new(47.0, 8.0, 488.0));

    let twin = simulated.twin().unwrap().unwrap();
    let settings = &twin.embedded().unwrap().configuration().settings;
    assert_eq!((settings.number("ap_max_angle"), settings.number("align_mag")), (33, 2));
    assert_eq!(twin.controller().profile(), Some(FirmwareProfile::Master));
    assert_eq!(twin.world_status().unwrap().wind, "5@270".parse().unwrap());
    let twin = real.twin().unwrap().unwrap();
    let settings = &twin.embedded().unwrap().configuration().settings;
    assert_eq!((settings.number("ap_max_angle"), settings.number("align_mag")), (33, 0));
    assert_eq!(twin.local_frame().map(|frame| (frame.lat_deg, frame.alt_amsl_m)), Some((47.0, 488.0)));
    let modes = &twin.embedded().unwrap().configuration().modes;
    assert_ne!(modes, &Configuration::default().modes, "the pilot has switches");
}
