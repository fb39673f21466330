//! The choice of the firmware: the embedded one, a SITL executable, or one that is already running.

use std::path::PathBuf;
use std::str::FromStr;

use super::physics::{FdmDialect, PhysicsArgs};
use super::{FlightArgs, Speed, UdpPorts};
use crate::link::conventions::{FirmwareClock, MotorOrder, Stamps};

/// A choice of the firmware.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum FirmwareChoice {
    /// The firmware in this program.
    #[default]
    Embedded,
    /// A SITL that another program started.
    Attach,
    /// A SITL executable, started as a child.
    Executable(PathBuf),
}

impl FromStr for FirmwareChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "" => Err("write embedded, attach, or the path of a SITL executable".to_owned()),
            "embedded" => Ok(Self::Embedded),
            "attach" => Ok(Self::Attach),
            path => Ok(Self::Executable(path.into())),
        }
    }
}

impl FirmwareChoice {
    /// Returns `true` if it runs outside this program.
    pub fn is_remote(&self) -> bool {
        *self != Self::Embedded
    }

    /// Checks that these options can be used with it on this clock.
    ///
    /// # Errors
    /// Returns a sentence with the reason and a suggestion.
    pub fn check(
        &self,
        link: &FirmwareLinkArgs,
        flight: &FlightArgs,
        physics: &PhysicsArgs,
        clock: FirmwareClock,
    ) -> Result<(), String> {
        if !self.is_remote() {
            return Ok(());
        }
        if physics.is_external() {
            return Err(
                "--physics external needs the embedded firmware: an executable and an external simulator fly without \
                        betadeck between them; leave out one of the two"
                    .to_owned(),
            );
        }
        match flight.speed {
            None | Some(Speed(1.0)) => Ok(()),
            Some(_) if clock == FirmwareClock::Sim => Ok(()),
            Some(Speed(speed)) if link.stamps() == Stamps::Sim && speed.is_finite() => Ok(()),
            Some(Speed(speed)) if link.stamps() == Stamps::Sim => Err(format!(
                "--speed {} needs simulated time, because nothing paces a SITL on the wall clock: write a factor",
                speed_text(speed)
            )),
            Some(Speed(speed)) => Err(format!(
                "--speed {} needs simulated time: this SITL runs on the wall clock, so it flies only at 1; leave --speed \
                 out, let betadeck start the executable with --clock sim, or add --fdm-stamps sim for a build whose \
                 clock follows the packets",
                speed_text(speed)
            )),
        }
    }
}

fn speed_text(speed: f64) -> String {
    if speed.is_finite() { speed.to_string() } else { "max".to_owned() }
}

/// The choice of the firmware, and its start.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct FirmwareArgs {
    /// Firmware: embedded, the path of a SITL executable, or attach: one that is running [default: embedded]
    ///
    /// An executable is started in a folder of its own below the state directory, gets the state of the embedded
    /// physics and ends with this program. It flies in simulated time (--clock). --tcp-port and --udp-ports name its
    /// ports, --fdm-dialect and --motor-order the format of its packets. On the wall clock it has these ports itself,
    /// and the TCP and RC doors are 7761 and 11004, or any free ones.
    #[arg(long, value_name = "WHICH", help_heading = "Firmware")]
    pub firmware: Option<FirmwareChoice>,

    /// The start of the firmware and the packets to it.
    #[command(flatten)]
    pub link: FirmwareLinkArgs,
}

/// The start of a remote firmware and the packets to it.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct FirmwareLinkArgs {
    /// An argument for the executable of --firmware; repeatable
    #[arg(long, value_name = "ARG", allow_hyphen_values = true, help_heading = "Firmware")]
    pub firmware_arg: Vec<String>,

    /// Takes the executable from the launcher's file [default: config.txt here, if it has a section Betaloop]
    #[arg(long, value_name = "FILE", conflicts_with = "firmware", help_heading = "Firmware")]
    pub betaloop: Option<PathBuf>,

    /// Changes the stored configuration of a remote firmware, and starts the executable that the file of a campaign names,
    /// without a question
    #[arg(long, help_heading = "Firmware")]
    pub yes: bool,

    /// Clock of an executable: sim or real [default: sim on Linux, else real]
    ///
    /// In simulated time an unmodified executable computes step by step with the craft: flights are repeatable, and as
    /// fast as the machine allows in fly, check and compare. A small library is preloaded into it for that. On the wall
    /// clock it flies in real time. A static executable, a script and one for another C library do so in any case.
    #[arg(long, value_name = "CLOCK", help_heading = "Firmware")]
    pub clock: Option<FirmwareClock>,

    /// Stamps of its packets with --clock real: constant, or sim for a patched build [default: constant]
    ///
    /// On the wall clock, the clock of a stock SITL jumps when stamps advance unevenly, so it gets the same stamp in
    /// every packet. A build whose clock follows the stamps flies at any --speed.
    #[arg(long, value_name = "STAMPS", help_heading = "Firmware")]
    pub fdm_stamps: Option<Stamps>,
}

impl FirmwareLinkArgs {
    /// Returns the stamps of the packets to the firmware.
    pub fn stamps(&self) -> Stamps {
        self.fdm_stamps.unwrap_or_default()
    }

    /// Returns a sentence about an option that was given but has no effect on this clock of an executable.
    pub fn idle_on_clock(&self, clock: FirmwareClock) -> Option<String> {
        let stamps = [("--fdm-stamps", self.fdm_stamps.is_some() && clock == FirmwareClock::Sim)];
        super::physics::without_effect(&stamps, "the firmware runs in simulated time (--clock real)")
    }

    /// Returns a sentence about options that were given but have no effect with this firmware.
    pub fn idle_options(&self, firmware: &FirmwareChoice) -> Option<String> {
        let arguments = ("--firmware-arg", !self.firmware_arg.is_empty());
        let stamps = ("--fdm-stamps", self.fdm_stamps.is_some());
        let (given, why) = match firmware {
            FirmwareChoice::Executable(_) => return None,
            FirmwareChoice::Attach => {
                let clock = ("--clock sim", self.clock == Some(FirmwareClock::Sim));
                (vec![arguments, clock], "the firmware is running already")
            }
            FirmwareChoice::Embedded => (
                vec![arguments, ("--yes", self.yes), ("--clock", self.clock.is_some()), stamps],
                "the firmware is embedded (--firmware PATH)",
            ),
        };
        super::physics::without_effect(&given, why)
    }
}

/// The ports of a remote firmware, for commands without doors of their own.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct FirmwarePortArgs {
    /// Port of its CLI and MSP over TCP [default: 5761]
    #[arg(long, value_name = "PORT", help_heading = "Firmware")]
    pub tcp_port: Option<u16>,

    /// Its UDP ports: raw PWM out, motors out, simulator in, RC in [default: 9001,9002,9003,9004]
    #[arg(long, value_name = "RAW,MOTORS,FDM,RC", help_heading = "Firmware")]
    pub udp_ports: Option<UdpPorts>,

    /// Meaning of the packets to it: auto, sitl-gz, gz-plugin or legacy [default: auto, which is sitl-gz]
    #[arg(long, value_name = "DIALECT", help_heading = "Firmware")]
    pub fdm_dialect: Option<FdmDialect>,

    /// Order of the motors in its packets: native, or legacy (before spring 2026) [default: native]
    #[arg(long, value_name = "ORDER", help_heading = "Firmware")]
    pub motor_order: Option<MotorOrder>,
}

impl FirmwarePortArgs {
    /// Returns a sentence about options that were given but have no effect with the embedded firmware.
    pub fn idle_options(&self, firmware_outside: bool) -> Option<String> {
        let given = [
            ("--tcp-port", self.tcp_port.is_some()),
            ("--udp-ports", self.udp_ports.is_some()),
            ("--fdm-dialect", self.fdm_dialect.is_some()),
            ("--motor-order", self.motor_order.is_some()),
        ];
        let sentence = super::physics::without_effect(&given, "the firmware is embedded (--firmware PATH)");
        sentence.filter(|_| !firmware_outside)
    }
}

/// A command line with nothing but the choice of the firmware.
#[derive(Debug, clap::Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct FirmwareOnly {
    #[command(flatten)]
    firmware: FirmwareArgs,
    #[command(flatten)]
    ports: FirmwarePortArgs,
}

/// Reads the options of a firmware that were kept from an earlier command line.
///
/// # Errors
/// Returns the problem as a sentence.
pub fn firmware_options(words: &[String]) -> Result<(FirmwareArgs, FirmwarePortArgs), String> {
    use clap::Parser as _;
    match FirmwareOnly::try_parse_from(words) {
        Ok(FirmwareOnly { firmware, ports }) => Ok((firmware, ports)),
        Err(error) => Err(error.to_string().lines().next().unwrap_or_default().to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::PhysicsChoice;

    fn refusal(speed: Option<f64>, stamps: Option<Stamps>) -> Option<String> {
        let flight = FlightArgs { speed: speed.map(Speed), ..FlightArgs::default() };
        let link = FirmwareLinkArgs { fdm_stamps: stamps, ..FirmwareLinkArgs::default() };
        FirmwareChoice::Attach.check(&link, &flight, &PhysicsArgs::default(), FirmwareClock::Real).err()
    }

    #[test]
    fn words_and_paths() {
        assert_eq!("embedded".parse(), Ok(FirmwareChoice::Embedded));
        assert_eq!("attach".parse(), Ok(FirmwareChoice::Attach));
        assert_eq!("./attach".parse(), Ok(FirmwareChoice::Executable("./attach".into())));
        assert!("".parse::<FirmwareChoice>().unwrap_err().contains("the path of a SITL executable"));
    }

    #[test]
    fn a_stock_firmware_flies_in_real_time_only() {
        assert_eq!(refusal(None, None), None);
        assert_eq!(refusal(Some(1.0), None), None);
        let sentence = refusal(Some(4.0), None).unwrap();
        assert!(sentence.starts_with("--speed 4 needs simulated time: this SITL"), "{sentence}");
        assert!(refusal(Some(f64::INFINITY), None).unwrap().contains("--fdm-stamps sim"));
        assert_eq!(refusal(Some(4.0), Some(Stamps::Sim)), None);
        assert!(refusal(Some(f64::INFINITY), Some(Stamps::Sim)).unwrap().contains("write a factor"));
    }

    #[test]
    fn firmware_and_physics_cannot_both_be_remote() {
        let physics = PhysicsArgs { physics: Some(PhysicsChoice::External), ..PhysicsArgs::default() };
        let check = |firmware: FirmwareChoice| {
            let (link, flight) = (FirmwareLinkArgs::default(), FlightArgs::default());
            firmware.check(&link, &flight, &physics, FirmwareClock::Sim)
        };
        assert_eq!(check(FirmwareChoice::Embedded), Ok(()));
        assert!(
            check(FirmwareChoice::Executable("x".into())).unwrap_err().contains("leave out one of the two")
        );
    }

    #[test]
    fn options_without_effect_are_named() {
        let link = FirmwareLinkArgs {
            firmware_arg: vec!["-x".to_owned()],
            yes: true,
            ..FirmwareLinkArgs::default()
        };
        assert_eq!(
            link.idle_options(&FirmwareChoice::Embedded).unwrap(),
            "--firmware-arg, --yes have no effect: the firmware is embedded (--firmware PATH)."
        );
        assert_eq!(
            link.idle_options(&FirmwareChoice::Attach).unwrap(),
            "--firmware-arg has no effect: the firmware is running already."
        );
        assert_eq!(link.idle_options(&FirmwareChoice::Executable("x".into())), None);
        let stamps = FirmwareLinkArgs { fdm_stamps: Some(Stamps::Sim), ..FirmwareLinkArgs::default() };
        assert!(stamps.idle_on_clock(FirmwareClock::Sim).unwrap().starts_with("--fdm-stamps has no effect"));
        assert_eq!(stamps.idle_on_clock(FirmwareClock::Real), None, "also for a script");
        let ports = FirmwarePortArgs { tcp_port: Some(1), ..FirmwarePortArgs::default() };
        assert!(ports.idle_options(false).unwrap().starts_with("--tcp-port has no effect"));
        assert_eq!(ports.idle_options(true), None);
    }
}
