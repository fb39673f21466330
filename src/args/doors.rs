//! The options of the doors for other programs, and the commands that mainly serve doors.

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;
use std::str::FromStr;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::physics::{PhysicsArgs, SimulatorArgs};
use super::value::{self, AttitudeChoice, OnOff, OutputFile};
use super::{FirmwareArgs, FlightArgs};
use crate::telemetry::FirmwareProfile;

/// The addresses of the doors; port 0 = the system chooses.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct DoorArgs {
    /// Address the doors listen on [default: 127.0.0.1; TCP and websocket also ::1]
    #[arg(long, value_name = "ADDR", help_heading = "Doors")]
    pub listen: Option<IpAddr>,

    /// Port of the websocket for the Betaflight App; 0 = any free one [default: 6761]
    #[arg(long, value_name = "PORT", help_heading = "Doors")]
    pub ws_port: Option<u16>,

    /// Port for CLI and MSP over TCP; 0 = any free one [default: 5761]
    #[arg(long, value_name = "PORT", help_heading = "Doors")]
    pub tcp_port: Option<u16>,

    /// UDP ports: raw PWM out, motors out, simulator in, RC in [default: 9001,9002,9003,9004]
    #[arg(long, value_name = "RAW,MOTORS,FDM,RC", help_heading = "Doors")]
    pub udp_ports: Option<UdpPorts>,

    /// Opens only the doors for an external simulator
    #[arg(long, conflicts_with_all = ["listen", "ws_port", "tcp_port", "udp_ports"], help_heading = "Doors")]
    pub no_ports: bool,

    /// MAVLink for other ground stations: udp:PORT where one listens, tcp:PORT to listen [default: none]
    ///
    /// QGroundControl, MAVProxy and MAVSDK listen on UDP 14550; Mission Planner connects to TCP 5760. Only this machine
    /// is served.
    #[arg(
        long,
        value_name = "PLACES",
        value_delimiter = ',',
        conflicts_with = "no_ports",
        help_heading = "Doors"
    )]
    pub mavlink: Vec<MavlinkPlace>,

    /// Autopilot that the craft claims to be there: generic, ardupilot, px4 [default: generic]
    #[arg(
        long,
        value_name = "NAME",
        hide_possible_values = true,
        requires = "mavlink",
        help_heading = "Doors"
    )]
    pub mavlink_as: Option<MavlinkIdentity>,

    /// Takes the sticks of MAVLink ground stations, as RC of a script
    #[arg(long, requires = "mavlink", help_heading = "Doors")]
    pub mavlink_rc: bool,

    /// Serves web pages of this origin on the websocket, too; repeatable
    ///
    /// Always served: requests without an origin, loopback hosts, https://app.betaflight.com, and the App's desktop
    /// and mobile shells. The client must call this machine (Host) by a loopback name, by the address that it
    /// reached, or by the name of an allowed origin.
    #[arg(long, value_name = "ORIGIN", help_heading = "Doors")]
    pub allow_origin: Vec<String>,
}

impl DoorArgs {
    /// Returns the address the doors listen on.
    pub fn address(&self) -> IpAddr {
        self.listen.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST))
    }

    /// Returns the port of the websocket.
    pub fn ws_port(&self) -> u16 {
        self.ws_port.unwrap_or(6761)
    }

    /// Returns the port of the first serial port.
    pub fn tcp_port(&self) -> u16 {
        self.tcp_port.unwrap_or(5761)
    }

    /// Returns the UDP ports.
    pub fn udp_ports(&self) -> UdpPorts {
        self.udp_ports.unwrap_or_default()
    }
}

/// The autopilot that the craft claims to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum MavlinkIdentity {
    Generic,
    Ardupilot,
    Px4,
}

/// A place where MAVLink ground stations meet the craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MavlinkPlace {
    /// Sends to this port of the loopback, from a port of its own.
    Udp(u16),
    /// Listens on this port; 0 = any free one.
    Tcp(u16),
}

impl FromStr for MavlinkPlace {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("{text} is not a place: write udp:PORT or tcp:PORT, such as udp:14550");
        let (transport, port) = text.trim().split_once(':').ok_or_else(wrong)?;
        let port = port.parse().map_err(|_| wrong())?;
        match transport {
            "udp" if port != 0 => Ok(Self::Udp(port)),
            "tcp" => Ok(Self::Tcp(port)),
            _ => Err(wrong()),
        }
    }
}

/// The four UDP ports of the simulator link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UdpPorts {
    /// Raw PWM out (RealFlight bridge).
    pub raw: u16,
    /// Motor commands out (Gazebo).
    pub motors: u16,
    /// Simulator state in.
    pub fdm: u16,
    /// RC channels in.
    pub rc: u16,
}

impl Default for UdpPorts {
    fn default() -> Self {
        Self { raw: 9001, motors: 9002, fdm: 9003, rc: 9004 }
    }
}

impl FromStr for UdpPorts {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let port = |text: &str| {
            text.trim().parse::<u16>().map_err(|_| format!("{text} is not a port; allowed are 0 to 65535"))
        };
        let parts = text.split(',').map(port).collect::<Result<Vec<u16>, String>>()?;
        match parts[..] {
            [raw, motors, fdm, rc] => Ok(Self { raw, motors, fdm, rc }),
            _ => Err("write four ports RAW,MOTORS,FDM,RC, such as 9001,9002,9003,9004".to_owned()),
        }
    }
}

/// The options of `serve`: firmware and physics in real time with all doors open, without a screen.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct ServeArgs {
    /// Writes events as JSON lines; - is standard output [default: sentences on standard output]
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,

    /// The doors.
    #[command(flatten)]
    pub doors: DoorArgs,

    /// The choice of the firmware.
    #[command(flatten)]
    pub firmware: FirmwareArgs,

    /// The choice of the physics.
    #[command(flatten)]
    pub physics: PhysicsArgs,

    /// The craft, its position and the air.
    #[command(flatten)]
    pub flight: FlightArgs,
}

/// The options of `sitl`: the firmware alone, for an external simulator.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
pub struct SitlArgs {
    /// Address to which motor packets are sent [default: 127.0.0.1]
    #[arg(long, value_name = "ADDR")]
    pub ip: Option<IpAddr>,

    /// Applies the CLI lines of FILE, saves and exits
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,

    /// Writes sitl_track.gpx in the working directory
    #[arg(long)]
    pub gpx: bool,

    /// Ends the process when the firmware reboots, instead of restarting it
    #[arg(long)]
    pub exit_on_reboot: bool,

    /// With --config: a line that fails makes the exit code 1
    #[arg(long)]
    pub strict: bool,

    /// Unknown settings between batch start and batch end do not prevent save from storing
    #[arg(long)]
    pub lenient: bool,

    /// Lets save replace an eeprom.bin that another firmware wrote
    #[arg(long)]
    pub overwrite_config: bool,

    /// The packets of the simulator.
    #[command(flatten)]
    pub simulator: SimulatorArgs,

    /// Lets a script arm that holds the ARM switch on from its first packet, or throttle up to 1150 [default: on]
    #[arg(long, value_enum, help_heading = "Firmware")]
    pub arm_assist: Option<OnOff>,

    /// Laws of the autopilot, stored as ap_profile: guide, master [default: the stored ones, at first guide]
    #[arg(long, value_name = "NAME", hide_possible_values = true, value_parser = value::profile, help_heading = "Firmware")]
    pub profile: Option<FirmwareProfile>,

    /// Source of the attitude: the simulator's packet (truth), or the firmware's estimator [default: truth]
    #[arg(long, value_enum, help_heading = "Firmware")]
    pub attitude: Option<AttitudeChoice>,

    /// Directory of eeprom.bin [default: the working directory]
    #[arg(long, value_name = "DIR")]
    pub state_dir: Option<PathBuf>,

    /// The doors.
    #[command(flatten)]
    pub doors: DoorArgs,
}

/// Returns the message of the reference firmware simulator for an unknown argument or a missing value; that simulator
/// then exits with code 1. Returns `None` for other errors and for `--help`.
pub fn sitl_usage_error(error: &clap::Error) -> Option<String> {
    if !matches!(error.kind(), ErrorKind::UnknownArgument | ErrorKind::InvalidValue) {
        return None;
    }
    let ContextValue::String(argument) = error.get(ContextKind::InvalidArg)? else { return None };
    // `--config <FILE>` if its value is missing.
    let argument = argument.split(" <").next().unwrap_or(argument);
    Some(format!("[SITL] Unknown argument: {argument} (use --help for usage)"))
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[test]
    fn places_of_ground_stations_are_read_and_others_are_refused_with_an_example() {
        assert_eq!("udp:14550".parse(), Ok(MavlinkPlace::Udp(14550)));
        assert_eq!(" tcp:0".parse(), Ok(MavlinkPlace::Tcp(0)));
        for wrong in ["14550", "udp:0", "udp:70000", "serial:1", "tcp:", ""] {
            let error = wrong.parse::<MavlinkPlace>().unwrap_err();
            assert!(error.contains("udp:14550"), "{wrong}: {error}");
        }
    }

    #[derive(Debug, Parser)]
    #[command(name = "x")]
    enum Doors {
        Serve(Box<ServeArgs>),
        Sitl(SitlArgs),
    }

    #[test]
    fn doors_have_the_usual_ports() {
        let Doors::Serve(serve) = Doors::try_parse_from(["x", "serve"]).unwrap() else { panic!() };
        let doors = serve.doors;
        assert_eq!((doors.ws_port(), doors.tcp_port(), doors.udp_ports().rc), (6761, 5761, 9004));
        assert!(doors.address().is_loopback());
    }

    #[test]
    fn ports_are_read_and_refused() {
        let read = |text: &str| {
            Doors::try_parse_from(["x", "serve", "--udp-ports", text, "--ws-port=0"])
                .map(|doors| match doors {
                    Doors::Serve(serve) => serve.doors.udp_ports(),
                    Doors::Sitl(_) => UdpPorts::default(),
                })
                .map_err(|error| error.to_string())
        };
        assert_eq!(read("1,2,3,0"), Ok(UdpPorts { raw: 1, motors: 2, fdm: 3, rc: 0 }));
        assert!(read("1,2,3").unwrap_err().contains("write four ports"));
        assert!(read("1,2,3,70000").unwrap_err().contains("70000 is not a port"));
    }

    #[test]
    fn closed_doors_have_no_ports() {
        let error = Doors::try_parse_from(["x", "sitl", "--no-ports", "--ws-port", "1"]).unwrap_err();
        assert!(error.to_string().contains("cannot be used with"));
        let Doors::Sitl(sitl) = Doors::try_parse_from(["x", "sitl", "--strict", "--ip", "::1"]).unwrap()
        else {
            panic!()
        };
        assert!(sitl.strict && !sitl.lenient && sitl.ip.is_some_and(|ip| ip.is_loopback()));
    }

    #[test]
    fn sitl_complains_like_the_reference() {
        let usage_error = |arguments: &[&str]| {
            let line = ["x", "sitl"].iter().chain(arguments);
            sitl_usage_error(&Doors::try_parse_from(line).unwrap_err())
        };
        let text =
            |argument: &str| Some(format!("[SITL] Unknown argument: {argument} (use --help for usage)"));
        assert_eq!(usage_error(&["--frobnicate"]), text("--frobnicate"));
        assert_eq!(usage_error(&["what"]), text("what"));
        assert_eq!(usage_error(&["--config"]), text("--config"));
        assert_eq!(usage_error(&["--help"]), None);
    }
}
