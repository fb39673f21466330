//! A craft that speaks MAVLink, over a simulated link.

use std::time::Duration;

use super::*;
use crate::mavlink::MissionItem;
use crate::mavlink::craft::{
    Answer, CraftOptions, CraftProtocol, CraftState, FlightMode, Identity, Lifetime, PeerId, RequestKind,
};
use crate::mavlink::frame::{Frame, Version};
use crate::mavlink::message::{Attitude, Heartbeat, Message};
use crate::mavlink::state::GeoPosition;
use crate::mavlink::value::MissionResult;
use crate::plan::builtin::BuiltinPlan;
use crate::plan::{FlightPlan, plan_lines};
use crate::telemetry::snapshot::Snapshot;
use crate::vehicle::Vehicle;

const HOME: GeoPosition = GeoPosition { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl: 300.0 };
const PEER: PeerId = PeerId(1);
const STEP: Duration = Duration::from_millis(20);

/// A ground station and a craft, which take requests as the test says.
struct Rig {
    craft: CraftProtocol,
    state: CraftState,
    station: MavlinkCraft,
    vehicle: Vehicle,
    now: Duration,
    said: Vec<String>,
    answers: Vec<(Ticket, LateAnswer)>,
    /// The missions that the craft was sent.
    missions: Vec<Vec<MissionItem>>,
    modes: usize,
    takes: bool,
}

impl Rig {
    fn new(identity: Identity) -> Self {
        let options = CraftOptions { identity, max_mission: 100, ..CraftOptions::default() };
        let state = CraftState {
            mode: Some(FlightMode::Acro),
            position: Some(HOME),
            altitude_above_home: Some(0.0),
            home: Some(HOME),
            attitude: Some([0.1, 0.2, 1.0]),
            ..CraftState::default()
        };
        let mut rig = Self {
            craft: CraftProtocol::new(options),
            state,
            station: MavlinkCraft::new("the craft".to_owned()),
            vehicle: Vehicle::elsewhere().unwrap(),
            now: Duration::ZERO,
            said: Vec::new(),
            answers: Vec::new(),
            missions: Vec::new(),
            modes: 0,
            takes: true,
        };
        assert!(rig.craft.connect(rig.now, PEER, Lifetime::UntilDisconnected));
        rig
    }

    fn run(&mut self, seconds: f64) {
        let end = self.now + Duration::from_secs_f64(seconds);
        while self.now < end {
            self.now += STEP;
            self.step(true);
        }
    }

    fn step(&mut self, is_heard: bool) {
        self.craft.advance(self.now, self.now, &self.state);
        while let Some((_, bytes)) = self.craft.poll_transmit() {
            if is_heard {
                self.station.handle(Input::Received(&bytes), self.now);
            }
        }
        self.station.handle_timeout(self.now);
        while let Some(bytes) = self.station.poll_transmit() {
            self.craft.receive(self.now, PEER, &bytes);
        }
        while let Some(request) = self.craft.poll_request() {
            match request.kind {
                RequestKind::Mission { items, .. } => {
                    let result = if self.takes { MissionResult::Accepted } else { MissionResult::Denied };
                    if self.takes {
                        self.craft.set_mission(items.clone());
                    }
                    self.missions.push(items);
                    self.craft.answer(request.ticket, Answer::Mission(result), &[]);
                }
                RequestKind::SetMode(_) => {
                    self.modes += 1;
                    self.craft.answer(request.ticket, Answer::Command(CommandResult::Accepted), &[]);
                }
                other => panic!("{other:?}"),
            }
        }
        while let Some(event) = self.station.poll_event() {
            match event {
                Event::Notice(notice) => self.said.push(notice.to_string()),
                Event::Answered(ticket, answer) => self.answers.push((ticket, answer)),
                _ => {}
            }
        }
        if let Some(place) = self.station.first_fix() {
            self.vehicle.set_origin(place);
        }
        let frame = self.vehicle.local_frame().copied();
        self.station.deliver(self.vehicle.remote_mut().unwrap(), frame.as_ref(), self.now);
        self.vehicle.tick();
    }

    /// Runs a line, and returns its answer: `true` for a refusal, and the text.
    fn line(&mut self, line: &str) -> (bool, String) {
        let asked = crate::vehicle::VehicleCommand::single_line(line);
        let crate::vehicle::Answer::Later(ticket) = self.vehicle.apply(&asked) else { panic!("{line}") };
        let (_, request) = self.vehicle.remote_mut().unwrap().take_request().unwrap();
        self.station.handle(Input::Requested(ticket, request), self.now);
        for _ in 0..1000 {
            self.run(0.02);
            if let Some(at) = self.answers.iter().position(|(answered, _)| *answered == ticket) {
                let (_, LateAnswer::Cli(reply)) = self.answers.remove(at) else { panic!("{line}") };
                return (reply.failed, reply.text);
            }
        }
        panic!("no answer to {line}: {:?}", self.said);
    }

    fn snapshot(&self) -> Snapshot {
        self.vehicle.snapshot()
    }

    fn plan(&self) -> Option<FlightPlan> {
        self.snapshot().stored_plan
    }

    fn permit(&mut self) {
        self.station.permit_changes(self.station.connection());
    }
}

fn square() -> FlightPlan {
    BuiltinPlan::find("square").unwrap().read().unwrap().plan
}

#[test]
fn a_craft_is_read_without_permission_and_its_mode_has_its_own_name() {
    for (identity, kind) in [
        (Identity::Generic, "a quadcopter"),
        (Identity::Ardupilot, "an ArduPilot quadcopter"),
        (Identity::Px4, "a PX4 quadcopter"),
    ] {
        let mut rig = Rig::new(identity);
        rig.run(3.0);
        let seen = rig.snapshot();
        assert!(rig.said[0].contains(&format!("answers: {kind}")), "{:?}", rig.said);
        assert_eq!(seen.craft.armed, Some(false));
        assert_eq!(seen.craft.mode_name.as_deref(), Some("Acro"));
        assert!((seen.estimate.pitch_deg.unwrap() - 0.2_f64.to_degrees()).abs() < 0.1);
        assert!(seen.estimate.n.unwrap().abs() < 0.1 && seen.estimate.alt.unwrap().abs() < 0.1);
        assert!(seen.origin.is_some());
        assert_eq!(rig.station.view().access, Access::Reading);
    }
}

#[test]
fn a_mode_is_changed_with_permission_only_and_nothing_arms_the_craft() {
    let mut rig = Rig::new(Identity::Ardupilot);
    rig.run(3.0);
    let (failed, said) = rig.line("mode Stabilize");
    assert!(failed && said.contains("not permitted"), "{said}");
    assert_eq!(rig.modes, 0);
    rig.permit();
    assert_eq!(rig.line("mode Stabilize"), (false, "accepted\r\n".to_owned()));
    assert_eq!(rig.modes, 1);
    let (failed, said) = rig.line("mode Warp");
    assert!(failed && said.contains("no such mode"), "{said}");
    assert!(rig.line("mode").1.contains("Stabilize"));
    assert!(rig.line("arm").0 && rig.line("motor 1 1500").0);
    assert!(rig.line("status").1.contains("mode: Acro, disarmed"));
}

#[test]
fn an_upload_is_sent_as_a_mission_and_read_back_equal() {
    for identity in [Identity::Generic, Identity::Ardupilot, Identity::Px4] {
        let mut rig = Rig::new(identity);
        rig.run(3.0);
        assert_eq!(rig.plan(), Some(FlightPlan::default()), "an empty mission was read");
        assert!(rig.line("waypoint clear").0, "not permitted yet");
        rig.permit();
        for line in plan_lines(&square()) {
            assert!(!rig.line(&line).0, "{line}");
        }
        assert!(!rig.line("set ap_max_angle = 20").0);
        let (failed, text) = rig.line("waypoint list");
        assert!(!failed, "{text}");
        assert_eq!(text.lines().collect::<Vec<_>>(), plan_lines(&square()).collect::<Vec<_>>());
        assert_eq!(rig.missions.len(), 1);
        rig.run(0.1);
        assert_eq!(rig.plan(), Some(square()));
        assert!(
            rig.said.iter().any(|said| said.contains("1 settings of the plan are not sent")),
            "{:?}",
            rig.said
        );
        // The plan stays the one that was sent when its mission is read again.
        rig.line("waypoint list");
        assert_eq!(rig.plan(), Some(square()));
    }
}

#[test]
fn a_refused_mission_leaves_the_old_one_and_gives_the_reason() {
    let mut rig = Rig::new(Identity::Px4);
    rig.run(3.0);
    rig.permit();
    rig.takes = false;
    for line in plan_lines(&square()) {
        rig.line(&line);
    }
    let (failed, text) = rig.line("waypoint list");
    assert!(failed && text.contains("the craft refused the mission: it takes no mission now"), "{text}");
    assert_eq!(rig.plan(), Some(FlightPlan::default()));
    assert_eq!(rig.line("waypoint list"), (false, "waypoint clear\r\n".to_owned()), "it is not sent again");
}

#[test]
fn silence_ends_the_connection_and_its_permission_and_the_craft_comes_back() {
    let mut rig = Rig::new(Identity::Generic);
    rig.run(3.0);
    rig.permit();
    for _ in 0..200 {
        rig.now += STEP;
        rig.step(false);
    }
    assert_eq!((rig.station.view().state, rig.station.access()), (RemoteState::Lost, Access::Reading));
    assert_eq!(rig.snapshot().craft.armed, None);
    assert!(rig.said.iter().any(|said| said.contains("no heartbeat has arrived for 3 s")), "{:?}", rig.said);
    let before = rig.station.connection();
    rig.run(2.0);
    assert_eq!((rig.station.view().state, rig.station.access()), (RemoteState::Ready, Access::Reading));
    assert!(rig.station.connection() > before);
    assert_eq!(rig.snapshot().craft.armed, Some(false));
}

#[test]
fn a_connection_that_comes_back_at_once_needs_a_new_permission_and_sends_nothing_that_was_begun_before() {
    let mut rig = Rig::new(Identity::Generic);
    rig.run(3.0);
    rig.permit();
    rig.line("waypoint clear");
    let before = rig.station.connection();
    rig.station.handle(Input::Lost("the other end closed the connection"), rig.now);
    assert_eq!(rig.station.view().state, RemoteState::Lost);
    rig.run(2.0);
    assert_eq!((rig.station.view().state, rig.station.access()), (RemoteState::Ready, Access::Reading));
    assert!(rig.station.connection() > before);
    assert!(!rig.line("waypoint list").0);
    assert!(rig.missions.is_empty());
}

#[test]
fn values_that_are_no_numbers_are_not_shown() {
    let mut rig = Rig::new(Identity::Generic);
    rig.run(1.0);
    let attitude = Attitude { roll: f32::NAN, pitch: f32::INFINITY, yaw: f32::NAN, ..Attitude::default() };
    let heartbeat = Heartbeat { autopilot: 3, r#type: 255, custom_mode: u32::MAX, ..Heartbeat::default() };
    for (sequence, message) in [Message::from(attitude), heartbeat.into()].into_iter().enumerate() {
        let frame =
            Frame { version: Version::V2, sequence: sequence as u8, system: 1, component: 1, message };
        rig.station.handle(Input::Received(&frame.encode().unwrap()), rig.now);
        rig.run(0.1);
    }
    assert!(rig.snapshot().estimate.roll_deg.is_none_or(f64::is_finite));
}

proptest::proptest! {
    #[test]
    fn any_bytes_and_any_line_are_survived(bytes: Vec<u8>, line: String) {
        let mut station = MavlinkCraft::new("the craft".to_owned());
        station.handle(Input::Received(&bytes), STEP);
        station.handle_timeout(STEP);
        drop(lines::parse(&line));
    }
}
