//! The public executable itself, if `BETADECK_TEST_SITL` names it (L-9, L-11). Its ports are fixed, so nothing else may
//! use them, and the machine must keep up with real time.

use std::io::{Read as _, Write as _};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpStream, UdpSocket};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use betadeck::link::conventions::{Dialect, MotorOrder, Stamps};
use betadeck::link::proto::sitl_feed::FeedConfig;
use betadeck::link::{ChildConfig, SitlChild, SitlPeer, SitlPorts};
use betadeck::signals::{MotorCommand, RcFrame};
use betadeck::sim::{Home, Noise, World, WorldConfig};
use nalgebra::Vector3;
use tempfile::TempDir;

use super::wire;
use crate::doors::msp;
use crate::doors::program::PATIENCE;

/// The variable that names the executable.
const VARIABLE: &str = "BETADECK_TEST_SITL";
const FDM: u16 = 9003;
const STEP: Duration = Duration::from_millis(1);
/// The configuration of the executable: ARM on AUX1; ANGLE, ALTHOLD and POS HOLD on AUX3; a trusted virtual compass.
const LINES: [&str; 7] = [
    "aux 0 0 0 1700 2100 0 0",
    "aux 1 1 2 1700 2100 0 0",
    "aux 2 3 2 1700 2100 0 0",
    "aux 3 11 2 1700 2100 0 0",
    "set ap_hover_throttle = 1500",
    "set trust_mag = ON",
    "set mag_declination = 20",
];

/// The executable as a child, and both of its links.
struct Executable {
    child: SitlChild,
    peer: SitlPeer,
    tcp: Option<TcpStream>,
    _directory: TempDir,
}

impl Executable {
    fn start(program: PathBuf) -> Self {
        let home = Home::default();
        let config = FeedConfig {
            dialect: Dialect::SitlGz,
            stamps: Stamps::Constant,
            motor_order: MotorOrder::Native,
            home: (home.lat_deg, home.lon_deg, home.alt_amsl_m),
        };
        let ip = IpAddr::V4(Ipv4Addr::LOCALHOST);
        let ports = SitlPorts { ip, raw: 9001, motors: 9002, fdm: FDM, rc: 9004 };
        let peer = SitlPeer::open(config, ports, Instant::now()).unwrap();
        let directory = tempfile::tempdir().unwrap();
        let config = ChildConfig {
            program,
            arguments: Vec::new(),
            directory: directory.path().join("firmware"),
            launcher: env!("CARGO_BIN_EXE_betadeck").into(),
        };
        let child = SitlChild::start(config).unwrap();
        let mut executable = Self { child, peer, tcp: None, _directory: directory };
        executable.boot();
        executable
    }

    /// Waits for the first motor packet, and connects.
    fn boot(&mut self) {
        let end = Instant::now() + PATIENCE;
        while self.peer.take_motors(Instant::now()).is_none() {
            assert!(Instant::now() < end, "it does not boot: {:?}", self.child.take_event());
            std::thread::sleep(STEP);
        }
        let tcp = loop {
            match TcpStream::connect(SocketAddr::from(([127, 0, 0, 1], 5761))) {
                Ok(tcp) => break tcp,
                Err(error) => assert!(Instant::now() < end, "{error}"),
            }
        };
        tcp.set_read_timeout(Some(PATIENCE)).unwrap();
        self.tcp = Some(tcp);
        self.peer.came_up();
    }

    /// Waits for the end of the executable and for its next boot.
    fn boot_again(&mut self) {
        let tcp = self.tcp.as_mut().unwrap();
        // Reads until the link is closed.
        drop(tcp.read_to_end(&mut Vec::new()));
        self.peer.went_down();
        self.boot();
    }

    fn ask(&mut self, code: u8, payload: &[u8]) -> Vec<u8> {
        msp::ask(self.tcp.as_mut().unwrap(), code, payload).unwrap_or_else(|| panic!("{code} is refused"))
    }

    /// Sends one command line in the App's framing and returns the answer.
    fn line(&mut self, line: &str) -> String {
        let tcp = self.tcp.as_mut().unwrap();
        tcp.write_all(&[&b"\x02"[..], line.as_bytes(), b"\n\x03"].concat()).unwrap();
        let (mut answer, mut byte) = (Vec::new(), [0]);
        while answer.last() != Some(&0x03) {
            tcp.read_exact(&mut byte).unwrap();
            answer.push(byte[0]);
        }
        String::from_utf8(answer).unwrap()
    }

    fn set_up(&mut self) {
        for line in LINES {
            let answer = self.line(line);
            assert!(!answer.contains("ERROR"), "{line}: {answer}");
        }
        self.tcp.as_mut().unwrap().write_all(b"\x02save\n\x03").unwrap();
        self.boot_again();
    }

    /// Returns roll, pitch (positive nose down) and heading, degrees.
    fn attitude(&mut self) -> [f64; 3] {
        let answer = self.ask(108, &[]);
        let number = |at: usize| f64::from(i16::from_le_bytes([answer[at], answer[at + 1]]));
        [number(0) / 10.0, number(2) / 10.0, number(4)]
    }

    fn arming_blocks(&mut self) -> u32 {
        u32::from_le_bytes(self.ask(101, &[])[17..21].try_into().unwrap())
    }

    /// Sends the executable the same reference packet for `seconds`.
    fn show(&mut self, case: &str, seconds: u64) {
        let (socket, packet) = (UdpSocket::bind("127.0.0.1:0").unwrap(), wire::bytes(case, "sitl_gz"));
        let end = Instant::now() + Duration::from_secs(seconds);
        while Instant::now() < end {
            socket.send_to(&packet, ("127.0.0.1", FDM)).unwrap();
            std::thread::sleep(STEP);
            self.peer.take_motors(Instant::now());
        }
    }
}

/// The simulated craft whose motors the executable commands, in step with the wall clock.
struct Flight {
    world: World,
    start: Instant,
    motors: MotorCommand,
    rc: RcFrame,
}

impl Flight {
    fn new() -> Self {
        let world = World::new(WorldConfig { noise: Noise::None, ..WorldConfig::default() }).unwrap();
        let rc =
            RcFrame { channels: [1500, 1500, 1000, 1500, 1000, 1000, 1000, 1000, 0, 0, 0, 0, 0, 0, 0, 0] };
        Self { world, start: Instant::now(), motors: MotorCommand::default(), rc }
    }

    /// Flies on for `seconds` and returns the greatest distance from the first position on each axis (ENU, m).
    fn fly(&mut self, executable: &mut Executable, seconds: f64) -> Vector3<f64> {
        let end_s = self.world.time().as_secs_f64() + seconds;
        let (from, mut farthest) = (self.world.truth().pos_enu, Vector3::zeros());
        while self.world.time().as_secs_f64() < end_s {
            let now = Instant::now();
            if let Some(motors) = executable.peer.take_motors(now) {
                self.motors = motors;
            }
            let due_s = (now - self.start).as_secs_f64();
            let mut stepped = false;
            while self.world.time().as_secs_f64() < due_s {
                self.world.step(&self.motors);
                stepped = true;
                if self.world.time().0.is_multiple_of(20_000) {
                    executable.peer.send_rc(&self.rc, now);
                }
                executable.peer.pass_over(self.world.sensors());
            }
            if stepped {
                executable.peer.send_state(self.world.sensors(), now);
            }
            let moved = self.world.truth().pos_enu - from;
            farthest = farthest.zip_map(&moved, |far: f64, here: f64| far.max(here.abs()));
            std::thread::sleep(Duration::from_micros(500));
        }
        farthest
    }
}

#[test]
fn the_public_executable_flies_the_square_in_simulated_time_and_each_time_the_same() {
    let Some(program) = std::env::var_os(VARIABLE) else {
        eprintln!("skipped: {VARIABLE} names no SITL executable");
        return;
    };
    let first = fly_square(&program);
    assert!(first == fly_square(&program), "two flights differ");
}

/// Returns the lines of a flight but the last, and the hash in that one.
fn fly_square(program: &std::ffi::OsStr) -> (String, String) {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_betadeck"));
    let flown = command.args(["fly", "square", "--json", "-", "--firmware"]).arg(program).output().unwrap();
    assert_eq!(flown.status.code(), Some(0), "{flown:?}");
    let lines = String::from_utf8(flown.stdout).unwrap();
    let (events, end) = lines.trim_end().rsplit_once('\n').unwrap();
    let end: serde_json::Value = serde_json::from_str(end).unwrap();
    (events.to_owned(), end["hash"].as_str().unwrap().to_owned())
}

#[test]
fn the_public_executable_has_one_hash_in_fly_and_check_and_does_not_differ_from_itself() {
    let Some(program) = std::env::var_os(VARIABLE) else {
        eprintln!("skipped: {VARIABLE} names no SITL executable");
        return;
    };
    let (_, hash) = fly_square(&program);
    let directory = tempfile::tempdir().unwrap();
    let scenario = directory.path().join("square.toml");
    std::fs::write(&scenario, "format = 1\n[plan]\nbuiltin = \"square\"\n").unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_betadeck"));
    let checked = command.arg("check").arg(&scenario).args(["--json", "-", "--firmware"]).arg(&program);
    let lines = String::from_utf8(checked.output().unwrap().stdout).unwrap();
    let flight: serde_json::Value = serde_json::from_str(lines.lines().next().unwrap()).unwrap();
    assert_eq!(flight["hash"], hash.as_str(), "check and fly differ: {flight}");

    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_betadeck"));
    command.args(["compare", "square", "--seeds", "1..2", "--json", "-"]);
    let compared = command.arg("--firmware").arg(&program).arg("--firmware").arg(&program).output().unwrap();
    assert_eq!(compared.status.code(), Some(0), "{compared:?}");
    let compared: serde_json::Value = serde_json::from_slice(&compared.stdout).unwrap();
    for measure in compared["measures"].as_array().unwrap() {
        assert_eq!((&measure["difference"], &measure["beyond_spread"]), (&0.0.into(), &false.into()));
    }
    assert_eq!(compared["tracks_apart_rms_m"]["between"]["max"], 0.0, "a firmware differs from itself");
}

#[test]
fn the_public_executable_sees_the_worked_attitudes_keeps_time_and_holds_a_hover() {
    let Some(program) = std::env::var_os(VARIABLE) else {
        eprintln!("skipped: {VARIABLE} names no SITL executable");
        return;
    };
    let mut executable = Executable::start(program.into());
    executable.set_up();

    for (case, truth) in [("W1", [0.0, 0.0, 0.0]), ("W2", [0.0, 0.0, 90.0]), ("W3", [0.0, 10.0, 0.0])] {
        executable.show(case, 6);
        let [roll, pitch, heading] = executable.attitude();
        assert!((roll - truth[0]).abs() <= 1.0 && (pitch - truth[1]).abs() <= 1.0, "{case}: {roll} {pitch}");
        let off = (heading - truth[2] + 180.0).rem_euclid(360.0) - 180.0;
        assert!(off.abs() <= 3.0, "{case}: heading {heading}");
        let gps = executable.ask(106, &[]);
        assert_eq!((gps[0], gps[1]), (2, 12), "{case}: fix and satellites");
        executable.ask(68, &[]);
        executable.boot_again();
    }

    let mut flight = Flight::new();
    flight.fly(&mut executable, 8.0);
    assert_eq!(executable.arming_blocks(), 0);
    // Sets the executable's clock to 2023-11-14 22:13:20, to compare it with the wall clock to the millisecond.
    executable.ask(246, &[0x00, 0xf1, 0x53, 0x65, 0, 0]);
    let set = Instant::now();
    flight.rc.channels[4] = 2000;
    flight.fly(&mut executable, 1.0);
    flight.rc.channels[2] = 1300;
    flight.fly(&mut executable, 0.2);
    flight.rc.channels[6] = 2000;
    flight.rc.channels[2] = 1800;
    flight.fly(&mut executable, 3.0);
    flight.rc.channels[2] = 1500;
    flight.fly(&mut executable, 10.0);
    let height_m = flight.world.truth().pos_enu.z;
    assert!(height_m > 3.0, "it hovers at {height_m} m");
    let moved = flight.fly(&mut executable, 20.0);
    assert!(moved.amax() <= 1.0, "it moved by {moved:?} m");

    flight.fly(&mut executable, (60.0 - set.elapsed().as_secs_f64()).max(0.0));
    let rtc = executable.ask(247, &[]);
    let passed_ms = set.elapsed().as_millis() as i64;
    let shown_ms = i64::from(rtc[5]) * 60_000
        + i64::from(rtc[6]) * 1000
        + i64::from(u16::from_le_bytes([rtc[7], rtc[8]]));
    let since_ms = shown_ms - (13 * 60 + 20) * 1000;
    assert!((since_ms - passed_ms).abs() <= 50, "its clock says {since_ms} ms after {passed_ms} ms");
    assert!(!flight.world.truth().crashed);
}
