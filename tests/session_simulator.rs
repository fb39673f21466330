//! A session whose craft a simulator outside moves: whose time it is, what the picture shows, what keys do.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use betadeck::firmware::config::Configuration;
use betadeck::firmware::{AttitudeSource, FirmwareOptions};
use betadeck::link::proto::fdm::{State, mirrored, pressure_pa};
use betadeck::link::proto::fdm_link::FdmLinkConfig;
use betadeck::link::{ClientId, ExternalSimulator, ListenConfig, Listeners, MotorPort, Request};
use betadeck::session::command::{PLACE_IS_EXTERNAL, TIME_IS_EXTERNAL};
use betadeck::session::{
    Command, Endpoints, Event, Handle, RequestHandler, SessionConfig, SessionEvent, SessionView, start,
};
use betadeck::signals::fdm::{Dialect, MotorOrder};
use betadeck::sim::{WorldConfig, attitude};
use betadeck::storage::Store;
use betadeck::telemetry::{
    EndpointKind, EndpointState, EndpointStatus, EventKind, FirmwareEvent, LinkState, SimulatorStats,
};
use betadeck::vehicle::{Vehicle, VehicleConfig};
use nalgebra::Vector3;
use tokio::sync::{mpsc, oneshot, watch};

/// Nothing in these tests takes this long unless it hangs.
const PATIENCE: Duration = Duration::from_secs(60);

/// How far ahead of the clock states arrive.
const AHEAD: Duration = Duration::from_secs(600);

/// Where the craft starts: latitude, longitude, degrees, altitude, m.
const START: (f64, f64, f64) = (40.4635, -79.5182, 250.0);

/// A session and the other ends of its cables.
struct Rig {
    session: Handle,
    requests: mpsc::Sender<Request>,
    motors: UdpSocket,
    notices: Vec<String>,
    /// Faults that were told: name, whether it began, when, ms.
    faults: Vec<(&'static str, bool, u64)>,
    stamp_ms: u64,
    /// When the newest state arrived. Usually far ahead of the clock, so that a slow machine is no silence.
    at: Instant,
    /// North of the start and above it, m, in the newest state.
    place: (f64, f64),
    _doors: Listeners,
    _views: watch::Sender<Vec<EndpointStatus>>,
}

/// What the link to the simulator has seen.
fn stats(view: &SessionView) -> SimulatorStats {
    let motors = view.endpoints.iter().find(|endpoint| endpoint.kind == EndpointKind::Motors).unwrap();
    let EndpointState::Simulator(stats) = motors.state else { panic!("{motors:?}") };
    stats
}

async fn rig() -> Rig {
    rig_with(&[]).await
}

/// A session with these faults to come.
async fn rig_with(faults: &[&str]) -> Rig {
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
    let handler = RequestHandler::new(doors.restart_bell());
    let endpoints = Some(Endpoints { requests: inbox, handler, status: views, simulator: Some(simulator) });
    let session = start(SessionConfig {
        vehicle,
        store: Store::in_memory(),
        starter_modes: true,
        speed: 1.0,
        takeoff_m: 10.0,
        endpoints,
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

impl Rig {
    /// Sends a state `ms` after the one before, this far north of the start and this high above it, m.
    async fn state(&mut self, ms: u64, north_m: f64, up_m: f64) {
        self.stamp_ms += ms;
        self.at += Duration::from_millis(ms);
        let moved = (north_m - self.place.0, up_m - self.place.1);
        let seconds = (ms as f64 * 1e-3).max(1e-3);
        self.place = (north_m, up_m);
        let state = State {
            stamp_s: self.stamp_ms as f64 * 1e-3,
            rate_flu: Vector3::zeros(),
            specific_force_flu: Vector3::new(0.0, 0.0, betadeck::geo::GRAVITY),
            attitude: attitude(90.0, 5.0, -3.0),
            vel_enu: Vector3::new(0.0, moved.0, moved.1) / seconds,
            lon_deg: START.1,
            lat_deg: mirrored(START.0, START.0 + north_m / 111_043.55),
            alt_m: START.2 + up_m,
            pressure_pa: pressure_pa(START.2 + up_m),
        };
        let datagram = Dialect::SitlGz.encode(&state).to_bytes().to_vec();
        let from = SocketAddr::from(([127, 0, 0, 1], 1));
        self.requests.send(Request::Fdm { datagram, from, at: self.at }).await.unwrap();
    }

    /// Waits for a picture.
    #[track_caller]
    fn picture(&mut self, wanted: impl FnMut(&SessionView) -> bool) -> impl Future<Output = SessionView> {
        let asked = std::panic::Location::caller();
        async move {
            let newest = self.session.view.clone();
            match tokio::time::timeout(PATIENCE, self.session.view.wait_for(wanted)).await {
                Ok(found) => found.unwrap().clone(),
                Err(_elapsed) => panic!("{asked}: still {:#?}", *newest.borrow()),
            }
        }
    }

    /// Waits for a notice.
    async fn hear(&mut self, words: &str) {
        while !self.notices.iter().any(|notice| notice.contains(words)) {
            let event = tokio::time::timeout(PATIENCE, self.session.events.recv()).await;
            let event = event.unwrap_or_else(|_| panic!("no {words:?} in {:#?}", self.notices));
            self.note(event.unwrap());
        }
        self.notices.retain(|notice| !notice.contains(words));
    }

    /// Waits for the beginning or the end of a fault; gives when it was, ms.
    async fn hear_fault(&mut self, name: &str, on: bool) -> u64 {
        loop {
            if let Some(&(_, _, at_ms)) = self.faults.iter().find(|told| (told.0, told.1) == (name, on)) {
                return at_ms;
            }
            let event = tokio::time::timeout(PATIENCE, self.session.events.recv()).await;
            let event = event.unwrap_or_else(|_| panic!("no {name} {on} in {:?}", self.faults));
            self.note(event.unwrap());
        }
    }

    fn note(&mut self, event: Event) {
        match event.kind {
            SessionEvent::Notice(notice) | SessionEvent::ArmingBlocked(notice) => self.notices.push(notice),
            SessionEvent::Simulator(remark) => self.notices.push(remark.to_string()),
            SessionEvent::Vehicle(EventKind::Notice(notice)) => self.notices.push(notice.to_string()),
            SessionEvent::Vehicle(EventKind::Fault { kind, on, .. }) => {
                self.faults.push((kind.into(), on, event.time.0 / 1000));
            }
            _ => {}
        }
    }

    /// The firmware's time when everything that was sent has been attended to, ms.
    async fn flown_ms(&mut self) -> u64 {
        // Answers come in the order of the questions, and the states were asked first.
        let (reply, answer) = oneshot::channel();
        let request = Request::EnterCli { client: ClientId(1), interactive: false, reply };
        self.requests.send(request).await.unwrap();
        tokio::time::timeout(PATIENCE, answer).await.unwrap().unwrap();
        // A picture of after that, which only a change brings.
        let mut sticks = self.session.view.borrow().sticks;
        sticks.channels[11] += 1;
        self.command(Command::Sticks(sticks)).await;
        self.picture(|view| view.sticks == sticks).await.vehicle.time.0 / 1000
    }

    async fn command(&self, command: Command) {
        self.session.commands.send(command).await.unwrap();
    }

    async fn world(&self, line: &str) -> Result<(), String> {
        let (reply, answer) = oneshot::channel();
        self.command(Command::World { line: line.to_owned(), reply }).await;
        tokio::time::timeout(PATIENCE, answer).await.unwrap().unwrap()
    }
}

#[tokio::test]
async fn until_a_simulator_speaks_the_firmware_lives_and_nothing_is_made_up() {
    let mut rig = rig().await;
    let view = rig.picture(|view| view.vehicle.time.0 > 50_000).await;
    assert_eq!(view.simulator, Some(LinkState::Waiting));
    assert_eq!(
        (view.vehicle.truth, view.vehicle.estimate.n, view.vehicle.craft.has_fix()),
        (None, None, false)
    );
    assert_eq!(view.vehicle.world.airframe, "external");
    assert_eq!(stats(&view).link, LinkState::Waiting);
    let motors = view.endpoints.iter().find(|endpoint| endpoint.kind == EndpointKind::Motors).unwrap();
    assert_eq!(motors.address, rig.motors.local_addr().unwrap().to_string());

    let (reply, answer) = oneshot::channel();
    rig.command(Command::Cli { line: "get ap_max_angle".to_owned(), reply }).await;
    let answer = tokio::time::timeout(PATIENCE, answer).await.unwrap().unwrap();
    assert!(answer.text.contains("ap_max_angle = "), "{}", answer.text);
}

#[tokio::test]
async fn the_simulators_stamps_are_the_time_and_its_state_the_truth() {
    let mut rig = rig().await;
    rig.state(0, 0.0, 0.0).await;
    rig.hear("The simulator speaks").await;
    // The first packet only sets the time base, the second tells where the craft starts.
    rig.state(0, 0.0, 0.0).await;
    let begun = rig.picture(|view| view.simulator == Some(LinkState::Flowing)).await.vehicle.time;
    for step in 1..=400 {
        rig.state(10, f64::from(step) * 0.1, f64::from(step) * 0.05).await;
    }
    let flown = |view: &SessionView| view.vehicle.time.0 >= begun.0 + 4_000_000;
    let view = rig.picture(flown).await;
    assert_eq!(view.vehicle.time.0, begun.0 + 4_000_000, "not a tick of the wall clock");
    let truth = view.vehicle.truth.unwrap();
    assert!((truth.n - 40.0).abs() < 0.01 && truth.e.abs() < 0.01 && (truth.alt - 20.0).abs() < 0.01);
    assert!((truth.lat_deg - (START.0 + 40.0 / 111_043.55)).abs() < 1e-9, "{truth:?}");
    assert!((truth.heading_deg - 90.0).abs() < 1e-6 && (truth.pitch_deg - 5.0).abs() < 1e-6);
    assert!((truth.roll_deg + 3.0).abs() < 1e-6 && (truth.vn - 10.0).abs() < 1e-6 && !truth.on_ground);
    assert!((view.vehicle.estimate.pitch_deg.unwrap() - 5.0).abs() < 0.1, "the firmware believes it");
    assert!(view.vehicle.craft.has_fix() && view.vehicle.craft.sats == Some(12));
    let flying = SimulatorStats { link: LinkState::Flowing, dialect: Some("sitl-gz"), refused: 0, old: 0 };
    assert_eq!(stats(&view), flying);
}

#[tokio::test]
async fn what_is_the_simulators_business_is_refused_with_the_way_out() {
    let mut rig = rig().await;
    rig.state(0, 0.0, 0.0).await;
    rig.hear("The simulator speaks").await;
    for command in [Command::Pause(true), Command::Step(100), Command::Speed(8.0)] {
        rig.command(command).await;
        rig.hear(TIME_IS_EXTERNAL).await;
    }
    rig.command(Command::ResetCraft).await;
    rig.hear(PLACE_IS_EXTERNAL).await;
    let refused = rig.world("wind=5@270").await.unwrap_err();
    assert!(refused.contains("the simulator makes the air"), "{refused}");
    let before = rig.session.view.borrow().vehicle.time;
    for _ in 0..100 {
        rig.state(10, 0.0, 0.0).await;
    }
    let view = rig.picture(|view| view.vehicle.time.0 >= before.0 + 1_000_000).await;
    assert!(!view.paused && view.simulator == Some(LinkState::Flowing), "it flies on");
}

#[tokio::test]
async fn silence_stops_time_and_is_shown_until_the_simulator_returns() {
    let mut rig = rig().await;
    rig.at = Instant::now();
    for _ in 0..50 {
        rig.state(10, 0.0, 0.0).await;
    }
    rig.hear("The simulator is silent: time stands still").await;
    let view = rig.picture(|view| view.simulator == Some(LinkState::Silent)).await;
    assert_eq!(stats(&view).link, LinkState::Silent);

    // Keys still act: the firmware can be started anew, and the way out is told.
    rig.command(Command::ResetCraft).await;
    rig.hear("The firmware started anew, disarmed").await;
    let still = rig.picture(|view| view.vehicle.truth.is_none()).await;
    assert_eq!(still.vehicle.time, view.vehicle.time);

    // The first packet only sets the time base.
    rig.at = Instant::now() + AHEAD;
    rig.state(10, 7.0, 0.0).await;
    rig.hear("The simulator speaks again after ").await;
    rig.state(10, 7.0, 0.0).await;
    let view = rig.picture(|view| view.vehicle.time.0 == still.vehicle.time.0 + 10_000).await;
    assert_eq!(view.simulator, Some(LinkState::Flowing));
    assert!(view.vehicle.truth.unwrap().n.abs() < 1e-6, "it counts from where it is seen now");
}

#[tokio::test]
async fn a_restarted_simulator_finds_a_disarmed_craft_and_resting_sticks() {
    let mut rig = rig().await;
    for _ in 0..700 {
        rig.state(10, 0.0, 0.0).await;
    }
    rig.picture(|view| view.vehicle.time.0 >= 6_900_000).await;
    let mut sticks = betadeck::signals::RcFrame::SAFE;
    sticks.channels[4] = 1900;
    rig.command(Command::Sticks(sticks)).await;
    rig.picture(|view| view.sticks == sticks).await;
    for _ in 0..100 {
        rig.state(10, 0.0, 0.0).await;
    }
    rig.picture(|view| view.vehicle.craft.is_armed()).await;

    // Its time falls; for half a second that is taken for a late packet.
    rig.stamp_ms = 0;
    for _ in 0..60 {
        rig.state(10, 0.0, 0.0).await;
    }
    rig.hear("The simulator was restarted: disarmed.").await;
    let view = rig.picture(|view| !view.vehicle.craft.is_armed()).await;
    assert_eq!(view.sticks, betadeck::signals::RcFrame::SAFE);
}

/// A session whose simulator speaks, and the firmware's time, ms.
async fn speaking(faults: &[&str]) -> (Rig, u64) {
    let mut rig = rig_with(faults).await;
    for _ in 0..3 {
        rig.state(10, 0.0, 0.0).await;
    }
    let now_ms = rig.flown_ms().await;
    (rig, now_ms)
}

#[tokio::test]
async fn a_stall_lasts_its_time_although_the_firmwares_stands_still() {
    let (mut rig, begun) = speaking(&[]).await;
    rig.world("fault=stall,0.3").await.unwrap();
    for _ in 0..29 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun, "nothing comes through");
    rig.state(10, 0.0, 0.0).await;
    assert_eq!(rig.flown_ms().await, begun + 300, "the stamps tell how long it was");
    assert_eq!((rig.hear_fault("stall", true).await, rig.hear_fault("stall", false).await), (begun, begun));

    // Longer than half a second: the first packet only sets the time base, so nothing jumps.
    rig.faults.clear();
    rig.world("fault=stall,2").await.unwrap();
    for _ in 0..200 {
        rig.state(10, 3.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun + 300);
    assert_eq!(rig.hear_fault("stall", false).await, begun + 300);
    rig.state(10, 3.0, 0.0).await;
    assert_eq!(rig.flown_ms().await, begun + 310);
}

#[tokio::test]
async fn without_a_word_from_the_simulator_a_stall_ends_by_the_clock() {
    let (mut rig, _) = speaking(&[]).await;
    rig.at = Instant::now();
    rig.state(10, 0.0, 0.0).await;
    // It has come through before the stall begins.
    rig.flown_ms().await;
    rig.world("fault=stall,0.3").await.unwrap();
    rig.hear_fault("stall", true).await;
    rig.hear_fault("stall", false).await;
    rig.world("fault=stall").await.unwrap();
    rig.hear("The simulator is silent: time stands still").await;
    rig.faults.clear();
    rig.world("end=stall").await.unwrap();
    rig.state(10, 0.0, 0.0).await;
    rig.hear_fault("stall", false).await;
}

/// Which of forty packets came through with half of them lost.
async fn losses(faults: &[&str]) -> Vec<bool> {
    let (mut rig, mut now) = speaking(faults).await;
    rig.world("fault=fdm-loss,,0.5").await.unwrap();
    let mut through = Vec::new();
    let begun = now;
    for sent in 1..=40 {
        rig.state(10, 0.0, 0.0).await;
        let flown = rig.flown_ms().await;
        assert!(flown == now || flown == begun + 10 * sent, "what was lost is made up for: {flown}");
        through.push(flown > now);
        now = flown;
    }
    through
}

#[tokio::test]
async fn the_same_packets_are_lost_in_every_session() {
    let first = losses(&[]).await;
    let count = first.iter().filter(|through| **through).count();
    assert!((8..=32).contains(&count), "{first:?}");
    // A fault that never begins draws nothing.
    assert_eq!(losses(&["fdm-jitter@0"]).await, first);
}

#[tokio::test]
async fn late_packets_come_later_and_those_overtaken_are_old() {
    let (mut rig, begun) = speaking(&[]).await;
    rig.world("fault=fdm-late,,50").await.unwrap();
    for _ in 0..5 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun);
    for sent in 6..=9 {
        rig.state(10, 0.0, 0.0).await;
        assert_eq!(rig.flown_ms().await, begun + (sent - 5) * 10);
    }
    rig.world("end=fdm-late").await.unwrap();
    rig.state(10, 0.0, 0.0).await;
    assert_eq!(rig.flown_ms().await, begun + 100, "the tenth comes at once");
    for _ in 0..10 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun + 200);
    let view = rig.picture(|view| stats(view).old > 0).await;
    let flying = SimulatorStats { link: LinkState::Flowing, dialect: Some("sitl-gz"), refused: 0, old: 4 };
    assert_eq!(stats(&view), flying);
}

#[tokio::test]
async fn doubled_packets_are_no_time_of_their_own() {
    let (mut rig, begun) = speaking(&[]).await;
    rig.world("fault=fdm-dup,,1").await.unwrap();
    rig.motors.set_nonblocking(true).unwrap();
    let count = |rig: &Rig| std::iter::from_fn(|| rig.motors.recv(&mut [0; 64]).ok()).count();
    count(&rig);
    rig.state(10, 0.0, 0.0).await;
    assert_eq!(rig.flown_ms().await, begun + 10);
    assert_eq!(count(&rig), 2, "only the first is answered with a servo and a raw packet");
    for _ in 0..50 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.flown_ms().await, begun + 510);
}

#[tokio::test]
async fn faults_begin_at_the_firmwares_time_and_end_after_theirs() {
    let (mut rig, begun) = speaking(&["fdm-jitter@boot+100,5,8", "gps-loss@boot+100,5"]).await;
    assert!(begun < 100_000 && rig.faults.is_empty());
    while rig.flown_ms().await < 104_000 {
        for _ in 0..100 {
            rig.state(10, 0.0, 0.0).await;
        }
    }
    let view = rig.session.view.borrow().clone();
    assert!(!view.vehicle.craft.has_fix(), "no solution for more than 2.5 s");
    let active: Vec<_> = view.vehicle.world.faults.iter().map(|fault| <&str>::from(fault.kind)).collect();
    assert_eq!(active, ["fdm-jitter", "gps-loss"]);
    for _ in 0..200 {
        rig.state(10, 0.0, 0.0).await;
    }
    assert_eq!(rig.hear_fault("fdm-jitter", true).await, 100_000);
    assert_eq!(rig.hear_fault("gps-loss", true).await, 100_000);
    assert_eq!(rig.hear_fault("gps-loss", false).await, 105_000);
    let ended = rig.hear_fault("fdm-jitter", false).await;
    assert!((104_900..=105_000).contains(&ended), "{ended}");
    rig.picture(|view| view.vehicle.craft.has_fix() && view.vehicle.world.faults.is_empty()).await;
}

#[tokio::test]
async fn a_lost_receiver_hears_no_script() {
    let (mut rig, _) = speaking(&[]).await;
    for on in [false, true] {
        if on {
            rig.world("fault=rx-loss").await.unwrap();
        }
        let mut lost = false;
        for _ in 0..100 {
            let from = SocketAddr::from(([127, 0, 0, 1], 1));
            let frame = betadeck::signals::RcFrame::SAFE;
            rig.requests.send(Request::Rc { stamp_s: 0.0, frame, from, at: rig.at }).await.unwrap();
            rig.state(10, 0.0, 0.0).await;
        }
        rig.flown_ms().await;
        while let Ok(event) = rig.session.events.try_recv() {
            lost |= matches!(event.kind, SessionEvent::Vehicle(EventKind::Firmware(FirmwareEvent::RxLoss)));
        }
        assert_eq!(lost, on);
    }
}

#[tokio::test]
async fn faults_of_the_craft_are_the_simulators() {
    let (rig, _) = speaking(&[]).await;
    let refused = rig.world("fault=motor,,2:0.8").await.unwrap_err();
    assert!(
        refused.contains("fault motor is up to the simulator") && refused.contains("fdm-loss"),
        "{refused}"
    );
    let refused = rig.world("fault=motor@boot+900,,2:0.8").await.unwrap_err();
    assert!(refused.contains("fault motor is up to the simulator"), "{refused}");
    for line in ["reset", "noise=none", "wind_profile=flat"] {
        let refused = rig.world(line).await.unwrap_err();
        assert!(refused.contains("places the craft: change that there"), "{line}: {refused}");
    }
    rig.world("end=all").await.unwrap();
}
