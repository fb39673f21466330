//! Flights of one plan, each from the same start.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::recorder::Recorder;
use crate::app::firmware::{self, RemoteFirmware};
use crate::app::interrupt::interrupt_flag;
use crate::app::{AppError, setup};
use crate::args::CompareArgs;
use crate::firmware::config::Configuration;
use crate::flight::setup::{BootLines, PhysicsSource};
use crate::flight::{Flight, FlightOptions, FlightSetup};
use crate::plan::format::PlanFile;
use crate::plan::review::Finding;
use crate::plan::validate::check_plan;
use crate::record::compare::{Route, Track};
use crate::session::upload;
use crate::signals::SimTime;
use crate::vehicle::Vehicle;

/// Ticks between two looks at an interrupt.
const SLICE: u64 = 4096;

/// What all flights start from.
#[derive(Debug)]
pub(super) struct Flights {
    plan: PlanFile,
    setup: FlightSetup,
    options: FlightOptions,
    route: Route,
    interrupted: Arc<AtomicBool>,
}

impl Flights {
    /// Reads the plan and the settings; what the user should know is added to `notices`.
    pub(super) fn new(args: &CompareArgs, notices: &mut Vec<String>) -> Result<Self, AppError> {
        let plan = setup::read_plan(&args.plan)?;
        check_plan(&plan.plan)
            .map_err(|fault| AppError::input(format!("{}: {}", plan.name, Finding::Fault(fault))))?;
        notices.extend(plan.notes.iter().map(ToString::to_string));
        let mut setup =
            setup::from_args(&args.flight, PhysicsSource::Embedded, plan.clone(), Configuration::default())?;
        setup.boot_lines.push(BootLines::settings("--set", &args.set));
        let vehicle = setup::build(setup.clone(), notices)?;
        let frame = vehicle.local_frame().ok_or_else(|| AppError::internal("the craft is nowhere"))?;
        let settings = vehicle.controller().settings_view().unwrap_or_default();
        Ok(Self {
            route: Route::new(&plan.plan, frame, &settings),
            plan,
            setup,
            options: FlightOptions {
                takeoff_m: args.takeoff_m(),
                timeout: SimTime::from_secs_f64(args.timeout_s()),
                samples_hz: 0.0,
                tolerance_m: args.tolerance_m(),
            },
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
            Some(_) => Err(firmware::not_linked()),
        }
    }

    fn fly_embedded(&self) -> Result<Option<Track>, AppError> {
        let mut vehicle = setup::build(self.setup.clone(), &mut Vec::new())?;
        upload(vehicle.controller_mut(), &self.plan.plan, &[]).map_err(AppError::input)?;
        let (mut flight, mut recorder) = self.start(vehicle)?;
        loop {
            for _ in 0..SLICE {
                if let Some(end) = recorder.tick(&mut flight) {
                    return Ok(Some(recorder.finish(end)));
                }
            }
            if self.interrupted.load(Ordering::Relaxed) {
                return Ok(None);
            }
        }
    }

    fn start(&self, vehicle: Vehicle) -> Result<(Flight, Recorder), AppError> {
        let flight = Flight::new(vehicle, &self.options).map_err(|mode| {
            AppError::input(format!(
                "no channel switches {mode}: the pilot needs one; set it with an aux line in --settings"
            ))
        })?;
        let recorder = Recorder::new(flight.vehicle());
        Ok((flight, recorder))
    }
}
