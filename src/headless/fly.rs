//! `betadeck fly`: a complete flight without a screen.
#![allow(clippy::disallowed_methods, reason = "measures the wall time of the flight")]

mod output;
mod watched;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::{report, setup};
use crate::args::{FlyArgs, PhysicsArgs, Speed};
use crate::events::Event;
use crate::files::log_output::{LogOutput, needs_embedded};
use crate::files::recording_file::Recorder;
use crate::files::terrain::with_terrain;
use crate::flight::setup::{BootLines, PhysicsSource};
use crate::flight::{FlightResult, FlightSetup, hazards};
use crate::geo::LatLon;
use crate::launch;
use crate::launch::run::{RemoteRun, RunOptions, unless_interrupted};
use crate::launch::{Beside, RemoteFirmware};
use crate::plan::estimate::Assumptions;
use crate::plan::format::PlanFile;
use crate::plan::review::{Finding, clearances};
use crate::process::error;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::report::End;
use crate::runner::{Flying as _, Runner, Stopped, Subscriber};
use crate::scenario::FlightHash;
use crate::storage::Store;
use crate::terrain::{Relief, Tiles};
use crate::vehicle::Vehicle;
use output::{Beside as BesideFlight, Output, Prelude, Recorded};
use watched::WatchedFlight;

/// Flies and reports. The exit code is 0 if the mission completed.
pub(crate) fn run(args: &FlyArgs, repeat: &[String]) -> Result<u8, AppError> {
    output::claim(args)?;
    let backdrop = if args.report.is_some() { report::backdrop(&args.backdrop)? } else { Vec::new() };
    let plan = setup::read_plan(&args.plan, args.flight.home)?;
    setup::refuse_unflyable(&plan)?;
    let mut notices = plan.notices();
    let physics = PhysicsArgs::default();
    let beside = Beside { ports: (&args.firmware_ports).into(), flight: &args.flight, physics: &physics };
    let firmware = launch::choose(&args.firmware, beside, &mut notices)?
        .map(|firmware| firmware.with_settings(&plan.settings, &args.mission.set));
    match firmware {
        None => setup::check_set(&args.mission.set)?,
        Some(_) if args.blackbox.is_some() => return Err(needs_embedded()),
        Some(_) => {}
    }
    notices.extend(args.firmware_ports.idle_options(firmware.is_some()));
    notices.extend(physics.idle_options(&args.flight, firmware.is_some()));
    let mut store = open_store(args)?;
    let stored = setup::stored(&mut store, &mut notices);
    let mut setup = setup::from_args(&args.flight, PhysicsSource::Embedded, plan.clone(), stored)?;
    setup = with_terrain(setup, &args.flight.terrain, &mut notices)?;
    setup.world.faults = args.trouble.faults().collect();
    setup.boot_lines.push(BootLines::settings("--set", &args.mission.set));
    setup.stick_inputs.clone_from(&args.trouble.stick);
    setup.remote_controller = firmware.is_some();
    let tiles = setup.world.terrain.clone();
    let recorded = args.record.as_ref().map(|_| setup.clone());
    let mut vehicle = setup::build(setup, &mut notices)?;
    // From the first input on. A remote firmware has none to keep.
    vehicle.keep_inputs(recorded.is_some());
    let beside = BesideFlight { command: report::command(repeat), backdrop, ..BesideFlight::default() };
    let start =
        Start { args, plan, tiles, vehicle, recorded, notices, beside, interrupted: interrupt_flag()? };
    let prepared = match &firmware {
        None => Some(start.embedded()?),
        Some(firmware) => start.remote(firmware)?,
    };
    let Some(Prepared { mut flight, mut output, mut run, interrupted }) = prepared else {
        return Ok(error::INTERRUPTED);
    };
    let mut watch = Stopwatch::start();
    run.runner().begin_flight();
    let flown =
        run.runner().fly(&mut flight, &mut (&mut output, &mut watch), || interrupted.load(Ordering::Relaxed));
    let flown = match (flown, flight.end()) {
        // Only the hash is missing.
        (Err(Stopped::Interrupted | Stopped::Failed(_)), Some(end)) => Ok(end.clone()),
        (flown, _) => flown,
    };
    let (end, failure) = match flown {
        Ok(end) => (end, None),
        Err(Stopped::Interrupted) => (flight.flight().interrupt("stopped by a signal"), None),
        // The files stay unfinished, because their end may be what cannot be written.
        Err(Stopped::BySubscriber) => return Err(output.into_problem()),
        // The files end like those of a finished flight.
        Err(Stopped::Failed(sentence)) => {
            (flight.flight().interrupt(&sentence), Some(AppError::environment(sentence)))
        }
    };
    let end_record = End {
        result: end.verdict.result.to_string(),
        reason: end.verdict.reason + &run.runner().disturbance(),
        truth: end.truth,
        flown_s: end.flown_s,
        wall_s: watch.seconds(),
        hash: flight.hash().and_then(|of_record| run.hash(of_record)),
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
    /// The elevation tiles under the plan.
    tiles: Option<Arc<Tiles>>,
    vehicle: Vehicle,
    /// The start of the flight for its recording, if one is wanted.
    recorded: Option<FlightSetup>,
    /// The first messages.
    notices: Vec<String>,
    /// The facts of a report that the flight does not have.
    beside: BesideFlight,
    interrupted: Arc<AtomicBool>,
}

/// A flight at its first tick.
struct Prepared {
    flight: WatchedFlight,
    output: Output,
    run: Run,
    interrupted: Arc<AtomicBool>,
}

/// The runner of the flight, with the remote firmware if there is one.
enum Run {
    Embedded(Runner),
    Remote(RemoteRun),
}

impl Run {
    fn runner(&mut self) -> &mut Runner {
        match self {
            Self::Embedded(runner) => runner,
            Self::Remote(run) => run.runner(),
        }
    }

    /// Returns the hash of the flight with this record; `None` on the wall clock, where no flight is repeatable.
    fn hash(&self, of_record: u64) -> Option<u64> {
        match self {
            Self::Embedded(_) => Some(of_record),
            Self::Remote(run) => run.motor_hash(),
        }
    }
}

impl Start<'_> {
    /// Prepares a flight with the embedded firmware.
    fn embedded(mut self) -> Result<Prepared, AppError> {
        setup::store_plan(&mut self.vehicle, &self.plan.plan)?;
        let options = setup::flight_options(&self.args.mission);
        self.notices.extend(self.hazards());
        let hash = self.hash();
        let recorder = self.recorder()?;
        let log = output::log_file(self.args);
        let log = log.map(|path| LogOutput::begin(&path, &mut self.vehicle)).transpose()?;
        self.beside.relief = self.relief();
        let Self { args, plan, vehicle, notices, beside, interrupted, .. } = self;
        let mut flight = WatchedFlight::new(setup::start_flight(vehicle, &options)?, hash);
        let files = Recorded { recorder, log };
        let mut output = Output::open(args, flight.vehicle(), &plan, beside, files)?;
        first_events(flight.vehicle_mut(), notices).iter().try_for_each(|event| output.write(event))?;
        let step_us = flight.vehicle().step_us();
        let run = Run::Embedded(Runner::new(step_us, args.speed(), None));
        Ok(Prepared { flight, output, run, interrupted })
    }

    /// Prepares a flight with a remote firmware; `None` if a signal came before the flight began.
    fn remote(mut self, firmware: &RemoteFirmware) -> Result<Option<Prepared>, AppError> {
        let mut prelude = Prelude::new(self.args);
        for event in first_events(&mut self.vehicle, std::mem::take(&mut self.notices)) {
            prelude.write(&event)?;
        }
        let options = RunOptions {
            state: self.args.flight.state_dir.as_deref(),
            speed: self.args.flight.speed.map(|Speed(speed)| speed),
            interrupted: Arc::clone(&self.interrupted),
            processor: None,
        };
        let prepared =
            RemoteRun::prepare(firmware, &mut self.vehicle, &self.plan.plan, options, &mut prelude);
        prelude.check()?;
        let Some(run) = unless_interrupted(prepared)? else { return Ok(None) };
        for hazard in self.hazards() {
            prelude.write(&Event::notice(self.vehicle.time(), hazard))?;
        }
        let hash = run.motor_hash().and_then(|_| self.hash());
        let recorder = self.recorder()?;
        self.beside.relief = self.relief();
        self.beside.firmware = Some(firmware.described());
        let flight = setup::start_flight(self.vehicle, &setup::flight_options(&self.args.mission))?;
        let output = prelude.open(flight.vehicle(), &self.plan, self.beside, recorder)?;
        let flight = WatchedFlight::new(flight, hash);
        Ok(Some(Prepared { flight, output, run: Run::Remote(run), interrupted: self.interrupted }))
    }

    /// Begins the hash of the flight, if something prints it.
    fn hash(&self) -> Option<FlightHash> {
        let args = self.args;
        let is_printed = args.json.is_some() || args.report.is_some() || args.markdown.is_some();
        is_printed.then(|| FlightHash::new(&self.vehicle, self.plan.plan.clone()))
    }

    /// Begins the recording, if one is wanted.
    fn recorder(&self) -> Result<Option<Recorder>, AppError> {
        let wanted = self.args.record.as_deref().zip(self.recorded.as_ref());
        wanted.map(|(path, setup)| Recorder::begin(path, setup)).transpose()
    }

    fn hazards(&self) -> Vec<String> {
        let (takeoff_m, review) = (self.args.mission.takeoff_m(), self.args.review);
        let mut hazards = hazards(&self.vehicle, takeoff_m, Some(review.max_altitude_m()));
        hazards.extend(self.low().iter().map(|finding| format!("Caution: {finding}.")));
        hazards
    }

    /// Returns the legs and the ways home that come too close to the ground.
    fn low(&self) -> Vec<Finding> {
        let Some(settings) = self.vehicle.controller().settings_view() else { return Vec::new() };
        let assumptions =
            Assumptions { start_alt_m: self.args.mission.takeoff_m(), ..settings.assumptions() };
        self.relief().map_or_else(Vec::new, |relief| {
            clearances(&self.plan.plan, &assumptions, &relief, self.args.review.clearance_m()).findings
        })
    }

    /// Returns the ground around home, if there are tiles.
    fn relief(&self) -> Option<Relief> {
        let frame = self.vehicle.local_frame()?;
        Relief::new(self.tiles.clone()?, LatLon::from_degrees(frame.lat_deg, frame.lon_deg))
    }
}

/// Measures the wall time from the engagement, or from the start if there is none, to the end.
struct Stopwatch {
    since: Instant,
    is_engaged: bool,
    ended_s: Option<f64>,
}

impl Stopwatch {
    fn start() -> Self {
        Self { since: Instant::now(), is_engaged: false, ended_s: None }
    }

    fn seconds(&self) -> f64 {
        self.ended_s.unwrap_or_else(|| self.since.elapsed().as_secs_f64())
    }
}

impl Subscriber<WatchedFlight> for Stopwatch {
    fn after_tick(&mut self, flight: &WatchedFlight) {
        if !self.is_engaged && flight.flight().engaged_at().is_some() {
            *self = Self { since: Instant::now(), is_engaged: true, ended_s: None };
        }
        if flight.end().is_some() {
            self.ended_s.get_or_insert_with(|| self.since.elapsed().as_secs_f64());
        }
    }
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
