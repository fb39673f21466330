//! `betadeck compare`: the same plan in the same air on two firmwares.

mod flights;
mod jobs;
mod log;
mod outputs;
mod recorder;

use std::sync::atomic::{AtomicBool, Ordering};

use crate::args::{CompareArgs, FirmwareChoice, FlightArgs, PhysicsArgs};
use crate::launch::{Beside, Chosen, RemoteFirmware};
use crate::link::conventions::FirmwareClock;
use crate::process::error::AppError;
use crate::process::{error, parallel};
use crate::report::compare::{Comparison, Side};
use flights::{Flights, Flown};
use jobs::Job;
use outputs::Outputs;

/// A firmware in the comparison.
#[derive(Debug)]
struct Compared {
    /// The name of the firmware.
    name: String,
    /// `None` = the embedded firmware.
    firmware: Option<RemoteFirmware>,
    /// The number of flights with one seed.
    times: u32,
}

impl Compared {
    /// Returns `true` if betadeck does not start it.
    fn is_attached(&self) -> bool {
        self.firmware.as_ref().is_some_and(|firmware| firmware.executable.is_none())
    }

    /// Returns `true` if no two of its flights are the same.
    fn is_on_wall_clock(&self) -> bool {
        self.firmware.as_ref().is_some_and(|firmware| firmware.clock == FirmwareClock::Real)
    }
}

/// Flies and compares. The exit code is 0 if all flights completed.
pub(crate) fn run(args: &CompareArgs, repeat: &[String]) -> Result<u8, AppError> {
    if let Some(path) = &args.log {
        return log::run(args, path, repeat);
    }
    let mut notices = Vec::new();
    let compared = compared(args, &mut notices)?;
    let outside = compared.iter().any(|one| one.firmware.is_some());
    notices.extend(args.firmware_ports.idle_options(outside));
    if args.flight.speed.is_some() && !outside {
        notices.push(
            "--speed has no effect: the embedded firmware is flown as fast as the machine allows.".to_owned(),
        );
    }
    let is_alone = compared.iter().any(Compared::is_on_wall_clock);
    if is_alone && args.jobs.is_some_and(|jobs| jobs > 1) {
        notices.push(parallel::JOBS_HAVE_NO_EFFECT.to_owned());
    }
    if let Some(times) = args.repeat.filter(|&times| times > 1 && !is_alone) {
        notices.push(format!(
            "--repeat {times} has no effect: each of these flights is the same every time; fly other seeds with --seeds \
             1..{times}."
        ));
    }
    let flights = Flights::new(args, &compared, &mut notices)?;
    let seeds = jobs::seeds(args, flights.world(), &mut notices);
    let jobs = jobs::jobs(args, &compared, &seeds)?;
    let outputs = Outputs::prepare(args, repeat, &jobs::logged(args, &compared, &jobs)?)?;
    notices.iter().for_each(|notice| error::tell(notice));
    let mut sides = compared.each_ref().map(|one| Side {
        name: one.name.clone(),
        is_log: false,
        repeatable: !one.is_on_wall_clock(),
        flights: Vec::new(),
    });
    let threads = if is_alone { 1 } else { parallel::threads(args.jobs) };
    let flown = fly(args, &flights, &compared, (&jobs, &outputs), threads, &mut sides);
    let has_flown = sides.iter().any(|side| !side.flights.is_empty());
    let conditions = conditions(&args.flight, &seeds);
    let comparison = Comparison::new(flights.plan_name(), &conditions, flights.route(), sides);
    if !matches!(flown, Ok(true)) && has_flown {
        error::tell(&format!("Not everything was flown. So far:\n\n{}", comparison.text()));
    }
    if !flown? {
        return Ok(error::INTERRUPTED);
    }
    outputs.write(&comparison, flights.frame())?;
    Ok(if comparison.is_complete() { 0 } else { error::FAILED })
}

/// Flies all jobs on this many threads. Returns `false` after an interrupt. Earlier flights are kept then, and after an
/// error.
fn fly(
    args: &CompareArgs,
    flights: &Flights,
    compared: &[Compared; 2],
    (jobs, outputs): (&[Job], &Outputs),
    threads: usize,
    sides: &mut [Side; 2],
) -> Result<bool, AppError> {
    let failed = AtomicBool::new(false);
    let is_stopped = || flights.is_interrupted() || failed.load(Ordering::Relaxed);
    let mut failure = None;
    let mut flown = 0;
    // The messages of the first flight of each firmware. Most others have the same ones.
    let mut usual = [Vec::new(), Vec::new()];
    parallel::all(
        jobs,
        threads,
        &is_stopped,
        |thread, job| {
            let log = job.log.and_then(|flight| outputs.log(flight));
            let done = flights.fly(compared.get(job.side)?, (job.seed, log), thread, threads == 1);
            if done.is_err() {
                failed.store(true, Ordering::Relaxed);
            }
            done.map(|track| track.map(|flown| (job, flown))).transpose()
        },
        |done: Result<(Job, Flown), AppError>, _| match done {
            // Flights after one that failed are not reported, because their number differs from run to run.
            _ if failure.is_some() => {}
            Err(error) => failure = Some(error),
            Ok((job, Flown { track, reported })) => {
                let Some((one, side)) = compared.get(job.side).zip(sides.get_mut(job.side)) else { return };
                let Some(usual) = usual.get_mut(job.side) else { return };
                let news = reported.iter().filter(|sentence| !usual.contains(*sentence));
                news.for_each(|sentence| error::tell(sentence));
                if side.flights.is_empty() {
                    *usual = reported;
                }
                let (name, title) = (&one.name, job.title(args));
                error::tell(&format!("{name}, {title}: {}: {}", track.result, track.reason));
                side.flights.push(track);
                flown += 1;
            }
        },
    )?;
    match failure {
        Some(failure) => Err(failure),
        None => Ok(flown == jobs.len()),
    }
}

/// Returns the two firmwares, checked.
fn compared(args: &CompareArgs, notices: &mut Vec<String>) -> Result<[Compared; 2], AppError> {
    let chosen = choose(args, notices)?;
    let choices = chosen.each_ref().map(|chosen| &chosen.choice);
    if choices.iter().all(|choice| choice.is_remote()) && choices.contains(&&FirmwareChoice::Attach) {
        return Err(AppError::input(
            "--firmware attach is compared only with the embedded firmware: a second remote one would need the same \
             ports; name both executables",
        ));
    }
    let started = choices.iter().find(|choice| matches!(choice, FirmwareChoice::Executable(_)));
    let outermost = started.or(choices.iter().find(|choice| choice.is_remote()));
    notices.extend(args.link.idle_options(outermost.unwrap_or(&&FirmwareChoice::Embedded)));
    let physics = PhysicsArgs::default();
    let beside = Beside { ports: (&args.firmware_ports).into(), flight: &args.flight, physics: &physics };
    let [first, second] = names(choices);
    let mut one = |name: String, chosen: &Chosen| -> Result<Compared, AppError> {
        // The options are checked before the executable is looked for.
        args.flights_of(&chosen.choice, FirmwareClock::Real).map_err(AppError::input)?;
        let firmware = chosen.check(&args.link, beside, notices)?;
        let clock = firmware.as_ref().map_or(FirmwareClock::Real, |firmware| firmware.clock);
        let times = args.flights_of(&chosen.choice, clock).map_err(AppError::input)?;
        Ok(Compared { name, firmware, times })
    };
    let [a, b] = &chosen;
    Ok([one(first, a)?, one(second, b)?])
}

/// Chooses the two firmwares. With one option, the first is the embedded one; without options, the second is that of
/// the launcher.
fn choose(args: &CompareArgs, notices: &mut Vec<String>) -> Result<[Chosen; 2], AppError> {
    let other = match &args.firmware[..] {
        [first, second] => return Ok([first, second].map(|choice| Chosen::by_option(choice.clone()))),
        [other] => Chosen::by_option(other.clone()),
        _ => Chosen::by_launcher(args.link.betaloop.as_deref(), notices)?,
    };
    if !other.choice.is_remote() {
        return Err(AppError::input(
            "name the firmware to compare with: --firmware PATH, or --betaloop FILE for the one of the launcher",
        ));
    }
    Ok([Chosen::by_option(FirmwareChoice::Embedded), other])
}

/// Returns the names: the names of their files, with the path if both files have the same name.
fn names(choices: [&FirmwareChoice; 2]) -> [String; 2] {
    let short = choices.map(|choice| match choice {
        FirmwareChoice::Embedded => "embedded".to_owned(),
        FirmwareChoice::Attach => "the running one".to_owned(),
        FirmwareChoice::Executable(path) => {
            path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
        }
    });
    match (choices, &short) {
        ([FirmwareChoice::Executable(a), FirmwareChoice::Executable(b)], [first, second])
            if first == second =>
        {
            [a, b].map(|path| path.display().to_string())
        }
        _ => short,
    }
}

/// Returns the air and the seeds, for people.
fn conditions(flight: &FlightArgs, seeds: &[u64]) -> String {
    let mut reported = vec![flight.wind.map_or_else(|| "calm".to_owned(), |wind| format!("wind {wind}"))];
    reported.extend(flight.gust.map(|gust| format!("gusts {gust} m/s")));
    reported.extend(flight.turbulence.map(|level| format!("turbulence {level}")));
    reported.extend(flight.noise.map(|noise| format!("noise {noise}")));
    reported.push(match seeds {
        [first, .., last] => format!("seeds {first}..{last}"),
        [seed] => format!("seed {seed}"),
        [] => String::new(),
    });
    reported.join(", ")
}
