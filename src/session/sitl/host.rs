//! Runs a firmware between an external simulator and the clients of the doors.

#![allow(clippy::disallowed_methods, reason = "the drop-in lives by the wall clock, as the executable does")]

use std::io;
use std::net::{IpAddr, SocketAddr};
use std::time::{Duration, Instant};

use tokio::sync::mpsc;

use super::lines::{self, FlightLine, OpenResult, SitlPorts};
use crate::firmware::cli::BuildInfo;
use crate::firmware::{Firmware, FirmwareOptions};
use crate::link::proto::fdm_link::{FdmLinkConfig, Verdict};
use crate::link::{DoorKind, Doors, DoorsConfig, ExternalSimulator, MotorPort, Request};
use crate::session::{Handled, RequestHandler};
use crate::signals::fdm::MotorOrder;
use crate::signals::{MotorCommand, SensorFrame, SimTime};
use crate::storage::Store;
use crate::telemetry::LinkState;

/// Requests that may wait.
const INBOX: usize = 1024;
/// Length of a firmware tick, µs.
const TICK_US: u64 = 1000;
/// Rhythm in which the firmware follows the wall clock until a simulator speaks.
const BEAT: Duration = Duration::from_millis(5);
/// Interval of the lines about the flight.
const SECOND: Duration = Duration::from_secs(1);
/// Most wall time that is caught up with at once.
const CATCH_UP: Duration = Duration::from_millis(100);
/// Firmware time between two looks at RC that a fast simulator would lose, µs.
const RC_LOOK_US: u64 = 20_000;

/// How to run.
#[derive(Debug, Clone, PartialEq)]
pub struct SitlConfig {
    /// The doors; their UDP ports are those of `ports`.
    pub doors: DoorsConfig,
    /// Where motors are sent.
    pub motors_ip: IpAddr,
    /// The UDP ports.
    pub ports: SitlPorts,
    /// How the firmware is built.
    pub firmware: FirmwareOptions,
    /// What it says about its build.
    pub build: BuildInfo,
    /// How to speak with the simulator.
    pub fdm: FdmLinkConfig,
    /// In which order the simulator's model expects the motors.
    pub motor_order: MotorOrder,
    /// End instead of starting the firmware anew.
    pub exit_on_reboot: bool,
}

/// A line for the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Said {
    /// On standard output.
    Out(String),
    /// On standard error.
    Err(String),
}

/// Why it ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SitlEnd {
    /// Somebody stopped it.
    Stopped,
    /// The firmware restarted, and was told to end then.
    Rebooted,
}

/// Why it cannot run.
#[derive(Debug, thiserror::Error)]
pub enum SitlError {
    /// Doors that cannot be opened; each was told in a line of its own.
    #[error("{0}")]
    Doors(String),
    /// There is no socket for the motors.
    #[error("cannot send motors to {to}: {error}")]
    Motors {
        /// Where they were to go.
        to: SocketAddr,
        /// What the system says.
        error: io::Error,
    },
}

/// A running drop-in.
pub struct Sitl {
    firmware: Firmware,
    store: Store,
    handler: RequestHandler,
    simulator: ExternalSimulator,
    doors: Doors,
    requests: mpsc::Receiver<Request>,
    exit_on_reboot: bool,
    /// Firmware time.
    time: SimTime,
    motors: MotorCommand,
    /// Wall time up to which the firmware has run while no simulator spoke.
    wall: Instant,
    next_line: Instant,
    /// Wall and firmware time of the newest measurement of the simulator's speed.
    measured: (Instant, SimTime),
    speed: f64,
    next_rc_look: SimTime,
    clients: u32,
    saw_fdm: bool,
    saw_rc: bool,
}

impl Sitl {
    /// Opens the doors and boots the firmware. Every link is told in a line with its result.
    ///
    /// # Errors
    /// When a door cannot be opened: a simulator that silently receives nothing costs an hour.
    pub async fn open(
        config: SitlConfig,
        mut store: Store,
        print: &mut impl FnMut(Said),
    ) -> Result<Self, SitlError> {
        let (inbox, requests) = mpsc::channel(INBOX);
        let (doors, motors) = open_links(&config, inbox, print).await;
        let motors = motors?;
        let problems: Vec<String> = doors.problems().map(ToString::to_string).collect();
        if !problems.is_empty() {
            return Err(SitlError::Doors(problems.join("\n")));
        }
        if let Some(address) = doors.address(DoorKind::Tcp) {
            print(Said::Err(format!("bind port {} for UART1", address.port())));
        }
        if let Some(address) = doors.address(DoorKind::WebSocket) {
            print(Said::Err(format!("[SITL] websocket for the Betaflight App: ws://{address}")));
        }
        let loaded = store.load();
        loaded.findings.into_iter().for_each(|finding| print(Said::Err(finding)));
        let mut firmware = Firmware::new(loaded.configuration, config.firmware);
        firmware.set_build(config.build);
        firmware.set_storage_facts(store.facts());
        let now = Instant::now();
        Ok(Self {
            firmware,
            store,
            handler: RequestHandler::new(doors.restart_bell(), false),
            simulator: ExternalSimulator::start(config.fdm, config.motor_order, motors, now),
            doors,
            requests,
            exit_on_reboot: config.exit_on_reboot,
            time: SimTime::ZERO,
            motors: MotorCommand::default(),
            wall: now,
            next_line: now + SECOND,
            measured: (now, SimTime::ZERO),
            speed: 1.0,
            next_rc_look: SimTime::ZERO,
            clients: 0,
            saw_fdm: false,
            saw_rc: false,
        })
    }

    /// Where a door listens.
    #[must_use]
    pub fn address(&self, door: DoorKind) -> Option<SocketAddr> {
        self.doors.address(door)
    }

    /// Runs until `stop`, or until the firmware restarts and was told to end then. `each_second` sees the firmware once
    /// a second while a simulator flies it.
    pub async fn run(
        mut self,
        print: &mut impl FnMut(Said),
        each_second: &mut impl FnMut(&Firmware),
        stop: impl Future<Output = ()>,
    ) -> SitlEnd {
        tokio::pin!(stop);
        let end = loop {
            let due = self.due();
            tokio::select! {
                // In this order: a simulator that waits comes before what is due by time.
                biased;
                () = &mut stop => break SitlEnd::Stopped,
                request = self.requests.recv() => {
                    let Some(request) = request else { break SitlEnd::Stopped };
                    if self.attend(request, print) && self.exit_on_reboot {
                        break SitlEnd::Rebooted;
                    }
                }
                () = tokio::time::sleep_until(due.into()) => {}
            }
            self.beat(Instant::now(), print, each_second);
        };
        self.doors.close().await;
        end
    }

    fn due(&self) -> Instant {
        let beat = if self.saw_fdm { self.next_line } else { self.wall + BEAT };
        beat.min(self.next_line).min(self.simulator.due())
    }

    /// Carries out what is due by time.
    fn beat(&mut self, now: Instant, print: &mut impl FnMut(Said), each_second: &mut impl FnMut(&Firmware)) {
        self.simulator.poll(now);
        if !self.saw_fdm {
            self.follow_wall_clock(now);
        }
        self.tell_clients(print);
        if now >= self.next_line {
            self.next_line = now + SECOND;
            self.measure_speed(now);
            if self.simulator.state(now) == LinkState::Flowing {
                self.flight_lines(print);
                each_second(&self.firmware);
            }
        }
    }

    /// Until a simulator speaks, time passes as on the wall and nothing is sensed.
    fn follow_wall_clock(&mut self, now: Instant) {
        let oldest = now.checked_sub(CATCH_UP).unwrap_or(now);
        self.wall = self.wall.max(oldest);
        while now.saturating_duration_since(self.wall).as_micros() >= u128::from(TICK_US) {
            self.wall += Duration::from_micros(TICK_US);
            self.time.0 += TICK_US;
            self.motors = self.firmware.step(&SensorFrame { time: self.time, ..SensorFrame::default() });
        }
    }

    /// Attends to a request; says whether the firmware restarted.
    fn attend(&mut self, request: Request, print: &mut impl FnMut(Said)) -> bool {
        match &request {
            Request::Rc { stamp_s, frame, .. } if !self.saw_rc => {
                self.saw_rc = true;
                print(Said::Out(lines::first_rc_line(*stamp_s, frame)));
            }
            Request::Fdm { datagram, from, .. } if !self.saw_fdm => {
                if let Some(line) = lines::first_fdm_line(datagram, *from) {
                    print(Said::Out(line));
                }
            }
            _ => {}
        }
        let Handled { notices, restarted, fdm } =
            self.handler.handle(request, &mut self.firmware, &mut self.store, Instant::now());
        notices.into_iter().for_each(|notice| print(Said::Err(notice)));
        if restarted {
            print(Said::Out(lines::RESET_LINE.to_owned()));
        }
        if let Some((datagram, at)) = fdm {
            self.fly(&datagram, at, print);
        }
        restarted
    }

    /// Runs the firmware on a datagram of the simulator and answers.
    fn fly(&mut self, datagram: &[u8], at: Instant, print: &mut impl FnMut(Said)) {
        let Self { simulator, firmware, time, motors, handler, next_rc_look, speed, .. } = self;
        let received = simulator.receive(datagram, at, |sensors, ticks| {
            let mut frame = *sensors;
            for _ in 0..ticks {
                time.0 += TICK_US;
                frame.time = *time;
                if *time >= *next_rc_look {
                    next_rc_look.0 = time.0 + RC_LOOK_US;
                    handler.keep_rc_fresh(firmware, *speed, at);
                }
                *motors = firmware.step(&frame);
                // Held inputs; a sample is new only once.
                (frame.pressure_pa, frame.mag_flu, frame.gps) = (None, None, None);
            }
            *motors
        });
        self.saw_fdm |= !matches!(received.verdict, Verdict::Refused(_));
        if received.verdict == (Verdict::Resync { restarted: true }) {
            self.firmware.restart_in_place();
            self.handler.after_restart(false, &mut self.firmware);
        }
        for notice in received.notices {
            print(Said::Err(notice.to_string()));
        }
    }

    fn measure_speed(&mut self, now: Instant) {
        let (wall, time) = std::mem::replace(&mut self.measured, (now, self.time));
        let elapsed = now.saturating_duration_since(wall).as_secs_f64();
        if elapsed > 0.0 {
            self.speed = self.time.seconds_since(time) / elapsed;
        }
    }

    fn flight_lines(&self, print: &mut impl FnMut(Said)) {
        let firmware = &self.firmware;
        let t_ms = self.time.0 / 1000;
        let craft = firmware.craft_view();
        if !craft.armed && !craft.arming_flags().is_empty() {
            print(Said::Out(lines::blocked_line(t_ms, craft.arming_flags())));
        }
        let facts = firmware.msp_facts(None);
        let line = FlightLine {
            t_ms,
            speed_mps: facts.gps.ground_speed_mps,
            position: facts.gps.position,
            alt_m: facts.gps.alt_amsl_m,
            attitude_deg: [facts.roll_deg, -facts.pitch_deg, facts.heading_deg],
        };
        print(Said::Out(line.to_string()));
    }

    /// Clients of the serial port come and go.
    fn tell_clients(&mut self, print: &mut impl FnMut(Said)) {
        let clients = self.doors.clients(DoorKind::Tcp);
        while self.clients < clients {
            print(Said::Err(format!("New connection on UART1, {}", self.clients)));
            self.clients += 1;
            print(Said::Err(format!("[NEW]UART1: {},1", self.clients)));
        }
        while self.clients > clients {
            self.clients -= 1;
            print(Said::Err(format!("[CLS]UART1: 1,{}", self.clients)));
        }
    }
}

/// Opens the links and tells how that went.
async fn open_links(
    config: &SitlConfig,
    inbox: mpsc::Sender<Request>,
    print: &mut impl FnMut(Said),
) -> (Doors, Result<MotorPort, SitlError>) {
    let (ip, ports) = (config.motors_ip.to_string(), config.ports);
    print(Said::Out(lines::output_line(&ip, ports)));
    let wanted = DoorsConfig { rc_port: Some(ports.rc), fdm_port: Some(ports.fdm), ..config.doors.clone() };
    let (doors, _) = Doors::open(&wanted, inbox).await;
    let to = |port| SocketAddr::new(config.motors_ip, port);
    let motors = MotorPort::open(to(ports.motors), to(ports.raw));
    let motors_opened = if motors.is_ok() { OpenResult::Done } else { OpenResult::NoSocket };
    let opened = |door| match doors.address(door) {
        Some(_) => OpenResult::Done,
        None => OpenResult::BindFailed,
    };
    // A port that the system chose is known only now.
    let chosen = |door, wanted| doors.address(door).map_or(wanted, |address| address.port());
    let ports =
        SitlPorts { fdm: chosen(DoorKind::Fdm, ports.fdm), rc: chosen(DoorKind::Rc, ports.rc), ..ports };
    let links = lines::link_lines(&ip, ports, motors_opened, opened(DoorKind::Fdm), opened(DoorKind::Rc));
    links.into_iter().for_each(|line| print(Said::Out(line)));
    (doors, motors.map_err(|error| SitlError::Motors { to: to(ports.motors), error }))
}

/// Opens the links, tells how that went, and closes them again: what the executable does before it reads a
/// configuration file.
pub async fn show_links(config: &SitlConfig, print: &mut impl FnMut(Said)) {
    let (inbox, _nobody_asks) = mpsc::channel(1);
    let (doors, _motors) = open_links(config, inbox, print).await;
    doors.close().await;
}
