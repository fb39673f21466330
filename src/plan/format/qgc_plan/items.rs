//! The items of a `.plan`: simple items in their old and their new form, and surveys with their expansion.

use serde_json::Value;

use super::super::bounds::MAX_ITEMS;
use super::super::loss::{Finding, LossReport, Place, Severity};
use super::super::mission_item::MissionItem;
use super::source::Source;

/// The seven parameters of an item by name.
const PARAMS: [&str; 7] =
    ["parameter 1", "parameter 2", "parameter 3", "parameter 4", "latitude", "longitude", "altitude"];

/// Reads the items of `/mission/items`.
pub(super) fn read(
    list: &[Value],
    source: &mut Source<'_, '_>,
    items: &mut Vec<MissionItem>,
    losses: &mut LossReport,
) {
    for (index, value) in list.iter().enumerate() {
        if items.len() > MAX_ITEMS || list.len() > MAX_ITEMS {
            let count = list.len().max(items.len());
            source.fault(
                "/mission/items",
                format!("the mission has {count} items, at most {MAX_ITEMS} are read"),
                "",
            );
            return;
        }
        if source.is_full() {
            return;
        }
        let pointer = format!("/mission/items/{index}");
        match value["type"].as_str() {
            Some("SimpleItem" | "missionItem") => items.extend(simple(value, index + 1, pointer, source)),
            Some("ComplexItem") => complex(value, index + 1, &pointer, source, items, losses),
            Some(other) => source.fault(
                &format!("{pointer}/type"),
                format!("{other} is not a type of item"),
                "allowed: SimpleItem, ComplexItem, missionItem",
            ),
            None => source.fault(
                &pointer,
                "the item has no type",
                "allowed: SimpleItem, ComplexItem, missionItem",
            ),
        }
    }
}

fn simple(value: &Value, number: usize, pointer: String, source: &mut Source<'_, '_>) -> Option<MissionItem> {
    let params = match value.get("params") {
        Some(params) => new_params(params, &format!("{pointer}/params"), source)?,
        None => old_params(value, &pointer, source)?,
    };
    let Some(command) = source.whole(&value["command"], &format!("{pointer}/command"), "command") else {
        if value["command"].is_null() {
            source.fault(&pointer, "the item has no command", "");
        }
        return None;
    };
    let Some(frame) = source.whole(&value["frame"], &format!("{pointer}/frame"), "frame") else {
        if value["frame"].is_null() {
            source.fault(&pointer, "the item has no frame", "");
        }
        return None;
    };
    // Old files number the items by `id`.
    let own = ["doJumpId", "id"].map(|key| source.whole(&value[key], &format!("{pointer}/{key}"), key));
    let own = own.into_iter().flatten().map(usize::from).next();
    let [p1, p2, p3, p4, lat_deg, lon_deg, altitude_m] = params;
    Some(MissionItem {
        number: own.unwrap_or(number),
        command,
        frame,
        params: [p1, p2, p3, p4],
        lat_deg,
        lon_deg,
        altitude_m,
        autocontinue: value["autoContinue"].as_bool().unwrap_or(true),
        place: Some(Place::Pointer { pointer }),
    })
}

fn new_params(value: &Value, pointer: &str, source: &mut Source<'_, '_>) -> Option<[Option<f64>; 7]> {
    let Some(values) = value.as_array().filter(|values| values.len() == PARAMS.len()) else {
        let count = value.as_array().map_or(0, Vec::len);
        source.fault(pointer, format!("params has {count} values"), "an item has 7 parameters");
        return None;
    };
    let mut params = [None; 7];
    for (at, (param, value)) in params.iter_mut().zip(values).enumerate() {
        *param = source.number(value, &format!("{pointer}/{at}"), PARAMS[at]);
    }
    Some(params)
}

/// Reads `param1` to `param4` and `coordinate` of version 1.
fn old_params(value: &Value, pointer: &str, source: &mut Source<'_, '_>) -> Option<[Option<f64>; 7]> {
    let mut params = [None; 7];
    for (at, param) in params.iter_mut().take(4).enumerate() {
        let key = format!("param{}", at + 1);
        *param = source.number(&value[&key], &format!("{pointer}/{key}"), PARAMS[at]);
    }
    let Some(values) = value["coordinate"].as_array().filter(|values| values.len() == 3) else {
        source.fault(pointer, "the item has no params", "an item has 7 parameters");
        return None;
    };
    for (at, value) in values.iter().enumerate() {
        params[4 + at] = source.number(value, &format!("{pointer}/coordinate/{at}"), PARAMS[4 + at]);
    }
    Some(params)
}

/// Reads the expansion of an item with several waypoints.
fn complex(
    value: &Value,
    number: usize,
    pointer: &str,
    source: &mut Source<'_, '_>,
    items: &mut Vec<MissionItem>,
    losses: &mut LossReport,
) {
    let kind = value["complexItemType"].as_str().unwrap_or("complex item");
    let list = match kind {
        "survey" | "CorridorScan" => value["TransectStyleComplexItem"]["Items"].as_array(),
        _ => None,
    };
    let Some(list) = list else {
        let hint = "replace it by simple items in QGroundControl";
        source.fault(pointer, format!("a {kind} has no list of items that can be read"), hint);
        return;
    };
    if items.len() + list.len() > MAX_ITEMS {
        let message =
            format!("the mission has {} items, at most {MAX_ITEMS} are read", items.len() + list.len());
        source.fault(pointer, message, "");
        return;
    }
    for (index, value) in list.iter().enumerate() {
        if source.is_full() {
            return;
        }
        let pointer = format!("{pointer}/TransectStyleComplexItem/Items/{index}");
        items.extend(simple(value, items.len() + 1, pointer, source));
    }
    let why = format!("it cannot be saved back as a {kind}");
    let finding = Finding::new(Severity::Changed, kind, why).item(number);
    let finding = finding.place(Place::Pointer { pointer: pointer.to_owned() });
    losses.add(finding.values(format!("{kind} of {} items", list.len()), format!("{} items", list.len())));
}
