//! The waypoints of a plan as a table: `type,lat_deg,lon_deg,alt_m,speed_mps,duration_s,pattern`. A plan with a
//! YAW_RATE has the column `yaw_rate_dps`, too.

use super::csv_table::{self, Row, Table};
use super::long::hint;
use super::loss::{Finding, LossReport, Place, Severity};
use super::number::decimal;
use super::{PlanFile, Problems, ReadOptions, Written, bounds, field};
use crate::geo::Degrees7;
use crate::plan::{Altitude, LegSpeed, MAX_WAYPOINTS, Seconds, Waypoint, WaypointType};

/// The columns, in the order in which they are written.
const COLUMNS: [&str; 7] = ["type", "lat_deg", "lon_deg", "alt_m", "speed_mps", "duration_s", "pattern"];
/// The columns that a file must have.
const NEEDED: [&str; 4] = ["type", "lat_deg", "lon_deg", "alt_m"];
/// The column that is written only if a waypoint needs it.
const YAW_RATE: &str = "yaw_rate_dps";
/// The longest duration, s.
const MAX_S: f64 = 6553.5;

/// Returns `true` if the text begins with the header of a table of waypoints.
pub(super) fn is_header(text: &str) -> bool {
    let (columns, _) = csv_table::header(text);
    NEEDED.iter().all(|name| columns.iter().any(|column| column == name))
}

/// Reads a table.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let Some(mut table) = Table::new(text, &NEEDED, problems) else { return PlanFile::default() };
    let columns = COLUMNS.map(|name| table.column(name));
    let mut reader = TableReader { columns, yaw_rate: table.column(YAW_RATE), losses: LossReport::default() };
    let unknown: Vec<&str> = table
        .columns()
        .iter()
        .map(String::as_str)
        .filter(|name| !name.is_empty() && !COLUMNS.contains(name) && *name != YAW_RATE)
        .collect();
    if !unknown.is_empty() {
        let why = "a plan has no such values";
        reader.losses.add(Finding::new(Severity::Info, "columns", why).values(unknown.join(", "), ""));
    }
    let mut waypoints = Vec::new();
    let mut too_many = None;
    while let Some(row) = table.next_row(problems) {
        let waypoint = reader.waypoint(&row, problems);
        if waypoints.len() == MAX_WAYPOINTS {
            too_many = Some(row.span.clone());
        }
        waypoints.push(waypoint.unwrap_or_default());
        reader.losses.items = row.number;
        if problems.is_full() {
            break;
        }
    }
    if let Some(span) = too_many.filter(|_| !options.long && !table.is_too_long()) {
        problems.add(span, format!("the table has {} waypoints", reader.losses.items), hint());
    }
    let mut file = PlanFile { home: options.home, losses: reader.losses, ..PlanFile::default() };
    file.take(waypoints);
    file
}

struct TableReader {
    columns: [Option<usize>; COLUMNS.len()],
    yaw_rate: Option<usize>,
    losses: LossReport,
}

impl TableReader {
    fn differs(
        &mut self,
        row: &Row<'_>,
        problems: &Problems<'_>,
        field: &str,
        from: &str,
        to: &str,
        why: &str,
    ) {
        let finding = Finding::new(Severity::Changed, field, why).at(row.number - 1).item(row.number);
        let line = problems.line_at(row.span.start);
        self.losses.add(finding.place(Place::Line { line }).values(from, to));
    }

    fn waypoint(&mut self, row: &Row<'_>, problems: &mut Problems<'_>) -> Option<Waypoint> {
        let [kind, lat, lon, altitude, speed, duration, pattern] = self.columns;
        let words = |error: field::FieldError| format!("{}; {}", error.message, error.hint);
        let kind = row.read(kind, problems, |text| match text {
            "" => Err("the type is missing".to_owned()),
            text => field::waypoint_type(text).map_err(words),
        })?;
        let uses = kind.capability();
        // A cell may be empty if its value has no meaning.
        let number = |what: &'static str, needed: bool| {
            move |text: &str| if text.is_empty() && !needed { Ok(0.0) } else { decimal(what, text) }
        };
        let lat_deg = row.read(lat, problems, number("latitude", uses.place));
        let lon_deg = row.read(lon, problems, number("longitude", uses.place));
        let altitude = row.read(altitude, problems, |text| {
            let metres = number("altitude", uses.altitude)(text)?;
            if uses.altitude {
                return bounds::altitude_m(metres).map(Altitude::above_home);
            }
            Altitude::checked(metres).ok_or_else(|| format!("altitude {metres} is out of range"))
        });
        let speed = row.read(speed, problems, |text| {
            let mps = number("speed", false)(text)?;
            let range = format!("allowed: 0 to {} m/s", LegSpeed::MAX_MPS);
            LegSpeed::checked(mps).ok_or_else(|| format!("speed {mps} is out of range; {range}"))
        });
        let seconds = row.read(duration, problems, |text| {
            let seconds = number("duration", false)(text)?;
            let range = format!("allowed: 0 to {MAX_S} s");
            let is_good = (0.0..=MAX_S).contains(&seconds);
            if is_good { Ok(seconds) } else { Err(format!("duration {seconds} is out of range; {range}")) }
        });
        let pattern = row.read(pattern, problems, |text| match text {
            "" => Ok(Default::default()),
            text => field::pattern(text).map_err(words),
        });
        let yaw_rate_dps = self.yaw_rate(row, kind, problems);
        let place = row.read(lat.filter(|_| lat_deg.is_some()), problems, |_| {
            bounds::position(lat_deg.unwrap_or_default(), lon_deg.unwrap_or_default())
        });
        let (position, wrapped) = place?;
        if wrapped {
            let (from, to) = (lon_deg?.to_string(), Degrees7(position.lon_e7).to_string());
            let why = "a longitude of a plan is within 180 degrees";
            self.differs(row, problems, "longitude", &from, &to, why);
        }
        let (speed, seconds) = (speed?, seconds?);
        if kind.has_yaw_rate() && speed.own_mps().is_some() {
            let message = format!("a YAW_RATE has no speed, its rate is in the column {YAW_RATE}");
            problems.add(row.place(self.columns[4]), message, "");
        }
        let mut duration = Seconds::new(seconds);
        if duration.is_zero() && seconds > 0.0 {
            duration = Seconds::new(0.1);
            let from = format!("{seconds} s");
            self.differs(row, problems, "duration", &from, "0.1 s", "a duration of 0 is endless");
        }
        Some(Waypoint {
            position,
            altitude: altitude?,
            speed,
            yaw_rate_dps: yaw_rate_dps?,
            duration,
            kind,
            pattern: pattern?,
        })
    }

    fn yaw_rate(&self, row: &Row<'_>, kind: WaypointType, problems: &mut Problems<'_>) -> Option<u16> {
        row.read(self.yaw_rate, problems, |text| match (kind.has_yaw_rate(), text) {
            (true, "") => Err(format!("a YAW_RATE needs the column {YAW_RATE}")),
            (false, "" | "0") => Ok(0),
            (false, _) => Err(format!("{YAW_RATE} {text} belongs to a YAW_RATE only")),
            (true, text) => {
                let rate = decimal(YAW_RATE, text)?;
                let is_good = rate.fract() == 0.0 && (0.0..=f64::from(u16::MAX)).contains(&rate);
                let range = "allowed: whole numbers, 0 to 65535 degrees/s";
                if is_good { Ok(rate as u16) } else { Err(format!("{YAW_RATE} {text}; {range}")) }
            }
        })
    }
}

/// Writes a table.
pub(super) fn write(file: &PlanFile) -> Written {
    let mut losses = LossReport { items: file.plan.waypoints.len(), ..LossReport::default() };
    let why = "a table has the waypoints only";
    for (field, text) in [("name", &file.name), ("description", &file.description)] {
        if !text.is_empty() {
            losses.add(Finding::new(Severity::Info, field, why));
        }
    }
    if let Some(home) = file.home {
        losses.add(Finding::new(Severity::Lost, "home", why).values(home.to_string(), ""));
    }
    if !file.settings.is_empty() {
        let count = file.settings.len().to_string();
        losses.add(Finding::new(Severity::Lost, "settings", why).values(count, ""));
    }
    let has_yaw_rate = file.plan.waypoints.iter().any(|waypoint| waypoint.kind.has_yaw_rate());
    let mut text = COLUMNS.join(",");
    if has_yaw_rate {
        text.push_str(&format!(",{YAW_RATE}"));
    }
    text.push('\n');
    for (index, waypoint) in file.plan.waypoints.iter().enumerate() {
        let Waypoint { position, altitude, speed, yaw_rate_dps, duration, kind, pattern } = waypoint;
        if let Err(why) = bounds::altitude_m(altitude.above_home_m())
            && kind.capability().altitude
        {
            losses.add(Finding::new(Severity::Refused, "altitude", why).at(index));
        }
        let (lat, lon) = (Degrees7(position.lat_e7), Degrees7(position.lon_e7));
        let (altitude, speed, duration) = (altitude.above_home_m(), speed.mps(), duration.get());
        text.push_str(&format!("{kind},{lat},{lon},{altitude},{speed},{duration},{pattern}"));
        match (has_yaw_rate, kind.has_yaw_rate()) {
            (false, _) => {}
            (true, false) => text.push(','),
            (true, true) => text.push_str(&format!(",{yaw_rate_dps}")),
        }
        text.push('\n');
    }
    if losses.worst() == Some(Severity::Refused) {
        text.clear();
    }
    Written { contents: text.into_bytes(), losses }
}

#[cfg(test)]
mod tests;
