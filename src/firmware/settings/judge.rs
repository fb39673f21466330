//! Judges a setting in a plan or an option, before any craft gets it, in sentences for people.

use super::parse::parse;
use super::{AssignError, Kind, PORT_NAMES, SETTINGS, Setting, find, foreign_name};
use crate::plan::format::{SettingFault, SettingPart};
use crate::text::did_you_mean;

/// Checks that the craft accepts `value` for the setting `name`. Settings of other builds are kept, whatever their
/// value.
///
/// # Errors
/// Returns the fault and the allowed values.
pub fn judge(name: &str, value: &str) -> Result<(), SettingFault> {
    let Some(setting) = find(name) else {
        return if foreign_name(name).is_some() { Ok(()) } else { Err(unknown(name)) };
    };
    parse(setting, value).map(drop).map_err(|error| wrong_value(setting, value, error))
}

fn unknown(name: &str) -> SettingFault {
    let guess = did_you_mean::closest(name, SETTINGS.iter().map(|setting| setting.name));
    let hint = guess.map_or_else(
        || "the CLI command get lists all settings".to_owned(),
        |guess| format!("did you mean {guess}?"),
    );
    SettingFault { part: SettingPart::Name, message: format!("{name} is not a setting"), hint }
}

fn wrong_value(setting: &Setting, value: &str, error: AssignError) -> SettingFault {
    let name = setting.name;
    let (message, hint) = match setting.kind {
        Kind::Number { min, max, .. } => {
            let digits = value.strip_prefix(['+', '-']).unwrap_or(value);
            let is_whole = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
            let problem = if is_whole { "is out of range" } else { "is not a whole number" };
            (format!("{name} {value} {problem}"), format!("allowed: {min} to {max}"))
        }
        Kind::Choice { words, .. } => (format!("{value} is not a value of {name}"), one_of(value, words)),
        Kind::Port { .. } => (format!("{value} is not a value of {name}"), one_of(value, &PORT_NAMES)),
        Kind::Array { default } => {
            let ((min, max), count) = (setting.width.bounds(), default.len());
            let hint = format!("write {count} whole numbers from {min} to {max} with commas between them");
            (format!("{value} is not a value of {name}"), hint)
        }
        Kind::Text { max } => {
            let problem = if matches!(error, AssignError::TextTooLong { .. }) {
                "is too long"
            } else {
                "is not a value"
            };
            let hint = format!("allowed: 1 to {max} letters, digits and signs, or - for none");
            (format!("{value} {problem} for {name}"), hint)
        }
    };
    SettingFault { part: SettingPart::Value, message, hint }
}

/// Returns the hint for a wrong word: `did you mean ON? allowed: OFF, ON`.
fn one_of(value: &str, words: &[&str]) -> String {
    let guess = did_you_mean::closest(value, words.iter().copied());
    let guess = guess.map_or_else(String::new, |word| format!("did you mean {word}? "));
    format!("{guess}allowed: {}", words.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_craft_takes_is_taken() {
        for (name, value) in [
            ("ap_max_angle", "25"),
            ("AP_L1_ENABLE", "on"),
            ("profile_name", "-"),
            ("acc_calibration", "1,2,3,1"),
            ("abs_control_gain", "whatever"),
        ] {
            assert_eq!(judge(name, value), Ok(()), "{name}");
        }
    }

    #[test]
    fn refusals_say_what_is_allowed() {
        let say = |name: &str, value: &str| judge(name, value).unwrap_err().to_string();
        assert_eq!(say("ap_max_angle", "999"), "ap_max_angle 999 is out of range; allowed: 10 to 70");
        assert!(say("ap_max_angle", "-99999999999999999999").contains(" is out of range; "));
        assert_eq!(say("ap_max_angle", "2.5"), "ap_max_angle 2.5 is not a whole number; allowed: 10 to 70");
        assert_eq!(say("ap_max_angel", "25"), "ap_max_angel is not a setting; did you mean ap_max_angle?");
        assert_eq!(say("foo", "1"), "foo is not a setting; the CLI command get lists all settings");
        assert_eq!(say("ap_l1_enable", "MAYBE"), "MAYBE is not a value of ap_l1_enable; allowed: OFF, ON");
        assert!(say("ap_yaw_mode", "VELOCTY").contains("did you mean VELOCITY? allowed: "));
        assert_eq!(
            say("profile_name", "longer_than"),
            "longer_than is too long for profile_name; allowed: 1 to 8 letters, digits and signs, or - for none"
        );
        assert!(say("acc_calibration", "1,2").contains("whole numbers from "));
    }

    /// Compares the verdict with that of the command line.
    #[test]
    fn the_verdict_is_that_of_the_craft() {
        let mut craft = crate::firmware::settings::Settings::default();
        for setting in &SETTINGS {
            for value in ["0", "1", "-1", "99999999999", "ON", "NONE", "a", "0,0,0", "-", "#"] {
                assert_eq!(
                    judge(setting.name, value).is_ok(),
                    craft.assign(setting, value).is_ok(),
                    "{}",
                    setting.name
                );
            }
        }
    }
}
