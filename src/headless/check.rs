//! `betadeck check`: scenarios flown on all processors and judged.

mod load;
mod output;
mod progress;
mod record;
mod remote;
pub(crate) use remote::{RemoteFlown, fly_case, options_to_open, prepare};
mod results;
mod run;
mod watch;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::setup;
use crate::args::{CheckArgs, FlightArgs, PhysicsArgs};
use crate::files::log_output::needs_embedded;
use crate::launch;
use crate::launch::{Beside, RemoteFirmware};
use crate::link::conventions::FirmwareClock;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::process::{error, parallel};
use crate::report::check::{Compared, Summary};
use crate::scenario::Draft;
use load::Loaded;
pub(crate) use load::{load_one, load_or_plan};
use output::Output;
pub(crate) use progress::Bar;
use results::Results;
pub(crate) use run::{Stopwatch, judged};

/// The exit code at which `git bisect run` skips a commit.
const SKIP_COMMIT: u8 = 125;

/// Flies and judges. The exit code is 0 if every expectation was met.
pub(crate) fn run(args: &CheckArgs, repeat: &[String]) -> Result<u8, AppError> {
    let ended = run_all(args, repeat);
    if !args.bisect {
        return ended;
    }
    match ended {
        Ok(code) if code >= error::ENVIRONMENT && code != error::INTERRUPTED => Ok(SKIP_COMMIT),
        Err(AppError { code, message }) if code >= error::ENVIRONMENT => {
            error::tell(&message);
            Ok(SKIP_COMMIT)
        }
        ended => ended,
    }
}

fn run_all(args: &CheckArgs, repeat: &[String]) -> Result<u8, AppError> {
    if args.list {
        return list(args);
    }
    if let Some(plan) = &args.new {
        let plan = setup::read_plan(plan, None)?;
        let text = Draft::from_plan(&plan).finish().map_err(AppError::input)?;
        return error::print(&text);
    }
    output::remove_earlier(args)?;
    let (flight, physics) = (FlightArgs::default(), PhysicsArgs::default());
    let beside = Beside { ports: (&args.firmware_ports).into(), flight: &flight, physics: &physics };
    let mut notices = Vec::new();
    let firmware = launch::choose(&args.firmware, beside, &mut notices)?;
    if firmware.is_some() && args.blackbox.is_some() {
        return Err(needs_embedded());
    }
    notices.extend(args.firmware_ports.idle_options(firmware.is_some()));
    notices.iter().for_each(|notice| error::tell(notice));
    let is_alone = firmware.as_ref().is_some_and(|firmware| firmware.clock == FirmwareClock::Real);
    if is_alone && args.jobs.is_some_and(|jobs| jobs > 1) {
        error::tell(parallel::JOBS_HAVE_NO_EFFECT);
    }
    let interrupted = interrupt_flag()?;
    if args.watch {
        return watch::run(args, repeat, firmware.as_ref(), &interrupted);
    }
    let loaded = load::load(args)?;
    fly(&loaded, args, repeat, firmware.as_ref(), &interrupted)
}

/// Flies the loaded scenarios once.
fn fly(
    loaded: &Loaded,
    args: &CheckArgs,
    repeat: &[String],
    firmware: Option<&RemoteFirmware>,
    interrupted: &Arc<AtomicBool>,
) -> Result<u8, AppError> {
    run::refuse_too_many(loaded, args)?;
    let jobs = run::jobs(loaded, args);
    if jobs.is_empty() {
        return Err(AppError::input(match &args.filter {
            Some(filter) => {
                format!("no flight has {filter} in its name: betadeck check --list shows the names")
            }
            None => "there is nothing to fly: name a slow scenario, or add --slow".to_owned(),
        }));
    }
    if let Some(firmware) = firmware {
        remote::refuse_many(firmware, jobs.len(), args.watch)?;
    }
    let names = || jobs.iter().map(|job| job.name(loaded).unwrap_or_default()).collect();
    let logs = output::log_files(args, loaded, names)?;
    let stop = AtomicBool::new(false);
    let mut results = Results::new(Output::open(args, repeat, loaded)?, jobs.len(), args.fail_fast, &stop);
    let started = run::Stopwatch::start();
    let is_stopped = || interrupted.load(Ordering::Relaxed) || stop.load(Ordering::Relaxed);
    let threads = parallel::threads(args.jobs);
    let trouble = match firmware {
        None => {
            let mut repetitions = run::Repetitions::default();
            let is_reported = args.report.is_some();
            let log_of = |job: &run::Job| logs.as_ref().and_then(|files| files.of(job.number));
            let fly = |_, job| run::one(loaded, job, is_reported, log_of(&job), &is_stopped);
            parallel::all(&jobs, threads, &is_stopped, fly, |(flight, report), done| {
                results.flight(repetitions.compare(flight), report, done);
            })?;
            None
        }
        Some(firmware) => {
            let run = remote::Run { loaded, firmware, is_reported: args.report.is_some(), interrupted };
            run.all(&jobs, threads, &is_stopped, &mut results)?
        }
    };
    let (mut output, flights) = results.finish()?;
    let is_interrupted = interrupted.load(Ordering::Relaxed);
    let whole = flights.len() == jobs.len();
    let compared = if whole { run::compared(loaded, &flights, args.filter.is_some()) } else { Vec::new() };
    let summary = Summary::new(flights, compared, jobs.len(), loaded.left_out, started.seconds());
    output.finish(&summary)?;
    Ok(match trouble {
        _ if is_interrupted => error::INTERRUPTED,
        Some(code) => code,
        None if summary.passed() => 0,
        None => error::FAILED,
    })
}

/// Prints names and cases, without flying.
fn list(args: &CheckArgs) -> Result<u8, AppError> {
    let loaded = load::load(&CheckArgs { slow: true, ..args.clone() })?;
    let mut text = String::new();
    for scenario in &loaded.scenarios {
        let slow = if scenario.slow { " (slow)" } else { "" };
        let cases: Vec<String> = scenario
            .cases
            .iter()
            .filter(|case| run::is_wanted(scenario, case, args))
            .map(|case| {
                let seeds = case.airs.len();
                let name = if case.name.is_empty() { "one case" } else { &case.name };
                if seeds == 1 { format!("    {name}\n") } else { format!("    {name} ({seeds} seeds)\n") }
            })
            .collect();
        if !cases.is_empty() {
            text.push_str(&format!("{}{slow}: {}\n{}", scenario.name, scenario.description, cases.concat()));
        }
    }
    error::print(&text)
}

/// Judged comparisons of several flights.
type Comparisons = Vec<Compared>;
