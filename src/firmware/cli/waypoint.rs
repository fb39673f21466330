//! The `waypoint` family: the stored flight plan as text.

use std::str::FromStr as _;

use strum::IntoEnumIterator as _;

use super::CliAction;
use super::session::{Session, integer};
use crate::geo::{Degrees7, LatLon};
use crate::plan::{
    AltitudeReference, CraftPlan, FlightPlan, HoldPattern, MAX_WAYPOINTS, Records, Waypoint, WaypointRecord,
    WaypointType, record_lines,
};
use crate::telemetry::{FirmwareProfile, NavState, Refusal};

/// `waypoint [list|status|insert|update|remove|clear]`.
pub(super) fn waypoint(session: &mut Session<'_>, rest: &str) {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    let (operation, arguments) =
        words.split_first().map_or(("list", [].as_slice()), |(word, rest)| (*word, rest));
    match operation.to_ascii_lowercase().as_str() {
        "list" | "status" | "clear" if !arguments.is_empty() => session.wrong_count(),
        "list" => list(session),
        "status" => status(session),
        "clear" => clear(session),
        "insert" => edit(session, arguments, Edit::Insert),
        "update" => edit(session, arguments, Edit::Update),
        "remove" => remove(session, arguments),
        _ => session.error("INVALID OPERATION. USE: list, status, insert, update, remove, clear"),
    }
}

fn clear(session: &mut Session<'_>) {
    session.configuration.plan.waypoints.clear();
    session.line("Waypoints cleared");
    session.act(CliAction::PlanChanged);
}

/// Stores a plan as `waypoint clear` and `waypoint insert` do, up to the first waypoint that is refused.
pub(super) fn store(session: &mut Session<'_>, records: &Records) {
    clear(session);
    for (index, record) in records.iter().enumerate() {
        if let Err(text) = check_place(record.position) {
            session.error(text);
            return;
        }
        put(session, Edit::Insert, index, (*record).into());
    }
}

fn list(session: &mut Session<'_>) {
    for line in lines(session) {
        session.line(line);
    }
}

/// Returns the lines that rebuild the stored plan, in the reference of the profile.
pub(super) fn lines(session: &Session<'_>) -> Vec<String> {
    record_lines(for_craft(session, &session.configuration.plan)).collect()
}

/// Returns the reference of waypoint altitudes in commands: that of the profile.
fn reference(session: &Session<'_>) -> AltitudeReference {
    match session.configuration.settings.profile() {
        FirmwareProfile::Guide => AltitudeReference::Home,
        FirmwareProfile::Master => AltitudeReference::SeaLevel { home_m: Some(session.facts.site_alt_m) },
    }
}

/// Returns the records of a plan in the reference of the profile.
fn for_craft(session: &Session<'_>, plan: &FlightPlan) -> Records {
    reference(session).plan_for_craft(plan).map(|plan| plan.records).unwrap_or_default()
}

/// Returns the waypoint that a record in the reference of the profile describes.
fn of_craft(session: &Session<'_>, record: WaypointRecord) -> Waypoint {
    let plan = CraftPlan { records: [record].into_iter().collect() };
    let plan = reference(session).plan_of_craft(&plan).unwrap_or_default();
    plan.waypoints.first().copied().unwrap_or_default()
}

/// Formats centimetres as metres with two decimals.
fn metres(cm: i32) -> String {
    let sign = if cm < 0 { "-" } else { "" };
    let size = cm.unsigned_abs();
    format!("{sign}{}.{:02}m", size / 100, size % 100)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Edit {
    Insert,
    Update,
}

fn edit(session: &mut Session<'_>, arguments: &[&str], edit: Edit) {
    let &[index, lat, lon, alt, speed, kind, duration, pattern] = arguments else {
        session.wrong_count();
        return;
    };
    let count = session.configuration.plan.waypoints.len();
    if edit == Edit::Update && count == 0 {
        session.error("NO WAYPOINTS TO UPDATE");
        return;
    }
    let Some(index) = integer(index) else {
        session.error("INVALID INDEX");
        return;
    };
    if edit == Edit::Insert && count >= MAX_WAYPOINTS {
        session.error("WAYPOINT LIST FULL");
        return;
    }
    let last = if edit == Edit::Insert { count } else { count - 1 };
    let Some(index) = usize::try_from(index).ok().filter(|index| *index <= last) else {
        session.error(format_args!("index NOT BETWEEN 0 AND {last}"));
        return;
    };
    let record = match read([lat, lon, alt, speed, kind, duration, pattern]) {
        Ok(record) => record,
        Err(text) => {
            session.error(text);
            return;
        }
    };
    let waypoint = of_craft(session, record);
    put(session, edit, index, waypoint);
}

/// Stores a waypoint. There is room for it, and the index is in range.
fn put(session: &mut Session<'_>, edit: Edit, index: usize, waypoint: Waypoint) {
    let waypoints = &mut session.configuration.plan.waypoints;
    let word = match edit {
        Edit::Insert => {
            waypoints.insert(index, waypoint);
            "insert"
        }
        Edit::Update => {
            if let Some(place) = waypoints.get_mut(index) {
                *place = waypoint;
            }
            "update"
        }
    };
    let plan = FlightPlan { waypoints: [waypoint].into_iter().collect() };
    if let Some(record) = for_craft(session, &plan).first() {
        session.line(format_args!("waypoint {word} {index} {}", record.values(metres(record.alt_cm))));
    }
    session.act(CliAction::PlanChanged);
}

/// Parses the fields after the index. The order of the checks decides the error text for a line with several faults.
fn read(fields: [&str; 7]) -> Result<WaypointRecord, String> {
    let [lat, lon, alt, speed, kind, duration, pattern] = fields;
    let lat_e7 = degrees(lat).ok_or("INVALID LATITUDE FORMAT. USE: -90.0000000 to 90.0000000")?;
    let lon_e7 = degrees(lon).ok_or("INVALID LONGITUDE FORMAT. USE: -180.0000000 to 180.0000000")?;
    let alt = integer(alt).ok_or("INVALID ALTITUDE")?;
    let alt_cm = i32::try_from(alt).map_err(|_| "ALTITUDE OUT OF RANGE")?;
    let speed = integer(speed).ok_or("INVALID SPEED")?;
    let duration = integer(duration).ok_or("INVALID DURATION")?;
    let speed = u16::try_from(speed).map_err(|_| "speed NOT BETWEEN 0 AND 65535")?;
    let duration_ds = u16::try_from(duration).map_err(|_| "duration NOT BETWEEN 0 AND 65535")?;
    let kind = WaypointType::from_str(kind).map_err(|_| {
        let types: Vec<&str> = WaypointType::iter().map(Into::into).collect();
        format!("INVALID TYPE. USE: {}", types.join(", "))
    })?;
    let pattern = HoldPattern::from_str(pattern).map_err(|_| "INVALID PATTERN. USE: NONE, ORBIT, FIGURE8")?;
    let position = LatLon::new(lat_e7, lon_e7);
    check_place(position)?;
    Ok(WaypointRecord { position, alt_cm, speed, duration_ds, kind, pattern })
}

fn check_place(position: LatLon) -> Result<(), &'static str> {
    if !LatLon::new(position.lat_e7, 0).is_on_globe() {
        return Err("LATITUDE OUT OF RANGE. USE: -90.0 to 90.0");
    }
    if !LatLon::new(0, position.lon_e7).is_on_globe() {
        return Err("LONGITUDE OUT OF RANGE. USE: -180.0 to 180.0");
    }
    Ok(())
}

/// Parses decimal degrees as degrees × 10⁷. Decimals beyond the seventh are cut, not rounded.
fn degrees(text: &str) -> Option<i32> {
    const DECIMALS: usize = 7;
    let (negative, digits) = match text.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let (whole, decimals) = digits.split_once('.').unwrap_or((digits, ""));
    let all_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    if whole.is_empty() || !all_digits(whole) || !all_digits(decimals) {
        return None;
    }
    let padded = decimals.bytes().chain(std::iter::repeat(b'0')).take(DECIMALS);
    let size = whole
        .bytes()
        .chain(padded)
        .fold(0_i64, |sum, digit| sum.saturating_mul(10).saturating_add(i64::from(digit - b'0')));
    let size = i32::try_from(size).ok()?;
    Some(if negative { -size } else { size })
}

fn remove(session: &mut Session<'_>, arguments: &[&str]) {
    let &[index] = arguments else {
        session.wrong_count();
        return;
    };
    let waypoints = &mut session.configuration.plan.waypoints;
    let count = waypoints.len();
    if count == 0 {
        session.error("NO WAYPOINTS TO REMOVE");
        return;
    }
    let Some(index) = integer(index) else {
        session.error("INVALID INDEX");
        return;
    };
    let removed = usize::try_from(index).ok().and_then(|index| waypoints.pop_at(index));
    if removed.is_none() {
        session.error(format_args!("index NOT BETWEEN 0 AND {}", count - 1));
        return;
    }
    session.line(format_args!("Waypoint {index} removed, {} waypoints remaining", count - 1));
    session.act(CliAction::PlanChanged);
}

/// Prints the plan being flown, or the stored one, and the state of the navigator.
fn status(session: &mut Session<'_>) {
    let facts = session.facts;
    let plan = facts.nav.active_plan.as_ref().unwrap_or(&session.configuration.plan).clone();
    session.line(format_args!("Waypoint count: {}", plan.waypoints.len()));
    if !plan.waypoints.is_empty() {
        session.raw("\n");
        session.line("Configured waypoints:");
        for (at, record) in for_craft(session, &plan).iter().enumerate() {
            session.line(format_args!(
                "  [{at}] {} {} {} {}",
                Degrees7(record.position.lat_e7),
                Degrees7(record.position.lon_e7),
                metres(record.alt_cm),
                record.kind
            ));
        }
    }
    session.raw("\n");
    session.line("Runtime status:");
    let nav = &facts.nav.telemetry;
    let profile = session.configuration.settings.profile();
    let state = |is_aborted| profile.state_word(nav.state, is_aborted);
    if let (NavState::Idle, Some(Refusal::Aborted(reason))) = (nav.state, nav.refusal) {
        session.line(format_args!("  state: {}", state(true)));
        session.line(format_args!("  abort reason: {}", reason.to_string().replace('_', " ")));
        return;
    }
    if nav.state == NavState::Idle {
        session.line("  inactive");
        if let Some(refusal) = facts.nav.refusal {
            session.line(format_args!("  refused: {}", refusal.sentence()));
        }
        return;
    }
    session.line(format_args!("  state: {}", state(false)));
    session.line(format_args!("  current waypoint: {}/{}", u16::from(nav.wp) + 1, nav.count));
    if nav.state == NavState::Complete {
        return;
    }
    if let (Some(distance), Some(bearing)) = (nav.distance_m, nav.bearing_rad) {
        let bearing = bearing.to_degrees().round().rem_euclid(360.0).abs();
        session.raw(format_args!("  distance: {distance:.2}m  bearing: {bearing:.0} deg"));
        if let Some(eta) = nav.eta_s {
            session.raw(format_args!("  eta: {eta:.0}s"));
        }
        session.line("");
    }
}
