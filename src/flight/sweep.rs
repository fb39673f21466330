//! The same flight with a fault at every second of it.
//!
//! The flight is flown once. At each second since the engagement, a copy of it is taken, gets the fault, and flies on to
//! its end. So a sweep costs half of as many whole flights, and gives the same results as they do.
//!
//! ```text
//! Sweep ──┬──── 1 s ──┬──── 2 s ──┬── … the flight without the fault
//!         └▶ Branch   └▶ Branch   └▶ Branch::fly ──▶ SweepPoint: home, off or lost
//! ```

use nalgebra::Vector2;

use super::{Flight, FlightEnd, FlightOptions, FlightResult, craft_at_boot};
use crate::plan::{FlightPlan, WaypointType};
use crate::signals::SimTime;
use crate::sim::{FaultStart, ScheduledFault, WorldCommand};
use crate::vehicle::Vehicle;

/// The result of a flight with a fault, for the owner of the craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, strum::Display, strum::EnumIter)]
#[strum(serialize_all = "lowercase")]
pub enum Fate {
    /// The plan is flown to its end, or the craft lands at home or at its LAND.
    Home,
    /// The craft ends elsewhere, under control.
    Off,
    /// The craft crashes, or it neither lands nor ends its plan.
    Lost,
}

/// The flight with a fault at one second.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepPoint {
    /// The begin of the fault, s after the engagement.
    pub second: u32,
    /// The true place of the craft at that instant, ENU from home, m.
    pub place_enu: [f64; 3],
    /// The result for the owner of the craft.
    pub fate: Fate,
    /// The result of the judge.
    pub result: FlightResult,
    /// The reason as a sentence.
    pub reason: String,
    /// The horizontal distance of the craft's last place from home or its LAND, whichever is closer, m.
    pub off_m: f64,
    /// The simulated time from the fault to the end, s.
    pub after_s: f64,
}

/// A sweep in progress.
#[derive(Debug)]
pub struct Sweep {
    flight: Flight,
    fault: ScheduledFault,
    /// The next second.
    second: u32,
    end: Option<FlightEnd>,
}

/// A copy of the flight with its fault, ready to fly on.
#[derive(Debug)]
pub struct Branch {
    second: u32,
    place_enu: [f64; 3],
    flight: Flight,
}

impl Sweep {
    /// Returns the sweep of a flight that is at home. The start of `fault` does not matter.
    pub fn new(flight: Flight, fault: ScheduledFault) -> Self {
        Self { flight, fault, second: 0, end: None }
    }

    /// Returns the sweep of `plan` with its `settings` from boot, flown by the craft of `vehicle` in the present air by the
    /// scripted pilot, who first climbs to `takeoff_m`.
    ///
    /// # Errors
    /// Fails with the reason why nothing can be flown, as a sentence.
    pub fn from_plan(
        vehicle: &Vehicle,
        plan: &FlightPlan,
        settings: &[String],
        takeoff_m: f64,
        fault: ScheduledFault,
    ) -> Result<Self, String> {
        let vehicle = craft_at_boot(vehicle, plan, settings, |_| {})?;
        let options = FlightOptions { takeoff_m, ..FlightOptions::default() };
        let flight = Flight::new(vehicle, &options).map_err(|refusal| refusal.sentence())?;
        Ok(Self::new(flight, fault))
    }

    /// Flies to the next second and returns the branch of it; `None` when the flight is over, or when `is_stopped`.
    ///
    /// # Errors
    /// Fails with a sentence if the fault is not possible in this flight.
    pub fn next_branch(&mut self, is_stopped: &impl Fn() -> bool) -> Result<Option<Branch>, String> {
        if self.second == 0 {
            // The engagement is not known in advance, so the first branch is a whole flight.
            return self.branch().map(Some);
        }
        while !is_stopped() && self.end.is_none() {
            if self.is_due() {
                return self.branch().map(Some);
            }
            for _ in 0..TICKS_PER_LOOK {
                self.end = self.flight.tick(drop);
                if self.end.is_some() || self.is_due() {
                    break;
                }
            }
        }
        Ok(None)
    }

    /// Returns the end of the flight without the fault, once it is over.
    pub fn end(&self) -> Option<&FlightEnd> {
        self.end.as_ref()
    }

    /// Returns `true` before the tick in which the next second begins.
    fn is_due(&self) -> bool {
        let vehicle = self.flight.vehicle();
        vehicle.engaged_at().is_some_and(|engaged| {
            vehicle.time().0 + vehicle.step_us() >= engaged.0 + u64::from(self.second) * 1_000_000
        })
    }

    fn branch(&mut self) -> Result<Branch, String> {
        let second = self.second;
        self.second += 1;
        let mut flight = self.flight.clone();
        let fault = ScheduledFault { start: FaultStart::Engagement(f64::from(second)), ..self.fault };
        let scheduled = flight.vehicle_mut().apply(&WorldCommand::Schedule(fault).into()).accepted();
        scheduled.map_err(|refusal| refusal.sentence())?;
        Ok(Branch { second, place_enu: place(self.flight.vehicle()), flight })
    }
}

/// The ticks between two looks at the stop request.
const TICKS_PER_LOOK: u32 = 1000;

impl Branch {
    /// Flies to the end; `None` if it was stopped.
    pub fn fly(mut self, is_stopped: &impl Fn() -> bool) -> Option<SweepPoint> {
        let (home, land) = (Vector2::zeros(), land_of(self.flight.vehicle()));
        while !is_stopped() {
            for _ in 0..TICKS_PER_LOOK {
                let Some(end) = self.flight.tick(drop) else {
                    if self.second == 0 && self.flight.vehicle().engaged_at() == Some(self.now()) {
                        self.place_enu = place(self.flight.vehicle());
                    }
                    continue;
                };
                return Some(self.point(end, home, land));
            }
        }
        None
    }

    fn now(&self) -> SimTime {
        self.flight.vehicle().time()
    }

    fn point(self, end: FlightEnd, home: Vector2<f64>, land: Option<Vector2<f64>>) -> SweepPoint {
        let vehicle = self.flight.vehicle();
        let [east, north, _] = place(vehicle);
        let off_m = [Some(home), land]
            .into_iter()
            .flatten()
            .map(|wanted| (Vector2::new(east, north) - wanted).norm())
            .fold(f64::INFINITY, f64::min);
        let fate = fate(&end, vehicle, off_m <= self.flight.tolerance_m);
        let begun = vehicle.engaged_at().map_or(0.0, SimTime::as_secs_f64) + f64::from(self.second);
        SweepPoint {
            second: self.second,
            place_enu: self.place_enu,
            fate,
            result: end.verdict.result,
            reason: end.verdict.reason,
            off_m,
            after_s: (end.time.as_secs_f64() - begun).max(0.0),
        }
    }
}

fn fate(end: &FlightEnd, vehicle: &Vehicle, is_at_its_place: bool) -> Fate {
    let is_down = vehicle.truth().is_some_and(|truth| truth.on_ground && !truth.crashed && !truth.diverged);
    match end.verdict.result {
        FlightResult::Complete => Fate::Home,
        FlightResult::Crashed | FlightResult::Diverged => Fate::Lost,
        _ if is_down && is_at_its_place => Fate::Home,
        _ if is_down => Fate::Off,
        // The plan is over, and the craft is parked in the air.
        FlightResult::Missed => Fate::Off,
        _ => Fate::Lost,
    }
}

/// Returns the place of the craft, ENU from home, m.
fn place(vehicle: &Vehicle) -> [f64; 3] {
    vehicle.truth().map_or([0.0; 3], |truth| truth.pos_enu.into())
}

/// Returns the place of the LAND of the plan, east and north of home, m.
fn land_of(vehicle: &Vehicle) -> Option<Vector2<f64>> {
    let frame = vehicle.local_frame()?;
    let plan: &FlightPlan = vehicle.controller().stored_plan()?;
    let land = plan.waypoints.iter().find(|waypoint| waypoint.kind == WaypointType::Land)?.position;
    Some(frame.to_enu(land.lat_deg(), land.lon_deg(), frame.alt_amsl_m).xy())
}
