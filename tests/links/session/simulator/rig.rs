//! A session and the simulator's side of its sockets.

use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use betadeck::events::{Event, SessionEvent};
use betadeck::firmware::config::Configuration;
use betadeck::firmware::{AttitudeSource, FirmwareOptions};
use betadeck::link::conventions::{Dialect, MotorOrder};
use betadeck::link::endpoint::{EndpointKind, EndpointState, EndpointStatus, SimulatorStats};
use betadeck::link::proto::fdm::{State, mirrored, pressure_pa};
use betadeck::link::proto::fdm_link::FdmLinkConfig;
use betadeck::link::{ClientId, ExternalSimulator, ListenConfig, Listeners, MotorPort, Request};
use betadeck::session::ReplyTo;
use betadeck::session::{Command, Endpoints, Handle, RequestHandler, SessionConfig, SessionView, start};
use betadeck::sim::{WorldCommand, WorldConfig, attitude};
use betadeck::storage::Store;
use betadeck::telemetry::EventKind;
use betadeck::vehicle::{Vehicle, VehicleCommand, VehicleConfig};
use nalgebra::Vector3;
use tokio::sync::{mpsc, oneshot, watch};

/// Nothing in these tests takes this long unless it hangs.
pub(crate) const PATIENCE: Duration = Duration::from_secs(600);

/// The time by which states arrive ahead of the clock.
pub(crate) const AHEAD: Duration = Duration::from_secs(600);

/// The start of the craft: latitude and longitude, degrees, and altitude, m.
pub(crate) const START: (f64, f64, f64) = (40.4635, -79.5182, 250.0);

/// A session and the far ends of its links.
pub(crate) struct Rig {
    pub(crate) session: Handle,
    pub(crate) requests: mpsc::Sender<Request>,
    pub(crate) motors: UdpSocket,
    notices: Vec<String>,
    /// The reported faults: name, `true` for the beginning and `false` for the end, time in ms.
    pub(crate) faults: Vec<(&'static str, bool, u64)>,
    pub(crate) stamp_ms: u64,
    /// The arrival of the newest state. It is usually far ahead of the clock, so that a slow machine is not taken for
    /// silence.
    pub(crate) at: Instant,
    /// The position in the newest state: north of the start and above it, m.
    place: (f64, f64),
    _doors: Listeners,
    _views: watch::Sender<Vec<EndpointStatus>>,
}

/// Returns the statistics of the link to the simulator.
pub(crate) fn stats(view: &SessionView) -> SimulatorStats {
    let motors = view.endpoints.iter().find(|endpoint| endpoint.kind == EndpointKind::Motors).unwrap();
    let EndpointState::Simulator(stats) = motors.state else { panic!("{motors:?}") };
    stats
}

pub(crate) async fn rig() -> Rig {
    rig_with(&[]).await
}

/// Starts a session with these scheduled faults.
pub(crate) async fn rig_with(faults: &[&str]) -> Rig {
    let motors = UdpSocket::bind("127.0.0.1:0").unwrap();
    motors.set_read_timeout(Some(PATIENCE)).unwrap();
    let (requests, inbox) = mpsc::channel(256);
    let closed = ListenConfig {
        tcp_port: None,
        ws_port: None,
        rc_port: None,
        fdm_port: None,
        ..ListenConfig::default()
    };
    let (doors, first) = Listeners::open(&closed, requests.clone()).await;
    let (views_tx, views) = watch::channel(first);
    let port = MotorPort::open(motors.local_addr().unwrap(), motors.local_addr().unwrap()).unwrap();
    let config = FdmLinkConfig::default();
    let simulator = ExternalSimulator::start(config, MotorOrder::Native, port, Instant::now());
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    let vehicle = Vehicle::with_external_physics(VehicleConfig {
        world: WorldConfig {
            faults: faults.iter().map(|fault| fault.parse().unwrap()).collect(),
            ..WorldConfig::default()
        },
        firmware: FirmwareOptions { attitude: AttitudeSource::Truth, ..FirmwareOptions::default() },
        configuration,
        live: true,
    })
    .unwrap();
    let handler = RequestHandler::new(doors.restart_signal());
    let endpoints = Some(Endpoints { requests: inbox, handler, status: views, simulator: Some(simulator) });
    let session = start(SessionConfig {
        vehicle,
        store: Store::in_memory(),
        starter_modes: true,
        speed: 1.0,
        takeoff_m: 10.0,
        is_recorded: true,
        endpoints,
        remote: None,
        first_events: Vec::new(),
    })
    .unwrap();
    Rig {
        session,
        requests,
        motors,
        notices: Vec::new(),
        faults: Vec::new(),
        stamp_ms: 0,
        at: Instant::now() + AHEAD,
        place: (0.0, 0.0),
        _doors: doors,
        _views: views_tx,
    }
}

/// Encodes the state of a craft this far north of the start and above it, m.
fn datagram(stamp_ms: u64, (north_m, up_m): (f64, f64), vel_enu: Vector3<f64>) -> Vec<u8> {
    let state = State {
        stamp_s: stamp_ms as f64 * 1e-3,
        rate_flu: Vector3::zeros(),
        specific_force_flu: Vector3::new(0.0, 0.0, betadeck::geo::GRAVITY),
        attitude: attitude(90.0, 5.0, -3.0),
        vel_enu,
        lon_deg: START.1,
        lat_deg: mirrored(START.0, START.0 + north_m / 111_043.55),
        alt_m: START.2 + up_m,
        pressure_pa: pressure_pa(START.2 + up_m),
    };
    Dialect::SitlGz.encode(&state).to_bytes().to_vec()
}

/// Encodes the state of a craft that does not move.
pub(crate) fn at_rest(stamp_ms: u64) -> Vec<u8> {
    datagram(stamp_ms, (0.0, 0.0), Vector3::zeros())
}

impl Rig {
    /// Sends a state `ms` after the one before, this far north of the start and this high above it, m.
    pub(crate) async fn state(&mut self, ms: u64, north_m: f64, up_m: f64) {
        self.stamp_ms += ms;
        self.at += Duration::from_millis(ms);
        let moved = (north_m - self.place.0, up_m - self.place.1);
        let seconds = (ms as f64 * 1e-3).max(1e-3);
        self.place = (north_m, up_m);
        let vel_enu = Vector3::new(0.0, moved.0, moved.1) / seconds;
        let datagram = datagram(self.stamp_ms, self.place, vel_enu);
        let from = SocketAddr::from(([127, 0, 0, 1], 1));
        self.requests.send(Request::Fdm { datagram, from, at: self.at }).await.unwrap();
    }

    /// Waits for a picture that matches, and returns it.
    #[track_caller]
    pub(crate) fn picture(
        &mut self,
        wanted: impl FnMut(&SessionView) -> bool,
    ) -> impl Future<Output = SessionView> {
        let asked = std::panic::Location::caller();
        async move {
            let newest = self.session.view.clone();
            match tokio::time::timeout(PATIENCE, self.session.view.wait_for(wanted)).await {
                Ok(found) => found.unwrap().clone(),
                Err(_elapsed) => panic!("{asked}: still {:#?}", *newest.borrow()),
            }
        }
    }

    /// Waits for a notice that contains these words.
    pub(crate) async fn hear(&mut self, words: &str) {
        while !self.notices.iter().any(|notice| notice.contains(words)) {
            let event = tokio::time::timeout(PATIENCE, self.session.events.recv()).await;
            let event = event.unwrap_or_else(|_| panic!("no {words:?} in {:#?}", self.notices));
            self.note(event.unwrap());
        }
        self.notices.retain(|notice| !notice.contains(words));
    }

    /// Waits for the beginning or the end of a fault, and returns its time, ms.
    pub(crate) async fn hear_fault(&mut self, name: &str, on: bool) -> u64 {
        loop {
            if let Some(&(_, _, at_ms)) =
                self.faults.iter().find(|reported| (reported.0, reported.1) == (name, on))
            {
                return at_ms;
            }
            let event = tokio::time::timeout(PATIENCE, self.session.events.recv()).await;
            let event = event.unwrap_or_else(|_| panic!("no {name} {on} in {:?}", self.faults));
            self.note(event.unwrap());
        }
    }

    fn note(&mut self, event: Event) {
        match event.kind {
            SessionEvent::Notice(notice)
            | SessionEvent::Warning(notice)
            | SessionEvent::ArmingBlocked(notice) => {
                self.notices.push(notice);
            }
            SessionEvent::Simulator(remark) => self.notices.push(remark.to_string()),
            SessionEvent::Vehicle(EventKind::Notice(notice)) => self.notices.push(notice.to_string()),
            SessionEvent::Vehicle(EventKind::Fault { kind, on, .. }) => {
                self.faults.push((kind.into(), on, event.time.0 / 1000));
            }
            _ => {}
        }
    }

    /// Waits until everything that was sent is handled, and returns the firmware's time, ms.
    pub(crate) async fn flown_ms(&mut self) -> u64 {
        // Requests are answered in their order, and the states were sent before this one.
        let (reply, answer) = oneshot::channel();
        let request = Request::EnterCli { client: ClientId(1), interactive: false, reply };
        self.requests.send(request).await.unwrap();
        tokio::time::timeout(PATIENCE, answer).await.unwrap().unwrap();
        // Waits for a later picture, which only a change brings.
        let mut sticks = self.session.view.borrow().sticks;
        sticks.channels[11] += 1;
        self.command(Command::Vehicle(VehicleCommand::Sticks(sticks))).await;
        self.picture(|view| view.sticks == sticks).await.vehicle.time.0 / 1000
    }

    pub(crate) async fn command(&self, command: Command) {
        self.session.commands.send(command).await.unwrap();
    }

    pub(crate) async fn world(&self, line: &str) -> Result<(), String> {
        let (reply, answer) = ReplyTo::channel();
        self.command(Command::World { change: Box::new(WorldCommand::parse(line).unwrap()), reply }).await;
        tokio::time::timeout(PATIENCE, answer).await.unwrap().unwrap()
    }
}

/// Starts a session whose simulator sends states. Returns it with the firmware's time, ms.
pub(crate) async fn speaking(faults: &[&str]) -> (Rig, u64) {
    let mut rig = rig_with(faults).await;
    for _ in 0..3 {
        rig.state(10, 0.0, 0.0).await;
    }
    let now_ms = rig.flown_ms().await;
    (rig, now_ms)
}
