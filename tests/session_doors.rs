//! A session with clients at its doors: what they can and cannot do to the flight and to each other.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use betadeck::firmware::FirmwareOptions;
use betadeck::firmware::config::Configuration;
use betadeck::link::proto::command_line::LineSource;
use betadeck::link::{ClientId, ListenConfig, Listeners, Request};
use betadeck::session::{Command, Endpoints, Handle, RequestHandler, SessionConfig, SessionView, start};
use betadeck::sim::WorldConfig;
use betadeck::storage::Store;
use betadeck::telemetry::{ArmingFlag, EndpointKind};
use betadeck::vehicle::{Vehicle, VehicleConfig};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::{mpsc, oneshot, watch};

/// Nothing in these tests takes this long unless it hangs.
const PATIENCE: Duration = Duration::from_secs(120);

/// A session with a TCP door.
struct Rig {
    session: Handle,
    requests: mpsc::Sender<Request>,
    doors: Listeners,
    _views: watch::Sender<Vec<betadeck::telemetry::EndpointStatus>>,
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
        endpoints: Some(Endpoints { requests: inbox, handler, status: views, simulator: None }),
        first_events: Vec::new(),
    })
    .unwrap();
    Rig { session, requests, doors, _views: views_tx }
}

impl Rig {
    /// The first picture that shows this.
    async fn picture(&mut self, what: &str, wanted: impl Fn(&SessionView) -> bool) {
        let waiting = self.session.view.wait_for(wanted);
        let found = tokio::time::timeout(PATIENCE, waiting).await;
        assert!(matches!(found, Ok(Ok(_))), "no picture of {what}");
    }

    async fn console(&self, line: &str) {
        let (reply, answer) = oneshot::channel();
        self.session.commands.send(Command::Cli { line: line.to_owned(), reply }).await.unwrap();
        answer.await.unwrap();
    }

    /// A person at the command line over TCP.
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

/// A question whose answer takes the firmware long.
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
                // Commands of the user interface are heard, too.
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
    rig.session.commands.send(Command::ResetCraft).await.unwrap();
    rig.console("version").await;
    person.write_all(b"version\n").await.unwrap();
    let mut said = Vec::new();
    while !said.ends_with(b"\r\n# ") {
        said.push(person.read_u8().await.unwrap());
    }
    // A picture of the time after.
    let now = rig.session.view.borrow().vehicle.time;
    rig.picture("the time after", |view| view.vehicle.time > now).await;
    assert!(is_blocked_by_cli(&rig.session.view.borrow()));
}

#[tokio::test]
async fn what_a_client_changes_is_seen_while_time_stands_still() {
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
