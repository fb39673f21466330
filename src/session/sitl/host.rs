//! Runs a session whose craft is moved by an external simulator, and prints the lines of the SITL executable.

#![allow(clippy::disallowed_methods, reason = "the drop-in runs in real time, as the executable does")]

use std::net::{IpAddr, SocketAddr};
use std::time::{Duration, Instant};

use tokio::sync::watch;
use tokio::time::{MissedTickBehavior, interval};

use super::lines::{self, FlightLine, OpenResult, SitlPorts};
use crate::events::{Event, SessionEvent, SimulatorNotice};
use crate::firmware::FirmwareOptions;
use crate::firmware::cli::BuildInfo;
use crate::link::conventions::MotorOrder;
use crate::link::endpoint::{BadPackets, EndpointKind, EndpointStatus};
use crate::link::proto::fdm_link::FdmLinkConfig;
use crate::link::{ExternalSimulator, ListenConfig, Listeners, MotorPort};
use crate::session::links::{Links, MotorTargets, MotorsError};
use crate::session::{Command, Handle, SessionConfig, start};
use crate::sim::{WorldConfig, WorldError};
use crate::storage::{StorageError, Store};
use crate::telemetry::FirmwareProfile;
use crate::telemetry::{EventKind, FirmwareEvent, LinkState, NavEvent, Snapshot};
use crate::vehicle::{Vehicle, VehicleCommand, VehicleConfig};

/// The interval at which clients of the serial port are counted.
const CLIENT_INTERVAL: Duration = Duration::from_millis(5);
/// The interval of the lines about the flight.
const FLIGHT_INTERVAL: Duration = Duration::from_secs(1);

#[derive(Debug, Clone, PartialEq)]
pub struct SitlConfig {
    /// The doors. Their UDP ports are those of `ports`.
    pub doors: ListenConfig,
    /// The address to which motors are sent.
    pub motors_ip: IpAddr,
    pub ports: SitlPorts,
    /// The build options of the firmware.
    pub firmware: FirmwareOptions,
    /// The reported build information.
    pub build: BuildInfo,
    /// The settings of the link to the simulator.
    pub fdm: FdmLinkConfig,
    /// The order in which the simulator's model expects the motors.
    pub motor_order: MotorOrder,
    /// The laws of the autopilot, instead of the stored choice. They are stored, too.
    pub profile: Option<FirmwareProfile>,
    /// `true` to exit instead of restarting the firmware.
    pub exit_on_reboot: bool,
}

/// A line for the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum OutputLine {
    Out(String),
    Err(String),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SitlEnd {
    Stopped,
    /// The firmware restarted and was configured to exit then.
    Rebooted,
}

/// The reason why the firmware cannot run.
#[derive(Debug, thiserror::Error)]
pub enum SitlError {
    /// Doors that cannot be opened. Each was reported in its own line.
    #[error("{0}")]
    Doors(String),
    /// There is no socket for the motors.
    #[error(transparent)]
    Motors(#[from] MotorsError),
    /// The vehicle cannot be created.
    #[error(transparent)]
    Vehicle(#[from] WorldError),
    /// The system cannot start a thread.
    #[error("cannot start a thread: {0}")]
    Thread(#[from] std::io::Error),
}

pub struct Sitl {
    session: Handle,
    doors: Listeners,
    /// Publishes the state of the doors to the session.
    publish: watch::Sender<Vec<EndpointStatus>>,
    exit_on_reboot: bool,
    /// The number of reported clients of the serial port.
    clients: u32,
}

impl Sitl {
    /// Opens the doors and boots the firmware. Prints a line with the result for every link.
    ///
    /// # Errors
    /// Returns an error if a door cannot be opened: a simulator that silently receives nothing would cost an
    /// hour of search.
    pub async fn open(
        config: SitlConfig,
        mut store: Store,
        print: &mut impl FnMut(OutputLine),
    ) -> Result<Self, SitlError> {
        let (links, motors) = open_links(&config, print).await;
        let motors = motors?;
        let problems: Vec<String> = links.doors.problems().map(ToString::to_string).collect();
        if !problems.is_empty() {
            return Err(SitlError::Doors(problems.join("\n")));
        }
        if let Some(address) = links.doors.address(EndpointKind::Tcp) {
            print(OutputLine::Err(format!("bind port {} for UART1", address.port())));
        }
        if let Some(address) = links.doors.address(EndpointKind::WebSocket) {
            print(OutputLine::Err(format!("[SITL] websocket for the Betaflight App: ws://{address}")));
        }
        let vehicle = boot(&config, &mut store, print)?;
        let simulator = ExternalSimulator::start(config.fdm, config.motor_order, motors, Instant::now());
        let (doors, endpoints, publish) = links.endpoints(Some(simulator));
        let session = start(SessionConfig {
            vehicle,
            store,
            starter_modes: false,
            speed: 1.0,
            takeoff_m: 0.0,
            is_recorded: false,
            endpoints: Some(endpoints),
            remote: None,
            first_events: Vec::new(),
        })?;
        Ok(Self { session, doors, publish, exit_on_reboot: config.exit_on_reboot, clients: 0 })
    }

    /// Returns the address at which a door listens.
    pub fn address(&self, door: EndpointKind) -> Option<SocketAddr> {
        self.doors.address(door)
    }

    /// Runs until `stop`, or until the firmware restarts and was configured to exit then. Returns the doors,
    /// which are still open. `each_second` gets the vehicle once a second while a simulator flies it.
    pub async fn run(
        mut self,
        print: &mut impl FnMut(OutputLine),
        each_second: &mut impl FnMut(&Snapshot),
        stop: impl Future<Output = ()>,
    ) -> (SitlEnd, Listeners) {
        tokio::pin!(stop);
        let mut next_line = Instant::now() + FLIGHT_INTERVAL;
        let mut count_clients = interval(CLIENT_INTERVAL);
        count_clients.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let end = loop {
            tokio::select! {
                biased;
                () = &mut stop => break SitlEnd::Stopped,
                event = self.session.events.recv() => {
                    let Some(event) = event else { break SitlEnd::Stopped };
                    let restarted = event.kind == SessionEvent::Restarted;
                    print_event(&event, print);
                    if restarted && self.exit_on_reboot {
                        break SitlEnd::Rebooted;
                    }
                }
                _ = count_clients.tick() => {}
            }
            self.print_clients(print);
            let now = Instant::now();
            if now >= next_line {
                next_line = now + FLIGHT_INTERVAL;
                self.publish.send_replace(self.doors.status());
                self.report_flight(print, each_second);
            }
        };
        let Handle { commands, thread, view, .. } = self.session;
        drop(commands.send(Command::Quit).await);
        // The session sends nothing more.
        drop(thread.join());
        let senseless = BadPackets::of(&view.borrow().endpoints).senseless;
        let bad = BadPackets { senseless, ..BadPackets::of(&self.doors.status()) };
        if !bad.is_none() {
            print(OutputLine::Err(format!("[SITL] Bad packets: {bad}.")));
        }
        (end, self.doors)
    }

    fn report_flight(&self, print: &mut impl FnMut(OutputLine), each_second: &mut impl FnMut(&Snapshot)) {
        let view = self.session.view.borrow().clone();
        if view.simulator == Some(LinkState::Flowing) {
            print_flight(&view.vehicle, print);
            each_second(&view.vehicle);
        }
    }

    /// Prints the connections and disconnections of serial clients.
    fn print_clients(&mut self, print: &mut impl FnMut(OutputLine)) {
        let clients = self.doors.clients(EndpointKind::Tcp);
        while self.clients < clients {
            print(OutputLine::Err(format!("New connection on UART1, {}", self.clients)));
            self.clients += 1;
            print(OutputLine::Err(format!("[NEW]UART1: {},1", self.clients)));
        }
        while self.clients > clients {
            self.clients -= 1;
            print(OutputLine::Err(format!("[CLS]UART1: 1,{}", self.clients)));
        }
    }
}

/// Boots the firmware on the stored configuration, with an external simulator and without own sticks.
fn boot(
    config: &SitlConfig,
    store: &mut Store,
    print: &mut impl FnMut(OutputLine),
) -> Result<Vehicle, WorldError> {
    let mut loaded = store.load();
    if let Some(profile) =
        config.profile.filter(|profile| *profile != loaded.configuration.settings.profile())
    {
        loaded.configuration.settings.set_profile(profile);
        // It is stored, because the firmware reads its settings again when it restarts.
        loaded.findings.extend(store.save(&loaded.configuration).err().map(|error| error.to_string()));
    }
    loaded.findings.into_iter().for_each(|finding| print(OutputLine::Err(finding)));
    if let Some(StorageError::Protected { .. }) = store.refusal() {
        let hint = "[SITL] --overwrite-config lets save replace it; --config FILE loads your settings.";
        print(OutputLine::Err(hint.to_owned()));
    }
    let mut vehicle = Vehicle::with_external_physics(VehicleConfig {
        world: WorldConfig::default(),
        firmware: config.firmware,
        configuration: loaded.configuration,
        live: true,
    })?;
    vehicle.apply(&VehicleCommand::CutRc(true));
    vehicle.set_build(config.build.clone());
    vehicle.set_storage_facts(store.facts());
    Ok(vehicle)
}

/// Prints the line about an event, if the executable has one.
fn print_event(event: &Event, print: &mut impl FnMut(OutputLine)) {
    match &event.kind {
        SessionEvent::FirstState { stamp_s, from } => {
            print(OutputLine::Out(lines::first_fdm_line(*stamp_s, *from)));
        }
        SessionEvent::FirstRc { stamp_s, frame } => {
            print(OutputLine::Out(lines::first_rc_line(*stamp_s, frame)));
        }
        SessionEvent::Restarted => print(OutputLine::Out(lines::RESET_LINE.to_owned())),
        SessionEvent::Notice(notice) | SessionEvent::Warning(notice) => {
            print(OutputLine::Err(notice.clone()));
        }
        SessionEvent::Simulator(SimulatorNotice::Adapted(notice)) => {
            print(OutputLine::Err(notice.to_string()));
        }
        SessionEvent::Vehicle(EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Refused(refusal)))) => {
            print(OutputLine::Out(lines::refused_line(event.time.0 / 1000, *refusal)));
        }
        SessionEvent::Simulator(_)
        | SessionEvent::Remote(_)
        | SessionEvent::Replay(_)
        | SessionEvent::Vehicle(_)
        | SessionEvent::ArmingBlocked(_)
        | SessionEvent::Branch { .. }
        | SessionEvent::Endpoints(_) => {}
    }
}

fn print_flight(vehicle: &Snapshot, print: &mut impl FnMut(OutputLine)) {
    let t_ms = vehicle.time.0 / 1000;
    let (craft, estimate) = (&vehicle.craft, &vehicle.estimate);
    if craft.armed == Some(false) && !craft.arming_flags().is_empty() {
        print(OutputLine::Out(lines::blocked_line(t_ms, craft.arming_flags())));
    }
    let gps = craft.gps.unwrap_or_default();
    let degrees = |angle: Option<f64>| angle.unwrap_or_default();
    let line = FlightLine {
        t_ms,
        speed_mps: gps.ground_speed_mps,
        position: gps.position,
        alt_m: gps.alt_amsl_m,
        attitude_deg: [
            degrees(estimate.roll_deg),
            -degrees(estimate.pitch_deg),
            degrees(estimate.heading_deg),
        ],
    };
    print(OutputLine::Out(line.to_string()));
}

/// Opens the links and prints the results.
async fn open_links(
    config: &SitlConfig,
    print: &mut impl FnMut(OutputLine),
) -> (Links, Result<MotorPort, MotorsError>) {
    let (ip, ports) = (config.motors_ip.to_string(), config.ports);
    print(OutputLine::Out(lines::output_line(&ip, ports)));
    let wanted = ListenConfig { rc_port: Some(ports.rc), fdm_port: Some(ports.fdm), ..config.doors.clone() };
    let links = Links::open(&wanted).await;
    let motors = MotorTargets { ip: config.motors_ip, motors: ports.motors, raw: ports.raw }.open();
    let motors_opened = if motors.is_ok() { OpenResult::Done } else { OpenResult::NoSocket };
    let opened = |door| match links.doors.address(door) {
        Some(_) => OpenResult::Done,
        None => OpenResult::BindFailed,
    };
    // A port that the system chose is known only now.
    let chosen = |door, wanted| links.doors.address(door).map_or(wanted, |address| address.port());
    let ports = SitlPorts {
        fdm: chosen(EndpointKind::Fdm, ports.fdm),
        rc: chosen(EndpointKind::Rc, ports.rc),
        ..ports
    };
    let reported =
        lines::link_lines(&ip, ports, motors_opened, opened(EndpointKind::Fdm), opened(EndpointKind::Rc));
    reported.into_iter().for_each(|line| print(OutputLine::Out(line)));
    (links, motors)
}

/// Opens the links, prints the results, and closes them again, as the executable does before it reads a
/// configuration file.
pub async fn show_links(config: &SitlConfig, print: &mut impl FnMut(OutputLine)) {
    let (links, _motors) = open_links(config, print).await;
    links.doors.close().await;
}
