//! Our own data in the files of maps: the keys of our TOML with their values as text.

use super::field::{self, FieldError};
use super::loss::{Finding, LossReport, Severity};
use super::map_file::Properties;
use super::native_read::{altitude_cm, duration_ds, speed_cms, yaw_rate};
use super::native_write::scaled;
use super::{HomePosition, PlanFile, home};
use crate::geo::{Degrees7, LatLon, offset_to_latlon};
use crate::math;
use crate::plan::record::WaypointRecord;
use crate::plan::{HoldPattern, Waypoint, WaypointType};
use nalgebra::Vector2;

/// The type of the point of home.
pub(super) const HOME: &str = "HOME";
/// The version of our data.
pub(super) const VERSION: &str = "1";
/// The number of points of a fence.
const FENCE_POINTS: u32 = 72;
/// The largest altitude that readers take, m.
const MAX_ALTITUDE_M: f64 = 20_000.0;

/// Returns the values of a record, the type first. Leaves out those that are the default for its type. The place of a
/// waypoint that is a place is that of its shape.
pub(super) fn values(record: WaypointRecord) -> Vec<(&'static str, String)> {
    let WaypointRecord { position, alt_cm, speed, duration_ds, kind, pattern } = record;
    let uses = kind.capability();
    let mut values = vec![("type", kind.to_string())];
    if !uses.place && position != LatLon::default() {
        values.push(("lat_deg", Degrees7(position.lat_e7).to_string()));
        values.push(("lon_deg", Degrees7(position.lon_e7).to_string()));
    }
    if uses.altitude || alt_cm != 0 {
        values.push(("alt_m", scaled(i64::from(alt_cm), 2)));
    }
    if kind.has_yaw_rate() {
        values.push(("yaw_rate_dps", speed.to_string()));
    } else if speed != 0 {
        values.push(("speed_mps", scaled(i64::from(speed), 2)));
    }
    // Without a value, a reader could not know whether the data of the point are there.
    if duration_ds != 0 || kind == WaypointType::Delay {
        values.push(("duration_s", scaled(i64::from(duration_ds), 1)));
    }
    if pattern != HoldPattern::None {
        values.push(("pattern", pattern.to_string()));
    }
    values
}

/// Returns the type that the properties give a waypoint of ours.
pub(super) fn own_type(properties: &Properties) -> Option<WaypointType> {
    let word = properties.get("type")?;
    // `Land` is a word of other programs, too.
    word.parse().ok().filter(|kind: &WaypointType| kind.to_string() == word)
}

/// Returns `true` if properties have data of a waypoint of ours beside its type.
pub(super) fn has_data(properties: &Properties) -> bool {
    let keys = ["alt_m", "speed_mps", "yaw_rate_dps", "duration_s", "pattern"];
    keys.into_iter().any(|key| properties.get(key).is_some())
}

/// Returns the record of our properties. A waypoint that is a place has that of its shape.
///
/// # Errors
///
/// Returns the message for a value that cannot be read, or is missing.
pub(super) fn record(
    properties: &Properties,
    kind: WaypointType,
    place: Option<LatLon>,
) -> Result<WaypointRecord, FieldError> {
    fn read<T: Default>(
        properties: &Properties,
        key: &str,
        read: fn(&str) -> Result<T, FieldError>,
    ) -> Result<T, FieldError> {
        properties.get(key).map_or(Ok(T::default()), read)
    }
    let position = match place {
        Some(place) if kind.uses_position() => place,
        None if kind.uses_position() => {
            let message = format!("a {kind} waypoint has no place");
            return Err(FieldError { message, hint: "it needs a point".to_owned() });
        }
        _ => LatLon::new(
            read(properties, "lat_deg", field::latitude)?,
            read(properties, "lon_deg", field::longitude)?,
        ),
    };
    Ok(WaypointRecord {
        position,
        alt_cm: read(properties, "alt_m", altitude_cm)?,
        speed: if kind.has_yaw_rate() {
            read(properties, "yaw_rate_dps", yaw_rate)?
        } else {
            read(properties, "speed_mps", speed_cms)?
        },
        duration_ds: read(properties, "duration_s", duration_ds)?,
        kind,
        pattern: read(properties, "pattern", field::pattern)?,
    })
}

/// Returns the altitude of home in our properties.
///
/// # Errors
///
/// Returns the message for a value that is not an altitude of home.
pub(super) fn home_amsl(properties: &Properties) -> Result<Option<f64>, FieldError> {
    let read = |text: &str| {
        home::amsl_m(text).map_err(|message| FieldError { message, hint: home::AMSL_HINT.to_owned() })
    };
    properties.get("alt_amsl_m").map(read).transpose()
}

/// Returns the points of the fence around home, counter-clockwise, the first one also at the end.
pub(super) fn fence(file: &PlanFile) -> Option<(f64, Vec<LatLon>)> {
    let radius = |line: &String| {
        line.strip_prefix("ap_max_distance_from_home = ").and_then(|value| value.parse::<f64>().ok())
    };
    let radius_m =
        file.settings.iter().rev().find_map(radius).filter(|&radius| radius > 0.0 && radius < 1e5)?;
    let home = file.home?.position;
    let point = |step: u32| {
        let bearing = -f64::from(step % FENCE_POINTS) * std::f64::consts::TAU / f64::from(FENCE_POINTS);
        offset_to_latlon(home, Vector2::new(math::cos(bearing), math::sin(bearing)) * radius_m)
    };
    Some((radius_m, (0..=FENCE_POINTS).map(point).collect()))
}

/// Returns the altitude of a waypoint above sea level, m, if files may have it.
pub(super) fn amsl_m(home: Option<HomePosition>, waypoint: &Waypoint) -> Option<f64> {
    let amsl = home?.amsl_m? + waypoint.altitude.above_home_m();
    (amsl.abs() <= MAX_ALTITUDE_M).then_some(amsl)
}

/// Returns the altitude of a waypoint above home, m, if files may have it.
pub(super) fn above_home_m(waypoint: &Waypoint) -> Option<f64> {
    let metres = waypoint.altitude.above_home_m();
    (metres.abs() <= MAX_ALTITUDE_M).then_some(metres)
}

/// Returns the waypoints that are a place, in flight order.
pub(super) fn places(file: &PlanFile) -> impl Iterator<Item = &Waypoint> {
    file.plan.waypoints.iter().filter(|waypoint| waypoint.kind.uses_position())
}

/// Returns a number with at most two decimals.
pub(super) fn metres(metres: f64) -> String {
    scaled((metres * 100.0).round() as i64, 2)
}

/// Returns the report for a written plan with what no map carries for other programs.
pub(super) fn losses(file: &PlanFile, fence_as: &str) -> LossReport {
    let mut losses = LossReport { items: file.plan.waypoints.len(), ..LossReport::default() };
    let why =
        "other programs show points and a line: types, speeds and times are data that only betadeck reads";
    losses.add(Finding::new(Severity::Info, "waypoint types", why));
    if let Some((radius_m, _)) = fence(file) {
        let why = "other programs show the fence and do not guard it";
        losses.add(Finding::new(Severity::Info, "fence", why).values(format!("{radius_m} m"), fence_as));
    }
    losses
}

/// Returns the name for XML. A name of blanks would be read as none.
pub(super) fn xml_name(file: &PlanFile) -> &str {
    if super::xml::carried(&file.name).is_empty() { "plan" } else { &file.name }
}

/// Adds a finding for each text that XML cannot hold as it is.
pub(super) fn add_text_losses(file: &PlanFile, losses: &mut LossReport) {
    let texts = [("name", &file.name), ("description", &file.description)];
    let settings = file.settings.iter().map(|line| ("settings", line));
    for (field, text) in texts.into_iter().chain(settings) {
        if super::xml::carried(text) != *text {
            let why = "XML holds no control characters, and no blanks at the ends of a text";
            losses.add(Finding::new(Severity::Changed, field, why));
        }
    }
}
