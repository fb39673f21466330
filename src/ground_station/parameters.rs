//! Settings as parameters: the table of names, which are at most 16 characters long on the link.

use crate::fc::{Allowed, CraftSetting, CraftSettings};
use crate::mavlink::craft::Parameter;

/// The beginnings of the names of the settings that are parameters.
const SHOWN: [&str; 5] = ["ap_", "alt_hold_", "pos_hold_", "gps_rescue_", "failsafe_"];
/// The longest name on the link.
const LONGEST: usize = 16;
/// Parts of names, and their short forms. The first match of each part counts.
const SHORT: [(&str, &str); 47] = [
    ("gps_rescue_allow_arming_without_fix", "RTL_ARM_NOFIX"),
    ("waypoint_arrival_radius", "wp_radius"),
    ("waypoint_hold_radius", "hold_radius"),
    ("velocity_buildup_max_pitch", "build_pitch"),
    ("velocity_control_enable", "vel_enable"),
    ("velocity_drag_coeff", "drag"),
    ("max_distance_from_home", "fence_dist"),
    ("geofence_action", "fence_act"),
    ("landing_detection_time", "land_detect"),
    ("landing_descent_rate", "land_rate"),
    ("landing_velocity_threshold", "land_vel"),
    ("landing_throttle_threshold", "land_thr"),
    ("landing_spiral_enable", "spiral_on"),
    ("landing_spiral_radius", "spiral_rad"),
    ("landing_spiral_rate", "spiral_rate"),
    ("landing_altitude_m", "land_alt"),
    ("min_nav_altitude_m", "min_nav_alt"),
    ("l1_max_cross_track_error", "l1_max_xte"),
    ("l1_max_lookahead", "l1_max_ahead"),
    ("l1_min_lookahead", "l1_min_ahead"),
    ("hold_figure8_width", "fig8_width"),
    ("hold_orbit_radius", "orbit_rad"),
    ("nav_carrot_lead_time", "carrot_time"),
    ("nav_carrot_lead_max", "carrot_max"),
    ("nav_corner_delta_v", "corner_dv"),
    ("nav_corner_speed", "corner_speed"),
    ("nav_preturn_dist", "preturn"),
    ("min_forward_velocity", "min_fwd_vel"),
    ("position_cutoff", "pos_cutoff"),
    ("hover_throttle", "hover_thr"),
    ("throttle_deadband", "thr_dband"),
    ("throttle_min", "thr_min"),
    ("throttle_max", "thr_max"),
    ("stick_deadband", "stick_dband"),
    ("stop_threshold", "stop_thresh"),
    ("failsafe_throttle_low_delay", "FS_THR_LOW_DELAY"),
    ("failsafe_stick_threshold", "FS_STICK_THRESH"),
    ("failsafe_recovery_delay", "FS_RECOVERY"),
    ("failsafe_landing_time", "FS_LAND_TIME"),
    ("gps_rescue_min_start_dist", "RTL_MIN_DIST"),
    ("gps_rescue_initial_climb", "RTL_CLIMB"),
    ("gps_rescue_sanity_checks", "RTL_SANITY"),
    ("gps_rescue_ground_speed", "RTL_SPEED"),
    ("alt_hold_climb_rate", "ALTHOLD_CLIMB"),
    ("alt_hold_deadband", "ALTHOLD_DBAND"),
    ("gps_rescue", "rtl"),
    ("failsafe", "fs"),
];

/// Returns the name of a setting on the link: at most 16 capital letters, digits and `_`.
pub fn alias(setting: &str) -> String {
    let name = SHORT
        .iter()
        .find(|(part, _)| setting.contains(part))
        .map_or_else(|| setting.to_owned(), |(part, short)| setting.replacen(part, short, 1));
    name.to_uppercase().chars().take(LONGEST).collect()
}

/// Returns the settings that are parameters, with their numbers. A word counts by its place in the list.
pub(super) fn table(settings: &CraftSettings) -> Vec<Parameter> {
    let shown = |setting: &&CraftSetting| SHOWN.iter().any(|start| setting.name.starts_with(start));
    let parameter =
        |setting: &CraftSetting| Some(Parameter { name: alias(&setting.name), value: number(setting)? });
    settings.all.iter().filter(shown).filter_map(parameter).collect()
}

/// Returns the setting with this name on the link.
pub(super) fn find<'a>(settings: &'a CraftSettings, name: &str) -> Option<&'a CraftSetting> {
    settings.all.iter().find(|setting| alias(&setting.name) == name)
}

/// Returns the number of a setting; `None` if it has none.
pub(super) fn number(setting: &CraftSetting) -> Option<f32> {
    match &setting.allowed {
        Allowed::Words(words) => {
            words.iter().position(|word| word.eq_ignore_ascii_case(&setting.value)).map(|at| at as f32)
        }
        Allowed::Number { .. } | Allowed::Unknown => setting.value.parse().ok(),
        Allowed::Numbers(_) | Allowed::Text(_) => None,
    }
}

/// Returns the text that gives a setting this number.
///
/// # Errors
/// Fails with a sentence if the setting does not take it.
pub(super) fn value(setting: &CraftSetting, number: f32) -> Result<String, String> {
    let whole = number.round() as i64;
    let is_whole = (f64::from(number) - whole as f64).abs() < 1e-3;
    match &setting.allowed {
        _ if !is_whole => Err(format!("{} takes whole numbers, not {number}.", setting.name)),
        Allowed::Words(words) => {
            let word = usize::try_from(whole).ok().and_then(|at| words.get(at)).cloned();
            word.ok_or_else(|| format!("{} has the values 0 to {}.", setting.name, words.len().max(1) - 1))
        }
        Allowed::Number { min, max } if !(min..=max).contains(&&whole) => {
            Err(format!("{} = {whole} is not allowed: {min} to {max}.", setting.name))
        }
        Allowed::Number { .. } | Allowed::Unknown | Allowed::Numbers(_) | Allowed::Text(_) => {
            Ok(whole.to_string())
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::firmware::settings::SETTINGS;

    #[test]
    fn the_parameters_have_short_names_of_their_own() {
        let mut names = BTreeMap::new();
        let shown = |name: &str| SHOWN.iter().any(|start| name.starts_with(start));
        for setting in SETTINGS.iter().filter(|setting| shown(setting.name)) {
            let alias = alias(setting.name);
            assert!(alias.len() <= LONGEST && !alias.is_empty(), "{alias}");
            if let Some(other) = names.insert(alias.clone(), setting.name) {
                panic!("{alias} is {other} and {}", setting.name);
            }
        }
        assert_eq!(alias("ap_waypoint_arrival_radius"), "AP_WP_RADIUS");
        assert!(names.len() > 60);
    }

    #[test]
    fn the_page_lists_parameters_and_messages() {
        let shown = |name: &str| SHOWN.iter().any(|start| name.starts_with(start));
        let rows = |head: &str, rows: Vec<String>| format!("{head}\n{}\n", rows.join("\n"));
        let settings = SETTINGS.iter().filter(|setting| shown(setting.name));
        let settings = settings.map(|setting| format!("| `{}` | `{}` |", alias(setting.name), setting.name));
        let messages = crate::mavlink::message::table()
            .iter()
            .map(|info| format!("| {} | {} | {:?} | {} |", info.id, info.name, info.direction, info.summary));
        let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/mavlink.md");
        let written = std::fs::read_to_string(page).unwrap_or_default();
        for table in [
            rows("| parameter | setting |\n| --- | --- |", settings.collect()),
            rows("| id | message | direction | |\n| --- | --- | --- | --- |", messages.collect()),
        ] {
            assert!(written.contains(&table), "{page} misses\n{table}");
        }
    }

    #[test]
    fn a_word_is_its_place_and_values_out_of_range_are_refused() {
        let words = ["CONTINUE", "LAND", "DISABLE"].map(str::to_owned).to_vec();
        let policy = CraftSetting {
            name: "ap_rx_loss_policy".to_owned(),
            value: "LAND".to_owned(),
            allowed: Allowed::Words(words),
            ..CraftSetting::default()
        };
        assert_eq!(number(&policy), Some(1.0));
        assert_eq!(value(&policy, 2.0).as_deref(), Ok("DISABLE"));
        assert!(value(&policy, 3.0).unwrap_err().contains("0 to 2") && value(&policy, 0.5).is_err());
        let angle = CraftSetting {
            name: "ap_max_angle".to_owned(),
            allowed: Allowed::Number { min: 10, max: 70 },
            ..CraftSetting::default()
        };
        assert_eq!(value(&angle, 30.0).as_deref(), Ok("30"));
        assert!(value(&angle, 71.0).unwrap_err().contains("10 to 70"));
    }
}
