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

    /// Sends states until one is answered, which only a raw packet shows. Returns the number of motor packets since the
    /// newest state, and `true` if that was too soon for a packet without a state.
    fn step(&mut self) -> (usize, bool) {
        for _ in 0..10 {
            let sent = Instant::now();
            self.send_state();
            let answered = self.raw.recv(&mut [0; 256]).is_ok();
            let motors = std::iter::from_fn(|| self.motors.recv(&mut [0; 256]).ok()).count();
            if answered {
                return (motors, sent.elapsed() < 2 * SILENCE);
            }
        }
        panic!("states that wait in the socket are not answered");
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

#[test]
fn a_state_that_waited_while_the_firmware_was_held_up_is_answered_once_and_nothing_is_sent_unasked() {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let mut simulator = Simulator::new();
    let (_session, _links) = session(&simulator, &runtime);
    // The firmware is not held up until it has answered a state.
    simulator.raw.recv(&mut [0; 256]).expect("the packet of the start");
    runtime.block_on(async {
        simulator.raw.set_nonblocking(true).unwrap();
        while simulator.raw.recv(&mut [0; 256]).is_err() {
            simulator.send_state();
            tokio::time::sleep(Duration::from_millis(10)).await;
        }
        simulator.raw.set_nonblocking(false).unwrap();
    });
    let mut in_time = 0;
    for round in 0.. {
        let (motors, soon) = simulator.step();
        // A busy machine proves nothing, nor do the states that were sent in a row.
        if round > 0 && soon {
            assert_eq!(motors, 1, "sent for state {round}");
            in_time += 1;
        }
        if in_time == 5 {
            break;
        }
    }
}
