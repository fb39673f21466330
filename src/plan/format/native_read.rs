//! The reader of the project's own format: TOML with units in the key names. It refuses unknown keys and finds all
//! problems in one pass.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::field::{self, FieldError};
use super::home::{self, HomePosition};
use super::long::hint;
use super::setting::{SettingCheck, SettingPart, setting_line};
use super::toml_table::{TomlTable, Value};
use super::{PlanFile, Problems, ReadOptions};
use crate::geo::LatLon;
use crate::plan::record::WaypointRecord;
use crate::plan::{HoldPattern, MAX_WAYPOINTS, TimeUse, Waypoint, WaypointType};

/// Keys of the whole file.
pub(super) const FILE_KEYS: &[&str] = &["name", "description", "settings", "home", "waypoint"];

/// Keys of `[home]`.
const HOME_KEYS: &[&str] = &["lat_deg", "lon_deg", "alt_amsl_m"];

/// Keys of `[[waypoint]]`.
const WAYPOINT_KEYS: &[&str] =
    &["type", "lat_deg", "lon_deg", "alt_m", "speed_mps", "yaw_rate_dps", "duration_s", "pattern"];

/// Reads the text and adds problems to `problems`.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let (document, syntax) = DeTable::parse_recoverable(text);
    for error in &syntax {
        let message = error.message().replace('\n', ", ");
        problems.add(error.span().unwrap_or(0..0), message, "this is not valid TOML");
    }
    if !syntax.is_empty() {
        // The rest that the parser recovered would only give follow-up problems.
        return PlanFile::default();
    }
    let span = document.span();
    let file = TomlTable::from_document("the plan file", document.get_ref(), span);
    file.refuse_unknown(FILE_KEYS, problems);
    let mut read = PlanFile {
        name: file.string("name", problems).unwrap_or_default(),
        description: file.string("description", problems).unwrap_or_default(),
        home: file.get("home").and_then(|value| read_home(value, problems)),
        settings: file
            .get("settings")
            .map(|value| read_settings(value, text, options.check, problems))
            .unwrap_or_default(),
        ..PlanFile::default()
    };
    let waypoints = file.get("waypoint").map(|value| read_waypoints(value, options.long, problems));
    read.take(waypoints.unwrap_or_default());
    read
}

fn read_home(value: &Value<'_>, problems: &mut Problems<'_>) -> Option<HomePosition> {
    let table = TomlTable::new("home".to_owned(), value, problems)?;
    table.refuse_unknown(HOME_KEYS, problems);
    let lat = table.required("lat_deg", problems).and_then(|v| number(v, field::latitude, problems));
    let lon = table.required("lon_deg", problems).and_then(|v| number(v, field::longitude, problems));
    let amsl = |text: &str| {
        home::amsl_m(text).map_err(|message| FieldError { message, hint: home::AMSL_HINT.to_owned() })
    };
    let amsl_m = table.get("alt_amsl_m").and_then(|value| number(value, amsl, problems));
    Some(HomePosition { position: LatLon::new(lat?, lon?), amsl_m })
}

fn read_settings(
    value: &Value<'_>,
    text: &str,
    check: SettingCheck,
    problems: &mut Problems<'_>,
) -> Vec<String> {
    let DeValue::Array(lines) = value.get_ref() else {
        problems.add(value.span(), "settings is not a list", "write settings = [\"ap_max_angle = 25\"]");
        return Vec::new();
    };
    let mut settings = Vec::new();
    for line in lines.iter() {
        let Some(setting) = line.get_ref().as_str().and_then(setting_line) else {
            problems.add(
                line.span(),
                "this is not a setting",
                "write a text of name and value, such as \"ap_max_angle = 25\"",
            );
            continue;
        };
        if let Some((name, value)) = setting.split_once(" = ")
            && let Err(fault) = check(name, value)
        {
            let part = if fault.part == SettingPart::Name { name } else { value };
            problems.add(place_of(part, text, line.span()), fault.message, fault.hint);
        }
        settings.push(setting);
    }
    settings
}

/// Returns the place of a part of a text inside its quotes; the place of the whole text if an escape hides the part.
fn place_of(part: &str, text: &str, quoted: Range<usize>) -> Range<usize> {
    let found = text.get(quoted.clone()).and_then(|inside| inside.rfind(part));
    found.map_or(quoted.clone(), |at| quoted.start + at..quoted.start + at + part.len())
}

fn read_waypoints(value: &Value<'_>, long: bool, problems: &mut Problems<'_>) -> Vec<Waypoint> {
    let mut waypoints = Vec::new();
    let DeValue::Array(tables) = value.get_ref() else {
        problems.add(
            value.span(),
            "waypoint is not a list of tables",
            "start each waypoint with [[waypoint]]",
        );
        return waypoints;
    };
    for (index, value) in tables.iter().enumerate() {
        if index == MAX_WAYPOINTS && !long {
            problems.add(
                value.span(),
                format!("waypoint {index} does not fit: the file has {}", tables.len()),
                hint(),
            );
        }
        if let Some(table) = TomlTable::new(format!("waypoint {index}"), value, problems) {
            waypoints.push(read_waypoint(&table, problems));
        }
    }
    waypoints
}

fn read_waypoint(table: &TomlTable<'_, '_>, problems: &mut Problems<'_>) -> Waypoint {
    table.refuse_unknown(WAYPOINT_KEYS, problems);
    let kind = table.required("type", problems).and_then(|value| word(value, field::waypoint_type, problems));
    let uses = kind.map(WaypointType::capability);
    let is_yaw_rate = kind.is_some_and(WaypointType::has_yaw_rate);
    // Without a known type, the keys that a record needs are unknown.
    let needs_place = uses.is_some_and(|uses| uses.place);
    let needs_altitude = uses.is_some_and(|uses| uses.altitude);
    let speed_key = if is_yaw_rate { "yaw_rate_dps" } else { "speed_mps" };
    let wrong_key = if is_yaw_rate { "speed_mps" } else { "yaw_rate_dps" };
    if let (Some(kind), Some(value)) = (kind, table.get(wrong_key)) {
        problems.add(
            value.span(),
            format!("a {kind} waypoint has no {wrong_key}"),
            format!("write {speed_key}"),
        );
    }
    let needs_duration = uses.is_some_and(|uses| uses.time == TimeUse::Needed);
    let mut read = |key, needed: bool| {
        if needed { table.required(key, problems) } else { table.get(key) }
    };
    let (lat, lon) = (read("lat_deg", needs_place), read("lon_deg", needs_place));
    let alt = read("alt_m", needs_altitude);
    let speed = read(speed_key, is_yaw_rate);
    let duration = read("duration_s", needs_duration);
    let pattern = table.get("pattern").and_then(|value| word(value, field::pattern, problems));
    let speed_value = if is_yaw_rate { yaw_rate } else { speed_cms };
    let record = WaypointRecord {
        position: LatLon::new(
            lat.and_then(|value| number(value, field::latitude, problems)).unwrap_or_default(),
            lon.and_then(|value| number(value, field::longitude, problems)).unwrap_or_default(),
        ),
        alt_cm: alt.and_then(|value| number(value, altitude_cm, problems)).unwrap_or_default(),
        speed: speed.and_then(|value| number(value, speed_value, problems)).unwrap_or_default(),
        duration_ds: duration.and_then(|value| number(value, duration_ds, problems)).unwrap_or_default(),
        kind: kind.unwrap_or_default(),
        pattern: pattern.unwrap_or(HoldPattern::None),
    };
    record.into()
}

pub(super) fn altitude_cm(text: &str) -> Result<i32, FieldError> {
    let value = scaled("alt_m", text, 100.0, f64::from(i32::MIN), f64::from(i32::MAX), "m above home")?;
    Ok(value as i32)
}

pub(super) fn speed_cms(text: &str) -> Result<u16, FieldError> {
    Ok(scaled("speed_mps", text, 100.0, 0.0, f64::from(u16::MAX), "m/s (0 = default)")? as u16)
}

pub(super) fn yaw_rate(text: &str) -> Result<u16, FieldError> {
    Ok(scaled("yaw_rate_dps", text, 1.0, 0.0, f64::from(u16::MAX), "deg/s (0 = no cap)")? as u16)
}

pub(super) fn duration_ds(text: &str) -> Result<u16, FieldError> {
    Ok(scaled("duration_s", text, 10.0, 0.0, f64::from(u16::MAX), "s")? as u16)
}

/// Returns a number times `factor`, rounded to the whole number that the craft stores.
fn scaled(key: &str, text: &str, factor: f64, low: f64, high: f64, unit: &str) -> Result<f64, FieldError> {
    let value = text.parse::<f64>().unwrap_or(f64::NAN);
    let stored = (value * factor).round();
    if (low..=high).contains(&stored) {
        return Ok(stored);
    }
    let problem = if value.is_nan() { "is not a number" } else { "is out of range" };
    Err(FieldError {
        message: format!("{key} {text} {problem}"),
        hint: format!("allowed: {} to {} {unit}", low / factor, high / factor),
    })
}

/// Reads a number from its decimal text.
fn number<T>(
    value: &Value<'_>,
    read: impl FnOnce(&str) -> Result<T, FieldError>,
    problems: &mut Problems<'_>,
) -> Option<T> {
    let text = match value.get_ref() {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
        DeValue::Float(float) => float.as_str(),
        DeValue::Integer(_) => {
            problems.add(value.span(), "a decimal number is expected here", "write 12.5");
            return None;
        }
        other => {
            let what = other.type_str();
            problems.add(value.span(), format!("a number is expected here, not a TOML {what}"), "write 12.5");
            return None;
        }
    };
    // TOML allows exponents, decimal degrees do not.
    let plain;
    let text = match text.parse::<f64>() {
        Ok(parsed) if text.contains(['e', 'E']) && parsed.is_finite() => {
            plain = format!("{parsed}");
            plain.as_str()
        }
        _ => text,
    };
    read(text).map_err(|error| problems.add(value.span(), error.message, error.hint)).ok()
}

fn word<T>(
    value: &Value<'_>,
    read: impl FnOnce(&str) -> Result<T, FieldError>,
    problems: &mut Problems<'_>,
) -> Option<T> {
    let Some(text) = value.get_ref().as_str() else {
        let what = value.get_ref().type_str();
        problems.add(value.span(), format!("a word is expected here, not a TOML {what}"), "write \"HOLD\"");
        return None;
    };
    read(text).map_err(|error| problems.add(value.span(), error.message, error.hint)).ok()
}

#[cfg(test)]
mod tests {
    use super::super::{Format, PlanError, parse, report, write};
    use super::*;

    const SMALL: &str = r#"name = "small"
description = "Two points"
settings = [
  "ap_max_angle = 25",
]

[home]
lat_deg = 40.4635000
lon_deg = -79.5182000
alt_amsl_m = 300

[[waypoint]]
type = "TAKEOFF"
alt_m = 10

[[waypoint]]
type = "YAW_RATE"
yaw_rate_dps = 45

[[waypoint]]
type = "HOLD"
lat_deg = 40.4640000
lon_deg = -79.5175000
alt_m = -0.5
speed_mps = 5.25
duration_s = 30.5
pattern = "FIGURE8"
"#;

    fn read_text(text: &str) -> PlanFile {
        parse("small.toml", text, Format::Toml).unwrap_or_else(|errors| panic!("{}", report(&errors)))
    }

    fn headlines(text: &str) -> Vec<String> {
        parse("p.toml", text, Format::Toml).unwrap_err().iter().map(PlanError::headline).collect()
    }

    #[test]
    fn canonical_text_prints_byte_identically() {
        let file = read_text(SMALL);
        let hold = file.plan.records()[2];
        assert_eq!((hold.alt_cm, hold.speed, hold.duration_ds), (-50, 525, 305));
        assert_eq!(file.plan.waypoints[1].yaw_rate_dps, 45);
        assert_eq!(file.settings, ["ap_max_angle = 25"]);
        assert_eq!(write(&file, Format::Toml).text(), SMALL);
    }

    #[test]
    fn numbers_may_be_written_in_several_ways() {
        let file = read_text(
            "settings = ['set  a=1']\nwaypoint = [{type='flyby', lat_deg=40.46400009, lon_deg=-7.95e1, alt_m=1_0}]",
        );
        assert_eq!(file.name, "small");
        assert_eq!(file.settings, ["a = 1"]);
        assert_eq!(file.plan.waypoints[0].position, LatLon::new(404_640_000, -795_000_000));
        assert_eq!(file.plan.records()[0].alt_cm, 1000);
    }

    #[test]
    fn all_problems_are_reported_with_their_places() {
        let text = "nmae = 'x'\nsettings = [5, 'a b']\n[home]\nlat_deg = 95\n[[waypoint]]\ntype = 'FLYOVR'\n\
                    [[waypoint]]\ntype = 'FLYBY'\nlat_deg = true\nlon_deg = 1\nalt_m = nan\nspeed_mps = 700\n\
                    yaw_rate_dps = 3\npattern = 8\n[[waypoint]]\nlat = 5\n";
        assert_eq!(
            headlines(text),
            [
                "p.toml:1:1: nmae is not a key of the plan file",
                "p.toml:2:13: this is not a setting",
                "p.toml:2:16: this is not a setting",
                "p.toml:3:1: lon_deg is missing in home",
                "p.toml:4:11: latitude 95 is out of range",
                "p.toml:6:8: FLYOVR is not a waypoint type",
                "p.toml:9:11: a number is expected here, not a TOML boolean",
                "p.toml:11:9: alt_m nan is not a number",
                "p.toml:12:13: speed_mps 700 is out of range",
                "p.toml:13:16: a FLYBY waypoint has no yaw_rate_dps",
                "p.toml:14:11: a word is expected here, not a TOML integer",
                "p.toml:15:1: type is missing in waypoint 2",
                "p.toml:16:1: lat is not a key of waypoint 2",
            ]
        );
    }

    #[test]
    fn settings_are_judged_where_they_stand() {
        fn check(name: &str, value: &str) -> Result<(), super::super::SettingFault> {
            let part = match (name, value) {
                ("bad", _) => SettingPart::Name,
                (_, "z") => SettingPart::Value,
                _ => return Ok(()),
            };
            Err(super::super::SettingFault { part, message: format!("{name} {value}"), hint: String::new() })
        }
        let text = "settings = [\n  \"set good=1\", 'bad = 5',\n  \"ap_z = z\", \"a = \\u007A\"]\n";
        let errors = super::super::parse_checked("p.toml", text, Format::Toml, check).unwrap_err();
        let places: Vec<_> = errors.iter().map(|e| (e.line, e.column, e.width, e.message.as_str())).collect();
        assert_eq!(places, [(2, 18, 3, "bad 5"), (3, 11, 1, "ap_z z"), (3, 15, 12, "a z")]);
    }

    #[test]
    fn numbers_are_decimal() {
        assert_eq!(
            headlines("[[waypoint]]\ntype='ALT_CHANGE'\nalt_m = 0x10"),
            ["p.toml:3:9: a decimal number is expected here"]
        );
    }

    #[test]
    fn syntax_errors_have_a_place() {
        let all = headlines("name = 'x'\n[[waypoint]]\nlat_deg = 4O.4\nalt_m = \n");
        assert!(all[0].starts_with("p.toml:3:1"), "{all:?}");
        assert!(all.len() >= 2, "{all:?}");
    }

    #[test]
    fn the_thirty_first_waypoint_is_refused_once() {
        let text = "[[waypoint]]\ntype='DELAY'\nduration_s=1\n".repeat(32);
        assert_eq!(headlines(&text), ["p.toml:91:1: waypoint 30 does not fit: the file has 32"]);
    }
}
