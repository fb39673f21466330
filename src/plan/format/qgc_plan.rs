//! QGroundControl's `.plan`: JSON with the items of a mission, a fence and rally points. The key `betadeck` has the
//! parts of a plan that the others cannot hold.

mod fence;
mod items;
mod private;
mod source;
#[cfg(test)]
mod tests;
mod write;

use serde_json::Value;

use super::long::hint;
use super::loss::{Finding, LossReport, Place, Severity};
use super::mission_item::{self, Mission, MissionItem};
use super::setting::{SettingFault, setting_line};
use super::{HomePosition, PlanFile, Problems, ReadOptions, home, json};
use crate::plan::MAX_WAYPOINTS;
use crate::plan::estimate::Assumptions;
use crate::plan::feature::Feature;
use source::Source;
pub(super) use write::write;

/// The setting of the fence.
const FENCE_SETTING: &str = "ap_max_distance_from_home";

/// Reads the text and adds problems to `problems`.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let Some(value) = json::parse(text, problems) else { return PlanFile::default() };
    let mut source = Source::new(text, problems);
    let mut file = PlanFile::default();
    read_file(&value, options, &mut source, &mut file);
    file
}

/// Returns `true` for a text with the mark of such a plan.
pub(super) fn is_plan(text: &str) -> bool {
    text.trim_start().starts_with('{') && text.contains("\"fileType\"")
}

/// Returns the fences of a `.plan` that are not the distance from home of the craft. A circle becomes an area of 72
/// points. Returns none for a text that is no plan.
pub fn qgc_fences(text: &str) -> Vec<Feature> {
    let mut problems = Problems::new("", text);
    let Some(value) = json::parse(text, &mut problems) else { return Vec::new() };
    let mut source = Source::new(text, &mut problems);
    let home = planned_home(&value["mission"], &mut source, &mut LossReport::default());
    let fences = fence::read(&value, home, &mut source);
    if problems.is_empty() { fences.features } else { Vec::new() }
}

fn read_file(
    value: &Value,
    options: &ReadOptions,
    source: &mut Source<'_, '_>,
    file: &mut PlanFile,
) -> Option<()> {
    check_kind(value, source)?;
    let mission = &value["mission"];
    let Some(list) = mission["items"].as_array() else {
        source.fault("/mission", "the mission has no list of items", "a plan has /mission/items");
        return None;
    };
    let file_home = planned_home(mission, source, &mut file.losses);
    file.home = mission_item::home(file_home, options);
    let mut items = Vec::new();
    items::read(list, source, &mut items, &mut file.losses);
    let private = private::Data::read(value, &mut file.losses);
    if let Some(private) = &private {
        file.name.clone_from(&private.name);
        file.description.clone_from(&private.description);
        file.settings = checked_settings(&private.settings, options, &mut file.losses);
    }
    let fences = fence::read(value, file.home, source);
    take_fence(&fences, private.is_some(), options, file);
    report_vehicle(mission, &mut file.losses);
    if !source.is_clean() {
        return None;
    }
    let assumptions = Assumptions::from_settings(&file.settings);
    let mission = Mission {
        items: &items,
        home: file.home,
        assumptions: &assumptions,
        waypoint_as: options.waypoint_as,
        flat: options.flat,
    };
    let mapping = mission.map();
    for fault in &mapping.faults {
        source.fault(&pointer(&items[fault.item]), fault.message.clone(), fault.hint.clone());
    }
    let too_many = mapping.too_many();
    let restored = private::restore(mapping, private, &mission);
    file.losses.findings.extend(restored.findings);
    file.losses.items = items.len();
    if restored.waypoints.len() > MAX_WAYPOINTS && !options.long && source.is_clean() {
        match too_many {
            Some(fault) => source.fault(&pointer(&items[fault.item]), fault.message, fault.hint),
            None => {
                let message = format!("the file has {} waypoints", restored.waypoints.len());
                source.fault("/mission/items", message, hint());
            }
        }
    }
    file.take(restored.waypoints);
    fences.report(&file.plan, &mut file.losses);
    report_rally_points(value, &mut file.losses);
    Some(())
}

fn pointer(item: &MissionItem) -> String {
    item.place.as_ref().map(ToString::to_string).unwrap_or_default()
}

fn check_kind(value: &Value, source: &mut Source<'_, '_>) -> Option<()> {
    let hint = "a plan of QGroundControl has \"fileType\": \"Plan\" and \"version\": 1";
    match (value["fileType"].as_str(), &value["version"]) {
        (Some("Plan"), version) if version.as_f64() == Some(1.0) => {}
        (Some("Plan"), Value::Null) => {
            source.fault("", "the plan has no version", hint);
            return None;
        }
        (Some("Plan"), version) => {
            source.fault("/version", format!("version {version} of a plan is unknown"), hint);
            return None;
        }
        (Some(other), _) => {
            source.fault("/fileType", format!("{other} is not a plan"), hint);
            return None;
        }
        (None, _) => {
            source.fault("", "this JSON is not a plan of QGroundControl", hint);
            return None;
        }
    }
    if !value["mission"].is_object() {
        source.fault("", "the plan has no mission", "a plan has /mission/items");
        return None;
    }
    let version = &value["mission"]["version"];
    if !version.is_null() && version.as_f64() != Some(1.0) && version.as_f64() != Some(2.0) {
        source.fault(
            "/mission/version",
            format!("version {version} of a mission is unknown"),
            "allowed: 1 and 2",
        );
        return None;
    }
    Some(())
}

/// Reads the home. Its altitude may be null.
fn planned_home(
    mission: &Value,
    source: &mut Source<'_, '_>,
    losses: &mut LossReport,
) -> Option<HomePosition> {
    let at = "/mission/plannedHomePosition";
    let value = &mission["plannedHomePosition"];
    // Old files have an item here.
    let (value, at) = match value.get("coordinate") {
        Some(coordinate) => (coordinate, format!("{at}/coordinate")),
        None => (value, at.to_owned()),
    };
    if value.is_null() {
        return None;
    }
    let Some(values) = value.as_array().filter(|values| matches!(values.len(), 2 | 3)) else {
        source.fault(&at, "the home is not a list of latitude, longitude and altitude", "");
        return None;
    };
    let lat = source.number(&values[0], &format!("{at}/0"), "latitude")?;
    let lon = source.number(&values[1], &format!("{at}/1"), "longitude")?;
    let altitude = values.get(2).unwrap_or(&Value::Null);
    let amsl_m = source.number(altitude, &format!("{at}/2"), "altitude");
    // A micrometre is enough, and survives the way through text.
    let amsl_m = amsl_m.map(|metres| (metres * 1e6).round() / 1e6);
    home::of_file(lat, lon, amsl_m, Some(&Place::Pointer { pointer: at }), losses)
}

/// Returns the settings of the private data that this craft has.
fn checked_settings(lines: &[String], options: &ReadOptions, losses: &mut LossReport) -> Vec<String> {
    let check = |line: &str| -> Result<String, String> {
        let line = setting_line(line).ok_or_else(|| "it is not a setting".to_owned())?;
        let (name, value) = line.split_once(" = ").unwrap_or((&line, ""));
        (options.check)(name, value).map_err(|fault: SettingFault| fault.message)?;
        Ok(line)
    };
    let mut settings = Vec::new();
    for line in lines {
        match check(line) {
            Ok(line) => settings.push(line),
            Err(why) => losses.add(Finding::new(Severity::Lost, "setting", why).values(line, "")),
        }
    }
    settings
}

/// Makes the circle around home the setting. With private data the setting is there already, and the circle says
/// whether another program changed it.
fn take_fence(fences: &fence::Fences, is_ours: bool, options: &ReadOptions, file: &mut PlanFile) {
    let before_m = Assumptions::from_settings(&file.settings).fence_m;
    let radius_m = fences.home_radius_m;
    let whole_m = radius_m.map(f64::floor);
    if before_m == whole_m {
        return;
    }
    let text = |metres: Option<f64>| metres.map_or_else(|| "none".to_owned(), |metres| format!("{metres} m"));
    let is_elsewhere = fences.elsewhere_m.iter().any(|radius_m| Some(radius_m.floor()) == before_m);
    let mut severity = Severity::Assumed;
    let why = match whole_m {
        Some(metres) => {
            if let Err(fault) = (options.check)(FENCE_SETTING, &metres.to_string()) {
                let finding = Finding::new(Severity::Lost, "fence", fault.message);
                file.losses.add(finding.values(text(radius_m), text(before_m)));
                return;
            }
            "another program changed the circle around home"
        }
        None if is_elsewhere => {
            severity = Severity::Lost;
            "the home moved away from the centre of the circle"
        }
        None => "another program removed the circle around home",
    };
    let is_fence =
        |line: &String| line.split(' ').next().is_some_and(|name| name.eq_ignore_ascii_case(FENCE_SETTING));
    file.settings.retain(|line| !is_fence(line));
    file.settings.extend(whole_m.map(|metres| format!("{FENCE_SETTING} = {metres}")));
    if is_ours {
        file.losses.add(Finding::new(severity, "fence", why).values(text(before_m), text(whole_m)));
    }
    if radius_m != whole_m {
        let why = "the distance from home is in whole metres";
        file.losses.add(Finding::new(Severity::Changed, "fence", why).values(text(radius_m), text(whole_m)));
    }
}

fn report_vehicle(mission: &Value, losses: &mut LossReport) {
    if let Some(vehicle) = mission["vehicleType"].as_f64().filter(|&vehicle| vehicle != 2.0) {
        let why = "the plan is for another kind of vehicle, and is flown by a quadcopter";
        losses.add(Finding::new(Severity::Assumed, "vehicle type", why).values(vehicle.to_string(), "2"));
    }
}

fn report_rally_points(value: &Value, losses: &mut LossReport) {
    let count = value["rallyPoints"]["points"].as_array().map_or(0, Vec::len);
    if count > 0 {
        let why = "this craft returns to its home";
        let points = if count == 1 { "point" } else { "points" };
        losses.add(Finding::new(Severity::Lost, "rally points", why).values(format!("{count} {points}"), ""));
    }
}
