//! Flights of one plan, each from the same start.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Compared;
use crate::args::{CompareArgs, Speed};
use crate::events::{Event, SessionEvent};
use crate::fc::guide_settings;
use crate::files::log_output::{LogOnly, LogOutput};
use crate::files::terrain::with_terrain;
use crate::firmware::config::Configuration;
use crate::flight::setup::{BootLines, PhysicsSource};
use crate::flight::{FlightOptions, FlightSetup};
use crate::geo::LocalFrame;
use crate::headless::compare::jobs::seeds_on_wall_clock;
use crate::headless::compare::recorder::Recorder;
use crate::headless::setup;
use crate::launch::run::{OnEvent, RemoteRun, RunOptions, Stopped, unless_interrupted};
use crate::launch::{RemoteFirmware, reported};
use crate::plan::format::PlanFile;
use crate::process::error;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::report::compare::Track;
use crate::report::route::Route;
use crate::runner::Runner;
use crate::sim::WorldConfig;

/// The common start of all flights.
#[derive(Debug)]
pub(super) struct Flights {
    plan: PlanFile,
    setup: FlightSetup,
    options: FlightOptions,
    route: Route,
    frame: LocalFrame,
    /// Settings that are applied last.
    set: Vec<String>,
    /// The requested speed of a remote firmware, as a multiple of real time.
    speed: Option<f64>,
    /// `true` if each firmware flies several seeds.
    has_seeds: bool,
    interrupted: Arc<AtomicBool>,
}

impl Flights {
    /// Reads the plan and the settings, and adds messages for the user to `notices`.
    pub(super) fn new(
        args: &CompareArgs,
        compared: &[Compared],
        notices: &mut Vec<String>,
    ) -> Result<Self, AppError> {
        let embedded_flies = compared.iter().any(|one| one.firmware.is_none());
        let executable_flies =
            compared.iter().flat_map(|one| &one.firmware).any(|firmware| firmware.executable.is_some());
        let plan = setup::read_plan(&args.plan, args.flight.home)?;
        setup::refuse_unflyable(&plan)?;
        notices.extend(plan.notices());
        let mut setup =
            setup::from_args(&args.flight, PhysicsSource::Embedded, plan.clone(), Configuration::default())?;
        setup = with_terrain(setup, &args.flight.terrain, notices)?;
        // An executable starts without a configuration and gets the guide's settings, so the embedded one gets them,
        // too.
        if executable_flies {
            setup.plan.settings = guide_settings()
                .map_err(AppError::internal)?
                .into_iter()
                .chain(setup.plan.settings)
                .collect();
        }
        // With two remote firmwares, only the radii of the embedded one are needed, to draw the plan.
        let unheard = &mut Vec::new();
        let set =
            setup::set_of_embedded(&args.mission.set, if embedded_flies { &mut *notices } else { unheard });
        let set = if embedded_flies { set? } else { set.unwrap_or_default() };
        setup.boot_lines.push(BootLines::settings("--set", &set));
        let vehicle = setup::build(setup.clone(), notices)?;
        let frame = vehicle.local_frame().ok_or_else(|| AppError::internal("the craft has no position"))?;
        let settings = vehicle.controller().settings_view().unwrap_or_default();
        Ok(Self {
            route: Route::new(&plan.plan, frame, &settings),
            frame: *frame,
            plan,
            setup,
            options: setup::flight_options(&args.mission),
            set: args.mission.set.clone(),
            speed: args.flight.speed.map(|Speed(speed)| speed),
            has_seeds: args.seeds.is_some(),
            interrupted: interrupt_flag()?,
        })
    }

    /// Returns the name of the plan.
    pub(super) fn plan_name(&self) -> &str {
        &self.plan.name
    }

    /// Returns the plan in metres.
    pub(super) fn route(&self) -> Route {
        self.route.clone()
    }

    /// Returns the frame of the route.
    pub(super) fn frame(&self) -> &LocalFrame {
        &self.frame
    }

    /// Returns the world without the seed of a flight.
    pub(super) fn world(&self) -> &WorldConfig {
        &self.setup.world
    }

    /// Returns `true` if the user wants no more flights.
    pub(super) fn is_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Flies once with a seed, and with the log of an embedded firmware in a file, if it is named; `None` after an
    /// interrupt. Messages about the firmware are printed at once if `at_once`.
    pub(super) fn fly(
        &self,
        compared: &Compared,
        (seed, log): (u64, Option<&Path>),
        thread: usize,
        at_once: bool,
    ) -> Result<Option<Flown>, AppError> {
        let mut setup = self.setup.clone();
        setup.world.seed = seed;
        let Some(firmware) = &compared.firmware else { return self.fly_embedded(setup, log) };
        let mut reported = Vec::new();
        let mut tell = |sentence: String| match at_once {
            true => error::tell(&sentence),
            false => reported.push(sentence),
        };
        let flown = unless_interrupted(self.fly_remote(setup, compared, firmware, thread, &mut tell))?;
        Ok(flown.map(|track| Flown { track, reported }))
    }

    fn fly_embedded(&self, setup: FlightSetup, log: Option<&Path>) -> Result<Option<Flown>, AppError> {
        let seed = setup.world.seed;
        let mut vehicle = setup::build(setup, &mut Vec::new())?;
        setup::store_plan(&mut vehicle, &self.plan.plan)?;
        let mut recorder = Recorder::new(&vehicle, seed);
        let mut log = log.map(|path| LogOutput::begin(path, &mut vehicle).map(LogOnly::new)).transpose()?;
        let mut flight = setup::start_flight(vehicle, &self.options)?;
        let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
        let end = runner.fly(&mut flight, &mut (&mut recorder, &mut log), || self.is_interrupted());
        log.map_or(Ok(()), LogOnly::finish)?;
        Ok(end.ok().map(|end| Flown { track: recorder.finish(&flight, end), reported: Vec::new() }))
    }

    /// Flies a remote firmware. An executable is restarted for each flight in an empty directory, because only that
    /// makes it forget the previous flight.
    fn fly_remote(
        &self,
        setup: FlightSetup,
        compared: &Compared,
        firmware: &RemoteFirmware,
        thread: usize,
        tell: &mut impl FnMut(String),
    ) -> Result<Track, Stopped> {
        let seed = setup.world.seed;
        let setup = FlightSetup { remote_controller: true, ..setup };
        let mut vehicle = setup::build(setup, &mut Vec::new())?;
        let firmware = firmware.with_settings(&self.plan.settings, &self.set);
        let options = RunOptions {
            state: None,
            speed: self.speed,
            interrupted: Arc::clone(&self.interrupted),
            processor: Some(thread),
        };
        // Every flight starts without a configuration, so this is not reported.
        let mut tell = OnEvent(|event: &Event| {
            if matches!(event.kind, SessionEvent::Remote(_)) {
                reported::sentence(event).into_iter().for_each(&mut *tell);
            }
        });
        let mut run = RemoteRun::prepare(&firmware, &mut vehicle, &self.plan.plan, options, &mut tell)?;
        // The executable was to run in simulated time, and cannot.
        if self.has_seeds && run.motor_hash().is_none() {
            return Err(seeds_on_wall_clock(&compared.name).into());
        }
        let mut recorder = Recorder::new(&vehicle, seed);
        let mut flight = setup::start_flight(vehicle, &self.options)?;
        let end = run.fly(&mut flight, &mut (&mut recorder, &mut tell))?;
        let mut track = recorder.finish(&flight, end);
        track.reason += &run.runner().disturbance();
        Ok(track)
    }
}

/// A flight that is over.
#[derive(Debug)]
pub(super) struct Flown {
    pub(super) track: Track,
    /// Messages about the firmware during the flight that were not printed.
    pub(super) reported: Vec<String>,
}
