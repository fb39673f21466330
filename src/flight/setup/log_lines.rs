//! The settings in the header of a log.

use crate::firmware::settings::{self, Kind};

/// The lines of a header that hold several settings, with the names of these.
const SEVERAL: &[(&str, &[&str])] = &[
    ("rc_rates", &["roll_rc_rate", "pitch_rc_rate", "yaw_rc_rate"]),
    ("rc_expo", &["roll_expo", "pitch_expo", "yaw_expo"]),
    ("rates", &["roll_srate", "pitch_srate", "yaw_srate"]),
    ("rate_limits", &["roll_rate_limit", "pitch_rate_limit", "yaw_rate_limit"]),
    ("rollPID", &["p_roll", "i_roll", "d_roll"]),
    ("pitchPID", &["p_pitch", "i_pitch", "d_pitch"]),
    ("yawPID", &["p_yaw", "i_yaw", "d_yaw"]),
    ("levelPID", &["angle_p_gain", "horizon_level_strength", "horizon_limit_sticks"]),
    ("d_max", &["d_max_roll", "d_max_pitch", "d_max_yaw"]),
    ("ff_weight", &["f_roll", "f_pitch", "f_yaw"]),
    ("vbatcellvoltage", &["vbat_min_cell_voltage", "vbat_warning_cell_voltage", "vbat_max_cell_voltage"]),
];

/// The settings that a simulated craft keeps: its logging, and what its simulated hardware determines.
const KEPT: &[&str] = &["motor_pwm_protocol", "pid_process_denom", "vbat_scale", "serialrx_provider"];

/// Returns the settings of a header's lines, each as `name = value`, that this firmware has and accepts. In headers, words
/// are numbers: their positions in the list.
pub fn settings_of_log<'a>(lines: impl Iterator<Item = (&'a str, &'a str)>) -> Vec<String> {
    let mut found = Vec::new();
    for (name, value) in lines {
        match SEVERAL.iter().find(|(line, _)| *line == name) {
            Some((_, names)) => {
                found
                    .extend(names.iter().zip(value.split(',')).filter_map(|(name, value)| line(name, value)));
            }
            None => found.extend(line(name, value)),
        }
    }
    found
}

/// A setting in the header of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LoggedSetting {
    /// The name of the setting.
    pub name: String,
    /// The value; a word if this firmware has one for it.
    pub value: String,
    /// The default of this firmware, if it has the setting.
    pub default: Option<String>,
}

impl LoggedSetting {
    /// Returns `true` if it differs from the default of this firmware.
    pub fn is_changed(&self) -> bool {
        self.default.as_ref().is_some_and(|default| *default != self.value)
    }

    fn of(name: &str, value: &str) -> Self {
        let value = value.trim();
        let setting = settings::find(name);
        let word = setting.and_then(|setting| match setting.kind {
            Kind::Choice { words, .. } => words.get(value.parse::<usize>().ok()?).copied(),
            _ => None,
        });
        Self {
            name: setting.map_or(name, |setting| setting.name).to_owned(),
            value: word.unwrap_or(value).to_owned(),
            default: setting.map(|setting| setting.display(&setting.default_value())),
        }
    }
}

/// Returns the lines of a header as settings, each with its default if this firmware has it. A line with several settings
/// becomes several.
pub fn logged_settings<'a>(lines: impl Iterator<Item = (&'a str, &'a str)>) -> Vec<LoggedSetting> {
    let mut found = Vec::new();
    for (name, value) in lines {
        let several =
            SEVERAL.iter().find(|(line, names)| *line == name && value.split(',').count() == names.len());
        match several {
            Some((_, names)) => {
                let pairs = names.iter().zip(value.split(','));
                found.extend(pairs.map(|(name, value)| LoggedSetting::of(name, value)));
            }
            None => found.push(LoggedSetting::of(name, value)),
        }
    }
    found
}

/// Returns the setting if the firmware has it and accepts the value.
fn line(name: &str, value: &str) -> Option<String> {
    let setting = settings::find(name)?;
    if KEPT.contains(&setting.name) || setting.name.starts_with("blackbox_") || setting.hardware {
        return None;
    }
    let value = match setting.kind {
        Kind::Choice { words, .. } => words.get(value.trim().parse::<usize>().ok()?)?,
        Kind::Port { .. } => return None,
        Kind::Number { .. } | Kind::Array { .. } | Kind::Text { .. } => value.trim(),
    };
    settings::judge(setting.name, value).ok()?;
    Some(format!("{} = {value}", setting.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_of_a_header_are_those_that_the_firmware_has_and_accepts() {
        let lines = [
            ("Firmware type", "Betaflight"),
            ("rollPID", "50,90,35"),
            ("ap_max_angle", "25"),
            ("rc_smoothing", "1"),
            ("ap_rx_loss_policy", "2"),
            ("yaw_expo", "300"),
            ("blackbox_sample_rate", "2"),
            ("something_else", "5"),
        ];
        let found = settings_of_log(lines.into_iter());
        assert_eq!(found[..3], ["p_roll = 50", "i_roll = 90", "d_roll = 35"]);
        assert!(
            found.contains(&"ap_max_angle = 25".to_owned())
                && found.contains(&"ap_rx_loss_policy = LAND".to_owned())
        );
        assert!(
            !found.iter().any(|setting| setting.contains("yaw_expo") || setting.contains("blackbox")),
            "{found:?}"
        );
    }

    #[test]
    fn lines_of_a_header_have_the_defaults_of_this_firmware() {
        let lines = [
            ("rollPID", "50,80,30"),
            ("ap_rx_loss_policy", "2"),
            ("Craft name", "x"),
            ("ap_max_angle", "50"),
        ];
        let found = logged_settings(lines.into_iter());
        let row = |name: &str| found.iter().find(|setting| setting.name == name).unwrap();
        assert!(row("p_roll").is_changed() && row("p_roll").value == "50" && row("p_roll").default.is_some());
        assert_eq!(row("ap_rx_loss_policy").value, "LAND");
        assert_eq!((row("Craft name").default.as_deref(), row("Craft name").is_changed()), (None, false));
        assert_eq!(
            (row("ap_max_angle").default.as_deref(), row("ap_max_angle").is_changed()),
            (Some("50"), false)
        );
    }
}
