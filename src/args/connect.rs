//! A flight controller on the desk, for which this program is only the ground station.

use std::path::PathBuf;

use super::physics::without_effect;
use super::{DoorArgs, FirmwareLinkArgs, FlightArgs, PhysicsArgs};
use crate::link::FcPlace;

/// The flight controller to connect to.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct ConnectArgs {
    /// A remote flight controller: serial:DEVICE[,BAUD], tcp:HOST:PORT, ws:URL or mavlink:PLACE; nothing is simulated
    ///
    /// serial:/dev/ttyACM0 is a board on a USB cable, tcp:192.168.4.1:5761 or ws://10.0.0.2:6761 one behind a bridge;
    /// wss:// is encrypted, in a program built with `--features tls`. Telemetry, command line and the plan are read from
    /// it. Changes need your permission once a connection. betadeck never arms it and turns no motor. A lost connection
    /// is restored automatically. mavlink:udp:14550, mavlink:tcp:HOST:PORT or mavlink:serial:/dev/ttyUSB0,57600 is a craft
    /// that speaks MAVLink: ArduPilot, PX4, INAV. The doors stay closed, except those whose port is given (--tcp-port, --ws-port).
    #[arg(long, value_name = "PLACE", conflicts_with_all = ["firmware", "betaloop", "physics"], help_heading = "Flight controller")]
    pub connect: Option<FcPlace>,

    /// Writes the frames of a MAVLink connection to FILE, which `replay` and other ground stations open
    ///
    /// The file must not exist. It has the frames of both directions with the time of day (.tlog).
    #[arg(long, value_name = "FILE", requires = "connect", help_heading = "Flight controller")]
    pub tlog: Option<PathBuf>,
}

impl ConnectArgs {
    /// Returns a sentence about options that were given but have no effect on a remote flight controller.
    pub fn idle_options(
        doors: &DoorArgs,
        firmware: &FirmwareLinkArgs,
        physics: &PhysicsArgs,
        flight: &FlightArgs,
    ) -> Option<String> {
        let no_door = doors.tcp_port.is_none() && doors.ws_port.is_none();
        let given = [
            ("--home", flight.home.is_some()),
            ("--heading", flight.heading.is_some()),
            ("--airframe", flight.airframe.is_some()),
            ("--settings", flight.settings.is_some()),
            ("--profile", flight.profile.is_some()),
            ("--attitude", flight.attitude.is_some()),
            ("--arm-assist", flight.arm_assist.is_some()),
            ("--wind", flight.wind.is_some()),
            ("--gust", flight.gust.is_some()),
            ("--turbulence", flight.turbulence.is_some()),
            ("--noise", flight.noise.is_some()),
            ("--world", !flight.world.is_empty()),
            ("--fault", !physics.fault.is_empty()),
            ("--seed", flight.seed.is_some()),
            ("--rate", flight.rate.is_some()),
            ("--speed", flight.speed.is_some()),
            ("--fdm-dialect", physics.simulator.fdm_dialect.is_some()),
            ("--fdm-mirror", physics.simulator.fdm_mirror.is_some()),
            ("--motor-order", physics.simulator.motor_order.is_some()),
            ("--firmware-arg", !firmware.firmware_arg.is_empty()),
            ("--clock", firmware.clock.is_some()),
            ("--fdm-stamps", firmware.fdm_stamps.is_some()),
            ("--yes", firmware.yes),
            ("--udp-ports", doors.udp_ports.is_some()),
            ("--listen", doors.listen.is_some() && no_door),
            ("--allow-origin", !doors.allow_origin.is_empty() && doors.ws_port.is_none()),
        ];
        without_effect(&given, "nothing is simulated with --connect")
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;
    use crate::args::{Cli, TuiArgs};

    fn tui(line: &[&str]) -> Result<TuiArgs, String> {
        let line = ["betadeck"].iter().chain(line);
        Cli::try_parse_from(line).map(|cli| cli.tui).map_err(|error| error.to_string())
    }

    fn idle(line: &[&str]) -> Option<String> {
        let args = tui(line).unwrap();
        ConnectArgs::idle_options(&args.doors, &args.firmware.link, &args.physics, &args.flight)
    }

    #[test]
    fn a_plan_may_be_opened_beside_it() {
        let args = tui(&["square", "--connect", "serial:/dev/ttyACM0", "--plain"]).unwrap();
        assert_eq!(args.connect.connect.unwrap().to_string(), "serial:/dev/ttyACM0");
        assert!(args.plan.is_some());
    }

    #[test]
    fn a_wrong_place_and_a_second_source_of_flight_are_refused() {
        let reported = tui(&["--connect", "/dev/ttyACM0"]).unwrap_err();
        assert!(reported.contains("such as serial:/dev/ttyACM0"), "{reported}");
        for other in ["--firmware=attach", "--physics=external", "--betaloop=config.txt"] {
            let reported = tui(&["--connect", "tcp:localhost:5761", other]).unwrap_err();
            assert!(reported.contains("cannot be used with"), "{reported}");
        }
    }

    #[test]
    fn what_is_simulated_elsewhere_has_no_effect() {
        let place = ["--connect", "tcp:localhost:5761"];
        assert_eq!(idle(&place), None);
        assert_eq!(idle(&[&place[..], &["--tcp-port", "0", "--listen", "::1"]].concat()), None);
        let reported = idle(&[&place[..], &["--wind", "5@270", "--udp-ports", "1,2,3,4"]].concat());
        assert_eq!(
            reported.as_deref(),
            Some("--wind, --udp-ports have no effect: nothing is simulated with --connect.")
        );
        assert!(idle(&[&place[..], &["--listen", "::1"]].concat()).unwrap().starts_with("--listen has"));
    }
}
