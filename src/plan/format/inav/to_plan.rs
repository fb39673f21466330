//! INAV items as a plan.

use super::super::bounds::{MAX_ITEMS, Reference};
use super::super::dropped::dropped;
use super::super::long::hint;
use super::super::loss::{Finding, LossReport, Place, Severity};
use super::super::{HomePosition, PlanFile, Problems, ReadOptions};
use super::private::Restored;
use super::unroll::{BadJump, flight_order};
use super::{Action, Contents, Form, Found, IGNORED_CMS, Item, Mission, SEA_LEVEL, USER_ACTIONS, private};
use crate::geo::LatLon;
use crate::plan::{Altitude, FlightPlan, LegSpeed, MAX_WAYPOINTS, Seconds, Waypoint, WaypointType};

/// The hold of an item with 0 s: the shortest of a plan, because 0 is endless there.
const MIN_S: f64 = 0.1;
/// The longest hold of a waypoint, s.
const MAX_S: f64 = 6553.5;

/// Returns the plan of the mission that the user chose.
pub(super) fn plan_file(
    contents: Contents,
    form: Form,
    options: &ReadOptions,
    problems: &mut Problems<'_>,
) -> PlanFile {
    let Contents { missions, findings, private } = contents;
    let count = missions.len();
    let mut losses = LossReport { findings, ..LossReport::default() };
    if count > 1 {
        losses.findings.push(others(&missions, options.mission));
    }
    let Some(mission) = missions.into_iter().nth(options.mission.max(1) - 1) else {
        let message = format!("the file has no mission {}", options.mission);
        problems.add(0..0, message, format!("it has {count}"));
        return PlanFile::default();
    };
    losses.items = mission.items.len();
    let items: Vec<Item> = mission.items.iter().map(|found| found.item).collect();
    let mut known = PlanFile::default();
    let mut private_plan = FlightPlan::default();
    let not_used = |why: &str| Finding::new(Severity::Assumed, "private data", why);
    match private.map(|text| private::restore(&text, &items, mission.home, form, options)) {
        None => {}
        Some(Ok(Restored { file, has_plan: true })) => {
            let mut home = file.home.or(options.home);
            if let (Some(home), Some(given)) = (&mut home, options.home)
                && home.position == given.position
            {
                home.amsl_m = home.amsl_m.or(given.amsl_m);
            }
            return PlanFile { home, losses, ..file };
        }
        Some(Ok(Restored { file, has_plan: false })) => {
            losses.add(not_used(private::EDITED));
            private_plan = file.plan.clone();
            known = PlanFile { plan: FlightPlan::default(), rest: Vec::new(), ..file };
        }
        Some(Err(why)) => losses.add(not_used(why)),
    }
    let home = home(mission.home, known.home, options);
    let mut reader = ItemReader { options, problems, home, losses, waypoints: Vec::new(), plain: 0 };
    reader.mission(&mission.items);
    reader.check_length(&mission.items);
    let (waypoints, mut losses) = (reader.waypoints, reader.losses);
    losses.findings.extend(dropped(&private_plan.waypoints, &waypoints, Severity::Lost));
    let mut file = PlanFile { home, losses, ..known };
    file.take(waypoints);
    file
}

/// Returns the home: that of the file, with the altitude that it lacks.
fn home(of_file: Option<LatLon>, known: Option<HomePosition>, options: &ReadOptions) -> Option<HomePosition> {
    let Some(position) = of_file else { return known.or(options.home) };
    let same = known.filter(|known| known.position == position);
    let amsl_m = same.and_then(|known| known.amsl_m).or_else(|| options.home.and_then(|home| home.amsl_m));
    Some(HomePosition { position, amsl_m })
}

/// Names the missions that are not read.
fn others(missions: &[Mission], chosen: usize) -> Finding {
    const MAX_NAMED: usize = 20;
    let others: Vec<(usize, usize)> = (1..)
        .zip(missions.iter().map(|mission| mission.items.len()))
        .filter(|&(number, _)| number != chosen.max(1))
        .collect();
    let (first, rest) = others.split_at(others.len().min(MAX_NAMED));
    let words = first.iter().map(|(number, items)| format!("mission {number} ({items} items)"));
    let mut named = words.collect::<Vec<_>>().join(", ");
    if !rest.is_empty() {
        let items: usize = rest.iter().map(|(_, items)| items).sum();
        named.push_str(&format!(" and {} more ({items} items)", rest.len()));
    }
    let why = "a plan is one mission: choose it with --mission N";
    Finding::new(Severity::Lost, "missions", why).values(named, "")
}

struct ItemReader<'o, 'p, 't> {
    options: &'o ReadOptions,
    problems: &'p mut Problems<'t>,
    home: Option<HomePosition>,
    losses: LossReport,
    waypoints: Vec<Waypoint>,
    /// The number of WAYPOINT items.
    plain: usize,
}

impl ItemReader<'_, '_, '_> {
    fn mission(&mut self, items: &[Found]) {
        let most = if self.options.long { MAX_ITEMS } else { MAX_WAYPOINTS };
        let order = match flight_order(items, most) {
            Ok(order) => order,
            Err(BadJump { index, message }) => {
                self.problems.add(items[index].span.clone(), message, "plans have no jumps");
                return;
            }
        };
        let mut is_first = vec![true; items.len()];
        for &index in &order {
            // The findings of an item that is flown again would only repeat.
            let before = self.losses.findings.len();
            self.item(&items[index]);
            if !std::mem::replace(&mut is_first[index], false) {
                self.losses.findings.truncate(before);
            }
            if items[index].item.action == Action::Rth {
                self.after_rth(&items[index], items.len() - index - 1);
            }
        }
        if self.plain > 0 {
            let why = "INAV turns at a WAYPOINT by its own setting: choose with --waypoint-as";
            let finding = Finding::new(Severity::Assumed, "type", why);
            let to = self.options.waypoint_as.to_string();
            self.losses.add(finding.values(format!("{} WAYPOINT", self.plain), to));
        }
    }

    /// Refuses a mission for which a plan has no room, if only a plan is wanted.
    fn check_length(&mut self, items: &[Found]) {
        let count = self.waypoints.len();
        if count > MAX_WAYPOINTS && !self.options.long {
            let span = items.first().map_or(0..0, |found| found.span.clone());
            self.problems.add(span, format!("the mission has {count} waypoints"), hint());
        }
    }

    fn after_rth(&mut self, rth: &Found, rest: usize) {
        if rest > 0 {
            let why = "the mission ends with this RTH";
            self.differs(rth, Severity::Lost, "items", &format!("{rest} after it"), "", why);
        }
    }

    /// Adds a finding about an item and the waypoint that comes next.
    fn differs(&mut self, found: &Found, severity: Severity, field: &str, from: &str, to: &str, why: &str) {
        let line = self.problems.line_at(found.span.start);
        let finding = Finding::new(severity, field, why).item(found.number).place(Place::Line { line });
        let finding = if found.item.action.has_place() || found.item.action == Action::Rth {
            finding.at(self.waypoints.len())
        } else {
            finding
        };
        self.losses.add(finding.values(from, to));
    }

    fn item(&mut self, found: &Found) {
        let Item { action, p1, p2, .. } = found.item;
        let name = action.to_string();
        match action {
            Action::Unassigned => {
                self.differs(found, Severity::Info, "item", &name, "", "it is an empty item");
            }
            Action::SetPoi | Action::SetHead => {
                let why = "the nose of the craft follows ap_yaw_mode";
                self.differs(found, Severity::Lost, "nose direction", &name, "", why);
            }
            Action::Jump => {
                let why = "plans have no jumps: the waypoints are repeated";
                let from = format!("JUMP to item {p1}, repeats: {p2}");
                self.differs(found, Severity::Changed, "item", &from, "", why);
            }
            Action::Waypoint => {
                let waypoint = self.place(found);
                let speed = self.leg_speed(found, p1);
                self.plain += 1;
                self.waypoints.push(Waypoint { kind: self.options.waypoint_as, speed, ..waypoint });
            }
            Action::PosholdUnlim => {
                let waypoint = self.place(found);
                self.waypoints.push(Waypoint { kind: WaypointType::Hold, ..waypoint });
            }
            Action::PosholdTime => {
                let waypoint = self.place(found);
                let speed = self.leg_speed(found, p2);
                let seconds = f64::from(p1).clamp(MIN_S, MAX_S);
                if (seconds - f64::from(p1)).abs() > MIN_S + 0.01 {
                    let why = "a HOLD lasts 0.1 s to 6553.5 s";
                    let (from, to) = (format!("{p1} s"), format!("{seconds} s"));
                    self.differs(found, Severity::Changed, "duration", &from, &to, why);
                }
                let duration = Seconds::new(seconds);
                self.waypoints.push(Waypoint { kind: WaypointType::Hold, duration, speed, ..waypoint });
            }
            Action::Land => {
                let waypoint = self.place(found);
                let speed = self.leg_speed(found, p1);
                if p2 != 0 {
                    let why = "a LAND finds the ground by its touchdown";
                    self.differs(found, Severity::Info, "ground elevation", &format!("{p2} m"), "", why);
                }
                self.waypoints.push(Waypoint { kind: WaypointType::Land, speed, ..waypoint });
            }
            Action::Rth => self.rth(found),
        }
    }

    /// Adds the way home: over it, and down or a hold there.
    fn rth(&mut self, found: &Found) {
        let Some(position) = self.home_for(found, "an RTH") else { return };
        let (then, to) = if found.item.p1 != 0 {
            (WaypointType::Land, "FLYOVER and LAND at home")
        } else {
            (WaypointType::Hold, "FLYOVER and endless HOLD at home")
        };
        let own = Altitude::from_cm(found.item.alt_cm);
        let altitude = self.waypoints.last().map_or(own, |last| last.altitude);
        let why = "plans have no return: they fly home at the altitude of the last waypoint";
        self.differs(found, Severity::Changed, "item", "RTH", to, why);
        let over = Waypoint { position, altitude, kind: WaypointType::Flyover, ..Waypoint::default() };
        self.waypoints.push(over);
        self.waypoints.push(Waypoint { kind: then, ..over });
    }

    /// Returns a waypoint at the position and the altitude of an item.
    fn place(&mut self, found: &Found) -> Waypoint {
        let Item { alt_cm, p3, .. } = found.item;
        let mut position = found.item.position;
        if found.item.is_at_home()
            && let Some(home) = self.home_for(found, "an item at home")
        {
            let why = "the item is at the home of the flight";
            self.differs(found, Severity::Assumed, "position", &position.to_string(), &home.to_string(), why);
            position = home;
        }
        if p3 & USER_ACTIONS != 0 {
            let actions: Vec<String> =
                (1..=4).filter(|bit| p3 & (1 << bit) != 0).map(|bit| bit.to_string()).collect();
            let why = "plans switch nothing at a waypoint";
            self.differs(found, Severity::Lost, "user actions", &actions.join(", "), "", why);
        }
        let reference = if p3 & SEA_LEVEL != 0 { Reference::SeaLevel } else { Reference::Home };
        let altitude = match reference.above_home(f64::from(alt_cm) / 100.0, self.home, self.options.flat) {
            Ok((altitude, _)) => altitude,
            Err(message) => {
                self.problems.add(found.span.clone(), message, "bit 0 of parameter 3 is set");
                Altitude::default()
            }
        };
        Waypoint { position, altitude, ..Waypoint::default() }
    }

    fn home_for(&mut self, found: &Found, what: &str) -> Option<LatLon> {
        let home = self.home.map(|home| home.position);
        if home.is_none() {
            let message = format!("{what} needs the home, and the file does not have it");
            self.problems.add(found.span.clone(), message, "add --home LAT,LON");
        }
        home
    }

    /// Returns a leg speed as INAV flies it: it ignores those up to 0.5 m/s.
    fn leg_speed(&mut self, found: &Found, cms: i32) -> LegSpeed {
        if (1..=IGNORED_CMS).contains(&cms) {
            let why = "INAV ignores a leg speed up to 0.5 m/s";
            let from = format!("{} m/s", f64::from(cms) / 100.0);
            self.differs(found, Severity::Changed, "speed", &from, "default", why);
        }
        let used = u16::try_from(cms).ok().filter(|&used| i32::from(used) > IGNORED_CMS);
        LegSpeed::from_cms(used.unwrap_or(0))
    }
}
