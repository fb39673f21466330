//! A stand-in for the public executable that flies: the embedded firmware behind the threads and the system calls of
//! `stand_in`. It keeps its configuration as command lines in its folder.

use std::path::Path;
use std::time::Duration;

use betadeck::firmware::cli::{CliMode, Interpreter};
use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::geo::LatLon;
use betadeck::link::conventions::{Dialect, MotorOrder};
use betadeck::link::proto::command_line::LineSource;
use betadeck::link::proto::fdm::{Packet, State, mirrored};
use betadeck::link::proto::serial_session::{SerialRequest, SerialSession};
use betadeck::link::proto::{rc, servo};
use betadeck::signals::{GpsSample, RcSource, SensorFrame, SimTime};

use super::stand_in::{sleep_50_us, with_threads};

/// The argument that makes this test program the flying stand-in.
pub(crate) const FLYING: &str = "flying";
/// A part of the name of its file that makes it come down too fast.
pub(crate) const WORSE: &str = "worse";
/// A part of the name of its file that makes it compute for long now and then, without an effect on what it computes.
pub(crate) const SLOW: &str = "slow";
/// The ports of the public executable: states, RC, motors, serial.
const PORTS: [u16; 4] = [9003, 9004, 9002, 5761];
/// The file with its configuration.
const MEMORY: &str = "memory.txt";
/// The magnetic field, ENU: 60° dip, 2° east declination.
const FIELD_ENU: [f64; 3] = [71.5, 2046.8, -3547.2];
/// A step, µs.
const STEP_US: u64 = 1000;

/// Runs until the process is ended.
pub(super) fn run() {
    let file = std::env::current_exe().unwrap().file_name().unwrap().to_string_lossy().into_owned();
    let (is_worse, is_slow) = (file.contains(WORSE), file.contains(SLOW));
    with_threads(PORTS, |parts, _threads| {
        let (mut sitl, mut states) = (Sitl::boot(is_worse), 0);
        // The public executable, too, sends some before its first state.
        parts.send_motors(&[0; 16]);
        loop {
            let (state, rc, count) = parts.newest();
            if count == std::mem::replace(&mut states, count) {
                sleep_50_us();
                continue;
            }
            if is_slow && count < 3000 && count % 350 == 13 {
                // Longer than this program waits for a step at a time. A sleep would take no real time.
                (0..5_000_000).for_each(|_| std::hint::spin_loop());
            }
            parts.send_motors(&sitl.step(&state, &rc));
            parts.send(&sitl.serve(&parts.received()));
        }
    });
}

/// The firmware and its serial port.
struct Sitl {
    firmware: Firmware,
    session: SerialSession,
    interpreter: Interpreter,
    /// The steps since boot.
    steps: u64,
    /// The first position, about which the others are mirrored on the wire: latitude and longitude, degrees.
    centre: Option<(f64, f64)>,
    is_worse: bool,
}

impl Sitl {
    fn boot(is_worse: bool) -> Self {
        let mut firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
        let kept = std::fs::read_to_string(MEMORY).unwrap_or_default();
        let mut interpreter = Interpreter::new(CliMode::Framed);
        kept.lines().for_each(|line| drop(firmware.run_cli(&mut interpreter, line)));
        let session = SerialSession::default();
        Self { firmware, session, interpreter: Interpreter::default(), steps: 0, centre: None, is_worse }
    }

    /// Computes a step, and returns the motor packet.
    fn step(&mut self, state: &[u8; 144], rc_packet: &[u8; 40]) -> [u8; servo::SIZE] {
        self.steps += 1;
        if let Some((_, frame)) = rc::decode(rc_packet)
            && self.steps.is_multiple_of(20)
        {
            self.firmware.receive_rc(&frame, RcSource::Udp);
        }
        if self.is_worse && self.steps.is_multiple_of(1000) {
            let line = "set ap_landing_descent_rate = 150";
            self.firmware.run_cli(&mut Interpreter::new(CliMode::Message), line);
        }
        let dialect = Dialect::SitlGz;
        let packet = Packet::parse(state).unwrap();
        let sensors = self.sensors(&dialect.decode(&packet, dialect.usual_gravity()));
        let motors = self.firmware.step(&sensors);
        servo::encode(MotorOrder::Native.arrange(servo::pulses_us(&motors)))
    }

    fn sensors(&mut self, state: &State) -> SensorFrame {
        let (lat_deg, lon_deg) = *self.centre.get_or_insert((state.lat_deg, state.lon_deg));
        let (lat_deg, lon_deg) = (mirrored(lat_deg, state.lat_deg), mirrored(lon_deg, state.lon_deg));
        let is_due = |every: u64| self.steps.is_multiple_of(every);
        SensorFrame {
            time: SimTime(self.steps * STEP_US),
            rate_flu: state.rate_flu,
            specific_force_flu: state.specific_force_flu,
            pressure_pa: is_due(20).then_some(state.pressure_pa),
            mag_flu: is_due(10).then(|| state.attitude.inverse_transform_vector(&FIELD_ENU.into())),
            gps: is_due(100).then(|| GpsSample {
                fix: true,
                sats: 12,
                position: LatLon::from_degrees(lat_deg, lon_deg),
                alt_amsl_cm: (state.alt_m * 100.0) as i32,
                vel_enu: state.vel_enu,
                hdop: 0.0,
                horizontal_accuracy_m: 0.5,
                vertical_accuracy_m: 0.5,
                speed_accuracy_mps: 0.0,
                latency_s: 0.0,
            }),
            battery: None,
            truth_attitude: Some(state.attitude),
        }
    }

    /// Takes bytes of the serial port in, and returns the answer.
    fn serve(&mut self, bytes: &[u8]) -> Vec<u8> {
        let now = Duration::from_millis(self.steps);
        self.session.push(bytes);
        while let Some(request) = self.session.next(now) {
            match request {
                SerialRequest::Msp(frame) => {
                    let reply = self.firmware.run_msp(frame.code, &frame.payload, None).reply;
                    self.session.reply(&frame, reply);
                }
                SerialRequest::EnterCli { interactive } => {
                    self.interpreter =
                        Interpreter::new(if interactive { CliMode::Interactive } else { CliMode::Framed });
                    self.session.admit(true, now);
                }
                SerialRequest::Line { line, .. } if line.trim() == "save" => self.save(),
                SerialRequest::Line { line, source } => {
                    let mut own = Interpreter::new(CliMode::Message);
                    let of_message = source == LineSource::Message;
                    let interpreter = if of_message { &mut own } else { &mut self.interpreter };
                    let reply = self.firmware.run_cli(interpreter, &line);
                    self.session.answer(&reply.into());
                }
                SerialRequest::Restart => std::process::exit(0),
                SerialRequest::Complete { .. }
                | SerialRequest::Flush
                | SerialRequest::LeftCli
                | SerialRequest::Ignored { .. } => {}
                SerialRequest::Foreign => self.session = SerialSession::default(),
            }
        }
        self.session.take_output()
    }

    /// Stores the configuration and ends, as the public executable does.
    fn save(&mut self) -> ! {
        let mut text = String::new();
        for dump in ["dump all", "waypoint list"] {
            text += &self.firmware.run_cli(&mut Interpreter::new(CliMode::Framed), dump).text;
        }
        std::fs::write(Path::new(MEMORY), text).unwrap();
        std::process::exit(0);
    }
}
