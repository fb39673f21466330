//! Flights of one plan, each from the same start.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Compared;
use super::recorder::Recorder;
use crate::app::firmware::run::{OnEvent, RemoteRun, RunOptions, Stopped, unless_interrupted};
use crate::app::firmware::{RemoteFirmware, reported};
use crate::app::interrupt::interrupt_flag;
use crate::app::{AppError, setup};
use crate::args::{CompareArgs, Speed};
use crate::fc::{guide_settings, upload};
use crate::firmware::config::Configuration;
use crate::flight::setup::{BootLines, PhysicsSource};
use crate::flight::{FlightOptions, FlightSetup};
use crate::plan::format::PlanFile;
use crate::report::compare::{Route, Track};
use crate::session::{Event, Runner, SessionEvent};

/// The common start of all flights.
#[derive(Debug)]
pub(super) struct Flights {
    plan: PlanFile,
    setup: FlightSetup,
    options: FlightOptions,
    route: Route,
    /// Settings that are applied last.
    set: Vec<String>,
    /// The requested speed of a remote firmware, as a multiple of real time.
    speed: Option<f64>,
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
        let plan = setup::read_plan(&args.plan)?;
        setup::refuse_unflyable(&plan)?;
        notices.extend(plan.notes.iter().map(ToString::to_string));
        let mut setup =
            setup::from_args(&args.flight, PhysicsSource::Embedded, plan.clone(), Configuration::default())?;
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
            plan,
            setup,
            options: setup::flight_options(&args.mission),
            set: args.mission.set.clone(),
            speed: args.flight.speed.map(|Speed(speed)| speed),
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

    /// Flies once; `None` after an interrupt.
    pub(super) fn fly(&self, firmware: Option<&RemoteFirmware>) -> Result<Option<Track>, AppError> {
        match firmware {
            None => self.fly_embedded(),
            Some(firmware) => unless_interrupted(self.fly_remote(firmware)),
        }
    }

    fn fly_embedded(&self) -> Result<Option<Track>, AppError> {
        let mut vehicle = setup::build(self.setup.clone(), &mut Vec::new())?;
        upload(vehicle.controller_mut(), &self.plan.plan, &[]).map_err(AppError::input)?;
        let mut recorder = Recorder::new(&vehicle);
        let mut flight = setup::start_flight(vehicle, &self.options)?;
        let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
        let end = runner.fly(&mut flight, &mut recorder, || self.interrupted.load(Ordering::Relaxed));
        Ok(end.ok().map(|end| recorder.finish(&flight, end)))
    }

    /// Flies a remote firmware. An executable is restarted for each flight in an empty directory, because only that
    /// makes it forget the previous flight.
    fn fly_remote(&self, firmware: &RemoteFirmware) -> Result<Track, Stopped> {
        let setup = FlightSetup { remote_controller: true, ..self.setup.clone() };
        let mut vehicle = setup::build(setup, &mut Vec::new())?;
        let firmware = firmware.with_settings(&self.plan.settings, &self.set);
        let options = RunOptions {
            state: None,
            speed: self.speed,
            interrupted: Arc::clone(&self.interrupted),
            processor: None,
        };
        // Every flight starts without a configuration, so this is not reported.
        let mut tell = OnEvent(|event: &Event| {
            if matches!(event.kind, SessionEvent::Remote(_)) {
                reported::tell(event);
            }
        });
        let mut run = RemoteRun::prepare(&firmware, &mut vehicle, &self.plan.plan, options, &mut tell)?;
        let mut recorder = Recorder::new(&vehicle);
        let mut flight = setup::start_flight(vehicle, &self.options)?;
        let end = run.fly(&mut flight, &mut (&mut recorder, &mut tell))?;
        Ok(recorder.finish(&flight, end))
    }
}
