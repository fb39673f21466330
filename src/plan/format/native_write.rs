//! The writer of the project's own format, in its canonical form.

use crate::geo::Degrees7;
use crate::plan::{HoldPattern, TimeUse};
use crate::text::printable::is_printable;

use super::loss::LossReport;
use super::{PlanFile, Written};
use crate::plan::record::WaypointRecord;

/// Writes a plan as TOML. Leaves out values that are the default for the type of their record.
pub(super) fn write(file: &PlanFile) -> Written {
    let mut text = format!("name = {}\n", quoted(&file.name));
    if !file.description.is_empty() {
        text.push_str(&format!("description = {}\n", quoted(&file.description)));
    }
    if !file.settings.is_empty() {
        text.push_str("settings = [\n");
        for line in &file.settings {
            text.push_str(&format!("  {},\n", quoted(line)));
        }
        text.push_str("]\n");
    }
    if let Some(home) = file.home {
        text.push_str("\n[home]\n");
        let (lat, lon) = (Degrees7(home.position.lat_e7), Degrees7(home.position.lon_e7));
        text.push_str(&format!("lat_deg = {lat}\nlon_deg = {lon}\n"));
        if let Some(amsl) = home.amsl_m {
            text.push_str(&format!("alt_amsl_m = {amsl}\n"));
        }
    }
    for record in file.plan.records() {
        write_waypoint(record, &mut text);
    }
    let losses = LossReport { items: file.plan.waypoints.len(), ..LossReport::default() };
    Written { contents: text.into_bytes(), losses }
}

fn write_waypoint(record: WaypointRecord, text: &mut String) {
    let WaypointRecord { position, alt_cm, speed, duration_ds, kind, pattern } = record;
    let (lat, lon) = (Degrees7(position.lat_e7), Degrees7(position.lon_e7));
    let uses = kind.capability();
    text.push_str(&format!("\n[[waypoint]]\ntype = \"{kind}\"\n"));
    if uses.place || position.lat_e7 != 0 || position.lon_e7 != 0 {
        text.push_str(&format!("lat_deg = {lat}\nlon_deg = {lon}\n"));
    }
    if uses.altitude || alt_cm != 0 {
        text.push_str(&format!("alt_m = {}\n", scaled(i64::from(alt_cm), 2)));
    }
    if kind.has_yaw_rate() {
        text.push_str(&format!("yaw_rate_dps = {speed}\n"));
    } else if speed != 0 {
        text.push_str(&format!("speed_mps = {}\n", scaled(i64::from(speed), 2)));
    }
    if matches!(uses.time, TimeUse::Stay | TimeUse::Needed) || duration_ds != 0 {
        text.push_str(&format!("duration_s = {}\n", scaled(i64::from(duration_ds), 1)));
    }
    if uses.pattern || pattern != HoldPattern::None {
        text.push_str(&format!("pattern = \"{pattern}\"\n"));
    }
}

/// Returns `value` × 10^−`decimals` without trailing zeros: 5000 at 2 → `50`, −150 at 2 → `-1.5`.
pub(super) fn scaled(value: i64, decimals: u32) -> String {
    let unit = 10_u64.pow(decimals);
    let size = value.unsigned_abs();
    let sign = if value < 0 { "-" } else { "" };
    let fraction = format!("{:0width$}", size % unit, width = decimals as usize);
    let fraction = fraction.trim_end_matches('0');
    let point = if fraction.is_empty() { "" } else { "." };
    format!("{sign}{}{point}{fraction}", size / unit)
}

/// Returns a TOML basic string.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c if is_printable(c) => out.push(c),
            c if c <= '\u{ffff}' => out.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => out.push_str(&format!("\\U{:08X}", u32::from(c))),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaled_values_have_no_trailing_zeros() {
        assert_eq!(scaled(5000, 2), "50");
        assert_eq!(scaled(-150, 2), "-1.5");
        assert_eq!(scaled(-5, 2), "-0.05");
        assert_eq!(scaled(0, 1), "0");
        assert_eq!(scaled(i64::from(i32::MIN), 2), "-21474836.48");
    }

    #[test]
    fn strings_are_escaped() {
        assert_eq!(quoted("\u{202e}飛\u{e0041}"), "\"\\u202E飛\\U000E0041\"");
        assert_eq!(quoted("a \"b\" \\ \n\u{7f}"), "\"a \\\"b\\\" \\\\ \\n\\u007F\"");
    }
}
