//! Opens the link to a remote firmware, and starts its program.
#![allow(clippy::disallowed_methods, reason = "a program is started and spoken with in wall time")]

use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener, UdpSocket};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use super::{FirmwarePorts, RemoteFirmware, on_the_wall_clock};
use crate::args::UdpPorts;
use crate::fc::{Provision, RemoteEnds, RemoteLink, starter_lines};
use crate::link::conventions::FirmwareClock;
use crate::link::lockstep::{Lockstep, LockstepConfig, LockstepPorts, NoReport};
use crate::link::proto::sitl_feed::FeedConfig;
use crate::link::{ChildConfig, ChildEnd, FcPlace, FcStream, SitlChild, SitlPeer, SitlPorts};
use crate::process::error::AppError;
use crate::storage::FirmwareFolder;
use crate::storage::state_file;
use crate::vehicle::Vehicle;

/// The subfolder of the state directory for the firmware's configuration. It is not our own folder, because the
/// firmware would overwrite our configuration.
const DIRECTORY: &str = "firmware";
/// The file with the firmware's configuration.
const STORED: &str = "eeprom.bin";
/// The file next to it. After a setup by betadeck it names the executable that made the configuration. A firmware
/// already writes its configuration at its first start, and a firmware with another layout starts with defaults.
const PROVISIONED: &str = "provisioned";
/// The longest text of that file, bytes.
const MAX_NOTE: u64 = 64 << 10;
/// The wall time within which an executable that can run in simulated time has booted, even on a busy machine.
const BOOTS_WITHIN: Duration = Duration::from_secs(10);

#[derive(Debug)]
pub(crate) struct OpenLink {
    /// The link, for the session or the flight.
    pub(crate) link: RemoteLink,
    /// `true` if it starts without a configuration of its own.
    pub(crate) is_fresh: bool,
    /// The place of its configuration, if betadeck started it.
    pub(crate) stored_in: Option<PathBuf>,
    /// Its directory, if that exists only as long as this program.
    pub(crate) directory: Option<FirmwareFolder>,
    /// The reason why it does not run in simulated time, although it could, as a sentence.
    not_in_steps: Option<String>,
}

impl OpenLink {
    /// Returns the sentences for the user about the start.
    pub(crate) fn notices(&self) -> impl Iterator<Item = String> {
        self.not_in_steps.clone().into_iter().chain(self.place_notice())
    }

    /// Returns the place of the firmware's configuration, as a sentence.
    fn place_notice(&self) -> Option<String> {
        let place = self.stored_in.as_ref()?.display();
        Some(match (&self.directory, self.is_fresh) {
            (Some(_), _) => {
                "The firmware starts without a configuration, and its saved configuration is lost when \
                 this program ends."
                    .to_owned()
            }
            (None, true) => {
                format!("The firmware starts without a configuration; it saves its configuration in {place}.")
            }
            (None, false) => format!("The firmware starts with its saved configuration in {place}."),
        })
    }
}

/// Starts the program for `vehicle`, which its motors fly, or finds the running one. Without a state directory it
/// runs in a folder that ends with this program.
///
/// Must be called on a tokio runtime.
///
/// # Errors
/// Returns an error if a port is not free, or if the system cannot start the program.
pub(crate) fn open(
    firmware: &RemoteFirmware,
    vehicle: &Vehicle,
    state: Option<&Path>,
) -> Result<OpenLink, AppError> {
    let ip = IpAddr::V4(Ipv4Addr::LOCALHOST);
    let ports = firmware.ports;
    let UdpPorts { raw, motors, fdm, rc } = ports.udp;
    let home = vehicle.local_frame().map(|frame| frame.to_geodetic(nalgebra::Vector3::zeros()));
    let feed = FeedConfig {
        dialect: ports.dialect,
        stamps: firmware.stamps,
        motor_order: ports.motor_order,
        home: home.ok_or_else(|| AppError::internal("a remote firmware needs the embedded physics"))?,
    };
    let (mut directory, mut is_fresh, mut stored_in, mut note) = (None, false, None, None);
    let (mut child, mut lockstep, mut not_in_steps) = (None, None, None);
    let name = firmware.executable.as_ref().and_then(|program| program.file_name()).map_or_else(
        || format!("the firmware at port {}", ports.tcp),
        |name| name.to_string_lossy().into_owned(),
    );
    if let Some(program) = &firmware.executable {
        let place = match state {
            Some(state) => state.join(DIRECTORY),
            None => {
                let temporary = FirmwareFolder::make().map_err(|error| {
                    AppError::environment(format!("cannot make a directory for the firmware: {error}"))
                })?;
                directory.insert(temporary).path().to_owned()
            }
        };
        is_fresh = !place.join(STORED).exists();
        stored_in = Some(place.clone());
        note = Some((place.join(PROVISIONED), identity(program)));
        let config = child_config(program.clone(), firmware.arguments.clone(), place)?;
        if firmware.clock == FirmwareClock::Sim {
            match boot(&config, firmware, Duration::from_micros(vehicle.step_us()))? {
                Ok(booted) => lockstep = Some(booted),
                Err(why) => not_in_steps = Some(on_the_wall_clock(&name, why)),
            }
        }
        child = lockstep.is_none().then_some(config);
    }
    let now = Instant::now();
    let mut link = match lockstep {
        Some(lockstep) => RemoteLink::in_steps(name, lockstep, feed, now),
        None => {
            let peer = SitlPeer::open(feed, SitlPorts { ip, raw, motors, fdm, rc }, now)
                .map_err(|error| AppError::environment(error.to_string()))?;
            if child.is_some() {
                check_free(SocketAddr::new(ip, ports.tcp), &[fdm, rc])?;
            }
            let child = child.map(SitlChild::start).transpose();
            let child =
                child.map_err(|error| AppError::environment(format!("cannot start a thread: {error}")))?;
            let stream = FcStream::open(FcPlace::Tcp { host: ip.to_string(), port: ports.tcp });
            RemoteLink::new(RemoteEnds { name, stream, peer: Some(peer), child }, now)
        }
    };
    let lines = starter_lines(&firmware.lines, is_fresh).map_err(AppError::internal)?;
    let is_set = |(file, words): &(PathBuf, String)| matches!(state_file::read(file, MAX_NOTE), Ok(Some(noted)) if noted == words.as_bytes());
    match note {
        None if lines.is_empty() => {}
        None => link.protocol_mut().provision(Provision::new(lines, firmware.may_write)),
        Some(note) if !is_fresh && lines.is_empty() && is_set(&note) => {}
        Some(note) => {
            let mut provision = Provision::new(lines, is_fresh || firmware.may_write);
            if !is_fresh && !is_set(&note) {
                let fresh = starter_lines(&firmware.lines, true).map_err(AppError::internal)?;
                provision = provision.or_when_bare(fresh);
            }
            link.protocol_mut().provision(provision.noted_in(note.0, note.1));
        }
    }
    Ok(OpenLink { link, is_fresh, stored_in, directory, not_in_steps })
}

/// Returns a text that differs between executables and between builds of the same one.
fn identity(program: &Path) -> String {
    let modified = std::fs::metadata(program).and_then(|file| file.modified()).ok();
    let since = modified.and_then(|modified| modified.duration_since(SystemTime::UNIX_EPOCH).ok());
    format!("{}\n{}\n", program.display(), since.unwrap_or_default().as_nanos())
}

fn child_config(
    program: PathBuf,
    arguments: Vec<String>,
    directory: PathBuf,
) -> Result<ChildConfig, AppError> {
    let launcher = std::env::current_exe()
        .map_err(|error| AppError::environment(format!("cannot find this program: {error}")))?;
    Ok(ChildConfig { program, arguments, directory, launcher })
}

/// Boots an executable in simulated time. Returns the reason, as part of a sentence, if it must run on the wall clock.
///
/// # Errors
/// Returns an error if it cannot be started, or ends at once.
fn boot(
    config: &ChildConfig,
    firmware: &RemoteFirmware,
    step: Duration,
) -> Result<Result<Lockstep, &'static str>, AppError> {
    let FirmwarePorts { tcp, udp: UdpPorts { motors, fdm, rc, .. }, .. } = firmware.ports;
    let ports = LockstepPorts { fdm, rc, motors, tcp };
    let start = |own_threads| {
        let keeps_inputs = firmware.keeps_inputs;
        Lockstep::start(LockstepConfig { child: config.clone(), ports, step, own_threads, keeps_inputs })
            .map_err(|error| AppError::environment(error.to_string()))
    };
    for own_threads in [false, true] {
        let (mut lockstep, started) = (start(own_threads)?, Instant::now());
        let reason = loop {
            match lockstep.wait() {
                Ok(_) if lockstep.listens() => return Ok(Ok(lockstep)),
                Ok(_) => return Ok(Err("it has opened no serial port of the number of --tcp-port")),
                Err(NoReport::Replaced) => {}
                Err(NoReport::Stopped) if started.elapsed() < BOOTS_WITHIN => {}
                Err(reason) => break reason,
            }
        };
        // Its threads may depend on each other in a way that needs threads of their own.
        let may_differ = lockstep.has_guests() && !matches!(reason, NoReport::Ended(ChildEnd::Code(_)));
        match reason {
            _ if may_differ => {}
            NoReport::Ended(end) => return Err(AppError::environment(lockstep.why_ended(end))),
            _ => break,
        }
    }
    Ok(Err("it does not wait for its clock as a SITL of Betaflight does"))
}

/// Checks that the ports are free. The executable continues without a port that is taken, and would then receive
/// nothing without a visible reason.
fn check_free(tcp: SocketAddr, udp: &[u16]) -> Result<(), AppError> {
    let taken = |port: String, option: &str, error: std::io::Error| {
        AppError::environment(format!(
            "the firmware cannot use {port}: {error}; stop the program that holds it (another SITL, another betadeck), \
             or start the firmware on other ports and name them with {option}"
        ))
    };
    TcpListener::bind(tcp).map_err(|error| taken(format!("TCP port {}", tcp.port()), "--tcp-port", error))?;
    for &port in udp {
        UdpSocket::bind((tcp.ip(), port))
            .map_err(|error| taken(format!("UDP port {port}"), "--udp-ports", error))?;
    }
    Ok(())
}
