//! A simulator as its own process would be: it sends states over UDP and waits for motors.

use std::net::{SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm::{State, mirrored, pressure_pa};
use betadeck::link::proto::servo;
use betadeck::signals::MotorCommand;
use betadeck::sim::{Noise, World, WorldConfig};

use super::program::PATIENCE;

/// The time that a simulator waits for motors before it continues without them.
const MOTORS_LATE: Duration = Duration::from_secs(1);

/// The current and past position of the craft.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Seen {
    pub(crate) east_m: f64,
    pub(crate) north_m: f64,
    pub(crate) alt_m: f64,
    pub(crate) highest_m: f64,
    pub(crate) furthest_north_m: f64,
    pub(crate) on_ground: bool,
    pub(crate) crashed: bool,
}

/// The sockets of a simulator that does not know its destination yet.
pub(crate) struct Sockets {
    motors: UdpSocket,
    raw: UdpSocket,
}

impl Sockets {
    pub(crate) fn open() -> Self {
        let socket = || UdpSocket::bind("127.0.0.1:0").unwrap();
        Self { motors: socket(), raw: socket() }
    }

    pub(crate) fn motors_port(&self) -> u16 {
        self.motors.local_addr().unwrap().port()
    }

    pub(crate) fn raw_port(&self) -> u16 {
        self.raw.local_addr().unwrap().port()
    }

    /// Runs the world at most `speed` times as fast as real time, until dropped.
    pub(crate) fn fly(self, fdm: SocketAddr, speed: f64) -> Simulator {
        let (seen, stop) = (Arc::new(Mutex::new(Seen::default())), Arc::new(AtomicBool::new(false)));
        let (shown, stopped) = (Arc::clone(&seen), Arc::clone(&stop));
        let thread = std::thread::spawn(move || {
            self.run(fdm, speed, &shown, &stopped);
        });
        Simulator { seen, stop, thread: Some(thread) }
    }

    fn run(&self, fdm: SocketAddr, speed: f64, seen: &Mutex<Seen>, stop: &AtomicBool) {
        self.motors.set_read_timeout(Some(MOTORS_LATE)).unwrap();
        let mut world = World::new(WorldConfig { noise: Noise::None, ..WorldConfig::default() }).unwrap();
        let frame = *world.local_frame();
        let (start, mut motors) = (Instant::now(), MotorCommand::default());
        while !stop.load(Ordering::Relaxed) {
            let ahead =
                Duration::from_secs_f64(world.time().as_secs_f64() / speed).saturating_sub(start.elapsed());
            // A millisecond is too short for a sleep.
            if ahead > Duration::from_millis(2) {
                std::thread::sleep(ahead);
            }
            world.step(&motors);
            let truth = world.truth();
            let (lat_deg, lon_deg, alt_m) = frame.to_geodetic(truth.pos_enu);
            let state = State {
                stamp_s: truth.time.as_secs_f64(),
                rate_flu: truth.rate_flu,
                specific_force_flu: truth.specific_force_flu,
                attitude: truth.attitude,
                vel_enu: truth.vel_enu,
                // Mirrored as in the public plugin.
                lon_deg: mirrored(frame.lon_deg, lon_deg),
                lat_deg: mirrored(frame.lat_deg, lat_deg),
                alt_m,
                pressure_pa: pressure_pa(alt_m),
            };
            {
                let mut seen = seen.lock().unwrap();
                (seen.east_m, seen.north_m, seen.alt_m) = (truth.pos_enu.x, truth.pos_enu.y, truth.pos_enu.z);
                seen.highest_m = seen.highest_m.max(truth.pos_enu.z);
                seen.furthest_north_m = seen.furthest_north_m.max(truth.pos_enu.y);
                (seen.on_ground, seen.crashed) = (truth.on_ground, truth.crashed);
            }
            self.motors.send_to(&Dialect::SitlGz.encode(&state).to_bytes(), fdm).unwrap();
            let mut packet = [0; 100];
            if let Ok(size) = self.motors.recv(&mut packet)
                && let Some(values) = servo::decode(&packet[..size])
            {
                motors = MotorCommand(values.map(f64::from));
            }
        }
    }
}

pub(crate) struct Simulator {
    seen: Arc<Mutex<Seen>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Simulator {
    pub(crate) fn seen(&self) -> Seen {
        *self.seen.lock().unwrap()
    }

    /// Checks the craft until `wanted` accepts it.
    pub(crate) fn wait(&self, what: &str, wanted: impl Fn(&Seen) -> bool) {
        let start = Instant::now();
        while !wanted(&self.seen()) {
            assert!(start.elapsed() < PATIENCE, "no {what}: {:?}", self.seen());
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        // A panic of the thread was printed already.
        drop(self.thread.take().map(JoinHandle::join));
    }
}
