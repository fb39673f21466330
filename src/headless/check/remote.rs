//! Flies the cases with a remote firmware, each with a new start.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{Loaded, run};
use crate::events::Event;
use crate::fc::Unset;
use crate::headless::check::record::Record;
use crate::headless::check::results::Results;
use crate::headless::check::run::{Job, Judged, Repetitions, Stopwatch};
use crate::headless::setup;
use crate::launch::run::{OnEvent, RemoteRun, RunOptions, Stopped};
use crate::launch::{RemoteFirmware, reported};
use crate::link::conventions::{FirmwareClock, Stamps};
use crate::process::error::AppError;
use crate::process::{error, parallel};
use crate::report::check::{CheckedFlight, shell_word};
use crate::report::flight::FlightReport;
use crate::runner::Subscriber;
use crate::scenario::{self, Air, Case, CaseFlight, Flown};
use crate::vehicle::Vehicle;

/// The message if flights cannot be prepared repeatedly.
const NO_MORE: &str = "Two flights in a row could not be prepared: the others are not tried.";

/// Refuses several flights with a firmware that is already running, because it is not restarted for each flight.
///
/// # Errors
/// Returns an error if more than one flight is requested.
pub(super) fn refuse_many(firmware: &RemoteFirmware, flights: usize, watch: bool) -> Result<(), AppError> {
    if firmware.executable.is_some() || (flights == 1 && !watch) {
        return Ok(());
    }
    let asked = if watch { "--watch flies again".to_owned() } else { format!("there are {flights}") };
    Err(AppError::input(format!(
        "--firmware attach flies one flight, because a running firmware keeps its estimates from the flight before, \
         and {asked}: choose one (--filter TEXT, --seeds 1..1), or let betadeck start the firmware for each \
         (--firmware PATH)"
    )))
}

/// The flights of a run with a remote firmware.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub(super) loaded: &'a Loaded,
    pub(super) firmware: &'a RemoteFirmware,
    /// `true` if flights have reports.
    pub(super) is_reported: bool,
    pub(super) interrupted: &'a Arc<AtomicBool>,
}

/// A flight that is over.
struct Done {
    flight: CheckedFlight,
    report: Option<Box<FlightReport>>,
    /// The messages about the firmware during the flight.
    reported: Vec<String>,
    /// The exit code of a problem with the environment.
    trouble: Option<u8>,
}

impl Run<'_> {
    /// Flies all jobs: several at once in simulated time, one after the other on the wall clock. A flight that cannot be
    /// prepared has failed, and the run goes on. Two such flights in a row, with a cause in the environment, end the run.
    /// Returns the exit code if there was such a problem.
    pub(super) fn all(
        self,
        jobs: &[Job],
        threads: usize,
        is_stopped: &(impl Fn() -> bool + Sync),
        results: &mut Results<'_>,
    ) -> Result<Option<u8>, AppError> {
        let is_repeatable = self.firmware.clock == FirmwareClock::Sim;
        let threads = if is_repeatable { threads } else { 1 };
        let (mut trouble, mut is_in_trouble) = (None, false);
        let mut repetitions = Repetitions::default();
        // Most flights have the same messages.
        let mut printed = BTreeSet::new();
        let gives_up = AtomicBool::new(false);
        let ends = || is_stopped() || gives_up.load(Ordering::Relaxed);
        parallel::all(
            jobs,
            threads,
            &ends,
            |thread, job| self.one(job, thread),
            |done: Done, count| {
                // A flight that began before the run was given up is not reported.
                if gives_up.load(Ordering::Relaxed) {
                    return;
                }
                for sentence in done.reported {
                    if printed.insert(sentence.clone()) {
                        results.tell(&sentence);
                    }
                }
                let was_in_trouble = std::mem::replace(&mut is_in_trouble, done.trouble.is_some());
                trouble = trouble.max(done.trouble);
                let flight = if is_repeatable { repetitions.compare(done.flight) } else { done.flight };
                results.flight(flight, done.report, count);
                if was_in_trouble && is_in_trouble && count < jobs.len() {
                    gives_up.store(true, Ordering::Relaxed);
                    results.tell(NO_MORE);
                }
            },
        )?;
        Ok(trouble)
    }

    /// Flies and judges one flight; `None` if it was interrupted in the air.
    fn one(self, job: Job, thread: usize) -> Option<Done> {
        let (case, air) = job.of(self.loaded)?;
        let unflown = CheckedFlight {
            is_remote: true,
            firmware_options: options_to_open(self.firmware),
            ..job.not_flown_yet(self.loaded)?
        };
        let mut reported = Vec::new();
        if let Some(judgements) = scenario::skip(case) {
            let flight = CheckedFlight { judgements, ..unflown };
            return Some(Done { flight, report: None, reported, trouble: None });
        }
        let ((flight, report), trouble) = match self.fly(case, air, unflown.clone(), thread, &mut reported) {
            Ok(flight) => (flight, None),
            Err(Stopped::Interrupted | Stopped::BySubscriber) => return None,
            Err(Stopped::Failed(AppError { code, message })) => {
                let trouble = (code >= error::ENVIRONMENT).then_some(code);
                ((CheckedFlight { problem: Some(message), ..unflown }, None), trouble)
            }
        };
        Some(Done { flight, report, reported, trouble })
    }

    fn fly(
        self,
        case: &Case,
        air: &Air,
        checked: CheckedFlight,
        thread: usize,
        reported: &mut Vec<String>,
    ) -> Result<Judged, Stopped> {
        let started = Stopwatch::start();
        match fly_case(self.firmware, case, air, self.interrupted, thread, self.is_reported, reported)? {
            Err(problem) => Ok((CheckedFlight { problem: Some(problem), ..checked }, None)),
            Ok(RemoteFlown { flown, problem, hash, report }) => {
                let judged = run::judged(checked, case, flown, &started);
                let hash = hash.unwrap_or(judged.hash);
                Ok((CheckedFlight { problem, hash, ..judged }, report))
            }
        }
    }
}

/// A flight that a remote firmware flew.
pub(crate) struct RemoteFlown {
    pub(crate) flown: Flown,
    /// The reason why it does not match its case.
    pub(crate) problem: Option<String>,
    /// The hash of its motor packets, in simulated time.
    pub(crate) hash: Option<u64>,
    /// The report about it, if one is wanted.
    pub(crate) report: Option<Box<FlightReport>>,
}

/// Flies a case with a new start of the firmware. The inner error is the reason why the pilot cannot fly it. Adds the
/// messages about the firmware to `reported`.
pub(crate) fn fly_case(
    firmware: &RemoteFirmware,
    case: &Case,
    air: &Air,
    interrupted: &Arc<AtomicBool>,
    thread: usize,
    is_reported: bool,
    reported: &mut Vec<String>,
) -> Result<Result<RemoteFlown, String>, Stopped> {
    let mut tell = OnEvent(|event: &Event| reported.extend(reported::sentence(event)));
    let (mut remote, vehicle) = prepare(firmware, case, air, interrupted, thread, &mut tell)?;
    let problem = remote.unset().and_then(|unset| not_as_wanted(case, unset));
    let mut flight = match CaseFlight::from_vehicle(case, vehicle) {
        Ok(flight) => flight,
        Err(problem) => return Ok(Err(problem)),
    };
    let mut record = Record::new(is_reported, flight.vehicle(), case);
    remote.runner().begin_flight();
    remote.fly(&mut flight, &mut (&mut record, &mut tell))?;
    let mut flown = flight.finish();
    flown.reason += &remote.runner().disturbance();
    let report = record.finish(case, &flown);
    Ok(Ok(RemoteFlown { flown, problem, hash: remote.motor_hash(), report }))
}

/// Starts the firmware for the flight of a case and sets it up. `thread` is the number of the flight among those at once.
///
/// # Errors
/// Returns the reason why it cannot be flown.
pub(crate) fn prepare(
    firmware: &RemoteFirmware,
    case: &Case,
    air: &Air,
    interrupted: &Arc<AtomicBool>,
    thread: usize,
    subscriber: &mut impl Subscriber<Vehicle>,
) -> Result<(RemoteRun, Vehicle), Stopped> {
    let mut setup = case.setup_in(air);
    setup.remote_controller = true;
    let plan = setup.plan.plan.clone();
    let mut firmware = firmware.with_settings(&setup.plan.settings, &[]);
    let of_case = setup.boot_lines.iter().filter(|lines| !lines.choose_profile());
    let of_case = of_case.flat_map(|lines| lines.text.lines());
    firmware.lines.usual.extend(of_case.map(str::to_owned));
    let mut vehicle = setup::build(setup, &mut Vec::new())?;
    let interrupted = Arc::clone(interrupted);
    let options = RunOptions { state: None, speed: None, interrupted, processor: Some(thread) };
    let remote = RemoteRun::prepare(&firmware, &mut vehicle, &plan, options, subscriber)?;
    Ok((remote, vehicle))
}

/// Returns the options of `betadeck open` that fly with the same firmware, as text with a blank before each; `None` if it is
/// not started by this program, or if the user's own lines, ports or formats are needed.
pub(crate) fn options_to_open(firmware: &RemoteFirmware) -> Option<String> {
    let is_usual = firmware.lines.of_user.is_empty()
        && firmware.ports.are_usual()
        && firmware.stamps == Stamps::default();
    let executable = firmware.executable.as_ref().filter(|_| is_usual)?;
    let mut options = format!(" --firmware {}", shell_word(&executable.display().to_string()));
    for argument in &firmware.arguments {
        options.push_str(&format!(" --firmware-arg {}", shell_word(argument)));
    }
    if firmware.clock == FirmwareClock::Real {
        options.push_str(" --clock real");
    }
    Some(options)
}

/// Returns the reason why the flight does not match the case: no line was set, or not all lines of the case itself.
/// Refused lines of a settings file are only reported, because other versions of the firmware refuse some of them.
fn not_as_wanted(case: &Case, unset: &Unset) -> Option<String> {
    match unset {
        Unset::Everything(why) => Some(why.clone()),
        Unset::Lines(lines) => {
            let own: Vec<&str> = case.own_lines().map(subject).collect();
            let not_set: Vec<String> = lines
                .iter()
                .filter(|unset| own.iter().any(|own| own.eq_ignore_ascii_case(subject(&unset.line))))
                .map(|unset| format!("`{}`: {}", unset.line, unset.why))
                .collect();
            (!not_set.is_empty()).then(|| {
                format!("the firmware is not configured as the case requires: {}", not_set.join("; "))
            })
        }
    }
}

/// Returns the subject of a line: the name for a setting, the whole line otherwise.
fn subject(line: &str) -> &str {
    line.split('=').next().unwrap_or_default().trim()
}
