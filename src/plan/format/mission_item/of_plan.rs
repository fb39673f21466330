//! Waypoints → items: one function for each kind of waypoint.

use super::{
    ABOVE_HOME, CHANGE_SPEED, LAND, LOITER_TIME, LOITER_TURNS, LOITER_UNLIMITED, MissionItem, NO_PLACE,
    TAKEOFF, WAYPOINT, YAW_SPEED, amount, metres, written_position,
};
use crate::geo::{LatLon, distance_bearing};
use crate::math;
use crate::plan::estimate::Assumptions;
use crate::plan::format::bounds;
use crate::plan::format::loss::{Finding, Severity};
use crate::plan::{Altitude, HoldPattern, LegSpeed, Seconds, TimeUse, Waypoint, WaypointType};

/// The items of a plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::plan::format) struct Sent {
    pub(in crate::plan::format) items: Vec<MissionItem>,
    /// The number of the waypoint of each item.
    pub(in crate::plan::format) sources: Vec<usize>,
    pub(in crate::plan::format) findings: Vec<Finding>,
}

/// Returns the items of a plan, numbered from 1. `private` says that the file also has the waypoints themselves, so that
/// values without an effect on the flight are not lost.
pub(in crate::plan::format) fn send(
    waypoints: &[Waypoint],
    home: LatLon,
    assumptions: &Assumptions,
    private: bool,
) -> Sent {
    let mut walk = PlanWalk {
        assumptions,
        private,
        sent: Sent::default(),
        speed: None,
        place: written_position(home).0,
        altitude: None,
        alt_change: None,
        delay: None,
        flybys: 0,
    };
    for (index, waypoint) in waypoints.iter().enumerate() {
        walk.take(index, waypoint);
    }
    if walk.flybys > 0 {
        let why = "elsewhere a FLYBY is a plain waypoint, which other craft may pass in another way";
        let finding = Finding::new(Severity::Info, "waypoint type", why);
        walk.sent.findings.push(finding.values(format!("{} FLYBY", walk.flybys), "waypoint"));
    }
    walk.sent
}

/// The state after some waypoints.
struct PlanWalk<'a> {
    assumptions: &'a Assumptions,
    private: bool,
    sent: Sent,
    /// The running speed; `None` = the default, which no item has changed.
    speed: Option<LegSpeed>,
    /// The place and the altitude of the waypoint before.
    place: LatLon,
    altitude: Option<Altitude>,
    alt_change: Option<Altitude>,
    delay: Option<Seconds>,
    flybys: usize,
}

/// A waypoint on its way into the file.
#[derive(Clone, Copy)]
struct Leg {
    index: usize,
    place: LatLon,
    altitude: Altitude,
}

impl PlanWalk<'_> {
    /// The table of the types.
    fn take(&mut self, index: usize, waypoint: &Waypoint) {
        match waypoint.kind {
            WaypointType::AltChange => self.change_altitude(index, waypoint),
            WaypointType::Delay => self.delay(index, waypoint),
            WaypointType::YawRate => self.yaw_rate(index, waypoint),
            WaypointType::Flyover => {
                let leg = self.begin(index, waypoint);
                let radius_m = self.assumptions.arrival_radius_m.max(0.01);
                self.add(WAYPOINT, [0.0, rounded(radius_m), 0.0], leg);
            }
            WaypointType::Flyby => {
                let leg = self.begin(index, waypoint);
                self.flybys += 1;
                let radius_m =
                    self.assumptions.turn_radius_m(self.assumptions.leg_speed_mps(&self.as_read(waypoint)));
                self.add(WAYPOINT, [0.0, 0.0, rounded(radius_m)], leg);
            }
            WaypointType::Hold => self.hold(index, waypoint),
            WaypointType::Land => self.land(index, waypoint),
            WaypointType::Takeoff => self.take_off(index, waypoint),
        }
        self.unused(index, waypoint);
    }

    fn change_altitude(&mut self, index: usize, waypoint: &Waypoint) {
        self.alt_change = Some(waypoint.altitude);
        let why = "the next waypoint gets this altitude, since an item of its own would climb on the spot";
        self.note(index, Severity::Changed, "type", why, "ALT_CHANGE", "no item");
    }

    fn delay(&mut self, index: usize, waypoint: &Waypoint) {
        self.delay = Some(waypoint.duration).filter(|duration| !duration.is_zero());
        let why = "the next leg gets a speed that takes this time, since a delay would stop other craft";
        let from = format!("DELAY of {}", amount(waypoint.duration.get(), "s"));
        self.note(index, Severity::Changed, "type", why, &from, "a speed");
    }

    fn yaw_rate(&mut self, index: usize, waypoint: &Waypoint) {
        let why = "other craft do not know this item";
        let from = amount(f64::from(waypoint.yaw_rate_dps), "deg/s");
        self.note(index, Severity::Lost, "yaw rate", why, &from, "");
        let params = [0.0, f64::from(waypoint.yaw_rate_dps), 0.0];
        self.add_command(YAW_SPEED, params, index);
    }

    fn hold(&mut self, index: usize, waypoint: &Waypoint) {
        let leg = self.begin(index, waypoint);
        let seconds = waypoint.duration.get();
        let is_endless = waypoint.duration.is_zero();
        let radius_m = rounded(self.assumptions.orbit_radius_m.max(0.1));
        let flown = self.as_read(waypoint);
        let rate = self.assumptions.orbit_rate_rps(&flown);
        match waypoint.pattern {
            HoldPattern::Orbit if is_endless => self.add(LOITER_UNLIMITED, [0.0, 0.0, radius_m], leg),
            HoldPattern::Orbit if rate > 0.0 => {
                let turns = seconds * rate / std::f64::consts::TAU;
                self.add(LOITER_TURNS, [turns, 0.0, radius_m], leg);
                self.check_turns(index, &flown, turns);
            }
            pattern => {
                if pattern != HoldPattern::None {
                    let why = "no item has this pattern: other craft stay on the point";
                    self.note(index, Severity::Lost, "pattern", why, &pattern.to_string(), "NONE");
                }
                self.stay(seconds, leg);
            }
        }
    }

    /// Returns the waypoint with the speed that the items give it.
    fn as_read(&self, waypoint: &Waypoint) -> Waypoint {
        Waypoint { speed: self.speed.unwrap_or_default(), ..*waypoint }
    }

    /// Reports a time that is another one without the settings of the plan.
    fn check_turns(&mut self, index: usize, flown: &Waypoint, turns: f64) {
        let plain = Assumptions::default().orbit_rate_rps(flown);
        let read = Seconds::new((turns * std::f64::consts::TAU / plain).clamp(0.1, 6553.5));
        if !self.private && read != flown.duration {
            let why =
                "an item has the number of turns, and the settings that give their time are not in the file";
            let (from, to) = (amount(flown.duration.get(), "s"), amount(read.get(), "s"));
            self.note(index, Severity::Changed, "duration", why, &from, &to);
        }
    }

    fn land(&mut self, index: usize, waypoint: &Waypoint) {
        let before = self.altitude;
        let leg = self.begin(index, waypoint);
        let start = Altitude::above_home(self.assumptions.start_alt_m);
        let mut level = before.unwrap_or(start);
        if !waypoint.duration.is_zero() {
            let why = "a landing has no time: the craft stays there before it";
            self.note(index, Severity::Changed, "type", why, "LAND", "HOLD, LAND");
            self.stay(waypoint.duration.get(), leg);
            level = leg.altitude;
        }
        if level != leg.altitude {
            let why = "the altitude of a MAVLink LAND is that of the ground: the craft arrives at the altitude before";
            self.note(index, Severity::Lost, "altitude", why, &metres(leg.altitude), &metres(level));
        }
        self.altitude = Some(level);
        self.add(LAND, [0.0; 3], Leg { altitude: Altitude::default(), ..leg });
    }

    fn take_off(&mut self, index: usize, waypoint: &Waypoint) {
        let leg = self.begin(index, waypoint);
        self.add(TAKEOFF, [0.0; 3], leg);
        if !waypoint.duration.is_zero() {
            let why = "a take-off has no time: the craft stays there after it";
            self.note(index, Severity::Changed, "type", why, "TAKEOFF", "TAKEOFF, HOLD");
            self.stay(waypoint.duration.get(), leg);
        }
    }

    fn stay(&mut self, seconds: f64, leg: Leg) {
        if seconds > 0.0 {
            self.add(LOITER_TIME, [seconds, 0.0, 0.0], leg);
        } else {
            self.add(LOITER_UNLIMITED, [0.0; 3], leg);
        }
    }

    /// Begins the leg to a waypoint: its place, its altitude and its speed.
    fn begin(&mut self, index: usize, waypoint: &Waypoint) -> Leg {
        let altitude = match self.alt_change.take() {
            Some(changed) => {
                if !self.private && changed != waypoint.altitude {
                    let why = "it is that of the ALT_CHANGE before";
                    let (from, to) = (metres(waypoint.altitude), metres(changed));
                    self.note(index, Severity::Changed, "altitude", why, &from, &to);
                }
                changed
            }
            None => waypoint.altitude,
        };
        if let Err(message) = bounds::altitude_m(altitude.above_home_m()) {
            self.note(index, Severity::Refused, "altitude", &message, &metres(altitude), "");
        }
        let mut place = self.place;
        if waypoint.kind.uses_position() {
            let (position, moved) = written_position(waypoint.position);
            if moved {
                let why = "0,0 means that there is no position";
                self.note(index, Severity::Changed, "position", why, "0,0", &position.to_string());
            }
            place = position;
        }
        self.change_speed(index, waypoint, place, altitude);
        (self.place, self.altitude) = (place, Some(altitude));
        Leg { index, place, altitude }
    }

    fn change_speed(&mut self, index: usize, waypoint: &Waypoint, place: LatLon, altitude: Altitude) {
        let most = self.assumptions.max_velocity_mps;
        let own = match self.delay.take() {
            None => waypoint.speed.own_mps(),
            Some(delay) => {
                let start_m = self.altitude.map_or(self.assumptions.start_alt_m, Altitude::above_home_m);
                let rise_m = altitude.above_home_m() - start_m;
                let length_m = math::hypot(distance_bearing(self.place, place).0, rise_m);
                let leg_mps = self.assumptions.leg_speed_mps(waypoint);
                Some(self.assumptions.delayed_mps(length_m, delay.get()).min(leg_mps))
            }
        };
        let wanted = match own {
            None if self.speed.is_none() => None,
            own => Some(LegSpeed::from_mps(own.unwrap_or(most).max(0.01))),
        };
        if let Some(speed) = wanted.filter(|_| wanted != self.speed) {
            self.add_command(CHANGE_SPEED, [1.0, speed.mps(), -1.0], index);
            self.speed = wanted;
        }
        if !self.private && wanted.unwrap_or_default() != waypoint.speed {
            let text = |speed: LegSpeed| {
                speed.own_mps().map_or_else(|| "default".to_owned(), |mps| amount(mps, "m/s"))
            };
            let (from, to) = (text(waypoint.speed), text(wanted.unwrap_or_default()));
            let why = "a speed in the file applies until the next one, and none stands for the default";
            self.note(index, Severity::Changed, "speed", why, &from, &to);
        }
    }

    /// Reports values of the waypoint that its type does not use.
    fn unused(&mut self, index: usize, waypoint: &Waypoint) {
        let uses = waypoint.kind.capability();
        let place = !uses.place && waypoint.position != LatLon::default();
        let altitude = !uses.altitude && waypoint.altitude != Altitude::default();
        let time = uses.time == TimeUse::Unused && !waypoint.duration.is_zero();
        let pattern = !uses.pattern && waypoint.pattern != HoldPattern::None;
        let speed = !waypoint.kind.is_positional() && waypoint.speed != LegSpeed::default();
        if !self.private && (place || altitude || time || pattern || speed) {
            let why = format!("a {} does not use it", waypoint.kind);
            self.note(index, Severity::Info, "unused values", &why, "", "");
        }
    }

    fn add(&mut self, command: u16, params: [f64; 3], leg: Leg) {
        self.push(command, params, leg.index, Some(leg));
    }

    fn add_command(&mut self, command: u16, params: [f64; 3], index: usize) {
        self.push(command, params, index, None);
    }

    fn push(&mut self, command: u16, [p1, p2, p3]: [f64; 3], index: usize, leg: Option<Leg>) {
        self.sent.items.push(MissionItem {
            number: self.sent.items.len() + 1,
            command,
            frame: if leg.is_some() { ABOVE_HOME } else { NO_PLACE },
            // A heading of 0 is north elsewhere.
            params: [Some(p1), Some(p2), Some(p3), if leg.is_some() { None } else { Some(0.0) }],
            lat_deg: Some(leg.map_or(0.0, |leg| degrees(leg.place.lat_e7))),
            lon_deg: Some(leg.map_or(0.0, |leg| degrees(leg.place.lon_e7))),
            altitude_m: Some(leg.map_or(0.0, |leg| leg.altitude.above_home_m())),
            autocontinue: true,
            place: None,
        });
        self.sent.sources.push(index);
    }

    /// Adds a finding with the number of the item that comes next.
    fn note(&mut self, index: usize, severity: Severity, field: &str, why: &str, from: &str, to: &str) {
        self.sent.findings.push(Finding::new(severity, field, why).at(index).values(from, to));
    }
}

/// Returns the decimal number that is nearest to the degrees.
fn degrees(e7: i32) -> f64 {
    f64::from(e7) / 1e7
}

/// Returns a length to the centimetre.
fn rounded(metres: f64) -> f64 {
    (metres * 100.0).round() / 100.0
}
