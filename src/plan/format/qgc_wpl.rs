//! `QGC WPL 110`: a text with an item a line, for Mission Planner, MAVProxy and QGroundControl.

use std::fmt::Write as _;
use std::ops::Range;

use super::bounds::MAX_ITEMS;
use super::loss::{Finding, LossReport, Place, Severity};
use super::mission_item::{self, Mission, MissionItem, Sent, send, written_position};
use super::{HomePosition, PlanFile, Problems, ReadOptions, Written, home};
use crate::geo::{Degrees7, LatLon};
use crate::plan::Waypoint;
use crate::plan::estimate::Assumptions;

/// The first line of a file.
pub(super) const HEADER: &str = "QGC WPL 110";
/// The beginning of the first line in any version.
pub(super) const MARK: &str = "QGC WPL";

/// The fields of a line.
const FIELDS: [&str; 12] = [
    "sequence number",
    "current",
    "frame",
    "command",
    "parameter 1",
    "parameter 2",
    "parameter 3",
    "parameter 4",
    "latitude",
    "longitude",
    "altitude",
    "autocontinue",
];

/// An item and the bytes of its line.
struct Line {
    item: MissionItem,
    span: Range<usize>,
}

/// Reads the text and adds problems to `problems`.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let lines = lines(text, problems);
    if !problems.is_empty() {
        return PlanFile::default();
    }
    let mut losses = LossReport::default();
    let first = lines.first().filter(|line| line.item.is_home());
    let file_home = first.and_then(|line| read_home(&line.item, &mut losses));
    let before = usize::from(first.is_some());
    if before == 0 && !lines.is_empty() {
        let why = "the file does not begin with the home: its first item is a waypoint";
        losses.add(Finding::new(Severity::Assumed, "home", why));
    }
    let (spans, items): (Vec<_>, Vec<_>) =
        lines.into_iter().skip(before).map(|line| (line.span, line.item)).unzip();
    if let Some(sentence) = other_kind(&items) {
        problems.add(spans[0].clone(), sentence, "open the file of the mission");
        return PlanFile::default();
    }
    let home = mission_item::home(file_home, options);
    let assumptions = Assumptions::default();
    let mission = Mission {
        items: &items,
        home,
        assumptions: &assumptions,
        waypoint_as: options.waypoint_as,
        flat: options.flat,
    };
    let mapping = mission.map();
    for fault in mapping.faults.iter().chain(&mapping.too_many().filter(|_| !options.long)) {
        problems.add(spans[fault.item].clone(), fault.message.clone(), fault.hint.clone());
    }
    losses.items = items.len();
    losses.findings.extend(mapping.findings);
    let mut file = PlanFile { home, losses, ..PlanFile::default() };
    file.take(mapping.waypoints.into_iter().map(|(waypoint, _)| waypoint));
    file
}

/// Reads the lines. Comments and empty lines are skipped.
fn lines(text: &str, problems: &mut Problems<'_>) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut begin = 0;
    let mut has_header = false;
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let start = begin + (line.len() - line.trim_start().len());
        begin += line.len();
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let span = start..start + line.len();
        if !has_header {
            if let Err((message, hint)) = check_header(line) {
                problems.add(span, message, hint);
                return lines;
            }
            has_header = true;
            continue;
        }
        if lines.len() > MAX_ITEMS {
            problems.add(span, format!("the file has more than {MAX_ITEMS} items"), "");
            return lines;
        }
        lines.extend(read_line(line, index + 1, span, problems));
    }
    if !has_header {
        problems.add(0..0, "the text is empty", format!("the first line is {HEADER}"));
    }
    lines
}

fn check_header(line: &str) -> Result<(), (String, String)> {
    let hint = format!("the first line is {HEADER}");
    let words: Vec<&str> = line.split_whitespace().take(5).collect();
    match words[..] {
        ["QGC", "WPL", "110"] => Ok(()),
        ["QGC", "WPL", "PB", version] => {
            Err((format!("QGC WPL PB {version} is a format of another program, which is not read"), hint))
        }
        ["QGC", "WPL", version] => Err((
            format!("QGC WPL {version} is an old format with other command numbers, which is not read"),
            hint,
        )),
        _ => Err(("this is not a waypoint file".to_owned(), hint)),
    }
}

fn read_line(line: &str, number: usize, span: Range<usize>, problems: &mut Problems<'_>) -> Option<Line> {
    let fields: Vec<&str> = line.split_whitespace().take(FIELDS.len() + 1).collect();
    if fields.len() != FIELDS.len() {
        let count = line.split_whitespace().count();
        let fields = if count == 1 { "field" } else { "fields" };
        problems.add(span, format!("the line has {count} {fields}"), "an item has 12 fields");
        return None;
    }
    let mut values = [0.0; FIELDS.len()];
    let mut is_right = true;
    for (at, (value, field)) in values.iter_mut().zip(&fields).enumerate() {
        match parse(field, (4..8).contains(&at)) {
            Ok(number) => *value = number,
            Err((message, hint)) => {
                // The field is a part of the line.
                let start = span.start + (field.as_ptr() as usize - line.as_ptr() as usize);
                problems.add(start..start + field.len(), format!("{} {field} {message}", FIELDS[at]), hint);
                is_right = false;
            }
        }
    }
    let whole = |at: usize| {
        let value: f64 = values[at];
        (value.fract() == 0.0 && (0.0..=65535.0).contains(&value)).then_some(value as u16)
    };
    let (Some(sequence), Some(frame), Some(command)) = (whole(0), whole(2), whole(3)) else {
        let wrong = [0, 2, 3].into_iter().find(|&at| whole(at).is_none()).unwrap_or(0);
        let message = format!("{} {} is out of range", FIELDS[wrong], values[wrong]);
        problems.add(span, message, "allowed: 0 to 65535");
        return None;
    };
    let param = |at: usize| Some(values[at]).filter(|value: &f64| !value.is_nan());
    let item = MissionItem {
        number: usize::from(sequence),
        command,
        frame,
        params: [param(4), param(5), param(6), param(7)],
        lat_deg: Some(values[8]),
        lon_deg: Some(values[9]),
        altitude_m: Some(values[10]),
        autocontinue: values[11] != 0.0,
        place: Some(Place::Line { line: number }),
    };
    is_right.then_some(Line { item, span })
}

/// Reads a number. A parameter that is not given may be `nan`.
fn parse(field: &str, may_be_nan: bool) -> Result<f64, (&'static str, &'static str)> {
    match field.parse::<f64>() {
        Ok(number) if number.is_finite() || (may_be_nan && number.is_nan()) => Ok(number),
        Ok(_) => Err(("is not a finite number", "")),
        Err(_) if field.contains(',') => Err(("has a decimal comma", "write numbers with a decimal point")),
        Err(_) => Err(("is not a number", "")),
    }
}

/// Reads the home item. The home of a file without one is 0,0.
fn read_home(item: &MissionItem, losses: &mut LossReport) -> Option<HomePosition> {
    home::of_file(item.lat_deg?, item.lon_deg?, item.altitude_m, item.place.as_ref(), losses)
}

/// Returns the sentence for a file of ArduPilot with the same first line that has no mission.
fn other_kind(items: &[MissionItem]) -> Option<&'static str> {
    if items.is_empty() {
        None
    } else if items.iter().all(MissionItem::is_rally) {
        Some("this is a list of rally points, not a plan")
    } else if items.iter().all(|item| item.is_fence() || item.is_rally()) {
        Some("this is a fence, not a plan")
    } else {
        None
    }
}

/// Writes a plan. A plan without a home is refused.
pub(super) fn write(file: &PlanFile) -> Written {
    let Some(home) = file.home else {
        let why = "a waypoint file begins with the home: give the plan one, or `convert` one by --home LAT,LON,AMSL";
        return refused(vec![Finding::new(Severity::Refused, "home", why)]);
    };
    let assumptions = Assumptions::from_settings(&file.settings);
    let (position, moved) = written_position(home.position);
    let sent = send(&file.plan.waypoints, position, &assumptions, false);
    let mut losses = LossReport { items: sent.items.len(), ..LossReport::default() };
    let text = text(position, home.amsl_m.unwrap_or(0.0), &sent);
    losses.findings = sent.findings;
    if losses.worst() == Some(Severity::Refused) {
        return refused(losses.findings);
    }
    if moved {
        let why = "0,0 means that there is no home";
        losses.add(Finding::new(Severity::Changed, "home", why).values("0,0", position.to_string()));
    }
    if home.amsl_m.is_none() {
        let why = "the altitude of the home above sea level is unknown: add --home LAT,LON,AMSL";
        losses.add(Finding::new(Severity::Changed, "home altitude", why).values("unknown", "0 m"));
    }
    let why = "a waypoint file has items only";
    losses.add(Finding::new(Severity::Info, "name", why).values(file.name.clone(), ""));
    if !file.description.is_empty() {
        losses.add(Finding::new(Severity::Info, "description", why));
    }
    if !file.settings.is_empty() {
        let count = file.settings.len();
        let settings = if count == 1 { "setting" } else { "settings" };
        losses.add(Finding::new(Severity::Lost, "settings", why).values(format!("{count} {settings}"), ""));
    }
    Written { contents: text.into_bytes(), losses }
}

/// Returns the index of the waypoint of each item that a waypoint file has after its home.
pub fn item_sources(waypoints: &[Waypoint], home: LatLon) -> Vec<usize> {
    send(waypoints, written_position(home).0, &Assumptions::default(), false).sources
}

fn refused(findings: Vec<Finding>) -> Written {
    Written { contents: Vec::new(), losses: LossReport { findings, ..LossReport::default() } }
}

fn text(home: LatLon, amsl_m: f64, sent: &Sent) -> String {
    let (lat, lon) = (Degrees7(home.lat_e7), Degrees7(home.lon_e7));
    let mut text = format!("{HEADER}\n0\t1\t0\t16\t0\t0\t0\t0\t{lat}\t{lon}\t{amsl_m:.6}\t1\n");
    for item in &sent.items {
        let MissionItem { number, command, frame, params, .. } = item;
        let [p1, p2, p3, p4] = params.map(|param| short(param.unwrap_or(0.0)));
        let position = LatLon::from_degrees(item.lat_deg.unwrap_or(0.0), item.lon_deg.unwrap_or(0.0));
        let (lat, lon) = (Degrees7(position.lat_e7), Degrees7(position.lon_e7));
        let altitude = item.altitude_m.unwrap_or(0.0);
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{number}\t0\t{frame}\t{command}\t{p1}\t{p2}\t{p3}\t{p4}\t{lat}\t{lon}\t{altitude:.6}\t1"
        );
    }
    text
}

/// Returns a number with at most six decimals, without an exponent.
fn short(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests;
