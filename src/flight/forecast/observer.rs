//! The observations of a forecast's flight on the way.

use super::path::{Path, PathPoint};
use super::plan_distance::PlanDistance;
use super::report::{Ended, Forecast};
use crate::plan::{FlightPlan, MAX_WAYPOINTS};
use crate::signals::SimTime;
use crate::telemetry::{L1Mode, NavTelemetry, PlanSource};
use crate::vehicle::Vehicle;

/// The distance from a new leg at which it counts as joined, m.
const JOINED_M: f64 = 1.0;
/// The interval of observations, µs: that of the navigator's updates.
const INTERVAL_US: u64 = 10_000;

/// The largest cross-track error. A leg counts from the point where it was joined, since a corner is not flown along
/// a line. A leg that was never joined counts with its smallest error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstXte {
    /// Distance from the leg, m.
    pub xte_m: f64,
    /// Waypoint at the end of the leg.
    pub wp: u8,
}

/// The time that a waypoint took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegTime {
    /// Index of the waypoint in the plan.
    pub wp: u8,
    /// From the start of its leg to the start of the next, s.
    pub time_s: f64,
    /// Charge drawn when the craft is done with it since the battery was full, %.
    pub battery_used_pct: f64,
}

/// The state of a leg in flight.
#[derive(Debug, Clone, Copy, Default)]
struct OnLeg {
    /// Waypoint at the end of the leg.
    wp: u8,
    /// `true` once the craft has come near the line.
    joined: bool,
    /// Smallest cross-track error so far, m; `None` before the first leg.
    least_m: Option<f64>,
}

/// The observations so far.
#[derive(Debug, Clone)]
pub(super) struct Observer {
    seen_at: SimTime,
    path: Path,
    distance: PlanDistance,
    on_leg: OnLeg,
    worst_xte: Option<WorstXte>,
    fence_margin_m: Option<f64>,
    legs: Vec<LegTime>,
}

impl Observer {
    /// Returns the observer of a vehicle that is about to fly `plan`, or `None` if an external simulator moves the craft.
    pub(super) fn new(vehicle: &Vehicle, plan: Option<&FlightPlan>) -> Option<Self> {
        let unknown = FlightPlan::default();
        let mut distance = PlanDistance::new(plan.unwrap_or(&unknown), vehicle.local_frame()?);
        let along_m = vehicle.controller().nav().map_or(0.0, |nav| distance.follow(nav));
        Some(Self {
            seen_at: vehicle.time(),
            path: Path::new(place(vehicle, along_m)?),
            distance,
            on_leg: OnLeg::default(),
            worst_xte: None,
            fence_margin_m: None,
            legs: Vec::with_capacity(MAX_WAYPOINTS),
        })
    }

    /// Observes the vehicle after a tick.
    pub(super) fn look(&mut self, vehicle: &Vehicle) {
        let now = vehicle.time();
        if now.0 / INTERVAL_US == self.seen_at.0 / INTERVAL_US {
            return;
        }
        let passed_s = now.seconds_since(std::mem::replace(&mut self.seen_at, now));
        let Some(nav) = vehicle.controller().nav() else { return };
        let along_m = self.distance.follow(nav);
        if let Some(point) = place(vehicle, along_m) {
            self.path.push(point);
        }
        if nav.engaged && nav.source == PlanSource::Stored {
            self.note_leg(nav, passed_s, battery_used_pct(vehicle));
        }
    }

    fn note_leg(&mut self, nav: &NavTelemetry, passed_s: f64, battery_used_pct: f64) {
        if let Some(leg) = self.legs.last_mut().filter(|leg| leg.wp == nav.wp) {
            leg.time_s += passed_s;
            leg.battery_used_pct = battery_used_pct;
        } else if self.legs.len() < MAX_WAYPOINTS {
            // A craft that was sent back flies a waypoint again. The list stays as long as a plan can be.
            self.legs.push(LegTime { wp: nav.wp, time_s: passed_s, battery_used_pct });
        }
        // Only when the craft follows a line. On a direct flight to a point there is no cross-track error.
        if let Some(xte_m) = nav.xte_m.filter(|_| nav.l1_mode == Some(L1Mode::Track)).map(f64::abs) {
            self.note_xte(xte_m, nav.wp);
        }
        if let Some(margin_m) = nav.fence_margin_m {
            self.fence_margin_m = Some(self.fence_margin_m.map_or(margin_m, |least| least.min(margin_m)));
        }
    }

    fn note_xte(&mut self, xte_m: f64, wp: u8) {
        if self.on_leg.wp != wp {
            self.end_leg();
            self.on_leg = OnLeg { wp, ..OnLeg::default() };
        }
        let leg = &mut self.on_leg;
        leg.joined |= xte_m <= JOINED_M;
        leg.least_m = Some(leg.least_m.map_or(xte_m, |least_m| least_m.min(xte_m)));
        if leg.joined {
            self.keep_worst(xte_m, wp);
        }
    }

    fn end_leg(&mut self) {
        if let OnLeg { wp, joined: false, least_m: Some(least_m) } = self.on_leg {
            self.keep_worst(least_m, wp);
        }
    }

    fn keep_worst(&mut self, xte_m: f64, wp: u8) {
        if self.worst_xte.is_none_or(|worst| xte_m > worst.xte_m) {
            self.worst_xte = Some(WorstXte { xte_m, wp });
        }
    }

    /// Returns the forecast of the flight that ended like this, here and now.
    pub(super) fn forecast(&mut self, ended: &Ended, vehicle: &Vehicle) -> Forecast {
        self.end_leg();
        let along_m = vehicle.controller().nav().map_or(0.0, |nav| self.distance.follow(nav));
        if let Some(point) = place(vehicle, along_m) {
            self.path.push(point);
        }
        Forecast {
            kind: ended.kind,
            end: ended.end,
            reason: ended.reason.trim_end_matches('.').to_owned(),
            time_s: ended.time_s,
            battery_used_pct: battery_used_pct(vehicle),
            worst_xte: self.worst_xte,
            fence_margin_m: self.fence_margin_m,
            legs: self.legs.clone(),
            moved_m: self.path.moved_m(),
            path: self.path.points(),
            unchanged: None,
        }
    }
}

/// Returns the charge drawn since the battery was full, %.
fn battery_used_pct(vehicle: &Vehicle) -> f64 {
    let battery = vehicle.truth().map(|truth| truth.battery).unwrap_or_default();
    let used_pct = 100.0 * battery.drawn_mah / battery.capacity_mah;
    if used_pct.is_finite() { used_pct.clamp(0.0, 100.0) } else { 0.0 }
}

/// Returns the true place of the craft.
fn place(vehicle: &Vehicle, along_m: f64) -> Option<PathPoint> {
    let truth = vehicle.truth()?;
    let (e, n, alt) = (truth.pos_enu.x, truth.pos_enu.y, truth.pos_enu.z);
    Some(PathPoint { n, e, alt, along_m, time_s: vehicle.time().as_secs_f64() })
}
