//! The clearance of a plan above the ground of elevation tiles: of its legs, of the way home from each waypoint, and
//! of a flight that was flown ahead of time.

use std::fmt;

use super::{Finding, ends_the_mission};
use crate::geo::{LatLon, local_offset, offset_to_latlon};
use crate::math;
use crate::plan::estimate::{Assumptions, ReturnMode};
use crate::plan::setpoint::AltitudeSetpoint;
use crate::plan::{Approach, FlightPlan, Modifier, Then, Waypoint};
use crate::terrain::Relief;

mod flown;

pub use flown::{FlownPlace, low_in_flight};

/// The default clearance, m. It is at least the error of elevation tiles, 5 to 10 m for nine places of ten.
pub const CLEARANCE_M: f64 = 15.0;
/// The spacing of the tiles where no tile says it, m.
const USUAL_STEP_M: f64 = 30.0;
/// The most looks at the ground under one line.
const MAX_LOOKS: f64 = 4096.0;
/// A shortage below this is rounding, m.
const SHORT_M: f64 = 0.1;
/// A craft this far from the altitude of its leg climbs or descends, m.
const LEVEL_M: f64 = 0.5;

/// The line with the low clearance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// The leg to the waypoint, as planned.
    Leg,
    /// The leg to the waypoint, as flown ahead of time.
    Flown,
    /// The way home from the waypoint.
    Return,
}

/// The edit that raises a line to its clearance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Raise {
    /// The altitude above home, m.
    pub to_m: f64,
    /// The waypoint that gives the altitude of the leg; `None` if a setting gives it.
    pub waypoint: Option<usize>,
    /// The other change of the plan that lets the craft climb in time.
    pub before: Before,
}

/// A change before the leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Before {
    /// No other change is needed.
    Nothing,
    /// The waypoint before is raised, too.
    Waypoint(usize),
    /// The craft climbs at home first.
    Takeoff,
}

/// A line that comes too close to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LowClearance {
    /// The waypoint to which the leg leads, or at which the way home begins.
    pub index: usize,
    /// The line that is too low.
    pub way: Way,
    /// The place of the lowest clearance.
    pub place: LatLon,
    /// Its distance from the beginning of the line, m.
    pub along_m: f64,
    /// The lowest clearance, m; negative in the ground.
    pub clearance_m: f64,
    /// The clearance that was asked for, m.
    pub margin_m: f64,
    /// The change of the plan that raises it.
    pub raise: Raise,
}

impl fmt::Display for LowClearance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { index, way, place, along_m, clearance_m, margin_m, .. } = self;
        match way {
            Way::Leg => write!(f, "the leg to waypoint {index} ")?,
            Way::Flown => write!(f, "the leg to waypoint {index}, as flown in the estimate, ")?,
            Way::Return => write!(f, "the way home from waypoint {index} ")?,
        }
        if *clearance_m < 0.0 {
            write!(f, "goes {:.0} m into the ground", -clearance_m)?;
        } else {
            write!(f, "is {clearance_m:.0} m above the ground")?;
        }
        write!(f, " {along_m:.0} m along it, at {place}; the clearance (--clearance) is {margin_m:.0} m")
    }
}

/// The clearance of a plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clearances {
    /// One finding for each leg and each way home that is too low.
    pub findings: Vec<Finding>,
    /// The lowest clearance of the legs, m, the waypoint to which the leg leads, and the distance along it, m.
    pub lowest: Option<(f64, usize, f64)>,
    /// The waypoints to which legs over unknown ground lead.
    pub unknown: Vec<usize>,
}

/// Returns the clearance of the legs of a flight from the home of `relief`, and of the way home from each waypoint.
pub fn clearances(
    plan: &FlightPlan,
    assumptions: &Assumptions,
    relief: &Relief,
    margin_m: f64,
) -> Clearances {
    let mut walk = Walk {
        assumptions,
        relief,
        margin_m,
        place: relief.home(),
        setpoint: AltitudeSetpoint::at(assumptions.start_alt_m),
        highest_m: assumptions.start_alt_m,
        is_first: true,
        alt_change: None,
        delay_s: None,
        said_before: None,
        found: Clearances::default(),
    };
    for (index, waypoint) in plan.waypoints.iter().enumerate() {
        walk.take(index, waypoint);
        if ends_the_mission(waypoint) {
            break;
        }
    }
    walk.found
}

/// The craft after some waypoints.
struct Walk<'a> {
    assumptions: &'a Assumptions,
    relief: &'a Relief,
    margin_m: f64,
    place: LatLon,
    setpoint: AltitudeSetpoint,
    highest_m: f64,
    /// `true` before the first leg.
    is_first: bool,
    alt_change: Option<(usize, f64)>,
    delay_s: Option<f64>,
    /// The waypoint that gave the altitude of the last leg.
    said_before: Option<usize>,
    found: Clearances,
}

/// The looks at the ground under a line.
struct Looks {
    from: LatLon,
    to: LatLon,
    length_m: f64,
    count: u32,
}

/// The lowest clearance of a line.
#[derive(Clone, Copy)]
struct Lowest {
    place: LatLon,
    along_m: f64,
    clearance_m: f64,
    /// The altitude of the craft there, m above home.
    alt_m: f64,
}

impl Looks {
    fn new(from: LatLon, to: LatLon, relief: &Relief) -> Self {
        let length_m = local_offset(from, to).norm();
        let step = |place| relief.tiles().step_m(place).unwrap_or(USUAL_STEP_M);
        let third_m = step(from).min(step(to)).max(1.0) / 3.0;
        Self { from, to, length_m, count: (length_m / third_m).ceil().clamp(1.0, MAX_LOOKS) as u32 }
    }

    /// Returns a look's place and its distance from the beginning, m.
    fn at(&self, look: u32) -> (LatLon, f64) {
        if look == self.count {
            return (self.to, self.length_m);
        }
        let share = f64::from(look) / f64::from(self.count);
        (offset_to_latlon(self.from, local_offset(self.from, self.to) * share), self.length_m * share)
    }
}

/// Returns the lower one of a known clearance and another.
fn lower(known: Option<Lowest>, other: Lowest) -> Option<Lowest> {
    Some(known.filter(|known| known.clearance_m <= other.clearance_m).unwrap_or(other))
}

impl Walk<'_> {
    fn take(&mut self, index: usize, waypoint: &Waypoint) {
        let own = (index, waypoint.altitude.above_home_m());
        match waypoint.kind.capability().approach {
            Approach::Modify(Modifier::Altitude) => self.alt_change = Some(own),
            Approach::Modify(Modifier::Delay) => self.delay_s = Some(waypoint.duration.get()),
            Approach::Modify(Modifier::YawRate) => {}
            Approach::Climb => {
                let (said_by, alt_m) = self.alt_change.take().unwrap_or(own);
                let limits = self.assumptions.setpoint_limits();
                self.setpoint.reach(alt_m, &limits, self.assumptions.hold_radius_m);
                self.setpoint.run(alt_m, &limits, waypoint.duration.get());
                self.delay_s = None;
                self.is_first = false;
                self.said_before = Some(said_by);
                self.highest_m = self.highest_m.max(self.setpoint.altitude_m);
            }
            Approach::Pass | Approach::Turn | Approach::Stop | Approach::Level => {
                let (said_by, alt_m) = self.alt_change.take().unwrap_or(own);
                self.fly(index, waypoint, said_by, alt_m);
            }
        }
    }

    fn fly(&mut self, index: usize, waypoint: &Waypoint, said_by: usize, alt_m: f64) {
        let limits = self.assumptions.setpoint_limits();
        let to = if waypoint.kind.uses_position() { waypoint.position } else { self.place };
        let looks = Looks::new(self.place, to, self.relief);
        let enough_m = self.assumptions.min_nav_alt_m;
        if self.is_first && self.setpoint.altitude_m < enough_m {
            let target_m = alt_m.max(enough_m + 1.0);
            self.setpoint.reach(target_m, &limits, target_m - enough_m);
        }
        let mut speed_mps = self.assumptions.leg_speed_mps(waypoint);
        if let Some(delay_s) = self.delay_s.take().filter(|&delay_s| delay_s > 0.0) {
            let length_m = math::hypot(looks.length_m, alt_m - self.setpoint.altitude_m);
            speed_mps = speed_mps.min(self.assumptions.delayed_mps(length_m, delay_s));
        }
        let step_s = looks.length_m / f64::from(looks.count) / speed_mps;
        let (mut lowest, mut low, mut needed_m, mut is_known) = (None, None, f64::NEG_INFINITY, true);
        let mut look_down = |place: LatLon, along_m: f64, alt_m: f64, margin_m: f64| {
            let Some(ground_m) = self.relief.above_home_m(place) else {
                is_known = false;
                return;
            };
            let here = Lowest { place, along_m, clearance_m: alt_m - ground_m, alt_m };
            lowest = lower(lowest, here);
            needed_m = needed_m.max(ground_m + margin_m);
            if here.clearance_m < margin_m - SHORT_M {
                low = lower(low, here);
            }
        };
        for look in 0..=looks.count {
            let (place, along_m) = looks.at(look);
            if look > 0 {
                self.setpoint.run(alt_m, &limits, step_s);
            }
            let climbs_from_home = self.is_first && self.setpoint.altitude_m < alt_m - LEVEL_M;
            let start_m = self.assumptions.start_alt_m.max(0.0);
            let margin_m = if climbs_from_home { self.margin_m.min(start_m) } else { self.margin_m };
            look_down(place, along_m, self.setpoint.altitude_m, margin_m);
        }
        if waypoint.kind.capability().then == Then::Hold {
            self.assumptions.wait_for_hold(&mut self.setpoint, alt_m);
            self.setpoint.run(alt_m, &limits, waypoint.duration.get());
            if waypoint.duration.is_zero() {
                self.setpoint = AltitudeSetpoint::at(alt_m);
            }
            look_down(to, looks.length_m, self.setpoint.altitude_m, self.margin_m);
        } else if waypoint.kind.capability().then == Then::Loiter {
            self.setpoint.run(alt_m, &limits, waypoint.duration.get());
        }
        if let Some(low) = low {
            let climbs = low.alt_m < alt_m - LEVEL_M;
            let before = match self.said_before {
                _ if !climbs => Before::Nothing,
                Some(before) => Before::Waypoint(before),
                None => Before::Takeoff,
            };
            let raise = Raise { to_m: needed_m.ceil(), waypoint: Some(said_by), before };
            self.report(index, Way::Leg, &low, raise);
        }
        let lowest = lowest.map(|lowest| (lowest.clearance_m, index, lowest.along_m));
        self.found.lowest = match (self.found.lowest, lowest) {
            (Some(known), Some(other)) if other.0 < known.0 => Some(other),
            (known, other) => known.or(other),
        };
        if !is_known {
            self.found.unknown.push(index);
        }
        self.is_first = false;
        self.said_before = Some(said_by);
        self.place = to;
        self.highest_m = self.highest_m.max(self.setpoint.altitude_m);
        if waypoint.kind.capability().then != Then::Land {
            self.way_home(index, said_by);
        }
    }

    fn way_home(&mut self, index: usize, said_by: usize) {
        let rescue = self.assumptions.return_flight;
        let alt_m = rescue.altitude_m(self.highest_m, self.setpoint.altitude_m);
        let looks = Looks::new(self.place, self.relief.home(), self.relief);
        let (mut lowest, mut ground_m) = (None, f64::NEG_INFINITY);
        for look in 0..=looks.count {
            let (place, along_m) = looks.at(look);
            let Some(here_m) = self.relief.above_home_m(place) else { continue };
            lowest = lower(lowest, Lowest { place, along_m, clearance_m: alt_m - here_m, alt_m });
            ground_m = ground_m.max(here_m);
        }
        let Some(lowest) = lowest.filter(|lowest| lowest.clearance_m < self.margin_m - SHORT_M) else {
            return;
        };
        let needed_m = (ground_m + self.margin_m).ceil();
        let raise = match rescue.mode {
            ReturnMode::Fixed => Raise { to_m: needed_m, waypoint: None, before: Before::Nothing },
            ReturnMode::Highest | ReturnMode::Present => {
                let to_m = (needed_m - rescue.climb_m).ceil();
                Raise { to_m, waypoint: Some(said_by), before: Before::Nothing }
            }
        };
        self.report(index, Way::Return, &lowest, raise);
    }

    fn report(&mut self, index: usize, way: Way, low: &Lowest, raise: Raise) {
        let Lowest { place, along_m, clearance_m, .. } = *low;
        let margin_m = self.margin_m;
        let finding = LowClearance { index, way, place, along_m, clearance_m, margin_m, raise };
        self.found.findings.push(Finding::LowClearance(finding));
    }
}

#[cfg(test)]
mod tests;
