//! A session with clients at its doors: their effects on the flight and on each other.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use betadeck::events::{Event, SessionEvent};
use betadeck::firmware::FirmwareOptions;
use betadeck::firmware::config::Configuration;
use betadeck::link::endpoint::EndpointKind;
use betadeck::link::proto::command_line::{LineReply, LineSource};
use betadeck::link::{ClientId, ListenConfig, Listeners, Request};
use betadeck::session::ReplyTo;
use betadeck::session::command::Seek;
use betadeck::session::{Command, Endpoints, Handle, RequestHandler, SessionConfig, SessionView, start};
use betadeck::signals::RcFrame;
use betadeck::sim::WorldConfig;
use betadeck::storage::Store;
use betadeck::telemetry::{ArmingFlag, Snapshot};
use betadeck::vehicle::{Vehicle, VehicleCommand, VehicleConfig};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::{mpsc, oneshot, watch};

/// Nothing in these tests takes this long unless it hangs.
const PATIENCE: Duration = Duration::from_secs(600);

/// A session with a TCP door.
struct Rig {
    session: Handle,
    requests: mpsc::Sender<Request>,
    doors: Listeners,
    _views: watch::Sender<Vec<betadeck::link::endpoint::EndpointStatus>>,
}

async fn rig() -> Rig {
    let (requests, inbox) = mpsc::channel(256);
    let only_tcp =
        ListenConfig { tcp_port: Some(0), ws_port: None, rc_port: None, ..ListenConfig::default() };
    let (doors, first) = Listeners::open(&only_tcp, requests.clone()).await;
    let (views_tx, views) = watch::channel(first);
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    let config = VehicleConfig {
        world: WorldConfig::default(),
        firmware: FirmwareOptions::default(),
        configuration,
        live: true,
    };
    let handler = RequestHandler::new(doors.restart_signal());
    let session = start(SessionConfig {
        vehicle: Vehicle::new(config).unwrap(),
        store: Store::in_memory(),
        starter_modes: true,
        speed: 1.0,
        takeoff_m: 10.0,
        is_recorded: true,
        endpoints: Some(Endpoints { requests: inbox, handler, status: views, simulator: None }),
        remote: None,
        first_events: Vec::new(),
    })
    .unwrap();
    Rig { session, requests, doors, _views: views_tx }
}

impl Rig {
    /// Waits for the first picture that matches.
    async fn picture(&mut self, what: &str, wanted: impl Fn(&SessionView) -> bool) {
        let waiting = self.session.view.wait_for(wanted);
        let found = tokio::time::timeout(PATIENCE, waiting).await;
        assert!(matches!(found, Ok(Ok(_))), "no picture of {what}");
    }

    async fn console(&self, line: &str) {
        let (reply, answer) = ReplyTo::channel();
        self.session.commands.send(Command::Cli { line: line.to_owned(), reply }).await.unwrap();
        answer.await.unwrap();
    }

    /// Opens the command line over TCP, as a person does.
    async fn person(&self) -> TcpStream {
        let mut stream = TcpStream::connect(self.doors.address(EndpointKind::Tcp).unwrap()).await.unwrap();
        stream.write_all(b"#").await.unwrap();
        let mut greeting = Vec::new();
        while !greeting.ends_with(b"# ") {
            greeting.push(stream.read_u8().await.unwrap());
        }
        stream
    }
}

fn is_blocked_by_cli(view: &SessionView) -> bool {
    view.vehicle.craft.arming_flags().has(ArmingFlag::Cli)
}

/// Returns a request that the firmware takes long to answer.
fn long_question(client: u64) -> Request {
    let (reply, _nobody_listens) = oneshot::channel();
    Request::Cli { client: ClientId(client), line: "dump all".to_owned(), source: LineSource::Framed, reply }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn clients_that_never_stop_asking_do_not_stop_time() {
    let mut rig = rig().await;
    let done = &AtomicBool::new(false);
    std::thread::scope(|scope| {
        for client in 0..3 {
            let requests = rig.requests.clone();
            scope.spawn(move || {
                while !done.load(Ordering::Relaxed) && requests.blocking_send(long_question(client)).is_ok() {
                }
            });
        }
        tokio::task::block_in_place(|| {
            tokio::runtime::Handle::current().block_on(async {
                rig.picture("two seconds of flight", |view| view.vehicle.time.as_secs_f64() > 2.0).await;
                // Commands of the user interface are handled, too.
                rig.session.commands.send(Command::Pause(true)).await.unwrap();
                rig.picture("the pause", |view| view.paused).await;
            });
        });
        done.store(true, Ordering::Relaxed);
    });
}

#[tokio::test]
async fn a_restart_from_the_console_closes_the_links() {
    let mut rig = rig().await;
    let mut person = rig.person().await;
    rig.picture("the block", is_blocked_by_cli).await;
    rig.console("save").await;
    let mut rest = Vec::new();
    tokio::time::timeout(PATIENCE, person.read_to_end(&mut rest)).await.unwrap().unwrap();
    rig.picture("no block", |view| !is_blocked_by_cli(view)).await;
}

#[tokio::test]
async fn a_craft_put_back_home_does_not_arm_while_somebody_is_at_the_command_line() {
    let mut rig = rig().await;
    let mut person = rig.person().await;
    rig.picture("the block", is_blocked_by_cli).await;
    rig.session.commands.send(Command::Vehicle(VehicleCommand::ResetCraft)).await.unwrap();
    rig.console("version").await;
    person.write_all(b"version\n").await.unwrap();
    let mut said = Vec::new();
    while !said.ends_with(b"\r\n# ") {
        said.push(person.read_u8().await.unwrap());
    }
    // Waits for a picture of a later time.
    let now = rig.session.view.borrow().vehicle.time;
    rig.picture("the time after", |view| view.vehicle.time > now).await;
    assert!(is_blocked_by_cli(&rig.session.view.borrow()));
}

#[tokio::test]
async fn what_a_client_changes_is_seen_while_time_is_paused() {
    let mut rig = rig().await;
    rig.session.commands.send(Command::Pause(true)).await.unwrap();
    rig.picture("the pause", |view| view.paused).await;
    let (reply, answer) = oneshot::channel();
    let line = "waypoint insert 0 40.4640000 -79.5175000 5000 0 FLYOVER 0 ORBIT".to_owned();
    rig.requests
        .send(Request::Cli { client: ClientId(1), line, source: LineSource::Framed, reply })
        .await
        .unwrap();
    assert!(!answer.await.unwrap().refused);
    rig.picture("the waypoint", |view| view.vehicle.stored_plan.as_ref().unwrap().waypoints.len() == 1).await;
}

/// The channel of the switch that a script turns on.
const SCRIPT: usize = 8;
/// The channel of the switch that the user turns on.
const STICKS: usize = 9;

/// Returns a frame with one switch on.
fn frame_with(channel: usize) -> RcFrame {
    let mut frame = RcFrame::SAFE;
    frame.channels[channel] = 2000;
    frame
}

/// Sends frames of a script in real time.
async fn script(requests: mpsc::Sender<Request>) {
    loop {
        let frame = frame_with(SCRIPT);
        let sent = requests.send(Request::Rc { stamp_s: 0.0, frame, at: Instant::now() }).await;
        if sent.is_err() {
            return;
        }
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
}

#[tokio::test]
async fn sticks_are_cut_while_a_script_flies_and_after_it_until_they_are_taken_back() {
    let mut rig = rig().await;
    rig.session.commands.send(Command::Vehicle(VehicleCommand::Sticks(frame_with(STICKS)))).await.unwrap();
    let is_on = |view: &SessionView, channel: usize| {
        view.vehicle.craft.channels.is_some_and(|channels| channels[channel] > 1700)
    };
    rig.picture("the sticks", |view| is_on(view, STICKS)).await;
    let running = tokio::spawn(script(rig.requests.clone()));
    rig.picture("the script", |view| is_on(view, SCRIPT) && !is_on(view, STICKS)).await;
    running.abort();
    // The script is silent for longer than a source stays fresh and than the link needs to count as lost.
    let then = rig.session.view.borrow().vehicle.time.as_secs_f64() + 1.5;
    rig.picture("the silence", |view| view.vehicle.time.as_secs_f64() > then).await;
    {
        let view = rig.session.view.borrow();
        assert!(view.rc_cut && !is_on(&view, STICKS), "the sticks fly in the script's place");
        assert_eq!(view.vehicle.craft.rc_link, Some(false));
    }
    let reported =
        |event: &Event| matches!(&event.kind, SessionEvent::Notice(text) if text.contains("`x` takes"));
    let events = std::iter::from_fn(|| rig.session.events.try_recv().ok());
    assert_eq!(events.filter(reported).count(), 1);
    // A user who takes the sticks back flies, regardless of the script.
    let running = tokio::spawn(script(rig.requests.clone()));
    rig.session.commands.send(Command::Vehicle(VehicleCommand::CutRc(false))).await.unwrap();
    rig.picture("the sticks again", |view| is_on(view, STICKS) && !view.rc_cut).await;
    let then = rig.session.view.borrow().vehicle.time.as_secs_f64() + 0.5;
    rig.picture("half a second", |view| view.vehicle.time.as_secs_f64() > then).await;
    assert!(!rig.session.view.borrow().rc_cut && is_on(&rig.session.view.borrow(), STICKS));
    running.abort();
}

#[tokio::test]
async fn flying_on_from_an_earlier_instant_closes_the_links_and_is_reported() {
    let mut rig = rig().await;
    let mut person = rig.person().await;
    rig.picture("the block", is_blocked_by_cli).await;
    let blocked = rig.session.view.borrow().vehicle.time;
    rig.session.commands.send(Command::Seek(Seek::Seconds(-1000.0))).await.unwrap();
    rig.picture("the beginning", |view| view.is_rewound() && view.vehicle.time < blocked).await;
    assert!(!is_blocked_by_cli(&rig.session.view.borrow()), "as it was then");
    // While an earlier instant is shown, clients talk to the waiting vehicle.
    person.write_all(b"version\n").await.unwrap();
    let mut said = Vec::new();
    while !said.ends_with(b"\r\n# ") {
        said.push(person.read_u8().await.unwrap());
    }
    rig.session.commands.send(Command::FlyOn).await.unwrap();
    let mut rest = Vec::new();
    tokio::time::timeout(PATIENCE, person.read_to_end(&mut rest)).await.unwrap().unwrap();
    rig.picture("the branch", |view| view.timeline.as_ref().is_some_and(|timeline| timeline.branch == 1))
        .await;
    let reported = async {
        while let Some(event) = rig.session.events.recv().await {
            if let SessionEvent::Branch { number, left } = event.kind {
                return Some((number, left > event.time));
            }
        }
        None
    };
    assert_eq!(tokio::time::timeout(PATIENCE, reported).await.unwrap(), Some((1, true)));
}

#[tokio::test]
async fn what_a_script_flew_is_shown_again_as_it_was() {
    let mut rig = rig().await;
    rig.session.commands.send(Command::Speed(8.0)).await.unwrap();
    let requests = rig.requests.clone();
    let script = tokio::spawn(async move {
        for step in 0.. {
            let mut frame = RcFrame::SAFE;
            frame.channels[0] = 1400 + step % 200;
            let sent = requests.send(Request::Rc { stamp_s: 0.0, frame, at: Instant::now() }).await;
            if sent.is_err() {
                return;
            }
            tokio::time::sleep(Duration::from_millis(10)).await;
        }
    });
    let heard = |picture: &Snapshot| picture.craft.channels.map(|channels| channels[0]);
    let mut seen: Vec<std::sync::Arc<Snapshot>> = Vec::new();
    let mut values = std::collections::BTreeSet::new();
    while values.len() < 12 {
        rig.session.view.changed().await.unwrap();
        let picture = rig.session.view.borrow_and_update().vehicle.clone();
        values.insert(heard(&picture));
        seen.push(picture);
    }
    script.abort();
    rig.session.commands.send(Command::Pause(true)).await.unwrap();
    // The last may be the newest instant.
    for picture in seen.iter().rev().skip(1).filter(|picture| picture.time.0 > 0) {
        rig.session.commands.send(Command::Seek(Seek::Time(picture.time))).await.unwrap();
        rig.picture("that instant", |view| view.is_rewound() && view.vehicle.time == picture.time).await;
        assert_eq!(rig.session.view.borrow().vehicle, *picture);
    }
}

/// Sends a line in a framed session of a client and returns the answer.
async fn framed_line(rig: &Rig, line: &str) -> LineReply {
    let (reply, answer) = oneshot::channel();
    let line = line.to_owned();
    let request = Request::Cli { client: ClientId(1), line, source: LineSource::Framed, reply };
    rig.requests.send(request).await.unwrap();
    answer.await.unwrap()
}

/// Sends a message of a client and returns the answer.
async fn message(rig: &Rig, code: u16, payload: &[u8]) -> Option<Vec<u8>> {
    let (reply, answer) = oneshot::channel();
    let payload = payload.to_vec();
    rig.requests.send(Request::Msp { code, payload, reply }).await.unwrap();
    answer.await.unwrap()
}

#[tokio::test]
async fn clients_change_nothing_while_an_earlier_instant_is_shown_and_are_answered_why() {
    const WAYPOINT: &str = "waypoint insert 0 40.4640000 -79.5175000 5000 0 FLYOVER 0 ORBIT";
    const SET_NAME: u16 = 11;
    let mut rig = rig().await;
    rig.picture("a second of flight", |view| view.vehicle.time.as_secs_f64() > 1.0).await;
    let list = framed_line(&rig, "waypoint list").await;
    assert!(!framed_line(&rig, "status").await.text.contains("earlier instant"));
    rig.session.commands.send(Command::Seek(Seek::Seconds(-1000.0))).await.unwrap();
    rig.picture("the beginning", SessionView::is_rewound).await;

    for line in [WAYPOINT, "set ap_max_angle = 21", "save", "defaults nosave", "motor 1 1100", "batch start"]
    {
        let said = framed_line(&rig, line).await;
        assert!(said.refused, "{line}: {}", said.text);
        assert_eq!(said.text.lines().count(), 1, "{line}: {}", said.text);
        assert!(said.text.starts_with("###ERROR: An earlier instant is shown"), "{line}: {}", said.text);
    }
    for (code, payload) in [(SET_NAME, b"evil".as_slice()), (250, b""), (68, b""), (200, &[0xdc, 5, 0xdc, 5])]
    {
        assert_eq!(message(&rig, code, payload).await, None, "{code}");
    }
    rig.requests.send(Request::Restart).await.unwrap();
    assert_eq!(message(&rig, 2, &[]).await.as_deref(), Some(b"BTFL".as_slice()), "what reads is answered");
    let status = framed_line(&rig, "status").await;
    assert!(!status.refused && status.text.contains("earlier instant is shown"), "{}", status.text);
    assert_eq!(framed_line(&rig, "waypoint list").await, list);

    rig.session.commands.send(Command::Seek(Seek::Newest)).await.unwrap();
    rig.picture("the newest instant", |view| !view.is_rewound()).await;
    assert!(!framed_line(&rig, "status").await.text.contains("earlier instant"));
    assert_eq!(framed_line(&rig, "waypoint list").await, list, "nothing was changed");
    assert!(!framed_line(&rig, WAYPOINT).await.refused);
    let reported =
        |event: &Event| matches!(&event.kind, SessionEvent::Notice(text) if text.contains("was refused"));
    let events = std::iter::from_fn(|| rig.session.events.try_recv().ok());
    assert_eq!(events.filter(reported).count(), 1, "reported once");
}
