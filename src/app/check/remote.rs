//! Flies the cases with a firmware outside: one after the other, in real time, each from a start of its own.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Loaded;
use super::run::{self, Job, Stopwatch};
use crate::app::AppError;
use crate::app::firmware::RemoteFirmware;
use crate::app::firmware::run::{RemoteRun, Stopped};
use crate::app::setup;
use crate::record::check::CheckedFlight;
use crate::scenario::{self, Air, Case, CaseFlight};
use crate::session::Event;

/// Flies all of them; `told` gets each result, with how many are flown.
pub(super) fn all(
    loaded: &Loaded,
    jobs: &[Job],
    firmware: &RemoteFirmware,
    interrupted: &Arc<AtomicBool>,
    stop: &AtomicBool,
    mut told: impl FnMut(CheckedFlight, usize),
) -> Result<(), AppError> {
    for (index, job) in jobs.iter().enumerate() {
        let (Some((case, air)), Some(flight)) = (job.of(loaded), job.not_flown_yet(loaded)) else { continue };
        let flight = match scenario::skip(case) {
            Some(judgements) => CheckedFlight { judgements, ..flight },
            None => match fly(case, air, flight, firmware, interrupted) {
                Ok(flight) => flight,
                // Interrupted in the air: it says nothing.
                Err(Stopped::Interrupted) => return Ok(()),
                Err(Stopped::Failed(error)) => return Err(error),
            },
        };
        told(flight, index + 1);
        if interrupted.load(Ordering::Relaxed) || stop.load(Ordering::Relaxed) {
            return Ok(());
        }
    }
    Ok(())
}

/// Flies and judges one.
fn fly(
    case: &Case,
    air: &Air,
    checked: CheckedFlight,
    firmware: &RemoteFirmware,
    interrupted: &Arc<AtomicBool>,
) -> Result<CheckedFlight, Stopped> {
    let started = Stopwatch::start();
    let mut setup = case.setup_in(air);
    setup.remote_controller = true;
    let plan = setup.plan.plan.clone();
    let mut firmware = firmware.with_settings(&setup.plan.settings, &[]);
    let of_case = setup.boot_lines.iter().flat_map(|lines| lines.text.lines());
    firmware.lines.of_user.extend(of_case.map(str::to_owned));
    let mut vehicle = setup::build(setup, &mut Vec::new())?;
    let mut remote =
        RemoteRun::start(&firmware, &vehicle, None, 1.0, Arc::clone(interrupted), &mut Vec::new())?;
    let mut quiet = |_: &Event| Ok(());
    remote.wait_until_ready(&mut vehicle, &mut quiet)?;
    remote.upload(&mut vehicle, &plan, &mut quiet)?;
    let mut flight = match CaseFlight::of_vehicle(case, vehicle) {
        Ok(flight) => flight,
        Err(problem) => return Ok(CheckedFlight { problem: Some(problem), ..checked }),
    };
    while !flight.is_over() {
        for _ in 0..remote.due() {
            if !flight.is_over() {
                flight.prepare();
                flight.tick(|_| {});
            }
        }
        remote.exchange(flight.vehicle_mut())?;
        remote.rest();
    }
    Ok(run::judged(checked, case, flight.finish(), &started))
}
