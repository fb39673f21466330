//! `betadeck lab`: a programme of flights on one or two builds of a SITL executable.

mod fly;
mod outputs;
mod programme;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::args::{FirmwareChoice, FirmwareLinkArgs, FlightArgs, LabArgs, PhysicsArgs};
use crate::headless::check::Stopwatch;
use crate::launch::{Beside, Chosen, RemoteFirmware};
use crate::link::conventions::FirmwareClock;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::process::{error, parallel};
use crate::report::lab::{Lab, LabFlight};
use fly::{Build, Pair};
use outputs::Outputs;
use programme::Programme;

/// The word for the embedded firmware in place of an executable.
const EMBEDDED: &str = "embedded";
/// The default time after which no further flight begins, s. The flights that are in the air then take a few seconds more.
const BUDGET_S: f64 = 170.0;
/// The flights at the beginning after which a firmware that could fly none of them is given up.
const TRIES: usize = 2;

/// Flies, compares and judges. The exit code is 0 if nothing is worse.
pub(crate) fn run(args: &LabArgs, repeat: &[String]) -> Result<u8, AppError> {
    let programme = Programme::read(args)?;
    if args.list {
        return error::print(&programme.list());
    }
    let head = args.head.as_deref().or(args.alone.as_deref());
    let head = head.ok_or_else(|| AppError::input("name an executable"))?;
    let mut notices = Vec::new();
    let base = args.base.as_deref().map(|path| build(args, path, "--base ", &mut notices)).transpose()?;
    let option = if args.head.is_some() { "--head " } else { "" };
    let builds = (base, build(args, head, option, &mut notices)?);
    let outputs = Outputs::prepare(args, repeat)?;
    notices.iter().for_each(|notice| error::tell(notice));
    if let Some(folder) = &args.keep {
        std::fs::create_dir_all(folder).map_err(|error| {
            AppError::environment(format!("--keep: cannot make the folder {}: {error}", folder.display()))
        })?;
    }
    let interrupted = interrupt_flag()?;
    let started = Stopwatch::start();
    let flights = fly(args, &programme, &builds, &interrupted, &started)?;
    let names =
        (args.base.as_deref().map(|path| name(path, head)), name(head, args.base.as_deref().unwrap_or(head)));
    let lab = Lab::new(names, programme.measures(), flights, programme.entries().len(), started.seconds());
    outputs.write(&lab)?;
    Ok(match lab.is_worse() {
        _ if interrupted.load(Ordering::Relaxed) => error::INTERRUPTED,
        true => error::FAILED,
        false => 0,
    })
}

/// Flies the programme until the time is over. Flights that had begun by then count.
fn fly(
    args: &LabArgs,
    programme: &Programme,
    builds: &(Option<Build>, Build),
    interrupted: &Arc<AtomicBool>,
    started: &Stopwatch,
) -> Result<Vec<LabFlight>, AppError> {
    let budget_s = args.budget.unwrap_or(BUDGET_S);
    let gives_up = AtomicBool::new(false);
    let is_stopped = || {
        interrupted.load(Ordering::Relaxed)
            || gives_up.load(Ordering::Relaxed)
            || started.seconds() >= budget_s
    };
    let mut flights: Vec<LabFlight> = Vec::new();
    let mut progress = outputs::Progress::new(started, budget_s);
    let mut trouble: Option<AppError> = None;
    parallel::all(
        programme.entries(),
        parallel::threads(args.jobs),
        &is_stopped,
        |thread, entry| {
            Pair { programme, builds, interrupted, keep: args.keep.as_deref() }.fly(entry, thread)
        },
        |flown: Result<LabFlight, AppError>, done| match flown {
            Ok(flight) => {
                progress.show(done, programme.entries().len(), &flight.head.scenario);
                flights.push(flight);
                if flights.len() == TRIES && !flights.iter().any(is_flown) {
                    gives_up.store(true, Ordering::Relaxed);
                }
            }
            Err(error) => {
                gives_up.store(true, Ordering::Relaxed);
                trouble.get_or_insert(error);
            }
        },
    )?;
    progress.clear();
    match (trouble, flights.first()) {
        (Some(error), _) => Err(error),
        (None, Some(first)) if !flights.iter().any(is_flown) => {
            let problem = first.base.iter().chain(Some(&first.head)).find_map(|side| side.problem.clone());
            Err(AppError::environment(problem.unwrap_or_default()))
        }
        _ => Ok(flights),
    }
}

/// Returns `true` if no side had a problem.
fn is_flown(flight: &LabFlight) -> bool {
    std::iter::once(&flight.head).chain(&flight.base).all(|side| side.problem.is_none())
}

/// Returns a build, checked.
fn build(args: &LabArgs, path: &Path, option: &str, notices: &mut Vec<String>) -> Result<Build, AppError> {
    if path == Path::new(EMBEDDED) {
        return Ok(Build::Embedded);
    }
    Ok(Build::Executable(Box::new(firmware(args, path, option, notices)?)))
}

/// Returns the firmware in a file, checked. It must run in simulated time. `option` names the file in messages.
fn firmware(
    args: &LabArgs,
    path: &Path,
    option: &str,
    notices: &mut Vec<String>,
) -> Result<RemoteFirmware, AppError> {
    let link = FirmwareLinkArgs { firmware_arg: args.firmware_arg.clone(), ..FirmwareLinkArgs::default() };
    let (flight, physics) = (FlightArgs::default(), PhysicsArgs::default());
    let beside = Beside { ports: (&args.firmware_ports).into(), flight: &flight, physics: &physics };
    let chosen = Chosen::by_option(FirmwareChoice::Executable(path.to_owned()));
    let mut own = Vec::new();
    let checked = chosen.check(&link, beside, &mut own).map_err(|AppError { code, message }| {
        // The message is about the option of the other commands.
        let message = message.replace("--firmware ", option).replace(", or write embedded or attach", "");
        AppError { code, message }
    })?;
    let firmware = checked.ok_or_else(|| AppError::input("name an executable"))?;
    if firmware.clock == FirmwareClock::Real {
        return Err(AppError::environment(format!(
            "{option}{} cannot run in simulated time here, and on the wall clock no two flights are the same: {}",
            path.display(),
            own.join(" ")
        )));
    }
    notices.append(&mut own);
    Ok(firmware)
}

/// Returns the name of an executable: that of its file, with the path if the other file has the same name.
fn name(path: &Path, other: &Path) -> String {
    match path.file_name() {
        Some(name) if path == other || other.file_name() != Some(name) => name.to_string_lossy().into_owned(),
        _ => path.display().to_string(),
    }
}
