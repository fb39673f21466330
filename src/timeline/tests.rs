//! A flight and its replay are the same to the last bit, whatever the inputs.

use super::*;
use crate::firmware::cli::CliMode;
use crate::firmware::config::Configuration;
use crate::firmware::{FirmwareOptions, msp};
use crate::msp::{Access, code};
use crate::plan::builtin::{BuiltinPlan, DEMO};
use crate::signals::{RcFrame, RcSource};
use crate::sim::{WorldCommand, WorldConfig};
use crate::telemetry::{InFlightCommand, Turbulence};
use crate::vehicle::{Answer, CliSession, FlightController, Message, Reply, VehicleCommand, VehicleConfig};

/// Key frames every second, so that a short flight has many.
const BOUNDS: Bounds = Bounds {
    interval_us: 1_000_000,
    dense_us: u64::MAX,
    sparse_interval_us: 0,
    reach_us: u64::MAX,
    input_bytes: usize::MAX,
    key_frames: usize::MAX,
};

/// Returns the whole vehicle as text, to the last bit of every number that is printed.
fn picture(vehicle: &Vehicle) -> String {
    let mut vehicle = vehicle.clone();
    vehicle.keep_inputs(false);
    vehicle.drain_events(drop);
    format!("{vehicle:?}")
}

fn vehicle() -> Vehicle {
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    let world = WorldConfig { turbulence: Turbulence::Moderate, ..WorldConfig::default() };
    let config = VehicleConfig { world, firmware: FirmwareOptions::default(), configuration, live: true };
    Vehicle::new(config).unwrap()
}

const CLIENT: CliSession = CliSession::Client(7);

fn line(vehicle: &mut Vehicle, session: CliSession, line: &str) {
    let _reported = vehicle.apply(&VehicleCommand::line(session, line));
}

fn message(vehicle: &mut Vehicle, code: u16, payload: &[u8]) {
    let _reported = vehicle.apply(&Message::of(code, payload.to_vec()).into());
}

/// Applies the inputs before a tick of the flight.
fn done(vehicle: &mut Vehicle, command: &VehicleCommand) {
    assert!(matches!(vehicle.apply(command), Answer::Now(Reply::Done)), "{command:?}");
}

fn move_stick(vehicle: &mut Vehicle, channel: usize, value_us: u16) {
    let mut sticks = vehicle.transmitter().sticks();
    sticks.channels[channel] = value_us;
    done(vehicle, &VehicleCommand::Sticks(sticks));
}

fn happen(tick: u64, vehicle: &mut Vehicle) {
    let world = |vehicle: &mut Vehicle, line: &str| {
        vehicle.apply(&VehicleCommand::from(WorldCommand::parse(line).unwrap())).accepted().unwrap();
    };
    match tick {
        500 => {
            let demo = BuiltinPlan::find(DEMO).unwrap().read().unwrap();
            let _reported = vehicle.apply(&VehicleCommand::upload(demo.plan, demo.settings));
        }
        880 => done(vehicle, &VehicleCommand::BeginCli(CLIENT, CliMode::Framed)),
        900 => line(vehicle, CliSession::Console, "batch start"),
        910 => line(vehicle, CLIENT, "batch start"),
        920 => line(vehicle, CLIENT, "nonsense"),
        950 => line(vehicle, CliSession::Console, "set ap_max_angle = 33"),
        1000 => line(vehicle, CliSession::Console, "batch end"),
        1400 => done(vehicle, &VehicleCommand::EndCli(CLIENT)),
        20_100 => done(vehicle, &VehicleCommand::EndAllCli),
        1003 => done(vehicle, &VehicleCommand::CliOpened),
        1200 => {
            let kept = vehicle.controller().configuration().cloned().unwrap();
            done(vehicle, &VehicleCommand::Restart(Box::new(kept)));
        }
        1300 => world(vehicle, "wind=4@270"),
        // The pilot waits for the fix first.
        1500 => vehicle.apply(&VehicleCommand::StartPilot(3.0)).accepted().unwrap(),
        15_300 => done(vehicle, &VehicleCommand::InFlight(InFlightCommand::HoldHere)),
        15_800 => done(vehicle, &VehicleCommand::InFlight(InFlightCommand::GoTo(2))),
        16_000 => world(vehicle, "fault=gps-loss,2"),
        17_000 => {
            done(vehicle, &VehicleCommand::StopPilot);
            move_stick(vehicle, 0, 1620);
        }
        17_500 => done(vehicle, &VehicleCommand::CutRc(true)),
        18_100 => {
            done(vehicle, &VehicleCommand::CutRc(false));
            done(vehicle, &VehicleCommand::SticksFirst(true));
        }
        18_700 => {
            let _refused = vehicle.apply(&VehicleCommand::ReturnHome);
        }
        19_200 => done(vehicle, &VehicleCommand::CancelReturn),
        19_500 => message(vehicle, code::SET_NAME, b"replayed"),
        20_000 => done(vehicle, &VehicleCommand::ResetCraft),
        20_500..22_000 if tick.is_multiple_of(7) => {
            let mut frame = RcFrame::SAFE;
            frame.channels[3] = 1500 + (tick % 90) as u16;
            done(vehicle, &VehicleCommand::Rc(frame, RcSource::Udp));
        }
        22_000..23_000 if tick.is_multiple_of(10) => {
            let frame: Vec<u8> = (0..8).flat_map(|n| (1400 + n + (tick % 50) as u16).to_le_bytes()).collect();
            message(vehicle, code::SET_RAW_RC, &frame);
            // This message only asks.
            message(vehicle, code::STATUS, &[]);
        }
        _ => {}
    }
}

/// Returns a flight with inputs of all kinds, its recording, and its pictures at some instants.
fn flight() -> (Timeline, Vehicle, Vec<(SimTime, String)>) {
    let mut vehicle = vehicle();
    let mut timeline = Timeline::within(BOUNDS, &mut vehicle).unwrap();
    let mut pictures = Vec::new();
    for tick in 0..24_000 {
        // Before the inputs of this instant.
        if tick % 1487 == 3 || matches!(tick, 1 | 1001 | 1201 | 2000 | 17_001 | 20_000 | 20_001) {
            pictures.push((vehicle.time(), picture(&vehicle)));
        }
        happen(tick, &mut vehicle);
        timeline.record(&mut vehicle);
        vehicle.tick();
        vehicle.drain_events(drop);
    }
    (timeline, vehicle, pictures)
}

#[test]
fn replayed_instants_are_the_flight_to_the_last_bit() {
    let (mut timeline, head, pictures) = flight();
    let armed = pictures.iter().filter(|(_, text)| text.contains("armed: true")).count();
    assert!(armed > 3, "the flight flies");
    // Forwards, and there and back.
    let count = pictures.len();
    let order = (0..count).chain((0..count).map(|n| n * 17 % count));
    for at in order {
        let (time, expected) = &pictures[at];
        assert_eq!(timeline.show(*time, head.time()), Shown::Earlier);
        let shown = picture(timeline.shown().unwrap());
        assert!(shown == *expected, "at {time:?} {}", first_difference(&shown, expected));
    }
    assert_eq!(timeline.show(head.time(), head.time()), Shown::Newest);
}

#[test]
fn a_flight_ends_at_the_very_instant_of_the_next_reset() {
    let (timeline, head, _) = flight();
    let (reset, _) = timeline
        .recording
        .inputs()
        .find(|(_, input)| matches!(input, crate::vehicle::VehicleCommand::ResetCraft))
        .expect("the craft is put back");
    assert_eq!(timeline.flight_ends(SimTime(reset.0 - 1)), Some(reset));
    assert_eq!(timeline.flight_ends(reset), Some(reset), "the reset is not part of the flight before it");
    assert!(reset < head.time() && timeline.flight_ends(head.time()).is_none(), "the last flight goes on");
}

/// Returns the first difference of two pictures.
fn first_difference(a: &str, b: &str) -> String {
    let at = a.bytes().zip(b.bytes()).take_while(|(a, b)| a == b).count().saturating_sub(60);
    let part = |text: &str| text.chars().skip(at).take(160).collect::<String>();
    format!("{}\n{}", part(a), part(b))
}

#[test]
fn playing_tick_by_tick_shows_what_seeking_shows() {
    let (mut timeline, head, pictures) = flight();
    let (start, (end, expected)) = (&pictures[2], &pictures[6]);
    timeline.show(start.0, head.time());
    while timeline.shown().unwrap().time() < *end {
        assert_eq!(timeline.play(1, head.time()), Shown::Earlier);
    }
    assert!(picture(timeline.shown().unwrap()) == *expected);
}

#[test]
fn a_branch_forgets_what_came_after_it_and_can_itself_be_replayed() {
    let (mut timeline, head, pictures) = flight();
    let (time, expected) = &pictures[pictures.len() / 2];
    timeline.show(*time, head.time());
    let mut vehicle = timeline.fly_on().unwrap();
    assert!(picture(&vehicle) == *expected);
    assert_eq!((timeline.branch(), timeline.shown().is_none()), (1, true));
    assert!(timeline.fly_on().is_none(), "nothing earlier is shown");

    // Another flight from here on with other sticks.
    let mut later = None;
    for tick in 0..5000 {
        if tick == 1700 {
            move_stick(&mut vehicle, 1, 1700);
        }
        if tick == 3333 {
            later = Some((vehicle.time(), picture(&vehicle)));
        }
        timeline.record(&mut vehicle);
        vehicle.tick();
    }
    for (time, expected) in [later.unwrap(), (*time, expected.clone())] {
        timeline.show(time, vehicle.time());
        assert!(picture(timeline.shown().unwrap()) == expected, "at {time:?}");
    }
}

#[test]
fn a_seek_before_the_recording_shows_its_beginning() {
    let mut vehicle = vehicle();
    (0..50).for_each(|_| vehicle.tick());
    let mut timeline = Timeline::within(BOUNDS, &mut vehicle).unwrap();
    assert_eq!(timeline.first(), None);
    for _ in 0..50 {
        timeline.record(&mut vehicle);
        vehicle.tick();
    }
    timeline.show(SimTime::ZERO, vehicle.time());
    assert_eq!(timeline.shown().map(Vehicle::time), timeline.first());
    assert_eq!(timeline.first(), Some(SimTime(50_000)));
}

#[test]
fn what_runs_elsewhere_is_not_recorded() {
    let config = VehicleConfig {
        world: WorldConfig::default(),
        firmware: FirmwareOptions::default(),
        configuration: Configuration::default(),
        live: true,
    };
    assert!(Timeline::new(&mut Vehicle::with_external_physics(config).unwrap()).is_none());
    let mut remote = Vehicle::with_remote_controller(WorldConfig::default()).unwrap();
    assert!(matches!(remote.controller(), FlightController::Remote(_)));
    assert!(Timeline::new(&mut remote).unwrap().is_pictures());
    assert!(Timeline::new(&mut Vehicle::elsewhere().unwrap()).is_none());
}

#[test]
fn the_flight_of_a_remote_firmware_can_be_looked_at_and_not_flown_again() {
    let mut vehicle = Vehicle::with_remote_controller(WorldConfig::default()).unwrap();
    let mut timeline = Timeline::new(&mut vehicle).unwrap();
    while vehicle.time() < SimTime(3_000_000) {
        timeline.record(&mut vehicle);
        vehicle.tick();
    }
    let head = vehicle.time();
    assert_eq!(timeline.show(SimTime(1_234_000), head), Shown::Earlier);
    assert_eq!(timeline.shown().unwrap().time(), SimTime(1_300_000), "the next picture");
    // Playing goes on from the instant, not from the picture.
    for (ticks, time) in [(50, 1_300_000), (20, 1_400_000), (1000, 2_400_000)] {
        assert_eq!(timeline.play(ticks, head), Shown::Earlier);
        assert_eq!(timeline.shown().unwrap().time(), SimTime(time));
    }
    assert!(timeline.fly_on().is_none());
    assert!(timeline.shown().is_some(), "the instant is still shown");
    assert_eq!(timeline.play(10_000, head), Shown::Newest);
}

#[test]
fn messages_that_only_ask_are_no_inputs() {
    let mut vehicle = vehicle();
    assert!(vehicle.keep_inputs(true));
    for kind in msp::MESSAGES.iter().map(|message| message.kind).filter(|kind| kind.access != Access::Write) {
        let before = picture(&vehicle);
        message(&mut vehicle, kind.code, &[0; 8]);
        assert!(!vehicle.has_inputs(), "{}", kind.name);
        assert!(picture(&vehicle) == before, "{} changes something", kind.name);
    }
}
