//! A firmware that was held up: the simulator's packets wait in the socket when the session wakes.

use std::net::{Ipv4Addr, UdpSocket};
use std::time::{Duration, Instant};

use betadeck::firmware::FirmwareOptions;
use betadeck::firmware::config::Configuration;
use betadeck::link::conventions::MotorOrder;
use betadeck::link::endpoint::EndpointKind;
use betadeck::link::proto::fdm_link::FdmLinkConfig;
use betadeck::link::{ExternalSimulator, ListenConfig};
use betadeck::session::{Handle, Links, MotorTargets, SessionConfig, start};
use betadeck::sim::WorldConfig;
use betadeck::storage::Store;
use betadeck::vehicle::{Vehicle, VehicleConfig};

use crate::session::simulator::rig::at_rest;

/// The silence after which the firmware sends without a state.
const SILENCE: Duration = Duration::from_millis(100);

/// The simulator's sockets.
struct Simulator {
    motors: UdpSocket,
    raw: UdpSocket,
    states: UdpSocket,
    stamp_ms: u64,
}

impl Simulator {
    fn new() -> Self {
        let [motors, raw, states] = [(); 3].map(|()| UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap());
        motors.set_nonblocking(true).unwrap();
        raw.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
        Self { motors, raw, states, stamp_ms: 0 }
    }

    fn send_state(&mut self) {
        self.stamp_ms += 4;
        self.states.send(&at_rest(self.stamp_ms)).unwrap();
    }

    /// Waits for a raw packet, which only the answer to a state brings. Returns `false` if none comes.
    fn is_answered(&self) -> bool {
        self.raw.recv(&mut [0; 256]).is_ok()
    }

    /// Returns the number of motor packets that have arrived.
    fn motors(&self) -> usize {
        std::iter::from_fn(|| self.motors.recv(&mut [0; 256]).ok()).count()
    }
}

/// Starts a session on a runtime that runs only inside `block_on`. In between no task wakes for a packet, as in a stall
/// of the whole program.
fn session(simulator: &Simulator, runtime: &tokio::runtime::Runtime) -> (Handle, impl Sized + use<>) {
    let config = ListenConfig {
        tcp_port: None,
        ws_port: None,
        rc_port: None,
        fdm_port: Some(0),
        ..ListenConfig::default()
    };
    let links = runtime.block_on(Links::open(&config));
    simulator.states.connect(links.doors.address(EndpointKind::Fdm).unwrap()).unwrap();
    let port = |socket: &UdpSocket| socket.local_addr().unwrap().port();
    let targets = MotorTargets {
        ip: Ipv4Addr::LOCALHOST.into(),
        motors: port(&simulator.motors),
        raw: port(&simulator.raw),
    };
    let motors = targets.open().unwrap();
    let link = ExternalSimulator::start(FdmLinkConfig::default(), MotorOrder::Native, motors, Instant::now());
    let (doors, endpoints, publish) = links.endpoints(Some(link));
    let vehicle = Vehicle::with_external_physics(VehicleConfig {
        world: WorldConfig::default(),
        firmware: FirmwareOptions::default(),
        configuration: Configuration::default(),
        live: true,
    });
    let session = start(SessionConfig {
        vehicle: vehicle.unwrap(),
        store: Store::in_memory(),
        starter_modes: true,
        speed: 1.0,
        takeoff_m: 10.0,
        is_recorded: true,
        endpoints: Some(endpoints),
        remote: None,
        first_events: Vec::new(),
    })
    .unwrap();
    (session, (doors, publish))
}

/// Sends states to a new session that is held up. Returns the number of states that were answered rightly, at most
/// `wanted`: the first one that is answered late ends the session, because the machine is busy and the link may have
/// sent motors without a state.
fn answered_in_time(wanted: usize) -> usize {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let mut simulator = Simulator::new();
    let (_session, _links) = session(&simulator, &runtime);
    assert!(simulator.is_answered(), "the packet of the start");
    let start = Instant::now();
    // The firmware is not held up until it has answered two states.
    runtime.block_on(async {
        for _ in 0..2 {
            simulator.send_state();
            tokio::time::sleep(Duration::from_millis(10)).await;
        }
    });
    if !(simulator.is_answered() && simulator.is_answered() && start.elapsed() < SILENCE) {
        return 0;
    }
    simulator.motors();
    (0..wanted)
        .take_while(|state| {
            let sent = Instant::now();
            simulator.send_state();
            let in_time = simulator.is_answered() && sent.elapsed() < 2 * SILENCE;
            if in_time {
                assert_eq!(simulator.motors(), 1, "sent for state {state}");
            }
            in_time
        })
        .count()
}

#[test]
fn a_state_that_waited_while_the_firmware_was_held_up_is_answered_once_and_nothing_is_sent_unasked() {
    let deadline = Instant::now() + Duration::from_secs(600);
    let mut answered = 0;
    while answered < 5 {
        answered += answered_in_time(5 - answered);
        assert!(Instant::now() < deadline, "{answered} of 5 states were answered in time");
    }
}
