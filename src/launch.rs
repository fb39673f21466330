//! The choice of the firmware from the options and the launcher's file, checked before any start.

mod executable;
pub(crate) mod link;
pub(crate) mod processor;
pub(crate) mod reported;
pub(crate) mod run;

use std::path::{Path, PathBuf};

use crate::args::{
    Betaloop, BetaloopError, DoorArgs, FdmDialect, FirmwareArgs, FirmwareChoice, FirmwareLinkArgs,
    FirmwarePortArgs, FlightArgs, PhysicsArgs, UdpPorts,
};
use crate::fc::ProvisionLines;
use crate::files::input_file;
use crate::link::conventions::{Dialect, FirmwareClock, MotorOrder, Stamps};
use crate::link::lockstep::check_lockstep;
use crate::process::error::AppError;

/// The launcher's file in the working directory.
const LAUNCHER_FILE: &str = "config.txt";

/// A remote firmware, found and checked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RemoteFirmware {
    /// The absolute path of the executable; `None` = it is already running.
    pub(crate) executable: Option<PathBuf>,
    pub(crate) arguments: Vec<String>,
    /// The ports and the format of its packets.
    pub(crate) ports: FirmwarePorts,
    /// The clock on which it runs.
    pub(crate) clock: FirmwareClock,
    /// The time stamps of the packets to it on the wall clock.
    pub(crate) stamps: Stamps,
    /// Command lines to set it up. The user's lines are those of `--settings` and those that a flight adds.
    pub(crate) lines: ProvisionLines,
    /// `true` if an earlier configuration may be changed without a question.
    pub(crate) may_write: bool,
    /// `true` to keep what it is given in simulated time, so that the flight can be continued from an earlier instant.
    pub(crate) keeps_inputs: bool,
}

impl RemoteFirmware {
    /// Returns the multiple of real time at which flights without a screen are flown, if the user asks for no other.
    pub(crate) fn usual_speed(&self) -> f64 {
        match self.clock {
            FirmwareClock::Sim => f64::INFINITY,
            FirmwareClock::Real => 1.0,
        }
    }

    /// Returns the name of the firmware for reports, and the lines that set it up.
    pub(crate) fn described(&self) -> (String, Vec<String>) {
        let name = match &self.executable {
            Some(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
            None => "the running one".to_owned(),
        };
        let clock = match self.clock {
            FirmwareClock::Sim => "in simulated time",
            FirmwareClock::Real => "on the wall clock",
        };
        let lines = self.lines.usual.iter().chain(&self.lines.of_user);
        (format!("{name} {clock}"), lines.cloned().collect())
    }

    /// Returns the same firmware with a plan's settings added to the usual lines, and those of `--set` after the
    /// user's lines.
    pub(crate) fn with_settings(&self, plan: &[String], set: &[String]) -> Self {
        let line = |setting: &String| format!("set {setting}");
        let mut firmware = self.clone();
        firmware.lines.usual.extend(plan.iter().map(line));
        firmware.lines.of_user.extend(set.iter().map(line));
        firmware
    }
}

/// The ports of a remote firmware, and the format of its packets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FirmwarePorts {
    /// The port of its CLI and MSP.
    pub(crate) tcp: u16,
    /// The ports of the simulator link.
    pub(crate) udp: UdpPorts,
    /// The meaning of the packets to it.
    pub(crate) dialect: Dialect,
    /// The order of the motors in its packets.
    pub(crate) motor_order: MotorOrder,
}

impl FirmwarePorts {
    fn new(
        tcp: Option<u16>,
        udp: Option<UdpPorts>,
        dialect: Option<FdmDialect>,
        motor_order: Option<MotorOrder>,
    ) -> Self {
        Self {
            tcp: tcp.unwrap_or(5761),
            udp: udp.unwrap_or_default(),
            dialect: dialect.unwrap_or_default().0.unwrap_or(Dialect::SitlGz),
            motor_order: motor_order.unwrap_or_default(),
        }
    }

    /// Returns `true` if no option has changed them.
    pub(crate) fn are_usual(self) -> bool {
        self == Self::new(None, None, None, None)
    }

    /// Refuses port 0, because no remote firmware listens on a port chosen by the system.
    fn check(self) -> Result<Self, AppError> {
        let UdpPorts { raw, motors, fdm, rc } = self.udp;
        if [self.tcp, raw, motors, fdm, rc].contains(&0) {
            return Err(AppError::input(
                "with --firmware, --tcp-port and --udp-ports name the ports that it uses: 0 is not a port",
            ));
        }
        Ok(self)
    }
}

impl From<(&DoorArgs, &PhysicsArgs)> for FirmwarePorts {
    /// Returns the ports of a command with doors, whose options name the ports of the firmware.
    fn from((doors, physics): (&DoorArgs, &PhysicsArgs)) -> Self {
        let speech = &physics.simulator;
        Self::new(doors.tcp_port, doors.udp_ports, speech.fdm_dialect, speech.motor_order)
    }
}

impl From<&FirmwarePortArgs> for FirmwarePorts {
    fn from(args: &FirmwarePortArgs) -> Self {
        Self::new(args.tcp_port, args.udp_ports, args.fdm_dialect, args.motor_order)
    }
}

/// The other options that affect the choice of the firmware.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beside<'a> {
    pub(crate) ports: FirmwarePorts,
    pub(crate) flight: &'a FlightArgs,
    pub(crate) physics: &'a PhysicsArgs,
}

/// Returns the firmware for a command, also from the launcher's file in the working directory; `None` = the embedded
/// one.
pub(crate) fn choose(
    args: &FirmwareArgs,
    beside: Beside<'_>,
    notices: &mut Vec<String>,
) -> Result<Option<RemoteFirmware>, AppError> {
    let chosen = match &args.firmware {
        Some(choice) => Chosen::by_option(choice.clone()),
        // An external simulator flies the embedded firmware.
        None if args.link.betaloop.is_none() && beside.physics.is_external() => {
            Chosen::by_option(FirmwareChoice::Embedded)
        }
        None => Chosen::by_launcher(args.link.betaloop.as_deref(), notices)?,
    };
    notices.extend(args.link.idle_options(&chosen.choice));
    chosen.check(&args.link, beside, notices)
}

/// A choice of the firmware.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Chosen {
    pub(crate) choice: FirmwareChoice,
    /// The launcher's file, if the choice comes from it.
    file: Option<PathBuf>,
}

impl Chosen {
    /// Returns the choice of `--firmware`.
    pub(crate) fn by_option(choice: FirmwareChoice) -> Self {
        Self { choice, file: None }
    }

    /// Returns the choice in a launcher's file, or else in the one in the working directory. If that file is missing
    /// or belongs to another program, the choice is the embedded firmware.
    pub(crate) fn by_launcher(file: Option<&Path>, notices: &mut Vec<String>) -> Result<Self, AppError> {
        let choice = match file {
            Some(file) => of_launcher(file, notices)?,
            None => of_launcher_here(notices)?,
        };
        Ok(Self { choice, file: Some(file.unwrap_or(Path::new(LAUNCHER_FILE)).to_owned()) })
    }

    /// Checks the conditions for a start; `None` = the embedded firmware.
    pub(crate) fn check(
        &self,
        link: &FirmwareLinkArgs,
        beside: Beside<'_>,
        notices: &mut Vec<String>,
    ) -> Result<Option<RemoteFirmware>, AppError> {
        check(&self.choice, link, beside, notices).map_err(|error| match &self.file {
            None => error,
            Some(file) => {
                let message = format!(
                    "{} (the firmware comes from {}; --firmware embedded flies the embedded one)",
                    error.message,
                    file.display()
                );
                AppError { message, ..error }
            }
        })
    }
}

fn check(
    choice: &FirmwareChoice,
    link: &FirmwareLinkArgs,
    beside: Beside<'_>,
    notices: &mut Vec<String>,
) -> Result<Option<RemoteFirmware>, AppError> {
    let (executable, clock) = match choice {
        FirmwareChoice::Embedded | FirmwareChoice::Attach => (None, FirmwareClock::Real),
        FirmwareChoice::Executable(path) => {
            let found = executable::find(&from_home(path))?;
            let clock = clock_of(&found, link.clock, notices);
            notices.extend(link.idle_on_clock(clock));
            (Some(found), clock)
        }
    };
    choice.check(link, beside.flight, beside.physics, clock).map_err(AppError::input)?;
    if !choice.is_remote() {
        return Ok(None);
    }
    Ok(Some(RemoteFirmware {
        arguments: if executable.is_some() { link.firmware_arg.clone() } else { Vec::new() },
        executable,
        ports: beside.ports.check()?,
        clock,
        stamps: link.stamps(),
        lines: ProvisionLines {
            usual: Vec::new(),
            of_user: match &beside.flight.settings {
                Some(path) => input_file::read(path)?.lines().map(str::to_owned).collect(),
                None => Vec::new(),
            },
        },
        may_write: link.yes,
        keeps_inputs: false,
    }))
}

/// Returns the clock on which an executable can run. Says why if it cannot run in simulated time.
fn clock_of(executable: &Path, wanted: Option<FirmwareClock>, notices: &mut Vec<String>) -> FirmwareClock {
    if wanted == Some(FirmwareClock::Real) {
        return FirmwareClock::Real;
    }
    match check_lockstep(executable) {
        Ok(()) => FirmwareClock::Sim,
        Err(why) => {
            let name = executable.file_name().unwrap_or_default().to_string_lossy().into_owned();
            notices.push(on_the_wall_clock(&name, &why.to_string()));
            FirmwareClock::Real
        }
    }
}

/// Returns the notice that an executable does not run in simulated time, for this reason.
fn on_the_wall_clock(name: &str, why: &str) -> String {
    format!("{name} runs on the wall clock, in real time: {why} (--clock real chooses that).")
}

/// Returns the executable named in a launcher's file.
fn of_launcher(file: &Path, notices: &mut Vec<String>) -> Result<FirmwareChoice, AppError> {
    let text = input_file::read(&from_home(file))?;
    let betaloop = Betaloop::read(&text)
        .map_err(|error| AppError::input(format!("--betaloop {}: {error}", file.display())))?;
    Ok(named(file, &betaloop, notices))
}

/// Returns the executable named in the launcher's file in the working directory, which may be missing or belong to
/// another program.
fn of_launcher_here(notices: &mut Vec<String>) -> Result<FirmwareChoice, AppError> {
    let file = Path::new(LAUNCHER_FILE);
    let Ok(text) = input_file::read(file) else { return Ok(FirmwareChoice::Embedded) };
    match Betaloop::read(&text) {
        Ok(betaloop) => Ok(named(file, &betaloop, notices)),
        Err(BetaloopError::NoSection | BetaloopError::Form(_)) => Ok(FirmwareChoice::Embedded),
        Err(error @ (BetaloopError::NoExecutable | BetaloopError::TwoExecutables { .. })) => {
            Err(AppError::input(format!("{LAUNCHER_FILE}: {error}, or fly with --firmware embedded")))
        }
    }
}

/// Returns the executable named in the launcher's file and informs the user.
fn named(file: &Path, betaloop: &Betaloop, notices: &mut Vec<String>) -> FirmwareChoice {
    let written = from_home(Path::new(&betaloop.executable));
    let executable = file.parent().unwrap_or(Path::new("")).join(written);
    let unused = match betaloop.unused.join(", ") {
        none if none.is_empty() => String::new(),
        keys => format!(" Keys not used: {keys}; the embedded physics flies instead of Gazebo."),
    };
    notices.push(format!(
        "The firmware comes from {}: {} (--firmware embedded flies the embedded one).{unused}",
        file.display(),
        executable.display()
    ));
    FirmwareChoice::Executable(executable)
}

/// Replaces `~` at the start of a path by the home directory. A shell does not do this in options and in files.
fn from_home(path: &Path) -> PathBuf {
    match (path.strip_prefix("~"), etcetera::home_dir()) {
        (Ok(rest), Ok(home)) => home.join(rest),
        _ => path.to_owned(),
    }
}

#[cfg(test)]
mod tests;
