//! Flies the cases with a remote firmware: one after the other, in real time, each with a new start.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Loaded;
use super::results::Results;
use super::run::{self, Job, Stopwatch};
use crate::app::firmware::run::{OnEvent, RemoteRun, RunOptions, Stopped};
use crate::app::firmware::{RemoteFirmware, reported};
use crate::app::{AppError, error, setup};
use crate::fc::Unset;
use crate::report::check::CheckedFlight;
use crate::scenario::{self, Air, Case, CaseFlight};
use crate::session::Event;

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

/// Flies all jobs. A flight that cannot be prepared has failed, and the run goes on. Two such flights in a row, with
/// a cause in the environment, end the run. Returns the exit code if there was such a problem.
pub(super) fn all(
    loaded: &Loaded,
    jobs: &[Job],
    firmware: &RemoteFirmware,
    interrupted: &Arc<AtomicBool>,
    results: &mut Results<'_>,
) -> Option<u8> {
    let (mut trouble, mut is_in_trouble) = (None, false);
    for (index, job) in jobs.iter().enumerate() {
        let (Some((case, air)), Some(unflown)) = (job.of(loaded), job.not_flown_yet(loaded)) else {
            continue;
        };
        let was_in_trouble = is_in_trouble;
        let flight = match scenario::skip(case) {
            Some(judgements) => CheckedFlight { judgements, ..unflown },
            None => match fly(case, air, unflown.clone(), firmware, interrupted, results) {
                Ok(flight) => {
                    is_in_trouble = false;
                    flight
                }
                // Interrupted in the air: there is no result.
                Err(Stopped::Interrupted | Stopped::BySubscriber) => return trouble,
                Err(Stopped::Failed(AppError { code, message })) => {
                    is_in_trouble = code >= error::ENVIRONMENT;
                    trouble = trouble.max(is_in_trouble.then_some(code));
                    CheckedFlight { problem: Some(message), ..unflown }
                }
            },
        };
        results.flight(flight, index + 1);
        if interrupted.load(Ordering::Relaxed) || results.is_stopped() {
            return trouble;
        }
        if was_in_trouble && is_in_trouble && index + 1 < jobs.len() {
            results.tell(NO_MORE);
            return trouble;
        }
    }
    trouble
}

/// Flies and judges one flight.
fn fly(
    case: &Case,
    air: &Air,
    checked: CheckedFlight,
    firmware: &RemoteFirmware,
    interrupted: &Arc<AtomicBool>,
    results: &mut Results<'_>,
) -> Result<CheckedFlight, Stopped> {
    let started = Stopwatch::start();
    let mut setup = case.setup_in(air);
    setup.remote_controller = true;
    let plan = setup.plan.plan.clone();
    let mut firmware = firmware.with_settings(&setup.plan.settings, &[]);
    let of_case = setup.boot_lines.iter().flat_map(|lines| lines.text.lines());
    firmware.lines.of_user.extend(of_case.map(str::to_owned));
    let mut vehicle = setup::build(setup, &mut Vec::new())?;
    let options = RunOptions { state: None, speed: 1.0, interrupted: Arc::clone(interrupted) };
    let mut tell = OnEvent(|event: &Event| {
        if let Some(sentence) = reported::sentence(event) {
            results.tell(&sentence);
        }
    });
    let mut remote = RemoteRun::prepare(&firmware, &mut vehicle, &plan, options, &mut tell)?;
    let problem = remote.unset().and_then(|unset| not_as_wanted(case, unset));
    let mut flight = match CaseFlight::of_vehicle(case, vehicle) {
        Ok(flight) => flight,
        Err(problem) => return Ok(CheckedFlight { problem: Some(problem), ..checked }),
    };
    remote.fly(&mut flight, &mut tell)?;
    Ok(CheckedFlight { problem, ..run::judged(checked, case, flight.finish(), &started) })
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
