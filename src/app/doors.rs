//! Opens the doors of a session and keeps their state in view.
#![allow(clippy::disallowed_methods, reason = "the state of the doors is published at a rhythm of wall time")]

use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener, UdpSocket};
use std::path::Path;
use std::time::{Duration, Instant};

use tokio::sync::watch;
use tokio_util::sync::CancellationToken;

use crate::args::{DoorArgs, FlightArgs, MavlinkIdentity, MavlinkPlace, PhysicsArgs};
use crate::events::EndpointAddresses;
use crate::fc::RemoteLink;
use crate::ground_station::{BoundDoor, Door, GroundStationOptions, Place};
use crate::launch::{FirmwarePorts, RemoteFirmware};
use crate::link::endpoint::EndpointKind;
use crate::link::proto::fdm_link::FdmLinkConfig;
use crate::link::{ExternalSimulator, FcPlace, ListenConfig, Listeners};
use crate::mavlink::craft::Identity;
use crate::process::error::AppError;
use crate::session::{Endpoints, Links, MotorTargets};

/// The options of a session.
#[derive(Debug, Clone, Copy)]
pub(super) struct LiveArgs<'a> {
    pub(super) doors: &'a DoorArgs,
    /// The remote flight controller to connect to; `None` for a simulated craft.
    pub(super) connect: Option<Connection<'a>>,
    /// The remote firmware, if the embedded one does not fly.
    pub(super) firmware: Option<&'a RemoteFirmware>,
    pub(super) physics: &'a PhysicsArgs,
    pub(super) flight: &'a FlightArgs,
    /// `true` if a screen shows the session and its earlier instants.
    pub(super) has_screen: bool,
}

/// A remote flight controller.
#[derive(Debug, Clone, Copy)]
pub(super) struct Connection<'a> {
    pub(super) place: &'a FcPlace,
    /// The file of the telemetry log.
    pub(super) tlog: Option<&'a Path>,
}

/// The interval at which the state of the doors is published.
const VIEW: Duration = Duration::from_millis(250);
/// The TCP and RC doors beside a firmware on the wall clock, which has the usual ports itself.
const TCP_BESIDE: u16 = 7761;
const RC_BESIDE: u16 = 11004;

/// The open doors on the side of the sockets.
#[derive(Debug)]
pub(super) struct OpenDoors {
    stop: CancellationToken,
    keeper: Option<tokio::task::JoinHandle<()>>,
    ground_station: Option<Door>,
}

/// The result of opening the doors.
#[derive(Debug)]
pub(super) struct Opened {
    pub doors: OpenDoors,
    /// The session's side.
    pub endpoints: Endpoints,
    pub addresses: EndpointAddresses,
    /// Problems of some doors, as sentences.
    pub notices: Vec<String>,
}

/// Opens the doors of the options; with `--no-ports` only those for an external simulator. A door that cannot be
/// opened is reported, and the others work. `link` is the one to a remote firmware.
///
/// # Errors
/// Returns an error if there is no socket for the motors of an external simulator.
pub(super) async fn open(
    LiveArgs { doors: args, connect, firmware, physics, flight, .. }: LiveArgs<'_>,
    link: Option<&RemoteLink>,
) -> Result<Option<Opened>, AppError> {
    let wanted = |port: u16| (!args.no_ports).then_some(port);
    // A firmware on the wall clock has its ports itself. One in simulated time uses others, which the system chose.
    let on_wall_clock = firmware.filter(|_| !link.is_some_and(RemoteLink::is_in_steps));
    let fdm_port = physics.is_external().then_some(args.udp_ports().fdm);
    let (tcp_port, ws_port, rc_port) = match (connect, on_wall_clock) {
        // For a real craft, only the requested doors are open, and no door for RC.
        (Some(_), _) => (args.tcp_port, args.ws_port, None),
        (None, Some(firmware)) => {
            let (tcp, rc) = beside(args.address(), firmware.ports);
            (wanted(tcp), wanted(args.ws_port()), wanted(rc))
        }
        (None, None) => (wanted(args.tcp_port()), wanted(args.ws_port()), wanted(args.udp_ports().rc)),
    };
    if [tcp_port, ws_port, rc_port, fdm_port].iter().all(Option::is_none) {
        return Ok(None);
    }
    let allow_origin = args.allow_origin.clone();
    let config = ListenConfig { listen: args.listen, tcp_port, ws_port, rc_port, fdm_port, allow_origin };
    let links = Links::open(&config).await;
    let doors = &links.doors;
    let mut notices: Vec<String> = doors.problems().map(|problem| format!("{problem}.")).collect();
    let port = |kind| doors.address(kind).map(|address| address.port());
    if let (Some(firmware), Some(tcp), Some(rc)) =
        (on_wall_clock, port(EndpointKind::Tcp), port(EndpointKind::Rc))
    {
        let (its_tcp, its_rc) = (firmware.ports.tcp, firmware.ports.udp.rc);
        notices.push(format!(
            "TCP {its_tcp} and UDP {its_rc} belong to the firmware: the doors of this program are TCP {tcp} and UDP {rc}."
        ));
    }
    if let Some(address) = args.listen.filter(|address| !address.is_loopback()) {
        notices.push(beyond_loopback(address, connect.is_some()));
    }
    let addresses = EndpointAddresses {
        ws: doors.address(EndpointKind::WebSocket),
        tcp: doors.address(EndpointKind::Tcp),
        fdm: doors.address(EndpointKind::Fdm),
        rc: doors.address(EndpointKind::Rc),
    };
    let simulator = match physics.is_external() {
        true => Some(simulator(args, physics, flight, addresses.fdm, &mut notices)?),
        false => None,
    };
    let (doors, endpoints, view_tx) = links.endpoints(simulator);
    let stop = CancellationToken::new();
    let keeper = tokio::spawn(keep(doors, view_tx, stop.clone()));
    Ok(Some(Opened {
        doors: OpenDoors { stop, keeper: Some(keeper), ground_station: None },
        endpoints,
        addresses,
        notices,
    }))
}

/// Returns the ports of the TCP and RC doors beside a firmware on the wall clock. They are any free ones if those for it
/// are taken, or if the firmware has other ports than usual: several may then run side by side.
fn beside(listen: IpAddr, firmware: FirmwarePorts) -> (u16, u16) {
    if !firmware.are_usual() {
        return (0, 0);
    }
    let tcp = TcpListener::bind((listen, TCP_BESIDE)).map_or(0, |_| TCP_BESIDE);
    let rc = UdpSocket::bind((listen, RC_BESIDE)).map_or(0, |_| RC_BESIDE);
    (tcp, rc)
}

/// Returns a sentence about doors that are open to other machines: the actions that they allow.
fn beyond_loopback(address: IpAddr, is_real_craft: bool) -> String {
    let can = match is_real_craft {
        true => "read this craft, and change it once you permit changes",
        false => "fly this craft",
    };
    format!("The doors listen on {address}: anyone on that network can {can}.")
}

/// Returns the link to the simulator that moves the craft.
fn simulator(
    args: &DoorArgs,
    physics: &PhysicsArgs,
    flight: &FlightArgs,
    hears_at: Option<SocketAddr>,
    notices: &mut Vec<String>,
) -> Result<ExternalSimulator, AppError> {
    let ports = args.udp_ports();
    let targets = MotorTargets { ip: IpAddr::V4(Ipv4Addr::LOCALHOST), motors: ports.motors, raw: ports.raw };
    let motors = targets.open().map_err(|error| AppError::environment(error.to_string()))?;
    if let Some(address) = hears_at {
        notices.push(format!(
            "A simulator moves the craft: it sends states to UDP {address} and receives motors at {}. Waiting for it.",
            targets.motors()
        ));
    }
    let speech = &physics.simulator;
    let config = FdmLinkConfig {
        dialect: speech.fdm_dialect.unwrap_or_default().0,
        mirror: speech.fdm_mirror.unwrap_or_default(),
        tick_us: 1_000_000 / u64::from(flight.rate_hz()),
    };
    Ok(ExternalSimulator::start(config, speech.motor_order.unwrap_or_default(), motors, Instant::now()))
}

/// Publishes the state of the doors when it changes, until the doors are closed.
async fn keep(
    doors: Listeners,
    views: watch::Sender<Vec<crate::link::endpoint::EndpointStatus>>,
    stop: CancellationToken,
) {
    loop {
        tokio::select! {
            () = stop.cancelled() => break,
            () = tokio::time::sleep(VIEW) => {
                let now = doors.status();
                views.send_if_modified(|shown| {
                    let changed = *shown != now;
                    *shown = now;
                    changed
                });
            }
        }
    }
    doors.close().await;
}

impl OpenDoors {
    /// Closes the doors and waits until their clients are informed.
    pub(super) async fn close(self) {
        self.stop.cancel();
        if let Some(ground_station) = self.ground_station {
            ground_station.close().await;
        }
        if let Some(keeper) = self.keeper {
            // The keeper does not panic.
            drop(keeper.await);
        }
    }

    /// Returns the doors with that of ground stations.
    pub(super) fn with_ground_station(doors: Option<Self>, door: Option<Door>) -> Option<Self> {
        let Some(door) = door else { return doors };
        let without = || Self { stop: CancellationToken::new(), keeper: None, ground_station: None };
        Some(Self { ground_station: Some(door), ..doors.unwrap_or_else(without) })
    }
}

/// Opens the sockets of the MAVLink door, if there is one. Sentences about it are added to `notices`.
pub(super) async fn bind_ground_station(
    args: &DoorArgs,
    is_real_craft: bool,
    notices: &mut Vec<String>,
) -> Option<BoundDoor> {
    let place = |place: &MavlinkPlace| match *place {
        MavlinkPlace::Udp(port) => Place::Udp(port),
        MavlinkPlace::Tcp(port) => Place::Tcp(port),
    };
    let options = GroundStationOptions {
        places: args.mavlink.iter().map(place).collect(),
        identity: match args.mavlink_as.unwrap_or(MavlinkIdentity::Generic) {
            MavlinkIdentity::Generic => Identity::Generic,
            MavlinkIdentity::Ardupilot => Identity::Ardupilot,
            MavlinkIdentity::Px4 => Identity::Px4,
        },
        takes_rc: args.mavlink_rc,
        is_read_only: is_real_craft,
    };
    if options.places.is_empty() {
        return None;
    }
    for place in &options.places {
        if let Place::Udp(port) = place {
            notices.push(format!("MAVLink: sends to 127.0.0.1:{port}, UDP."));
        }
    }
    let (door, errors) = BoundDoor::bind(options).await;
    notices.extend(door.listening().iter().map(|address| format!("MAVLink: listens on {address}, TCP.")));
    notices.extend(errors.iter().map(|error| format!("{error}.")));
    if is_real_craft {
        notices.push("MAVLink shows this craft and changes nothing on it.".to_owned());
    }
    Some(door)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{PhysicsChoice, UdpPorts};

    #[tokio::test]
    async fn without_ports_only_those_of_an_external_simulator_are_open() {
        let ports = UdpPorts { raw: 9, motors: 9, fdm: 0, rc: 0 };
        let doors = DoorArgs { no_ports: true, udp_ports: Some(ports), ..DoorArgs::default() };
        let flight = FlightArgs::default();
        let embedded = PhysicsArgs::default();
        let of = |physics| LiveArgs {
            doors: &doors,
            connect: None,
            firmware: None,
            physics,
            flight: &flight,
            has_screen: false,
        };
        assert!(open(of(&embedded), None).await.unwrap().is_none());
        let place = "tcp:localhost:1".parse().unwrap();
        let closed = LiveArgs {
            doors: &DoorArgs::default(),
            connect: Some(Connection { place: &place, tlog: None }),
            ..of(&embedded)
        };
        assert!(
            open(closed, None).await.unwrap().is_none(),
            "a craft outside has the doors that are asked for"
        );
        let external = PhysicsArgs { physics: Some(PhysicsChoice::External), ..PhysicsArgs::default() };
        let opened = open(of(&external), None).await.unwrap().unwrap();
        let views = opened.endpoints.status.borrow().clone();
        assert_eq!(views.iter().map(|door| door.kind.to_string()).collect::<Vec<_>>(), ["udp fdm"]);
        assert!(opened.endpoints.simulator.is_some());
        assert!(
            opened.notices.iter().any(|notice| notice.contains(&views[0].address)),
            "{:?}",
            opened.notices
        );
        opened.doors.close().await;
    }

    #[test]
    fn everything_a_network_can_do_at_the_doors_of_a_craft_is_reported() {
        let address = IpAddr::V4(Ipv4Addr::UNSPECIFIED);
        let of_real_craft = beyond_loopback(address, true);
        assert!(
            of_real_craft.ends_with("can read this craft, and change it once you permit changes."),
            "{of_real_craft}"
        );
        assert!(beyond_loopback(address, false).ends_with("can fly this craft."));
    }
}
