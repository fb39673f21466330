//! `betadeck fly`: a complete flight without a screen.
#![allow(clippy::disallowed_methods, reason = "measures the wall time of the flight and paces it when asked")]

mod output;
mod remote;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::error::{self, AppError};
use super::firmware::{self, Beside};
use super::interrupt::interrupt_flag;
use super::setup;
use crate::args::{FlyArgs, PhysicsArgs};
use crate::fc::upload;
use crate::flight::setup::{BootLines, PhysicsSource};
use crate::flight::{Flight, FlightEnd, FlightOptions, FlightResult};
use crate::plan::format::PlanFile;
use crate::report::End;
use crate::session::{Event, Pacer, hazards};
use crate::storage::Store;
use crate::vehicle::Vehicle;
use output::Output;

/// The number of ticks between two checks of the clock and of the interrupt.
const SLICE: u64 = 4096;

/// Flies and reports. The exit code is 0 if the mission completed.
pub(super) fn run(args: &FlyArgs) -> Result<u8, AppError> {
    output::claim(args)?;
    let plan = setup::read_plan(&args.plan)?;
    setup::refuse_unflyable(&plan)?;
    let mut notices: Vec<String> = plan.notes.iter().map(ToString::to_string).collect();
    let physics = PhysicsArgs::default();
    let beside = Beside { ports: (&args.firmware_ports).into(), flight: &args.flight, physics: &physics };
    let firmware = firmware::choose(&args.firmware, beside, &mut notices)?
        .map(|firmware| firmware.with_settings(&plan.settings, &args.mission.set));
    if firmware.is_none() {
        setup::check_set(&args.mission.set)?;
    }
    notices.extend(args.firmware_ports.idle_options(firmware.is_some()));
    notices.extend(physics.idle_options(&args.flight, firmware.is_some()));
    let mut store = open_store(args)?;
    let stored = setup::stored(&mut store, &mut notices);
    let mut setup = setup::from_args(&args.flight, PhysicsSource::Embedded, plan.clone(), stored)?;
    setup.world.faults = args.faults().collect();
    setup.boot_lines.push(BootLines::settings("--set", &args.mission.set));
    setup.stick_inputs.clone_from(&args.stick);
    setup.remote_controller = firmware.is_some();
    let vehicle = setup::build(setup, &mut notices)?;
    let start = Start { args, plan, vehicle, notices, interrupted: interrupt_flag()? };
    let flown = match &firmware {
        None => embedded(start)?,
        Some(firmware) => remote::fly(start, firmware)?,
    };
    let Some(Flown { end, wall, output, failure }) = flown else { return Ok(error::INTERRUPTED) };
    let end_record = End {
        result: end.verdict.result.to_string(),
        reason: end.verdict.reason,
        truth: end.truth,
        flown_s: end.flown_s,
        wall_s: wall.as_secs_f64(),
    };
    let finished = output.finish(end.time, &end_record);
    match failure {
        Some(failure) => Err(failure),
        None => finished.map(|()| exit_code(end.verdict.result)),
    }
}

/// The start of a flight.
struct Start<'a> {
    args: &'a FlyArgs,
    plan: PlanFile,
    vehicle: Vehicle,
    /// The first messages.
    notices: Vec<String>,
    interrupted: Arc<AtomicBool>,
}

/// A finished flight.
struct Flown {
    end: FlightEnd,
    /// Wall time from the engagement to the end, or from the start if it did not engage.
    wall: Duration,
    output: Output,
    /// The error that ended the flight early.
    failure: Option<AppError>,
}

impl Start<'_> {
    fn options(&self) -> FlightOptions {
        setup::flight_options(&self.args.mission, self.args.samples.unwrap_or(0.0))
    }
}

/// Opens the outputs and reports the events so far.
fn open_output(
    args: &FlyArgs,
    plan: &PlanFile,
    vehicle: &mut Vehicle,
    notices: Vec<String>,
) -> Result<Output, AppError> {
    let mut output = Output::open(args, vehicle, plan)?;
    first_events(vehicle, notices).iter().try_for_each(|event| output.event(event))?;
    Ok(output)
}

/// Returns the events of the vehicle so far, and the notices.
fn first_events(vehicle: &mut Vehicle, notices: Vec<String>) -> Vec<Event> {
    let mut events: Vec<Event> = Vec::new();
    vehicle.drain_events(|event| events.push(event.into()));
    events.extend(notices.into_iter().map(|notice| Event::notice(vehicle.time(), notice)));
    events
}

fn exit_code(result: FlightResult) -> u8 {
    match result {
        FlightResult::Complete => 0,
        FlightResult::Missed
        | FlightResult::Landed
        | FlightResult::Refused
        | FlightResult::Aborted
        | FlightResult::Disarmed
        | FlightResult::Crashed
        | FlightResult::Timeout => error::FAILED,
        FlightResult::Diverged => error::INTERNAL,
        FlightResult::Interrupted => error::INTERRUPTED,
    }
}

/// Opens the store; `fly` starts fresh unless the user names a directory.
fn open_store(args: &FlyArgs) -> Result<Store, AppError> {
    match &args.flight.state_dir {
        // `fly` saves nothing, so a missing directory is a typing error.
        Some(directory) if !directory.is_dir() => Err(AppError::input(format!(
            "--state-dir {} is not a directory: name the one that serve or the user interface stores in",
            directory.display()
        ))),
        Some(directory) => Ok(Store::read_only(directory)),
        None => Ok(Store::in_memory()),
    }
}

/// Flies with the embedded firmware.
fn embedded(mut start: Start<'_>) -> Result<Option<Flown>, AppError> {
    // A plan that the craft refuses is invalid input.
    upload(start.vehicle.controller_mut(), &start.plan.plan, &[]).map_err(AppError::input)?;
    let options = start.options();
    let max_alt_m = Some(start.args.review.max_altitude_m());
    start.notices.extend(hazards(&start.vehicle, options.takeoff_m, max_alt_m));
    let Start { args, plan, vehicle, notices, interrupted } = start;
    let mut flight = setup::start_flight(vehicle, &options)?;
    let mut output = open_output(args, &plan, flight.vehicle_mut(), notices)?;
    let (end, wall) = fly(flight, args.speed(), &interrupted, &mut output)?;
    Ok(Some(Flown { end, wall, output, failure: None }))
}

/// Runs the flight to its end. The wall time counts from the engagement, or from boot if there was none.
fn fly(
    mut flight: Flight,
    speed: f64,
    interrupted: &AtomicBool,
    output: &mut Output,
) -> Result<(FlightEnd, Duration), AppError> {
    let started = Instant::now();
    let mut engaged: Option<Instant> = None;
    let mut pacer = Pacer::new(flight.vehicle().step_us(), speed);
    let mut problem = None;
    loop {
        let due = pacer.due(started.elapsed(), SLICE);
        for _ in 0..due {
            let end = flight.tick(|report| {
                if let Err(error) = output.report(report) {
                    problem.get_or_insert(error);
                }
            });
            if engaged.is_none() && flight.engaged_at().is_some() {
                engaged = Some(Instant::now());
            }
            if let Err(error) = output.track(flight.vehicle()) {
                problem.get_or_insert(error);
            }
            if let Some(error) = problem.take() {
                return Err(error);
            }
            if let Some(end) = end {
                return Ok((end, engaged.unwrap_or(started).elapsed()));
            }
        }
        if interrupted.load(Ordering::Relaxed) {
            return Ok((flight.interrupt("stopped by a signal"), engaged.unwrap_or(started).elapsed()));
        }
        if due < SLICE {
            // A person may be watching the output.
            output.flush()?;
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}
