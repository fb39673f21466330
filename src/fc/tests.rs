//! Tests a link with boards whose answers the tests choose.
#![allow(clippy::disallowed_methods, reason = "the clock of a test begins somewhere")]

mod board;

use std::time::{Duration, Instant};

use tokio::sync::mpsc;

use super::*;
use crate::link::{FcStream, StreamEvent};
use crate::msp::code;
use crate::plan::AltitudeReference;
use crate::telemetry::DisarmReason;
use crate::vehicle::{LateAnswer, Message, Vehicle, VehicleCommand};
use board::{Board, Place};
use remote::{Craft, Event, Input};

const TICK: Duration = Duration::from_millis(10);
const SECOND: Duration = Duration::from_secs(1);
const FIELD: Place = Place { lat: 470_000_000, lon: 80_000_000, alt_m: 400 };
const COAST: Place = Place { lat: 540_000_000, lon: 100_000_000, alt_m: 5 };

/// The link, the board at its other end, and the notices.
struct Bench {
    vehicle: Vehicle,
    link: RemoteLink,
    board: Board,
    now: Instant,
    to_link: mpsc::Sender<StreamEvent>,
    from_link: mpsc::Receiver<Vec<u8>>,
    reported: Vec<String>,
}

impl Bench {
    fn new(board: Board) -> Self {
        let (to, from_link) = mpsc::channel(64);
        let (to_link, from) = mpsc::channel(64);
        let stream = FcStream { to, from, place: "serial:test".to_owned(), bytes_per_s: None };
        let ends = RemoteEnds { name: "serial:test".to_owned(), stream, peer: None, child: None };
        let now = Instant::now();
        let (vehicle, reported) = (Vehicle::elsewhere().unwrap(), Vec::new());
        let mut bench =
            Self { vehicle, link: RemoteLink::new(ends, now), board, now, to_link, from_link, reported };
        bench.plug_in();
        bench
    }

    fn plug_in(&mut self) {
        self.to_link.try_send(StreamEvent::Connected).unwrap();
    }

    /// Moves the cable from this board to another one.
    fn plug_into(&mut self, board: Board) {
        self.to_link.try_send(StreamEvent::Lost("it was pulled".to_owned())).unwrap();
        self.run(0.1);
        self.board = board;
        self.plug_in();
    }

    fn run(&mut self, seconds: f64) {
        let end = self.now + Duration::from_secs_f64(seconds);
        while self.now < end {
            self.now += TICK;
            let notices = self.link.exchange(&mut self.vehicle, None, self.now);
            self.reported.extend(notices.iter().map(ToString::to_string));
            while let Ok(bytes) = self.from_link.try_recv() {
                let answer = self.board.answer(&bytes);
                if !answer.is_empty() {
                    self.to_link.try_send(StreamEvent::Bytes(answer)).unwrap();
                }
            }
        }
    }

    fn reference(&self) -> AltitudeReference {
        self.vehicle.controller().altitude_reference()
    }

    fn was_reported(&self, part: &str) -> bool {
        self.reported.iter().any(|sentence| sentence.contains(part))
    }
}

#[test]
fn another_board_at_the_same_port_inherits_nothing_of_the_one_before() {
    let mut bench = Bench::new(Board { from_home: true, ..Board::at(FIELD) });
    bench.run(5.0);
    assert_eq!(bench.reference(), AltitudeReference::Home);
    bench.plug_into(Board::at(COAST));
    bench.run(5.0);
    assert_eq!(bench.reference(), AltitudeReference::SeaLevel { home_m: Some(5.0) });
    let origin = bench.vehicle.snapshot().origin.unwrap();
    assert!((origin.lat_deg() - 54.0).abs() < 1e-6, "drawn where it is: {origin:?}");
    assert!(
        bench.was_reported("count from home") && bench.was_reported("count from sea level"),
        "{:?}",
        bench.reported
    );

    bench.plug_into(Board { settings: "", ..Board::at(COAST) });
    bench.run(5.0);
    assert_eq!(bench.reference(), AltitudeReference::Unreported);
}

#[test]
fn home_is_where_a_real_craft_is_disarmed_not_where_it_was_seen_first() {
    let reference = |home_m| AltitudeReference::SeaLevel { home_m };
    let mut bench = Bench::new(Board { armed: true, answers_in_flight: true, ..Board::at(FIELD) });
    bench.board.place.alt_m = 520;
    bench.run(5.0);
    assert_eq!(bench.reference(), reference(None), "seen in flight only");
    bench.board.place.alt_m = 400;
    bench.board.armed = false;
    bench.run(5.0);
    assert_eq!(bench.reference(), reference(Some(400.0)));

    let mut bench = Bench::new(Board::at(Place { alt_m: 0, ..FIELD }));
    bench.run(5.0);
    bench.board.place.alt_m = 398;
    bench.run(1.0);
    assert_eq!(bench.reference(), reference(Some(398.0)), "its receiver has found the altitude");
    bench.board.place.alt_m = 400;
    bench.run(1.0);
    assert_eq!(bench.reference(), reference(Some(398.0)), "it wanders");
    bench.board.armed = true;
    bench.run(1.0);
    bench.board.place.alt_m = 500;
    bench.run(1.0);
    assert_eq!(bench.reference(), reference(Some(398.0)), "it flies");
}

#[test]
fn a_board_that_says_nothing_any_more_is_lost_and_another_one_when_it_speaks_again() {
    let mut bench = Bench::new(Board::at(FIELD));
    bench.run(5.0);
    assert_eq!(bench.link.protocol().view().state, RemoteState::Ready);
    bench.link.protocol_mut().permit_changes(1);
    bench.board.silent = true;
    bench.run(6.0);
    assert_eq!(bench.link.protocol().view().state, RemoteState::Lost);
    assert!(bench.was_reported("serial:test no longer answers"), "{:?}", bench.reported);
    assert_eq!(bench.vehicle.snapshot().craft.armed, None, "the last report is old");
    assert_eq!(bench.link.protocol().access(), Access::Reading);
    bench.run(20.0);
    assert_eq!(bench.reported.iter().filter(|reported| reported.contains("no longer answers")).count(), 1);

    bench.board = Board { from_home: true, ..Board::at(COAST) };
    bench.run(8.0);
    assert_eq!(
        (bench.link.protocol().view().state, bench.link.protocol().connection()),
        (RemoteState::Ready, 2)
    );
    assert_eq!(bench.reference(), AltitudeReference::Home);
    assert_eq!(bench.vehicle.snapshot().craft.armed, Some(false));
    assert_eq!(bench.link.protocol().access(), Access::Reading, "it was permitted for the one before");
}

#[test]
fn what_could_not_be_reported_in_flight_is_asked_after_it() {
    let mut bench = Bench::new(Board { armed: true, ..Board::at(FIELD) });
    bench.run(10.0);
    assert_eq!(
        (bench.link.protocol().view().state, bench.reference()),
        (RemoteState::Ready, AltitudeReference::Unreported)
    );
    assert!(
        bench.was_reported("the reference of its waypoints' altitudes is not known yet"),
        "{:?}",
        bench.reported
    );
    bench.board.armed = false;
    bench.run(5.0);
    assert_eq!(bench.reference(), AltitudeReference::SeaLevel { home_m: Some(400.0) });
    assert!(!bench.link.protocol().view().opens_cli);
    assert!(
        bench.reported.last().unwrap().contains("its waypoints' altitudes count from sea level"),
        "{:?}",
        bench.reported
    );
}

#[test]
fn what_a_line_sets_is_known_soon_after() {
    let mut bench = Bench::new(Board::at(FIELD));
    bench.run(5.0);
    let radius_m = |bench: &Bench| bench.vehicle.controller().settings_view().unwrap().arrival_radius_m;
    assert!((radius_m(&bench) - 5.0).abs() < 1e-9);
    bench.board.settings = "ap_waypoint_arrival_radius = 700\r\n";
    bench.run(3.0);
    assert!((radius_m(&bench) - 5.0).abs() < 1e-9, "nothing says that it changed");
    let line = "set ap_waypoint_arrival_radius = 700";
    bench.vehicle.apply(&VehicleCommand::single_line(line));
    bench.run(3.0);
    assert!((radius_m(&bench) - 7.0).abs() < 1e-9);
    assert_eq!(bench.link.protocol().view().state, RemoteState::Ready);
    let asked = bench.board.lines.iter().filter(|line| *line == "get ap_").count();
    bench.run(5.0);
    assert_eq!(bench.board.lines.iter().filter(|line| *line == "get ap_").count(), asked, "once");
}

#[test]
fn a_craft_that_its_pilot_disarms_is_disarmed_by_the_switch() {
    for (switch_is_on, reason) in [(false, DisarmReason::Switch), (true, DisarmReason::Unknown)] {
        let mut bench = Bench::new(Board::at(FIELD));
        bench.run(5.0);
        (bench.board.armed, bench.board.arm_us) = (true, 1900);
        bench.run(2.0);
        // Regardless of the last poll: the switch is reported after the disarming.
        bench.board.armed = false;
        bench.board.arm_us = if switch_is_on { 1900 } else { 1000 };
        bench.run(1.0);
        assert_eq!(bench.vehicle.controller().last_disarm(), Some(reason));
    }
}

#[test]
fn every_question_is_asked_once_and_answered_before_it_counts_as_ready() {
    let mut bench = Bench::new(Board::at(FIELD));
    while bench.link.protocol().view().state != RemoteState::Ready {
        bench.run(0.01);
    }
    assert_eq!(
        bench.board.lines,
        ["get ap_", "get trust_mag", "get alt_hold_", "get min_check", "waypoint list"]
    );
}

#[test]
fn the_motors_of_a_real_craft_are_those_that_it_tells() {
    let mut bench = Bench::new(Board::at(FIELD));
    assert_eq!(bench.vehicle.snapshot().craft.motors, None);
    bench.run(5.0);
    assert_eq!(bench.vehicle.snapshot().craft.motors, Some([0.5; 4]));
}

#[test]
fn what_does_not_say_that_it_is_betaflight_is_of_no_use() {
    let mut bench = Bench::new(Board { variant: None, ..Board::at(FIELD) });
    bench.run(5.0);
    assert!(
        matches!(bench.link.protocol().view().state, RemoteState::Unusable(_)),
        "{:?}",
        bench.link.protocol().view().state
    );
    assert!(bench.was_reported("does not identify itself"), "{:?}", bench.reported);
}

#[test]
fn a_return_home_can_be_taken_back_as_long_as_its_switch_is_on() {
    let is_on = |bench: &Bench| {
        rescue::is_on(
            bench.link.protocol().msp().unwrap().observer(),
            &bench.vehicle.transmitter().sticks().channels,
        )
    };
    let mut bench = Bench::new(Board::at(FIELD));
    assert_eq!(is_on(&bench), None, "no switch was reported");
    bench.run(5.0);
    assert_eq!(is_on(&bench), Some(false));
    bench.vehicle.apply(&VehicleCommand::ReturnHome);
    bench.run(0.1);
    assert_eq!(is_on(&bench), Some(true));
    bench.vehicle.apply(&VehicleCommand::CancelReturn);
    bench.run(0.1);
    assert_eq!(is_on(&bench), Some(false));
}

#[test]
fn the_timeout_is_when_something_is_due() {
    let craft = Craft {
        name: "the board".to_owned(),
        place: "serial:test".to_owned(),
        bytes_per_s: None,
        is_fed: false,
        is_child: false,
        is_in_steps: false,
    };
    let (mut board, mut now) = (Board::at(FIELD), Duration::ZERO);
    let mut remote = Remote::new(craft, now);
    assert_eq!(remote.timeout(), None, "nothing is due without a connection");
    remote.handle(Input::Connected, now);
    // The clock jumps from one timeout to the next.
    let mut step = |remote: &mut Remote, board: &mut Board| {
        now = now.max(remote.timeout().unwrap());
        remote.handle_timeout(now);
        while let Some(bytes) = remote.poll_transmit() {
            remote.handle(Input::Received(&board.answer(&bytes)), now);
        }
        now
    };
    for _ in 0..30 {
        step(&mut remote, &mut board);
    }
    assert_eq!(remote.state(), RemoteState::Ready);
    let begun = step(&mut remote, &mut board);
    let steps =
        std::iter::repeat_with(|| step(&mut remote, &mut board)).take_while(|at| *at < begun + SECOND);
    let steps = steps.count();
    assert!((10..300).contains(&steps), "{steps} steps in a second");
    board.silent = true;
    let silent = step(&mut remote, &mut board);
    let lost = std::iter::repeat_with(|| (step(&mut remote, &mut board), remote.state()));
    let (lost, _) = lost.take(100).find(|(_, state)| *state == RemoteState::Lost).unwrap();
    assert!((2..8).contains(&(lost - silent).as_secs()), "{:?}", lost - silent);
}

#[test]
fn a_message_to_a_child_that_boots_waits_for_its_connection() {
    let craft = |is_child| Craft {
        name: "the child".to_owned(),
        place: "tcp:here:1".to_owned(),
        bytes_per_s: None,
        is_fed: true,
        is_child,
        is_in_steps: false,
    };
    let request = |vehicle: &mut Vehicle| {
        let message = Message { code: code::API_VERSION, payload: Vec::new(), clock: None };
        vehicle.apply(&message.into());
        let (ticket, request) = vehicle.remote_mut().unwrap().take_request().unwrap();
        Input::Requested(ticket, request)
    };
    let answers = |remote: &mut Remote| {
        let events = std::iter::from_fn(|| remote.poll_event());
        events
            .filter_map(|event| if let Event::Answered(_, answer) = event { Some(answer) } else { None })
            .collect::<Vec<_>>()
    };
    let now = Duration::ZERO;
    let (mut vehicle, mut board) = (Vehicle::elsewhere().unwrap(), Board::at(FIELD));
    let mut remote = Remote::new(craft(true), now);
    remote.handle(request(&mut vehicle), now);
    let nothing: Vec<LateAnswer> = Vec::new();
    assert_eq!(answers(&mut remote), nothing, "it boots");
    remote.handle(Input::Connected, now);
    for _ in 0..3 {
        remote.handle_timeout(now);
        while let Some(bytes) = remote.poll_transmit() {
            remote.handle(Input::Received(&board.answer(&bytes)), now);
        }
    }
    assert_eq!(answers(&mut remote), [LateAnswer::Msp(Some(vec![0, 1, 49]))]);

    remote.handle(request(&mut vehicle), now);
    remote.handle_timeout(now);
    remote.handle(Input::Lost("it restarts"), now);
    assert_eq!(answers(&mut remote), nothing, "the end of the client's link is the answer");
    remote.handle(request(&mut vehicle), now);
    remote.handle(Input::NotStarted("it is gone"), now);
    assert_eq!(answers(&mut remote), [LateAnswer::Msp(None)], "it never boots");

    let mut attached = Remote::new(craft(false), now);
    attached.handle(request(&mut vehicle), now);
    assert_eq!(answers(&mut attached), [LateAnswer::Msp(None)], "nobody may ever start it");
}
