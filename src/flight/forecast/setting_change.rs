//! The effect of other settings: the same flight with them and without them.

use super::{Forecast, ForecastKind, ForecastRun, check_flies, check_possible};
use crate::firmware::cli::RefusedLine;
use crate::flight::FlightOptions;
use crate::plan::FlightPlan;
use crate::vehicle::{Vehicle, VehicleCommand, VehicleRefusal};

/// The flight without the changed settings.
#[derive(Debug)]
pub(super) enum Unchanged {
    Flying(Box<ForecastRun>),
    Flown(Box<Forecast>),
}

impl Unchanged {
    pub(super) fn is_flying(&self) -> bool {
        matches!(self, Self::Flying(_))
    }

    pub(super) fn advance(&mut self, ticks: u32) {
        if let Self::Flying(run) = self
            && let Some(forecast) = run.advance(ticks)
        {
            *self = Self::Flown(Box::new(forecast));
        }
    }

    pub(super) fn flown(self) -> Option<Box<Forecast>> {
        match self {
            Self::Flying(_) => None,
            Self::Flown(forecast) => Some(forecast),
        }
    }
}

/// A plan with the setting lines that its upload sets, without `set `.
#[derive(Debug, Clone, Copy)]
pub struct PlanWithSettings<'a> {
    /// The plan.
    pub plan: &'a FlightPlan,
    /// The settings, as `name = value`.
    pub settings: &'a [String],
}

impl ForecastRun {
    /// Forecasts the present flight with the setting lines `changed` (without `set `) and without them. If the craft
    /// does not fly, it forecasts a flight of the plan from home by the scripted pilot, who first climbs to `takeoff_m`.
    ///
    /// # Errors
    /// Fails with the reason why no forecast is possible, as a sentence.
    pub fn setting_change(
        vehicle: Vehicle,
        changed: &[String],
        PlanWithSettings { plan, settings }: PlanWithSettings<'_>,
        takeoff_m: f64,
    ) -> Result<Self, String> {
        check_possible(&vehicle)?;
        let run = |mut vehicle: Vehicle, changed: &[String]| {
            if check_flies(&vehicle).is_ok() {
                set(&mut vehicle, changed)?;
                return Self::begin(ForecastKind::LookAhead, vehicle, FlightOptions::default().takeoff_m);
            }
            Self::plan_estimate(vehicle, plan, &[settings, changed].concat(), takeoff_m)
        };
        let unchanged = run(vehicle.clone(), &[])?;
        let changed = run(vehicle, changed)?;
        Ok(Self { unchanged: Some(Unchanged::Flying(Box::new(unchanged))), ..changed })
    }
}

/// Sets settings as the command line does.
fn set(vehicle: &mut Vehicle, settings: &[String]) -> Result<(), String> {
    for setting in settings {
        let line = format!("set {setting}");
        let reply = vehicle.apply(&VehicleCommand::single_line(&line)).line();
        if let Some(refused) = reply.filter(|reply| reply.failed) {
            let refused = RefusedLine { line, reply: refused.text.trim().to_owned() };
            return Err(VehicleRefusal::Upload(refused).sentence());
        }
    }
    Ok(())
}
