//! Clients of the links with a remote flight controller: their requests reach it, and its answers reach them.

#![allow(clippy::disallowed_methods, reason = "the request handler is given its time")]

use std::net::SocketAddr;
use std::time::{Duration, Instant};

use betadeck::link::proto::command_line::{LineReply, LineSource};
use betadeck::link::{ClientId, ListenConfig, Listeners, Request};
use betadeck::plan::{Altitude, FlightPlan, Waypoint};
use betadeck::session::{Handled, Persistence, RequestHandler};
use betadeck::signals::RcFrame;
use betadeck::storage::Store;
use tokio::sync::{mpsc, oneshot};

use super::*;

const CLIENT: ClientId = ClientId(1);
/// The code of MSP_API_VERSION.
const API_VERSION: u16 = 1;

/// The rig and a request handler of the links.
struct Links {
    rig: Rig,
    handler: RequestHandler,
    persistence: Persistence,
    now: Instant,
}

impl Links {
    async fn new() -> Self {
        let closed = ListenConfig { tcp_port: None, ws_port: None, rc_port: None, ..ListenConfig::default() };
        let (doors, _) = Listeners::open(&closed, mpsc::channel(1).0).await;
        let mut rig = Rig::new();
        Self {
            handler: RequestHandler::new(doors.restart_signal()),
            persistence: Persistence::new(Store::in_memory(), &mut rig.vehicle, true),
            rig,
            now: Instant::now(),
        }
    }

    fn handle(&mut self, request: Request) -> Handled {
        self.handler.handle(request, &mut self.rig.vehicle, &mut self.persistence, self.now)
    }

    fn message(&mut self, code: u16) -> oneshot::Receiver<Option<Vec<u8>>> {
        let (reply, answer) = oneshot::channel();
        self.handle(Request::Msp { code, payload: Vec::new(), reply });
        answer
    }

    fn line(&mut self, line: &str) -> oneshot::Receiver<LineReply> {
        let (reply, answer) = oneshot::channel();
        let (line, source) = (line.to_owned(), LineSource::Prompt);
        self.handle(Request::Cli { client: CLIENT, line, source, reply });
        answer
    }

    /// Lets the stand-in answer, and passes its answers on.
    fn exchange(&mut self) {
        self.rig.run(0.001 * (DELAY + 2) as f64);
        while let Some((ticket, answer)) = self.rig.vehicle.take_answer() {
            self.handler.deliver(ticket, answer);
        }
    }
}

#[tokio::test]
async fn a_client_speaks_with_the_remote_flight_controller() {
    let mut links = Links::new().await;
    let mut version = links.message(API_VERSION);
    let mut setting = links.line("get ap_max_angle");
    let mut nonsense = links.line("nonsense");
    let mut unknown = links.message(9999);
    assert!(version.try_recv().is_err() && setting.try_recv().is_err(), "not yet");
    links.exchange();
    let expected = links.rig.stand_in.firmware.run_msp(API_VERSION, &[], None).reply;
    assert!(expected.is_some() && version.try_recv().unwrap() == expected);
    let said = setting.try_recv().unwrap();
    assert!(said.text.contains("ap_max_angle = ") && !said.refused, "{said:?}");
    assert!(nonsense.try_recv().unwrap().refused);
    assert_eq!(unknown.try_recv().unwrap(), None);
}

#[tokio::test]
async fn what_a_client_sets_is_set_there_and_stored_there() {
    let mut links = Links::new().await;
    let (reply, mut admitted) = oneshot::channel();
    links.handle(Request::EnterCli { client: CLIENT, interactive: true, reply });
    assert!(admitted.try_recv().unwrap(), "it is not known to be armed");
    let mut set = links.line("set ap_max_angle = 33");
    let mut save = links.line("save");
    links.exchange();
    assert!(!set.try_recv().unwrap().refused && !save.try_recv().unwrap().refused);
    assert_eq!(links.rig.stand_in.firmware.parameters().nav.max_angle, 33);
    assert_eq!(links.rig.stand_in.restarts, 0, "it restarts by itself, nobody asks it to");
}

#[tokio::test]
async fn a_line_of_a_person_is_typed_at_the_prompt_until_the_person_leaves() {
    let mut links = Links::new().await;
    let enter = |interactive| {
        let (reply, _admitted) = oneshot::channel();
        Request::EnterCli { client: CLIENT, interactive, reply }
    };
    let _by_message = links.line("get ap_max_angle");
    links.handle(enter(false));
    let _framed = links.line("get ap_max_angle");
    links.handle(Request::LeftCli { client: CLIENT });
    links.exchange();
    assert_eq!(links.rig.stand_in.typed, [] as [&str; 0]);
    links.handle(enter(true));
    let _typed = links.line("nonsense");
    links.handle(Request::LeftCli { client: CLIENT });
    links.exchange();
    assert_eq!(links.rig.stand_in.typed, ["nonsense", ""]);
    // A restart closes the prompt.
    links.handle(enter(true));
    links.handler.after_restart(true, &mut links.rig.vehicle);
    links.handle(Request::LeftCli { client: CLIENT });
    links.exchange();
    assert_eq!(links.rig.stand_in.typed, ["nonsense", ""]);
}

#[tokio::test]
async fn a_restart_ends_the_wait_for_a_message_but_not_for_the_line_that_caused_it() {
    let mut links = Links::new().await;
    let (mut message, mut line) = (links.message(API_VERSION), links.line("save"));
    links.handler.after_restart(true, &mut links.rig.vehicle);
    assert_eq!(message.try_recv(), Err(oneshot::error::TryRecvError::Closed));
    links.exchange();
    assert!(!line.try_recv().unwrap().refused);
}

#[tokio::test]
async fn a_client_of_a_silent_flight_controller_gets_an_error() {
    let mut links = Links::new().await;
    let mut version = links.message(API_VERSION);
    let mut line = links.line("status");
    links.now += Duration::from_secs(599);
    links.handler.give_up_overdue(links.now);
    assert!(version.try_recv().is_err() && line.try_recv().is_err(), "it may still answer");
    links.now += Duration::from_secs(2);
    links.handler.give_up_overdue(links.now);
    assert_eq!(version.try_recv().unwrap(), None);
    let said = line.try_recv().unwrap();
    assert_eq!(said.text, "###ERROR: THE FLIGHT CONTROLLER DOES NOT ANSWER###");
    assert!(said.refused);
    // A late answer has no recipient.
    links.exchange();
}

#[tokio::test]
async fn a_craft_that_may_be_armed_is_not_restarted_by_a_client_that_leaves() {
    let mut links = Links::new().await;
    assert!(!links.handle(Request::Restart).restarted);
    links.exchange();
    assert_eq!(links.rig.stand_in.restarts, 0);
}

#[tokio::test]
async fn scripts_and_simulators_are_heard_beside_a_remote_flight_controller() {
    let mut links = Links::new().await;
    let from: SocketAddr = "127.0.0.1:9".parse().unwrap();
    let at = links.now;
    let handled = links.handle(Request::Fdm { datagram: vec![1, 2, 3], from, at });
    assert_eq!(handled.fdm, Some((vec![1, 2, 3], at)));
    let mut frame = RcFrame::SAFE;
    frame.channels[0] = 1600;
    links.handle(Request::Rc { stamp_s: 0.0, frame, at });
    links.exchange();
    let roll = links.rig.stand_in.firmware.craft_view().channels.unwrap()[0];
    assert_eq!(roll, 1600);
}

fn plan() -> FlightPlan {
    let mut plan = FlightPlan::default();
    plan.waypoints.push(Waypoint { altitude: Altitude::above_home(20.0), ..Waypoint::default() });
    plan
}

#[test]
fn a_flight_without_a_session_cannot_upload_to_a_remote_flight_controller() {
    let mut rig = Rig::new();
    let upload = VehicleCommand::upload(plan(), Vec::new());
    let refused = rig.vehicle.apply(&upload).accepted().unwrap_err();
    assert_eq!(refused.to_string(), "a remote flight controller accepts a plan only in a session");
}
