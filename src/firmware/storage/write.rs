//! Writes the records of an image.

use std::fmt::Write as _;

use super::super::config::Configuration;
use super::super::settings::{SETTINGS, Scope};

/// Returns the payload of an image.
pub(super) fn payload(configuration: &Configuration) -> String {
    let mut out = String::new();
    let mut record = |fields: &[&dyn std::fmt::Display]| {
        for (at, field) in fields.iter().enumerate() {
            // Writing to a string cannot fail.
            let _infallible = if at == 0 { write!(out, "{field}") } else { write!(out, "\t{field}") };
        }
        out.push('\n');
    };
    let settings = &configuration.settings;
    for setting in &SETTINGS {
        let instances =
            (0..setting.scope.instances()).filter_map(|instance| settings.value(setting, instance));
        let values: Vec<String> = instances.map(|value| setting.display(value)).collect();
        record(&[&"setting", &setting.name, &values.join("\t")]);
    }
    for scope in [Scope::Profile, Scope::RateProfile, Scope::BatteryProfile] {
        record(&[&"active", &scope.word(), &settings.active(scope)]);
    }
    record(&[&"features", &configuration.features.0]);
    record(&[&"mixer", &configuration.mixer]);
    for (at, row) in configuration.custom_mix.iter().enumerate() {
        record(&[&"mix", &at, &row.throttle, &row.roll, &row.pitch_down, &row.yaw]);
    }
    record(&[&"map", &configuration.channel_map]);
    for (at, row) in configuration.modes.iter().enumerate() {
        let logic = row.logic as u8;
        record(&[
            &"mode",
            &at,
            &row.box_id,
            &row.aux_channel,
            &row.start_us,
            &row.end_us,
            &logic,
            &row.linked,
        ]);
    }
    for (at, row) in configuration.adjustments.iter().enumerate() {
        let range: [&dyn std::fmt::Display; 3] = [&row.aux_channel, &row.start_us, &row.end_us];
        let what: [&dyn std::fmt::Display; 4] = [&row.function, &row.select_channel, &row.center, &row.scale];
        record(&[&"adjustment", &at, range[0], range[1], range[2], what[0], what[1], what[2], what[3]]);
    }
    for (at, row) in configuration.rx_ranges.iter().enumerate() {
        record(&[&"rxrange", &at, &row.min_us, &row.max_us]);
    }
    for (at, row) in configuration.rx_fail.0.iter().enumerate() {
        record(&[&"rxfail", &at, &(row.mode as u8), &row.value_us]);
    }
    for (at, row) in configuration.serial.0.iter().enumerate() {
        let bauds: [&dyn std::fmt::Display; 4] =
            [&row.msp_baud, &row.gps_baud, &row.telemetry_baud, &row.blackbox_baud];
        record(&[&"serial", &at, &row.functions, bauds[0], bauds[1], bauds[2], bauds[3]]);
    }
    for waypoint in configuration.plan.records() {
        let place: [&dyn std::fmt::Display; 3] =
            [&waypoint.position.lat_e7, &waypoint.position.lon_e7, &waypoint.alt_cm];
        let (kind, pattern) = (waypoint.kind as u8, waypoint.pattern as u8);
        record(&[
            &"waypoint",
            place[0],
            place[1],
            place[2],
            &waypoint.speed,
            &kind,
            &waypoint.duration_ds,
            &pattern,
        ]);
    }
    record(&[&"board", &configuration.board_name]);
    record(&[&"manufacturer", &configuration.manufacturer_id]);
    for line in configuration.kept.iter() {
        record(&[&"kept", &line.scope.word(), &line.instance, &line.name, &line.text]);
    }
    for unknown in &configuration.unknown_records {
        record(&[unknown]);
    }
    out
}
