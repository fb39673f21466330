//! The writer of `.plan` files.

use serde::Serialize as _;
use serde_json::{Value, json};

use super::super::loss::{Finding, LossReport, Severity};
use super::super::mission_item::{MissionItem, NO_PLACE, send, written_position};
use super::super::{PlanFile, Written};
use super::FENCE_SETTING;
use super::private::Data;
use crate::plan::estimate::Assumptions;

/// Writes a plan. A plan without a home is refused.
pub(in crate::plan::format) fn write(file: &PlanFile) -> Written {
    let assumptions = Assumptions::from_settings(&file.settings);
    let Some(home) = file.home else {
        let why =
            "a plan of QGroundControl has a home: give the plan one, or `convert` one by --home LAT,LON,AMSL";
        let finding = Finding::new(Severity::Refused, "home", why);
        return refused(vec![finding]);
    };
    let (position, moved) = written_position(home.position);
    let sent = send(&file.plan.waypoints, position, &assumptions, true);
    let mut losses = LossReport { items: sent.items.len(), findings: sent.findings, ..LossReport::default() };
    if losses.worst() == Some(Severity::Refused) {
        return refused(losses.findings);
    }
    if moved {
        let why = "0,0 means that there is no home";
        losses.add(Finding::new(Severity::Changed, "home", why).values("0,0", position.to_string()));
    }
    let others = file.settings.iter().filter(|line| !line.starts_with(FENCE_SETTING)).count();
    if others > 0 {
        let why = "only betadeck reads them in the file, and QGroundControl drops them when it saves";
        let settings = if others == 1 { "setting" } else { "settings" };
        losses.add(Finding::new(Severity::Lost, "settings", why).values(format!("{others} {settings}"), ""));
    }
    let items: Vec<Value> = sent.items.iter().map(item).collect();
    let (lat, lon) = (f64::from(position.lat_e7) / 1e7, f64::from(position.lon_e7) / 1e7);
    let center = [number(lat), number(lon)];
    let circles: Vec<Value> = assumptions
        .fence_m
        .map(|radius_m| {
            let circle = json!({ "center": center, "radius": number(radius_m) });
            json!({ "version": 1, "inclusion": true, "circle": circle })
        })
        .into_iter()
        .collect();
    // Mission Planner reads the speeds as whole numbers.
    let speed = number(assumptions.max_velocity_mps.round().max(1.0));
    let private = Data::new(&file.name, &file.description, &file.settings, &file.plan.waypoints);
    let plan = json!({
        "fileType": "Plan",
        "version": 1,
        "groundStation": "betadeck",
        "mission": {
            "version": 2,
            "firmwareType": 0,
            "vehicleType": 2,
            "cruiseSpeed": speed,
            "hoverSpeed": speed,
            "globalPlanAltitudeMode": 1,
            "plannedHomePosition": [center[0], center[1], home.amsl_m.map(number)],
            "items": items,
        },
        "geoFence": { "version": 2, "circles": circles, "polygons": [] },
        "rallyPoints": { "version": 2, "points": [] },
        "betadeck": serde_json::to_value(private).unwrap_or_default(),
    });
    Written { contents: text(&plan), losses }
}

fn refused(findings: Vec<Finding>) -> Written {
    Written { contents: Vec::new(), losses: LossReport { findings, ..LossReport::default() } }
}

fn item(item: &MissionItem) -> Value {
    let optional = |value: Option<f64>| value.map_or(Value::Null, number);
    let mut params: Vec<Value> = item.params.iter().map(|&param| optional(param)).collect();
    params.extend([item.lat_deg, item.lon_deg, item.altitude_m].map(optional));
    let mut value = json!({
        "type": "SimpleItem",
        "doJumpId": item.number,
        "command": item.command,
        "frame": item.frame,
        "autoContinue": item.autocontinue,
        "params": params,
    });
    if item.frame != NO_PLACE {
        value["AltitudeMode"] = json!(1);
        value["Altitude"] = optional(item.altitude_m);
        value["AMSLAltAboveTerrain"] = Value::Null;
    }
    value
}

/// Returns a number, without a point if it is whole.
fn number(value: f64) -> Value {
    let micro = (value * 1e6).round() / 1e6;
    // Positions have more digits than six.
    let value = if (micro - value).abs() < 1e-9 { micro } else { value };
    if value.fract() == 0.0 && value.abs() < 1e15 { json!(value as i64) } else { json!(value) }
}

/// Returns the text, indented as QGroundControl does it.
fn text(plan: &Value) -> Vec<u8> {
    let mut contents = Vec::new();
    let format = serde_json::ser::PrettyFormatter::with_indent(b"    ");
    let mut writer = serde_json::Serializer::with_formatter(&mut contents, format);
    // Writing to memory does not fail.
    let _ = plan.serialize(&mut writer);
    contents.push(b'\n');
    contents
}
