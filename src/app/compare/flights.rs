//! Flights of one plan, each from the same start.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Compared;
use super::recorder::Recorder;
use crate::app::firmware::configuration::guide_settings;
use crate::app::firmware::run::{RemoteRun, RunOptions, Seen, Stopped, unless_interrupted};
use crate::app::firmware::{RemoteFirmware, told};
use crate::app::interrupt::interrupt_flag;
use crate::app::{AppError, setup};
use crate::args::{CompareArgs, Speed};
use crate::firmware::config::Configuration;
use crate::flight::setup::{BootLines, PhysicsSource};
use crate::flight::{FlightOptions, FlightSetup};
use crate::plan::format::PlanFile;
use crate::record::compare::{Route, Track};
use crate::session::{Event, SessionEvent, upload};

/// Ticks between two looks at an interrupt.
const SLICE: u64 = 4096;

/// What all flights start from.
#[derive(Debug)]
pub(super) struct Flights {
    plan: PlanFile,
    setup: FlightSetup,
    options: FlightOptions,
    route: Route,
    /// Settings that come last.
    set: Vec<String>,
    /// Times real time of a firmware outside.
    speed: f64,
    interrupted: Arc<AtomicBool>,
}

impl Flights {
    /// Reads the plan and the settings; what the user should know is added to `notices`.
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
        // An executable starts without a configuration and gets the guide's settings: so does the embedded one beside it.
        if executable_flies {
            setup.plan.settings = guide_settings()?.into_iter().chain(setup.plan.settings).collect();
        }
        // Two firmwares outside fly: only the radii of the embedded one are asked for, to draw the plan.
        let unheard = &mut Vec::new();
        let set =
            setup::set_of_embedded(&args.mission.set, if embedded_flies { &mut *notices } else { unheard });
        let set = if embedded_flies { set? } else { set.unwrap_or_default() };
        setup.boot_lines.push(BootLines::settings("--set", &set));
        let vehicle = setup::build(setup.clone(), notices)?;
        let frame = vehicle.local_frame().ok_or_else(|| AppError::internal("the craft is nowhere"))?;
        let settings = vehicle.controller().settings_view().unwrap_or_default();
        Ok(Self {
            route: Route::new(&plan.plan, frame, &settings),
            plan,
            setup,
            options: setup::flight_options(&args.mission, 0.0),
            set: args.mission.set.clone(),
            speed: args.flight.speed.map_or(1.0, |Speed(speed)| speed),
            interrupted: interrupt_flag()?,
        })
    }

    /// What the plan is called.
    pub(super) fn plan_name(&self) -> &str {
        &self.plan.name
    }

    /// The plan in metres.
    pub(super) fn route(&self) -> Route {
        self.route.clone()
    }

    /// Flies once; `None` when it was interrupted.
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
        loop {
            for _ in 0..SLICE {
                let end = flight.tick(|report| recorder.hear(&report));
                recorder.look(&flight);
                if let Some(end) = end {
                    return Ok(Some(recorder.finish(&flight, end)));
                }
            }
            if self.interrupted.load(Ordering::Relaxed) {
                return Ok(None);
            }
        }
    }

    /// Each flight starts an executable anew, in an empty directory, as nothing else makes it forget the one before.
    fn fly_remote(&self, firmware: &RemoteFirmware) -> Result<Track, Stopped> {
        let setup = FlightSetup { remote_controller: true, ..self.setup.clone() };
        let mut vehicle = setup::build(setup, &mut Vec::new())?;
        let firmware = firmware.with_settings(&self.plan.settings, &self.set);
        let options =
            RunOptions { state: None, speed: self.speed, interrupted: Arc::clone(&self.interrupted) };
        // That each starts without a configuration goes without saying.
        let mut tell = |event: &Event| {
            if matches!(event.kind, SessionEvent::Remote(_)) {
                told::tell(event);
            }
            Ok(())
        };
        let mut run = RemoteRun::prepare(&firmware, &mut vehicle, &self.plan.plan, options, &mut tell)?;
        let mut recorder = Recorder::new(&vehicle);
        let mut flight = setup::start_flight(vehicle, &self.options)?;
        let end = run.fly(&mut flight, &mut |seen| {
            match seen {
                Seen::Report(report) => recorder.hear(&report),
                Seen::Told(event) => told::tell(&event),
                Seen::Ticked(flight) => recorder.look(flight),
            }
            Ok(())
        })?;
        Ok(recorder.finish(&flight, end))
    }
}
