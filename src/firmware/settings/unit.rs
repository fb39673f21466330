//! The unit of a setting, from its description. The description is the only place that names it.

/// The units of the descriptions.
const UNITS: [&str; 33] = [
    "0.0001 deg per (m/s)2",
    "0.01",
    "0.01 Hz",
    "0.01 V",
    "0.01 per s",
    "0.01 percent of the range",
    "0.01 s",
    "0.1 Hz",
    "0.1 deg",
    "0.1 deg per m",
    "0.1 deg per m/s",
    "0.1 deg per m/s²",
    "0.1 m/s",
    "0.1 mV/A",
    "0.1 per s",
    "0.1 percent",
    "0.1 s",
    "100 deg/s²",
    "1000 deg/s²",
    "Hz",
    "cm",
    "cm/s",
    "cm/s²",
    "deg",
    "deg/s",
    "gyro units",
    "m",
    "mA",
    "mAh",
    "minutes",
    "ms",
    "percent",
    "rpm per volt",
];
/// The units that are shown in another way than they are described.
const SHORT: [(&str, &str); 3] =
    [("percent", "%"), ("0.1 percent", "0.1 %"), ("0.01 percent of the range", "0.01 %")];

/// Returns the unit at the end of the first clause of a description; empty if there is none.
pub(super) fn of_help(help: &'static str) -> &'static str {
    let clause = help.split(';').next().unwrap_or_default().trim_end_matches('.');
    let Some((_, end)) = clause.rsplit_once(", ") else { return "" };
    if let Some((_, short)) = SHORT.iter().find(|(unit, _)| *unit == end) {
        return short;
    }
    let is_unit = UNITS.contains(&end) || matches!(end, "s" | "µs");
    if is_unit { end } else { "" }
}

#[cfg(test)]
mod tests {
    use super::super::{Kind, SETTINGS};
    use super::*;

    #[test]
    fn every_unit_in_the_list_is_used_and_no_description_has_another() {
        let ends: Vec<&str> = SETTINGS
            .iter()
            .filter_map(|setting| {
                let clause = setting.help.split(';').next()?;
                Some(clause.trim_end_matches('.').rsplit_once(", ")?.1)
            })
            .collect();
        for unit in UNITS {
            assert!(ends.contains(&unit), "no setting is in {unit}");
        }
        // The end of a clause that is not a unit has words of its own.
        for setting in &SETTINGS {
            let clause = setting.help.split(';').next().unwrap_or_default().trim_end_matches('.');
            let Some((_, end)) = clause.rsplit_once(", ") else { continue };
            let is_word = !end.contains(' ') && !end.ends_with(')');
            let looks_like_one = end.starts_with(|c: char| c.is_ascii_digit()) || is_word;
            let is_known = !of_help(setting.help).is_empty() || end == "0 is linear";
            assert!(!looks_like_one || is_known, "{}: {end}", setting.name);
        }
    }

    #[test]
    fn units_are_those_of_the_descriptions() {
        let unit = |name: &str| super::super::find(name).map(|setting| of_help(setting.help));
        assert_eq!(unit("ap_max_velocity"), Some("cm/s"));
        assert_eq!(unit("ap_hover_throttle"), Some("µs"));
        assert_eq!(unit("vbat_warning_cell_voltage"), Some("0.01 V"));
        assert_eq!(unit("thr_corr_value"), Some("0.1 %"));
        assert_eq!(unit("ap_yaw_mode"), Some(""));
        let words = SETTINGS.iter().filter(|setting| matches!(setting.kind, Kind::Choice { .. }));
        assert!(words.map(|setting| of_help(setting.help)).all(str::is_empty));
    }
}
