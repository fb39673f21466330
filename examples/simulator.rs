//! A small external simulator: the project's quadcopter with the UDP packets of Gazebo's plugin, in real time.
//!
//! ```sh
//! cargo run --release --example simulator      # and, in another terminal:
//! betadeck --physics external                  # or `betadeck sitl`
//! ```
//!
//! It does the same as a bridge from your own simulator: for each step it waits for one packet of motors, moves the
//! craft and sends its state. Start it with `simulator MOTORS STATES` for ports other than 9002 and 9003.
#![allow(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "an external simulator has a clock of its own"
)]

use std::error::Error;
use std::io::ErrorKind;
use std::net::{Ipv4Addr, UdpSocket};
use std::time::{Duration, Instant};

use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm::{GZ_PLUGIN_SIZE, State, mirrored, pressure_pa};
use betadeck::link::proto::servo;
use betadeck::signals::MotorCommand;
use betadeck::sim::{World, WorldConfig};

/// The number of plant steps in one step of the simulator, which lasts 4 ms.
const STEPS: u32 = 4;
/// The length of a step.
const STEP: Duration = Duration::from_millis(4);
/// The time to wait for motors before the craft moves without them.
const PATIENCE: Duration = Duration::from_secs(1);
/// The number of misses in a row after which the firmware is gone: motors off, and no state is sent.
const MAX_MISSES: u32 = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let ports: Vec<u16> = std::env::args().skip(1).map(|port| port.parse()).collect::<Result<_, _>>()?;
    let (motors_port, states_port) = match ports[..] {
        [] => (9002, 9003),
        [motors, states] => (motors, states),
        _ => return Err("usage: simulator [MOTORS STATES]".into()),
    };
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, motors_port))?;
    socket.set_read_timeout(Some(PATIENCE))?;
    let mut world = World::new(WorldConfig::default())?;
    let mut motors = MotorCommand::default();
    let mut misses = MAX_MISSES;
    let mut next = Instant::now();
    println!("Reading motors on {motors_port}, telling states to {states_port}.");
    loop {
        let heard = receive(&socket);
        match heard {
            Some(values) => {
                if misses >= MAX_MISSES {
                    println!("{:8.1} s: a firmware flies.", world.time().as_secs_f64());
                }
                (motors, misses) = (MotorCommand(values.map(f64::from)), 0);
            }
            None => misses = misses.saturating_add(1),
        }
        if misses == MAX_MISSES {
            println!("{:8.1} s: the firmware is gone.", world.time().as_secs_f64());
            motors = MotorCommand::default();
        }
        for _ in 0..STEPS {
            world.step(&motors);
        }
        if misses < MAX_MISSES {
            socket.send_to(&state(&world), (Ipv4Addr::LOCALHOST, states_port))?;
        }
        // Keeps real time, but does not make up for delays.
        next = (next + STEP).max(Instant::now());
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
    }
}

/// Returns the next packet of motors. An interrupted wait, as when the process is stopped and continued, is not a miss.
fn receive(socket: &UdpSocket) -> Option<[f32; 4]> {
    let mut bytes = [0; 64];
    loop {
        match socket.recv(&mut bytes) {
            Ok(size) => return servo::decode(&bytes[..size]),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(_) => return None,
        }
    }
}

/// Encodes the state of the craft as Gazebo's plugin does: positions are mirrored about the start.
fn state(world: &World) -> Vec<u8> {
    let (truth, frame) = (world.truth(), world.local_frame());
    let (lat_deg, lon_deg, alt_m) = frame.to_geodetic(truth.pos_enu);
    let state = State {
        stamp_s: world.time().as_secs_f64(),
        rate_flu: truth.rate_flu,
        specific_force_flu: truth.specific_force_flu,
        attitude: truth.attitude,
        vel_enu: truth.vel_enu,
        lon_deg: mirrored(frame.lon_deg, lon_deg),
        lat_deg: mirrored(frame.lat_deg, lat_deg),
        alt_m,
        pressure_pa: pressure_pa(alt_m),
    };
    let mut bytes = Dialect::GzPlugin.encode(&state).to_bytes().to_vec();
    bytes.resize(GZ_PLUGIN_SIZE, 0);
    bytes
}
