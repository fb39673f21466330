//! A headless flight: a vehicle, the scripted pilot and a judge.
//!
//! Boot, wait for the fix, arm, climb, engage, fly to the end. As the core it is: no clock, no files. The caller gets
//! events and samples and decides what to do with them.

mod judge;
pub mod setup;

pub use judge::{FlightResult, Judge, JudgeFacts, Verdict};
pub use setup::FlightSetup;

pub use crate::pilot::StickInput;
use crate::plan::{FlightPlan, WaypointType};
use crate::signals::SimTime;
use crate::telemetry::{Event, EventKind, Mode, NavTelemetry, PlanSource};
use crate::vehicle::Vehicle;

/// How a flight is flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightOptions {
    /// Altitude of the pilot's climb before engaging, m; 0 = engage on the ground.
    pub takeoff_m: f64,
    /// When to give up, counted from boot.
    pub timeout: SimTime,
    /// Samples a simulated second; 0 = none.
    pub samples_hz: f64,
}

/// A flight under way.
#[derive(Debug)]
pub struct Flight {
    vehicle: Vehicle,
    judge: Judge,
    sample_every_us: Option<u64>,
    touched_down: bool,
    ends_in_land: bool,
}

/// What a flight reports.
#[derive(Debug)]
pub enum Report<'a> {
    /// Something happened.
    Event(Event),
    /// Time for a sample.
    Sample(&'a Vehicle),
}

/// The end of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightEnd {
    /// What became of it.
    pub verdict: Verdict,
    /// Simulated seconds from the engagement (or boot, if there was none) to the end.
    pub flown_s: f64,
    /// When it ended.
    pub time: SimTime,
}

impl Flight {
    /// A flight of the plan that `vehicle` has stored.
    ///
    /// # Errors
    /// The mode that no channel switches.
    pub fn new(mut vehicle: Vehicle, options: &FlightOptions) -> Result<Self, Mode> {
        vehicle.start_pilot(options.takeoff_m)?;
        let ends_in_land = vehicle.controller().stored_plan().is_some_and(ends_in_land);
        let sample_every_us =
            (options.samples_hz > 0.0).then(|| ((1e6 / options.samples_hz).round() as u64).max(1));
        Ok(Self {
            vehicle,
            judge: Judge::new(options.timeout),
            sample_every_us,
            touched_down: false,
            ends_in_land,
        })
    }

    /// The vehicle.
    #[must_use]
    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// When the autopilot engaged for the first time.
    #[must_use]
    pub fn engaged_at(&self) -> Option<SimTime> {
        self.judge.engaged_at()
    }

    /// Flies one tick; a value ends the flight.
    pub fn tick(&mut self, mut report: impl FnMut(Report)) -> Option<FlightEnd> {
        self.vehicle.tick();
        let touched_down = &mut self.touched_down;
        self.vehicle.drain_events(|event| {
            match event.kind {
                EventKind::Touchdown { .. } => *touched_down = true,
                EventKind::Firmware(crate::telemetry::FirmwareEvent::Armed) => *touched_down = false,
                EventKind::Boot { .. }
                | EventKind::Firmware(_)
                | EventKind::Fault { .. }
                | EventKind::Contact { .. }
                | EventKind::Crash { .. }
                | EventKind::Notice(_) => {}
            }
            report(Report::Event(event));
        });
        let now = self.vehicle.time();
        if let Some(every) = self.sample_every_us
            && now.0 / every != (now.0 - self.vehicle.step_us()) / every
        {
            report(Report::Sample(&self.vehicle));
        }
        let verdict = self.judge.look(&self.facts())?;
        let from = self.judge.engaged_at().unwrap_or_default();
        Some(FlightEnd { verdict, flown_s: now.seconds_since(from), time: now })
    }

    fn facts(&self) -> JudgeFacts {
        let controller = self.vehicle.controller();
        let unknown = NavTelemetry::default();
        let nav = controller.nav().unwrap_or(&unknown);
        JudgeFacts {
            time: self.vehicle.time(),
            engaged: controller.modes().has(Mode::Autopilot)
                || nav.source != PlanSource::Stored && nav.engaged,
            armed: controller.is_armed(),
            last_disarm: controller.last_disarm(),
            state: nav.state,
            wp: nav.wp,
            source: nav.source,
            refusal: nav.refusal,
            ends_in_land: self.ends_in_land,
            touched_down: self.touched_down,
            crashed: self.vehicle.crashed(),
            diverged: self.vehicle.diverged(),
        }
    }
}

/// Whether the last positional waypoint that is flown is a LAND (nothing behind a LAND is flown).
fn ends_in_land(plan: &FlightPlan) -> bool {
    plan.waypoints.iter().any(|waypoint| waypoint.kind == WaypointType::Land)
}
