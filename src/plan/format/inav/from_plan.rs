//! A plan as INAV items.

use super::super::bounds;
use super::super::loss::{Finding, Severity};
use super::super::{HomePosition, PlanFile};
use super::{Action, Form, IGNORED_CMS, Item, LAST, as_place};
use crate::geo::{LatLon, distance_bearing};
use crate::plan::{HoldPattern, Waypoint, WaypointType};

/// The longest hold in whole seconds that a waypoint holds, too.
const MAX_S: f64 = 6553.0;
/// The fastest leg of an item, cm/s.
const FASTEST_CMS: i32 = i16::MAX as i32;

/// The reason to move a place.
const ZERO: &str = "INAV takes 0,0 for the home of the flight";

/// The items of a plan, and the differences.
#[derive(Debug, Default)]
pub(super) struct Items {
    pub(super) items: Vec<Item>,
    pub(super) findings: Vec<Finding>,
}

impl Items {
    /// Returns `true` if the plan has values that no item can hold.
    pub(super) fn is_refused(&self) -> bool {
        self.findings.iter().any(|finding| finding.severity == Severity::Refused)
    }
}

/// A modifier that waits for the next item: the index of its waypoint, and its value.
type Waiting = Option<(usize, f64)>;

struct Writer {
    form: Form,
    out: Items,
    /// The place where the leg to the next item begins.
    place: Option<LatLon>,
    /// The altitude of an ALT_CHANGE, m.
    altitude: Waiting,
    /// The duration of a DELAY, s.
    delay: Waiting,
    /// The number of waypoints that the craft passes without a stop.
    passed: usize,
}

/// Returns the items of the plan.
pub(super) fn items(file: &PlanFile, form: Form) -> Items {
    let place = file.home.map(|home| home.position);
    let mut writer = Writer { form, out: Items::default(), place, altitude: None, delay: None, passed: 0 };
    writer.file(file);
    for (index, waypoint) in file.plan.waypoints.iter().enumerate() {
        writer.waypoint(index, waypoint);
    }
    writer.drop_modifiers("no waypoint follows it");
    if writer.passed > 0 {
        let why = "INAV turns at every waypoint by its own setting";
        let finding = Finding::new(Severity::Info, "type", why);
        writer.add(finding.values(format!("{} FLYOVER or FLYBY", writer.passed), "WAYPOINT"));
    }
    if let Some(last) = writer.out.items.last_mut() {
        last.flag = LAST;
    }
    writer.out
}

impl Writer {
    fn add(&mut self, finding: Finding) {
        self.out.findings.push(finding);
    }

    /// Adds a finding about a waypoint and the item that comes next.
    fn differs(
        &mut self,
        severity: Severity,
        index: usize,
        field: &str,
        from: impl Into<String>,
        to: impl Into<String>,
        why: &str,
    ) {
        let number = self.out.items.len() + self.form.first;
        self.add(Finding::new(severity, field, why).at(index).item(number).values(from, to));
    }

    /// Adds a finding about a waypoint without an item.
    fn lost(&mut self, index: usize, field: &str, from: String, why: &str) {
        self.add(Finding::new(Severity::Lost, field, why).at(index).values(from, ""));
    }

    /// Reports everything in the file except the waypoints.
    fn file(&mut self, file: &PlanFile) {
        if let Some(HomePosition { position, amsl_m }) = file.home {
            if !self.form.has_home {
                let why = "INAV takes the place of arming";
                self.add(Finding::new(Severity::Lost, "home", why).values(position.to_string(), ""));
            } else if position != as_place(position) {
                let finding = Finding::new(Severity::Changed, "home", ZERO);
                self.add(finding.values(position.to_string(), as_place(position).to_string()));
            }
            if let Some(amsl_m) = amsl_m.filter(|_| self.form.has_home) {
                let why = "INAV measures the altitude of the home";
                let finding = Finding::new(Severity::Info, "home altitude", why);
                self.add(finding.values(format!("{amsl_m} m above sea level"), ""));
            }
        }
        if !file.settings.is_empty() {
            let why = "the settings of this plan are not those of INAV";
            let finding = Finding::new(Severity::Lost, "settings", why);
            self.add(finding.values(file.settings.len().to_string(), ""));
        }
        for (field, text) in [("name", &file.name), ("description", &file.description)] {
            if !text.is_empty() {
                self.add(Finding::new(Severity::Info, field, "INAV does not show it"));
            }
        }
    }

    fn waypoint(&mut self, index: usize, waypoint: &Waypoint) {
        let altitude_m = waypoint.altitude.above_home_m();
        match waypoint.kind {
            WaypointType::AltChange => {
                if let Some((replaced, metres)) = self.altitude.replace((index, altitude_m)) {
                    let why = "the ALT_CHANGE after it replaces it";
                    self.lost(replaced, "altitude", format!("ALT_CHANGE {metres} m"), why);
                }
            }
            WaypointType::Delay => {
                if let Some((replaced, seconds)) = self.delay.replace((index, waypoint.duration.get())) {
                    let why = "the DELAY after it replaces it";
                    self.lost(replaced, "duration", format!("DELAY {seconds} s"), why);
                }
            }
            WaypointType::YawRate => {
                let rate = format!("{} deg/s", waypoint.yaw_rate_dps);
                self.lost(index, "yaw rate", rate, "INAV limits the yaw rate by a setting only");
            }
            WaypointType::Takeoff => {
                self.drop_modifiers("the TAKEOFF after it has no item");
                let why = "INAV has no climb on the spot: take off by hand before the mission";
                self.lost(index, "type", "TAKEOFF".to_owned(), why);
            }
            WaypointType::Flyover | WaypointType::Flyby => {
                self.passed += 1;
                let item = self.item(index, waypoint, Action::Waypoint);
                let p1 = self.leg_speed(index, waypoint);
                self.push(Item { p1, ..item });
            }
            WaypointType::Hold => self.hold(index, waypoint),
            WaypointType::Land => {
                let item = self.item(index, waypoint, Action::Land);
                let mut p1 = self.leg_speed(index, waypoint);
                if !waypoint.duration.is_zero() {
                    let wait = format!("{} s", waypoint.duration.get());
                    let why = "a wait before a landing is a hold of its own";
                    self.differs(Severity::Changed, index, "duration", wait, "POSHOLD_TIME, LAND", why);
                    let seconds = self.whole_seconds(index, waypoint);
                    self.push(Item { action: Action::PosholdTime, p1: seconds, p2: p1, ..item });
                    p1 = 0;
                }
                self.push(Item { p1, ..item });
            }
        }
    }

    fn hold(&mut self, index: usize, waypoint: &Waypoint) {
        if waypoint.pattern != HoldPattern::None {
            let why = "INAV holds on the point only";
            self.differs(Severity::Lost, index, "pattern", waypoint.pattern.to_string(), "NONE", why);
        }
        if waypoint.duration.is_zero() {
            let item = self.item(index, waypoint, Action::PosholdUnlim);
            let why = "a POSHOLD_UNLIM has no leg speed";
            if let Some((delay, seconds)) = self.delay.take() {
                self.lost(delay, "duration", format!("{seconds} s"), why);
            }
            if let Some(mps) = waypoint.speed.own_mps() {
                self.differs(Severity::Changed, index, "speed", format!("{mps} m/s"), "default", why);
            }
            self.push(item);
        } else {
            let item = self.item(index, waypoint, Action::PosholdTime);
            let p2 = self.leg_speed(index, waypoint);
            let p1 = self.whole_seconds(index, waypoint);
            self.push(Item { p1, p2, ..item });
        }
    }

    fn push(&mut self, item: Item) {
        self.place = Some(item.position);
        self.out.items.push(item);
    }

    /// Returns the item of a waypoint with its place and altitude.
    fn item(&mut self, index: usize, waypoint: &Waypoint, action: Action) -> Item {
        let position = as_place(waypoint.position);
        if position != waypoint.position {
            let (from, to) = (waypoint.position.to_string(), position.to_string());
            self.differs(Severity::Changed, index, "position", from, to, ZERO);
        }
        let own_m = waypoint.altitude.above_home_m();
        let altitude_m = match self.altitude.take() {
            None => own_m,
            Some((change, metres)) => {
                let why = "INAV has no item for it: the next item has its altitude";
                self.add(
                    Finding::new(Severity::Changed, "altitude", why)
                        .at(change)
                        .item(self.out.items.len() + self.form.first)
                        .values("ALT_CHANGE", format!("{metres} m")),
                );
                metres
            }
        };
        if let Err(why) = bounds::altitude_m(altitude_m) {
            self.add(Finding::new(Severity::Refused, "altitude", why).at(index));
        }
        let alt_cm = (altitude_m * 100.0).round() as i32;
        let rounded = (altitude_m.round() * 100.0) as i32;
        if self.form.whole_metres && rounded != alt_cm {
            let why = "MW-XML has whole metres";
            let (from, to) = (format!("{altitude_m} m"), format!("{} m", rounded / 100));
            self.differs(Severity::Changed, index, "altitude", from, to, why);
        }
        let alt_cm = if self.form.whole_metres { rounded } else { alt_cm };
        Item { action, position, alt_cm, p1: 0, p2: 0, p3: 0, flag: 0 }
    }

    /// Returns the leg speed to a waypoint in cm/s; 0 is that of the craft.
    fn leg_speed(&mut self, index: usize, waypoint: &Waypoint) -> i32 {
        if let Some((delay, seconds)) = self.delay.take() {
            let leg_m = self.place.map(|place| distance_bearing(place, waypoint.position).0);
            let cms = leg_m.map_or(f64::NAN, |leg_m| (leg_m / seconds * 100.0).round());
            let number = self.out.items.len() + self.form.first;
            if cms > f64::from(IGNORED_CMS) && cms <= f64::from(FASTEST_CMS) {
                let why = "INAV has no item for it: the leg has the speed for it";
                let finding = Finding::new(Severity::Changed, "duration", why).at(delay).item(number);
                self.add(finding.values(format!("DELAY {seconds} s"), format!("{} m/s", cms / 100.0)));
                return cms as i32;
            }
            let why = match leg_m {
                None => "the leg begins at the home, and that is unknown",
                Some(_) => "no leg speed of INAV gives this time",
            };
            self.lost(delay, "duration", format!("DELAY {seconds} s"), why);
        }
        let Some(mps) = waypoint.speed.own_mps() else { return 0 };
        let cms = (mps * 100.0).round() as i32;
        let from = format!("{mps} m/s");
        if cms <= IGNORED_CMS {
            let why = "INAV ignores a leg speed up to 0.5 m/s";
            self.differs(Severity::Changed, index, "speed", from, "default", why);
            return 0;
        }
        if cms > FASTEST_CMS {
            let why = "it is the fastest leg of an item";
            self.differs(Severity::Changed, index, "speed", from, "327.67 m/s", why);
        }
        cms.min(FASTEST_CMS)
    }

    /// Returns a hold time in whole seconds, at least one: 0 s would be no stop.
    fn whole_seconds(&mut self, index: usize, waypoint: &Waypoint) -> i32 {
        let seconds = waypoint.duration.get();
        let rounded = seconds.round().clamp(1.0, MAX_S);
        if (rounded - seconds).abs() > 0.01 {
            let (from, to) = (format!("{seconds} s"), format!("{rounded} s"));
            self.differs(Severity::Changed, index, "duration", from, to, "INAV holds for whole seconds");
        }
        rounded as i32
    }

    /// Reports the modifiers that change no item.
    fn drop_modifiers(&mut self, why: &str) {
        if let Some((index, metres)) = self.altitude.take() {
            self.lost(index, "altitude", format!("ALT_CHANGE {metres} m"), why);
        }
        if let Some((index, seconds)) = self.delay.take() {
            self.lost(index, "duration", format!("DELAY {seconds} s"), why);
        }
    }
}
