//! Items → waypoints: one function for each kind of command.

use std::collections::BTreeMap;

use super::mapping::{Fault, Mapping};
use super::{MissionItem, amount, command, jump, metres};
use crate::geo::LatLon;
use crate::plan::estimate::Assumptions;
use crate::plan::format::HomePosition;
use crate::plan::format::bounds;
use crate::plan::format::loss::{Finding, Severity};
use crate::plan::{Altitude, HoldPattern, LegSpeed, Seconds, Waypoint, WaypointType};

/// The longest time of a waypoint, s.
const MAX_S: f64 = 6553.5;
/// The shortest stay, s: a stay of 0 is endless.
const MIN_S: f64 = 0.1;
/// A time or a radius that differs by less counts as unchanged, s or m.
const SAME: f64 = 0.011;

/// A mission and the facts that give its items a meaning.
#[derive(Debug, Clone, Copy)]
pub(in crate::plan::format) struct Mission<'a> {
    pub(in crate::plan::format) items: &'a [MissionItem],
    pub(in crate::plan::format) home: Option<HomePosition>,
    pub(in crate::plan::format) assumptions: &'a Assumptions,
    /// The type of a waypoint that does not say how it is passed.
    pub(in crate::plan::format) waypoint_as: WaypointType,
    /// An altitude above ground is one above home.
    pub(in crate::plan::format) flat: bool,
}

impl Mission<'_> {
    /// Returns the waypoints of the items, the differences, and the items that cannot be taken.
    pub(in crate::plan::format) fn map(&self) -> Mapping {
        let order = match jump::order(self.items) {
            Ok(order) => order,
            Err(fault) => return Mapping { faults: vec![fault], ..Mapping::default() },
        };
        let mut walk = ItemWalk {
            mission: self,
            mapping: Mapping { findings: order.findings, jump: order.jump, ..Mapping::default() },
            speed: LegSpeed::default(),
            place: None,
            altitude: None,
            alt_change: None,
            plain: 0,
            headings: 0,
            left_out: BTreeMap::new(),
        };
        for (at, &index) in order.indices.iter().enumerate() {
            walk.take(index);
            if self.items[index].command == RETURN {
                walk.leave(&order.indices[at + 1..]);
                break;
            }
        }
        walk.finish()
    }
}

/// The command RETURN_TO_LAUNCH.
const RETURN: u16 = 20;

/// The state of the craft after some items.
struct ItemWalk<'m> {
    mission: &'m Mission<'m>,
    mapping: Mapping,
    /// The running speed.
    speed: LegSpeed,
    /// The place and the altitude of the previous waypoint.
    place: Option<LatLon>,
    altitude: Option<Altitude>,
    alt_change: Option<Altitude>,
    /// The number of waypoints that do not say how they are passed.
    plain: usize,
    /// The number of items with a heading.
    headings: usize,
    /// The number of items that are left out, by command.
    left_out: BTreeMap<u16, usize>,
}

impl<'m> ItemWalk<'m> {
    fn take(&mut self, index: usize) {
        let item = &self.mission.items[index];
        if !item.autocontinue {
            let why = "the autopilot always goes on to the next waypoint";
            self.note(item, Severity::Lost, "autocontinue", why, "off", "on");
        }
        let has_heading = matches!(item.command, 16 | 17 | 21 | 22 | 84 | 85);
        self.headings += usize::from(has_heading && item.param(4) != 0.0);
        if let Err(message) = self.command(index, item) {
            let message = format!("item {}: {message}", item.number);
            self.mapping.faults.push(Fault { item: index, message, hint: String::new() });
        }
    }

    /// The table of the commands.
    fn command(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        match item.command {
            16 => self.pass(index, item),
            82 => {
                let why = "the craft flies straight legs";
                self.note(item, Severity::Lost, "spline", why, "curve", "straight");
                self.pass(index, item)
            }
            17 => self.loiter(index, item, None),
            18 => self.loiter(index, item, Some(item.param(1))),
            19 => self.loiter_time(index, item),
            RETURN => self.return_home(index, item),
            21 => self.land(index, item),
            85 => {
                self.note(item, Severity::Lost, "transition", "the craft has no wings", "", "");
                self.land(index, item)
            }
            94 => {
                self.note(item, Severity::Lost, "payload", "the craft places no payload", "", "");
                self.land(index, item)
            }
            22 => self.take_off(index, item),
            84 => {
                self.note(item, Severity::Lost, "transition", "the craft has no wings", "", "");
                self.take_off(index, item)
            }
            30 => self.change_altitude(index, item),
            31 => self.loiter_to_altitude(index, item),
            93 => self.delay(index, item),
            178 => self.change_speed(item),
            213 => self.yaw_rate(index, item),
            number if command::left_out(number).is_some() => {
                *self.left_out.entry(number).or_default() += 1;
                Ok(())
            }
            number => Err(format!("command {number} is unknown")),
        }
    }

    fn pass(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let (position, altitude) = self.point(item)?;
        let [stay_s, accepted_m, passed_m] = [1, 2, 3].map(|number| item.param(number));
        let mut waypoint = Waypoint { position, altitude, ..Waypoint::default() };
        if stay_s != 0.0 {
            waypoint.kind = WaypointType::Hold;
            waypoint.duration = self.duration(item, stay_s)?;
        } else if passed_m != 0.0 {
            waypoint.kind = WaypointType::Flyby;
        } else if accepted_m > 0.0 {
            waypoint.kind = WaypointType::Flyover;
            let ours = self.mission.assumptions.arrival_radius_m;
            if (accepted_m - ours).abs() > SAME {
                let why = "ap_waypoint_arrival_radius decides for all waypoints";
                let (from, to) = (amount(accepted_m, "m"), amount(ours, "m"));
                self.note(item, Severity::Info, "acceptance radius", why, &from, &to);
            }
        } else {
            waypoint.kind = self.mission.waypoint_as;
            self.plain += 1;
        }
        self.push(index, waypoint);
        Ok(())
    }

    /// A stay without an end, or for a number of turns.
    fn loiter(&mut self, index: usize, item: &'m MissionItem, turns: Option<f64>) -> Result<(), String> {
        let (position, altitude) = self.point(item)?;
        let radius_m = item.param(3);
        let circles = turns.is_some() || radius_m != 0.0;
        let pattern = if circles { HoldPattern::Orbit } else { HoldPattern::None };
        let kind = WaypointType::Hold;
        let mut waypoint =
            Waypoint { position, altitude, kind, pattern, speed: self.speed, ..Waypoint::default() };
        if let Some(turns) = turns {
            let rate = self.mission.assumptions.orbit_rate_rps(&waypoint);
            if rate <= 0.0 && turns > 0.0 {
                return Err("the craft flies no turns: ap_max_turn_rate is 0".to_owned());
            }
            let seconds = if turns > 0.0 { turns * std::f64::consts::TAU / rate } else { turns };
            waypoint.duration = self.duration(item, seconds)?;
        }
        let ours = self.mission.assumptions.orbit_radius_m.max(0.1);
        if radius_m != 0.0 && (radius_m.abs() - ours).abs() > SAME {
            let why = "ap_hold_orbit_radius decides for all circles";
            let (from, to) = (amount(radius_m.abs(), "m"), amount(ours, "m"));
            self.note(item, Severity::Changed, "radius", why, &from, &to);
        }
        if radius_m < 0.0 {
            let why = "an ORBIT is flown clockwise";
            self.note(item, Severity::Lost, "direction", why, "counter-clockwise", "clockwise");
        }
        self.push(index, waypoint);
        Ok(())
    }

    fn loiter_time(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let (position, altitude) = (self.here(item)?, self.altitude(item)?);
        if item.param(3) != 0.0 {
            let why = "a multirotor stays on the point";
            self.note(item, Severity::Info, "radius", why, &amount(item.param(3).abs(), "m"), "");
        }
        let duration = self.duration(item, item.param(1))?;
        self.push(
            index,
            Waypoint { position, altitude, duration, kind: WaypointType::Hold, ..Waypoint::default() },
        );
        Ok(())
    }

    fn return_home(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let home =
            self.mission.home.ok_or("a return needs the home, and there is none: add --home LAT,LON")?;
        let why = "a plan flies home and lands there, at the altitude of the waypoint before";
        self.note(item, Severity::Changed, "return", why, "1 item", "2 waypoints");
        let (position, altitude) = (home.position, self.level());
        for kind in [WaypointType::Flyover, WaypointType::Land] {
            self.push(index, Waypoint { position, altitude, kind, ..Waypoint::default() });
        }
        Ok(())
    }

    /// The altitude of a MAVLink landing is that of the ground. Ours is that of the approach.
    fn land(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let position = self.here(item)?;
        let reference = item.reference()?;
        let theirs_m = item.altitude_m.map(bounds::altitude_m).transpose()?;
        let altitude = self.level();
        // The ground is never flown to, so that an unknown home is no problem.
        let theirs = theirs_m.and_then(|metres| reference.above_home(metres, self.mission.home, true).ok());
        if theirs.is_none_or(|(theirs, _)| theirs != altitude) {
            let why = "the altitude of a MAVLink LAND is that of the ground";
            let from = theirs_m.map_or_else(String::new, |metres| amount(metres, "m"));
            self.note(item, Severity::Changed, "altitude", why, &from, &metres(altitude));
        }
        self.push(index, Waypoint { position, altitude, kind: WaypointType::Land, ..Waypoint::default() });
        Ok(())
    }

    fn take_off(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let position = match item.degrees() {
            Some(_) => self.position(item)?,
            None => self.here(item).unwrap_or_default(),
        };
        let altitude = self.altitude(item)?;
        if item.param(1) != 0.0 {
            let why = "a multirotor climbs on the spot";
            self.note(item, Severity::Info, "pitch", why, &amount(item.param(1), "deg"), "");
        }
        self.push(index, Waypoint { position, altitude, kind: WaypointType::Takeoff, ..Waypoint::default() });
        Ok(())
    }

    fn change_altitude(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let altitude = self.altitude(item)?;
        if item.param(1) != 0.0 {
            let why = "the altitude gives the direction";
            let direction = if item.param(1) > 1.5 { "descend" } else { "climb" };
            self.note(item, Severity::Info, "direction", why, direction, "");
        }
        self.push(index, Waypoint { altitude, kind: WaypointType::AltChange, ..Waypoint::default() });
        Ok(())
    }

    fn loiter_to_altitude(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let (position, altitude) = (self.here(item)?, self.altitude(item)?);
        let level = self.altitude.unwrap_or(altitude);
        let why = "a plan flies to the point, and then climbs or sinks on the spot";
        self.note(item, Severity::Changed, "loiter to altitude", why, "1 item", "2 waypoints");
        for (kind, altitude) in [(WaypointType::Flyover, level), (WaypointType::Takeoff, altitude)] {
            self.push(index, Waypoint { position, altitude, kind, ..Waypoint::default() });
        }
        Ok(())
    }

    fn delay(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let seconds = item.param(1);
        if seconds < 0.0 {
            return Err("a delay until a time of day is not possible".to_owned());
        }
        let (Some(position), Some(altitude)) = (self.place, self.altitude) else {
            let why = "a delay before the first waypoint has no place";
            self.note(item, Severity::Lost, "delay", why, &amount(seconds, "s"), "");
            return Ok(());
        };
        let why = "a delay in a file means that the craft waits, as it does elsewhere";
        self.note(item, Severity::Assumed, "delay", why, &amount(seconds, "s"), "HOLD");
        let duration = self.duration(item, seconds)?;
        self.push(
            index,
            Waypoint { position, altitude, duration, kind: WaypointType::Hold, ..Waypoint::default() },
        );
        Ok(())
    }

    fn change_speed(&mut self, item: &'m MissionItem) -> Result<(), String> {
        let (of, mps) = (item.param(1), item.params[1].unwrap_or(-1.0));
        if !(0.0..2.0).contains(&of) {
            let why = "only the speed over ground can be set";
            self.note(item, Severity::Lost, "climb or descent speed", why, &amount(mps, "m/s"), "");
            return Ok(());
        }
        if mps == -2.0 {
            self.speed = LegSpeed::default();
        } else if mps > 0.0 {
            let kept = LegSpeed::checked(mps).filter(|speed| speed.mps() > 0.0);
            self.speed = kept.ok_or_else(|| {
                format!("speed {mps} m/s is out of range, allowed: 0.01 to {} m/s", LegSpeed::MAX_MPS)
            })?;
            if of < 1.0 {
                let why = "the speed through the air is taken as the speed over ground";
                self.note(item, Severity::Assumed, "speed", why, &amount(mps, "m/s"), "");
            }
            let most = self.mission.assumptions.max_velocity_mps;
            if mps > most + SAME {
                let why = "ap_max_velocity limits the speed in flight";
                self.note(item, Severity::Changed, "speed", why, &amount(mps, "m/s"), &amount(most, "m/s"));
            }
        } else if mps != -1.0 && mps != 0.0 {
            return Err(format!("speed {mps} m/s is out of range, allowed: -2, -1 and 0 to 655.35 m/s"));
        }
        Ok(())
    }

    fn yaw_rate(&mut self, index: usize, item: &'m MissionItem) -> Result<(), String> {
        let rate = item.param(2);
        if !(0.0..=f64::from(u16::MAX)).contains(&rate) {
            return Err(format!("yaw rate {rate} deg/s is out of range, allowed: 0 to 65535 deg/s"));
        }
        let yaw_rate_dps = rate.round() as u16;
        if (rate - f64::from(yaw_rate_dps)).abs() > SAME {
            let (from, to) = (amount(rate, "deg/s"), amount(rate.round(), "deg/s"));
            self.note(item, Severity::Changed, "yaw rate", "a plan has whole degrees", &from, &to);
        }
        self.push(index, Waypoint { yaw_rate_dps, kind: WaypointType::YawRate, ..Waypoint::default() });
        Ok(())
    }

    /// Adds a waypoint. One that is flown to gets the running speed.
    fn push(&mut self, index: usize, waypoint: Waypoint) {
        let mut waypoint = waypoint;
        if waypoint.kind.is_positional() {
            waypoint.speed = self.speed;
            self.place = Some(waypoint.position);
            self.altitude = Some(self.alt_change.take().unwrap_or(waypoint.altitude));
        } else if waypoint.kind == WaypointType::AltChange {
            self.alt_change = Some(waypoint.altitude);
        }
        self.mapping.waypoints.push((waypoint, index));
    }

    /// Adds a finding of the item that becomes the next waypoint.
    fn note(&mut self, item: &MissionItem, severity: Severity, field: &str, why: &str, from: &str, to: &str) {
        let mut finding = Finding::new(severity, field, why).item(item.number).values(from, to);
        finding.place = item.place.clone();
        // A speed and the like belong to no waypoint of their own.
        if !matches!(item.command, 178) {
            finding.waypoint = Some(self.mapping.waypoints.len());
        }
        self.mapping.findings.push(finding);
    }

    /// Returns the altitude of the waypoint before, or that at which a mission begins.
    fn level(&self) -> Altitude {
        self.altitude.unwrap_or_else(|| Altitude::above_home(self.mission.assumptions.start_alt_m))
    }

    fn position(&mut self, item: &MissionItem) -> Result<LatLon, String> {
        let (lat, lon) = item.degrees().ok_or("it has no position")?;
        let (position, wrapped) = bounds::position(lat, lon)?;
        if wrapped {
            let why = "a longitude is within 180 degrees";
            self.note(
                item,
                Severity::Changed,
                "longitude",
                why,
                &lon.to_string(),
                &position.lon_deg().to_string(),
            );
        }
        Ok(position)
    }

    /// Returns the position and the altitude of a point. Without a position it is that of the craft, as in ArduPilot,
    /// and so is an altitude of 0.
    fn point(&mut self, item: &MissionItem) -> Result<(LatLon, Altitude), String> {
        let position = self.here(item)?;
        let mut altitude = self.altitude(item)?;
        if item.degrees().is_none() {
            if item.altitude_m == Some(0.0) {
                altitude = self.level();
            }
            let why = "an item without a position is at the place of the waypoint before";
            self.note(
                item,
                Severity::Assumed,
                "position",
                why,
                "",
                &format!("{position}, {}", metres(altitude)),
            );
        }
        Ok((position, altitude))
    }

    /// Returns the position. Without one the item is at the place of the craft.
    fn here(&mut self, item: &MissionItem) -> Result<LatLon, String> {
        item.reference()?;
        if item.degrees().is_some() {
            return self.position(item);
        }
        let place = self.place.or_else(|| self.mission.home.map(|home| home.position));
        place.ok_or_else(|| "it has no position, and there is none before it".to_owned())
    }

    fn altitude(&mut self, item: &MissionItem) -> Result<Altitude, String> {
        let metres = item.altitude_m.ok_or("it has no altitude")?;
        let (altitude, finding) =
            item.reference()?.above_home(metres, self.mission.home, self.mission.flat)?;
        if let Some(finding) = finding {
            self.note(item, finding.severity, &finding.field, &finding.why, &finding.from, &finding.to);
        }
        Ok(altitude)
    }

    fn duration(&mut self, item: &MissionItem, seconds: f64) -> Result<Seconds, String> {
        if !(0.0..=1e9).contains(&seconds) {
            return Err(format!("a stay of {seconds} s is out of range, allowed: 0 to {MAX_S} s"));
        }
        let duration = Seconds::new(seconds.clamp(MIN_S, MAX_S));
        if seconds > 0.0 && (duration.get() - seconds).abs() > SAME {
            let why = "times are kept to 0.1 s, up to 6553.5 s";
            let to = amount(duration.get(), "s");
            self.note(item, Severity::Changed, "duration", why, &amount(seconds, "s"), &to);
        }
        Ok(duration)
    }

    /// Reports the items after a return.
    fn leave(&mut self, rest: &[usize]) {
        let Some(&first) = rest.first() else { return };
        let item = &self.mission.items[first];
        let why = "the mission ends with the return";
        let mut finding = Finding::new(Severity::Lost, "items after the return", why).item(item.number);
        finding.place = item.place.clone();
        self.mapping.findings.push(finding.values(counted(rest.len()), ""));
    }

    /// Adds the findings of the whole file.
    fn finish(mut self) -> Mapping {
        let mut add = |severity, field: String, count: usize, to: String, why: &str| {
            self.mapping.findings.push(Finding::new(severity, field, why).values(counted(count), to));
        };
        if self.plain > 0 {
            let why = "the items do not say how they are passed";
            let to = self.mission.waypoint_as.to_string();
            add(Severity::Assumed, "waypoint type".to_owned(), self.plain, to, why);
        }
        if self.headings > 0 {
            let why = "a waypoint has no heading: ap_yaw_mode decides";
            add(Severity::Lost, "heading".to_owned(), self.headings, String::new(), why);
        }
        for (&number, &count) in &self.left_out {
            if let Some(row) = command::left_out(number) {
                add(row.severity, format!("{} (command {number})", row.field), count, String::new(), row.why);
            }
        }
        self.mapping
    }
}

fn counted(items: usize) -> String {
    if items == 1 { "1 item".to_owned() } else { format!("{items} items") }
}
