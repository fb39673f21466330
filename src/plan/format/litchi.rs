//! Missions of Litchi, read only: a table with one row a waypoint.

use super::bounds::{self, Reference};
use super::csv_table::{self, Row, Table};
use super::long::hint;
use super::loss::{Finding, LossReport, Place, Severity};
use super::number::decimal;
use super::{PlanFile, Problems, ReadOptions};
use crate::geo::{Degrees7, GRAVITY};
use crate::math;
use crate::plan::estimate::Assumptions;
use crate::plan::{LegSpeed, MAX_WAYPOINTS, Seconds, Waypoint, WaypointType};

/// The columns that a file must have. All others may be missing.
const NEEDED: [&str; 3] = ["latitude", "longitude", "altitude(m)"];
/// The most actions of a waypoint.
const MAX_ACTIONS: usize = 15;
/// Two radii of a turn that differ less than this count as equal, m.
const SAME_RADIUS_M: f64 = 1.0;
/// The longest hold, s.
const MAX_S: f64 = 6553.5;

/// Returns `true` if the text begins with the header of a mission.
pub(super) fn is_header(text: &str) -> bool {
    let (columns, _) = csv_table::header(text);
    columns.iter().map(String::as_str).take(NEEDED.len()).eq(NEEDED)
}

/// Parts of a file that are no part of a plan, each with the number of rows that use it.
#[derive(Debug, Default)]
struct Unused {
    headings: usize,
    gimbal: usize,
    points_of_interest: usize,
    photos: usize,
    recordings: usize,
    tilts: usize,
    curves_of_stops: usize,
}

struct LitchiReader {
    options: ReadOptions,
    columns: Columns,
    losses: LossReport,
    waypoints: Vec<Waypoint>,
    /// The number of altitudes above ground, and the finding about them.
    above_ground: Option<(usize, Finding)>,
    unused: Unused,
}

/// The columns that are read.
struct Columns {
    latitude: Option<usize>,
    longitude: Option<usize>,
    altitude: Option<usize>,
    altitude_mode: Option<usize>,
    curve: Option<usize>,
    speed: Option<usize>,
    heading: Option<usize>,
    gimbal: Option<usize>,
    point_of_interest: [Option<usize>; 2],
    photos: [Option<usize>; 2],
    /// The type and the parameter of each action.
    actions: Vec<(Option<usize>, Option<usize>)>,
}

impl Columns {
    fn new(table: &Table<'_>) -> Self {
        let column = |name: &str| table.column(name);
        let actions = (1..=MAX_ACTIONS)
            .map(|number| (column(&format!("actiontype{number}")), column(&format!("actionparam{number}"))))
            .filter(|(kind, _)| kind.is_some());
        Self {
            latitude: column("latitude"),
            longitude: column("longitude"),
            altitude: column("altitude(m)"),
            altitude_mode: column("altitudemode"),
            curve: column("curvesize(m)"),
            speed: column("speed(m/s)"),
            heading: column("heading(deg)"),
            gimbal: column("gimbalmode"),
            point_of_interest: ["poi_latitude", "poi_longitude"].map(column),
            photos: ["photo_timeinterval", "photo_distinterval"].map(column),
            actions: actions.collect(),
        }
    }
}

/// Reads a mission.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let Some(mut table) = Table::new(text, &NEEDED, problems) else { return PlanFile::default() };
    let mut reader = LitchiReader {
        options: options.clone(),
        columns: Columns::new(&table),
        losses: LossReport::default(),
        waypoints: Vec::new(),
        above_ground: None,
        unused: Unused::default(),
    };
    let mut first = None;
    while let Some(row) = table.next_row(problems) {
        first.get_or_insert_with(|| row.span.clone());
        reader.losses.items = row.number;
        if reader.row(&row, problems).is_none() && problems.is_full() {
            break;
        }
    }
    if reader.losses.items > MAX_WAYPOINTS && !options.long && !table.is_too_long() {
        let message = format!("the mission has {} waypoints", reader.losses.items);
        problems.add(first.unwrap_or(0..0), message, hint());
    }
    reader.whole_file();
    let mut file = PlanFile { home: options.home, losses: reader.losses, ..PlanFile::default() };
    file.take(reader.waypoints);
    file
}

impl LitchiReader {
    /// Adds a finding about a row.
    fn differs(
        &mut self,
        row: &Row<'_>,
        problems: &Problems<'_>,
        severity: Severity,
        field: &str,
        (from, to): (String, String),
        why: &str,
    ) {
        let line = problems.line_at(row.span.start);
        let finding = Finding::new(severity, field, why).at(row.number - 1).item(row.number);
        self.losses.add(finding.place(Place::Line { line }).values(from, to));
    }

    /// Reads one waypoint. Returns `None` if a value is wrong.
    fn row(&mut self, row: &Row<'_>, problems: &mut Problems<'_>) -> Option<()> {
        let number =
            |column: Option<usize>, what: &str, default: Option<f64>, problems: &mut Problems<'_>| {
                row.read(column, problems, |text| match default {
                    Some(default) if text.is_empty() => Ok(default),
                    _ => decimal(what, text),
                })
            };
        let lat = number(self.columns.latitude, "latitude", None, problems)?;
        let lon = number(self.columns.longitude, "longitude", None, problems)?;
        let place = row.read(self.columns.latitude, problems, |_| bounds::position(lat, lon));
        let (position, wrapped) = place?;
        if wrapped {
            let why = "a longitude of a plan is within 180 degrees";
            let values = (lon.to_string(), Degrees7(position.lon_e7).to_string());
            self.differs(row, problems, Severity::Changed, "longitude", values, why);
        }
        let mode = number(self.columns.altitude_mode, "altitudemode", Some(0.0), problems)?;
        let reference = row.read(self.columns.altitude_mode, problems, |text| match mode {
            0.0 => Ok(Reference::Home),
            1.0 => Ok(Reference::Ground),
            _ => Err(format!("altitudemode {text} is not known, allowed: 0, 1")),
        })?;
        let metres = number(self.columns.altitude, "altitude", None, problems)?;
        let (altitude, finding) = row.read(self.columns.altitude, problems, |_| {
            reference.above_home(metres, self.options.home, self.options.flat)
        })?;
        if let Some(finding) = finding {
            self.above_ground.get_or_insert((0, finding)).0 += 1;
        }
        let mps = number(self.columns.speed, "speed", Some(0.0), problems)?;
        let speed = row.read(self.columns.speed, problems, |_| {
            let range = format!("allowed: 0 to {} m/s", LegSpeed::MAX_MPS);
            LegSpeed::checked(mps).ok_or_else(|| format!("speed {mps} is out of range; {range}"))
        })?;
        let curve_m = number(self.columns.curve, "curvesize", Some(0.0), problems)?;
        let hold_s = self.actions(row, problems)?;
        self.count_unused(row);
        let mut waypoint = Waypoint { position, altitude, speed, ..Waypoint::default() };
        if hold_s > 0.0 {
            waypoint.kind = WaypointType::Hold;
            waypoint.duration = self.hold(row, hold_s, problems);
            self.unused.curves_of_stops += usize::from(curve_m > 0.0);
        } else if curve_m > 0.0 {
            waypoint.kind = WaypointType::Flyby;
            self.curve(row, curve_m, speed, problems);
        }
        self.waypoints.push(waypoint);
        Some(())
    }

    /// Reads the actions of a row, and returns the time of its stays, s.
    fn actions(&mut self, row: &Row<'_>, problems: &mut Problems<'_>) -> Option<f64> {
        let mut stay_s = 0.0;
        for at in 0..self.columns.actions.len() {
            let (kind, parameter) = self.columns.actions[at];
            let code = row.read(kind, problems, |text| match text {
                "" => Ok(-1.0),
                text => decimal("the action", text),
            })?;
            let value = || row.value(parameter).to_owned();
            match code {
                -1.0 => {}
                0.0 => {
                    let ms = row.read(parameter, problems, |text| {
                        let ms = decimal("the stay", text)?;
                        let is_good = (0.0..=1e9).contains(&ms);
                        if is_good { Ok(ms) } else { Err(format!("a stay of {text} ms is not possible")) }
                    })?;
                    stay_s += ms / 1000.0;
                }
                1.0 => self.unused.photos += 1,
                2.0 | 3.0 => self.unused.recordings += 1,
                4.0 => {
                    let why = "the nose of the craft follows ap_yaw_mode";
                    let values = (format!("rotate to {}°", value()), String::new());
                    self.differs(row, problems, Severity::Lost, "action", values, why);
                }
                5.0 => self.unused.tilts += 1,
                _ => {
                    let values = (format!("action {code}"), String::new());
                    let why = "this action of Litchi is not known";
                    self.differs(row, problems, Severity::Lost, "action", values, why);
                }
            }
        }
        Some(stay_s)
    }

    fn hold(&mut self, row: &Row<'_>, seconds: f64, problems: &Problems<'_>) -> Seconds {
        let rounded = ((seconds * 10.0).round() / 10.0).clamp(0.1, MAX_S);
        if (rounded - seconds).abs() > 1e-6 {
            let why = "a HOLD lasts tenths of a second, up to 6553.5 s";
            let values = (format!("{seconds} s"), format!("{rounded} s"));
            self.differs(row, problems, Severity::Changed, "duration", values, why);
        }
        Seconds::new(rounded)
    }

    fn curve(&mut self, row: &Row<'_>, curve_m: f64, speed: LegSpeed, problems: &Problems<'_>) {
        let craft = Assumptions::default();
        let mps = speed.own_mps().unwrap_or(craft.max_velocity_mps);
        let radius_m = mps * mps / (GRAVITY * math::tan(craft.max_angle_deg.to_radians()));
        if (radius_m - curve_m).abs() > SAME_RADIUS_M {
            let why = "a FLYBY begins its turn at the radius of its speed";
            let values = (format!("{curve_m} m"), format!("{radius_m:.1} m"));
            self.differs(row, problems, Severity::Changed, "curve", values, why);
        }
    }

    fn count_unused(&mut self, row: &Row<'_>) {
        let Columns { heading, gimbal, point_of_interest, photos, .. } = &self.columns;
        let number = |column: Option<usize>| row.value(column).parse::<f64>().unwrap_or(0.0);
        let counted = |is_used: bool| usize::from(is_used);
        self.unused.headings += counted(number(*heading).abs() > 0.0);
        self.unused.gimbal += counted(number(*gimbal).abs() > 0.0);
        let is_point = point_of_interest.iter().any(|&column| number(column).abs() > 0.0);
        self.unused.points_of_interest += counted(is_point);
        self.unused.photos += counted(photos.iter().any(|&column| number(column) > 0.0));
    }

    /// Adds the findings about the whole file.
    fn whole_file(&mut self) {
        if let Some((count, finding)) = self.above_ground.take() {
            self.losses.add(finding.values(format!("{count} above ground"), "above home"));
        }
        let Unused { headings, gimbal, points_of_interest, photos, recordings, tilts, curves_of_stops } =
            self.unused;
        for (severity, field, count, why) in [
            (Severity::Lost, "headings", headings, "the nose of the craft follows ap_yaw_mode"),
            (Severity::Info, "gimbal modes", gimbal, "plans have no camera"),
            (Severity::Info, "points of interest", points_of_interest, "plans have no camera"),
            (Severity::Info, "photos", photos, "plans have no camera"),
            (Severity::Info, "recordings", recordings, "plans have no camera"),
            (Severity::Info, "camera tilts", tilts, "plans have no camera"),
            (Severity::Info, "curves at stays", curves_of_stops, "the craft stops there"),
        ] {
            if count > 0 {
                self.losses.add(Finding::new(severity, field, why).values(count.to_string(), ""));
            }
        }
    }
}

#[cfg(test)]
mod tests;
