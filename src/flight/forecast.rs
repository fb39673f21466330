//! Flights flown in advance on a copy of the vehicle: time, distance from the line, and end.
//!
//! A forecast uses no thread and no clock. Its owner advances it tick by tick and drops it when it is no longer
//! needed. Its result depends on the vehicle alone, so the same vehicle gives the same forecast.

mod endless;
mod observer;
mod path;
mod plan_distance;
mod report;
mod setting_change;
mod what_if;

pub use super::FlightResult;
pub use observer::{LegTime, WorstXte};
pub use path::PathPoint;
pub use report::{Forecast, ForecastEnd, ForecastKind};
pub use setting_change::PlanWithSettings;
pub use what_if::{WHAT_IFS, WhatIf};

use super::setup::SetupNotice;
use super::{Flight, FlightEnd, FlightOptions, Verdict};
use crate::firmware::Firmware;
use crate::plan::FlightPlan;
use crate::signals::{RC_CHANNELS, SimTime};
use crate::sim::WorldCommand;
use crate::telemetry::{AbortReason, Refusal};
use crate::vehicle::{Vehicle, VehicleCommand};
use endless::EndlessWatch;
use observer::Observer;
use report::Ended;
use setting_change::Unchanged;

/// The altitude from which a craft without ground contact counts as in the air, m. A bounce stays below it.
const IN_THE_AIR_M: f64 = 1.0;
/// The reason why an empty plan is not flown.
pub(super) const NO_WAYPOINTS: &str = "No waypoints, so there is nothing to fly.";
/// The longest flight that a forecast follows, simulated s.
pub const LIMIT_S: f64 = 1800.0;

/// A forecast in progress.
#[derive(Debug)]
pub struct ForecastRun {
    kind: ForecastKind,
    flight: Flight,
    started: SimTime,
    limit: SimTime,
    endless: EndlessWatch,
    observer: Observer,
    /// The same flight without the changed settings. It is flown first.
    unchanged: Option<Unchanged>,
    /// The change of the world that begins at the engagement.
    at_engagement: Option<WorldCommand>,
}

impl ForecastRun {
    /// Forecasts a flight of `plan` with its `settings` from home by the scripted pilot, who first climbs to
    /// `takeoff_m`: in the present air, with the present craft, undamaged and without faults.
    ///
    /// # Errors
    /// Fails with the reason why nothing can be flown, as a sentence.
    pub fn plan_estimate(
        mut vehicle: Vehicle,
        plan: &FlightPlan,
        settings: &[String],
        takeoff_m: f64,
    ) -> Result<Self, String> {
        if plan.waypoints.is_empty() {
            return Err(NO_WAYPOINTS.to_owned());
        }
        if vehicle.embedded().is_none() {
            return Err(CONTROLLER_IS_REMOTE.to_owned());
        }
        let channels = (0..RC_CHANNELS as u8).map(VehicleCommand::ReleaseChannel);
        let before = [
            VehicleCommand::upload(plan.clone(), settings.to_vec()),
            WorldCommand::ClearFaults.into(),
            VehicleCommand::CutRc(false),
            VehicleCommand::ResetCraft,
            VehicleCommand::StartPilot(takeoff_m),
        ];
        for command in channels.chain(before) {
            apply(&mut vehicle, &command)?;
        }
        Self::begin(ForecastKind::PlanEstimate, vehicle, takeoff_m)
    }

    /// Forecasts the present flight of `vehicle`: the sticks stay as they are, the scripted pilot continues.
    ///
    /// # Errors
    /// Fails with the reason why no forecast is possible, as a sentence.
    pub fn look_ahead(vehicle: Vehicle) -> Result<Self, String> {
        check_flies(&vehicle)?;
        Self::begin(ForecastKind::LookAhead, vehicle, FlightOptions::default().takeoff_m)
    }

    /// Does the same as [`Self::look_ahead`], with a failure at this instant. If the craft does not fly, it forecasts a
    /// flight of the plan from home like [`Self::plan_estimate`]: in another wind, or with a failure at the engagement.
    ///
    /// # Errors
    /// Fails with the reason why no forecast is possible, as a sentence.
    pub fn what_if(
        mut vehicle: Vehicle,
        what_if: &WhatIf,
        PlanWithSettings { plan, settings }: PlanWithSettings<'_>,
        takeoff_m: f64,
    ) -> Result<Self, String> {
        check_world(&vehicle)?;
        let wind = vehicle.world_status().map(|world| world.wind).unwrap_or_default();
        let command = what_if.command(wind)?;
        let flies = check_flies(&vehicle);
        let flies = if vehicle.embedded().is_some() {
            flies.is_ok()
        } else {
            // A remote flight controller does not fly the plan from home here.
            flies?;
            check_reaches_remote(&vehicle, &command)?;
            true
        };
        let begins_now = flies || matches!(command, WorldCommand::SetWind(_));
        if begins_now {
            apply(&mut vehicle, &command.clone().into())?;
        }
        if flies {
            return Self::begin(ForecastKind::WhatIf, vehicle, FlightOptions::default().takeoff_m);
        }
        let at_engagement = (!begins_now).then_some(command);
        Ok(Self { at_engagement, ..Self::plan_estimate(vehicle, plan, settings, takeoff_m)? })
    }

    fn begin(kind: ForecastKind, mut vehicle: Vehicle, takeoff_m: f64) -> Result<Self, String> {
        vehicle.drain_events(drop);
        vehicle.keep_inputs(false);
        let plan = vehicle.embedded().and_then(Firmware::active_plan).or(vehicle.controller().stored_plan());
        let observer = Observer::new(&vehicle, plan).ok_or(PHYSICS_IS_EXTERNAL)?;
        let started = vehicle.time();
        // This forecast ends a flight that takes too long, by its own clock.
        let timeout = SimTime(u64::MAX);
        let options = FlightOptions { takeoff_m, timeout, ..FlightOptions::default() };
        Ok(Self {
            kind,
            flight: Flight::go_on(vehicle, &options),
            started,
            limit: SimTime(started.0 + SimTime::from_secs_f64(LIMIT_S).0),
            endless: EndlessWatch::default(),
            observer,
            unchanged: None,
            at_engagement: None,
        })
    }

    /// Returns the vehicle that flies ahead.
    pub fn vehicle(&self) -> &Vehicle {
        self.flight.vehicle()
    }

    /// Returns the vehicle that flies ahead. The steps of a remote flight controller are the caller's.
    pub fn vehicle_mut(&mut self) -> &mut Vehicle {
        self.flight.vehicle_mut()
    }

    /// Advances the flight by at most `ticks`. Returns the forecast when the flight is over.
    pub fn advance(&mut self, ticks: u32) -> Option<Forecast> {
        if let Some(unchanged) = self.unchanged.as_mut().filter(|unchanged| unchanged.is_flying()) {
            unchanged.advance(ticks);
            return None;
        }
        let forecast = (0..ticks).find_map(|_| self.tick())?;
        let unchanged = self.unchanged.take().and_then(Unchanged::flown);
        Some(Forecast { unchanged, ..forecast })
    }

    fn tick(&mut self) -> Option<Forecast> {
        let mut happened = false;
        let end = self.flight.tick(|_| happened = true);
        if self.flight.engaged_at().is_some()
            && let Some(command) = self.at_engagement.take()
        {
            // It was read already. A world that has no such fault flies on without it.
            let _done = self.flight.vehicle_mut().apply(&command.into());
        }
        let vehicle = self.flight.vehicle();
        self.observer.look(vehicle);
        let (end, reason) = match end {
            Some(end) => self.flight_end(end),
            None => self.endless.look(vehicle, happened).or_else(|| self.too_long())?,
        };
        let engaged_at = self.flight.engaged_at().filter(|_| self.kind == ForecastKind::PlanEstimate);
        let vehicle = self.flight.vehicle();
        let time_s = vehicle.time().seconds_since(engaged_at.unwrap_or(self.started));
        let ended = Ended { kind: self.kind, end, reason, time_s };
        Some(self.observer.forecast(&ended, vehicle))
    }

    fn flight_end(&self, end: FlightEnd) -> (ForecastEnd, String) {
        let Verdict { result, reason } = end.verdict;
        if result != FlightResult::Aborted {
            return (ForecastEnd::Flight(result), reason);
        }
        let why = match self.flight.vehicle().controller().nav().and_then(|nav| nav.refusal) {
            // Nothing went wrong: the pilot switched the autopilot off.
            None => return (ForecastEnd::Endless, endless::LEFT_TO_STICKS.to_owned()),
            Some(Refusal::Aborted(AbortReason::GpsLost)) => "the GPS fix is lost",
            Some(Refusal::Aborted(AbortReason::Stalled)) => "no progress",
            Some(Refusal::Aborted(AbortReason::Flyaway)) => "blown away from its waypoint",
            Some(Refusal::Aborted(AbortReason::MagFault)) => "the course does not fit the heading",
            Some(_) => return (ForecastEnd::Flight(result), reason),
        };
        (ForecastEnd::Flight(result), format!("mission given up, {why}"))
    }

    fn too_long(&self) -> Option<(ForecastEnd, String)> {
        let vehicle = self.flight.vehicle();
        (vehicle.time() >= self.limit).then(|| {
            let doing = match vehicle.controller().nav() {
                Some(nav) if nav.engaged => format!("still {} at waypoint {}", nav.state, nav.wp),
                _ => "still not flown by the autopilot".to_owned(),
            };
            (ForecastEnd::TooLong, format!("not over within {:.0} minutes: {doing}", LIMIT_S / 60.0))
        })
    }
}

/// The reason why there are no estimates of a plan with a remote flight controller.
pub const SETTINGS_UNKNOWN: &str =
    "There is no estimate yet: the remote craft has not reported its autopilot settings and its position.";

/// The reason why there are no forecasts with a remote flight controller.
pub const CONTROLLER_IS_REMOTE: &str =
    "The flight controller is another program, which cannot be copied: there is no forecast of its flight.";

/// The reason why there are no forecasts with an external simulator.
pub const PHYSICS_IS_EXTERNAL: &str =
    "The simulator moves the craft and cannot be copied: there is no forecast of its flight.";

/// Checks that forecasts of this vehicle's flights are possible.
///
/// # Errors
/// Fails with the reason, as a sentence.
pub fn check_possible(vehicle: &Vehicle) -> Result<(), String> {
    if vehicle.embedded().is_none() {
        return Err(CONTROLLER_IS_REMOTE.to_owned());
    }
    check_world(vehicle)
}

fn check_world(vehicle: &Vehicle) -> Result<(), String> {
    if vehicle.truth().is_none() {
        return Err(PHYSICS_IS_EXTERNAL.to_owned());
    }
    Ok(())
}

/// Checks that a remote flight controller can notice a change of the world.
fn check_reaches_remote(vehicle: &Vehicle, command: &WorldCommand) -> Result<(), String> {
    let switches = vehicle.world_status().map(|world| world.switches).unwrap_or_default();
    match command.fault().filter(|fault| !fault.acts_on_remote_controller(&switches)) {
        Some(fault) => Err(SetupNotice::IdleFault(fault.kind()).to_string()),
        None => Ok(()),
    }
}

fn check_flies(vehicle: &Vehicle) -> Result<(), String> {
    check_world(vehicle)?;
    if vehicle.crashed() {
        return Err("The craft crashed, so its flight is over: `R` puts it back home.".to_owned());
    }
    if !vehicle.controller().is_armed() && vehicle.transmitter().pilot_doing().is_none() {
        let falls =
            vehicle.snapshot().truth.is_some_and(|truth| !truth.on_ground && truth.alt > IN_THE_AIR_M);
        let (does, way_out) =
            if falls { ("falls", "`R` puts it back home") } else { ("stands", "`F` flies the plan") };
        return Err(format!("The craft {does} disarmed, so there is no flight to look ahead to: {way_out}."));
    }
    Ok(())
}

fn apply(vehicle: &mut Vehicle, command: &VehicleCommand) -> Result<(), String> {
    vehicle.apply(command).accepted().map_err(|refusal| refusal.sentence())
}
