//! The settings in an output of `get`, which prints for each setting its value, its profile, its range and, if it has
//! another value, its default.

use super::{Allowed, CraftSetting, CraftSettings, described};
use crate::firmware::settings;

/// The most settings that are read, several times those of any firmware.
const MOST: usize = 5000;
/// The most words of a list.
const MAX_WORDS: usize = 1000;
/// The longest text that is taken for the name of a setting, bytes.
const MAX_NAME: usize = 64;
/// The first words of the lines below a value.
const RANGE: &str = "Allowed range:";
const WORDS: &str = "Allowed values:";
const LENGTH: &str = "Array length:";
const TEXT: &str = "String length:";
const DEFAULT: &str = "Default value:";
/// The lines that name the profile of a value.
const PROFILES: [&str; 3] = ["profile", "rateprofile", "battery_profile"];

impl CraftSettings {
    /// Returns the settings in an output of `get`, those of the embedded firmware's table first and in its order.
    pub fn from_get(output: &str) -> Self {
        let mut all: Vec<CraftSetting> = Vec::new();
        for line in output.lines().map(str::trim) {
            match (value_line(line), all.last_mut()) {
                (Some((name, value)), _) => {
                    if all.len() == MOST {
                        break;
                    }
                    all.push(CraftSetting { value: value.to_owned(), ..described(name) });
                }
                (None, Some(setting)) => take_detail(setting, line),
                (None, None) => {}
            }
        }
        for setting in &mut all {
            // A default is printed only where the value differs from it.
            setting.default.get_or_insert_with(|| setting.value.clone());
        }
        let place = |setting: &CraftSetting| {
            let is_same = |other: &str| other.eq_ignore_ascii_case(&setting.name);
            settings::SETTINGS.iter().position(|row| is_same(row.name)).unwrap_or(usize::MAX)
        };
        all.sort_by_cached_key(place);
        Self { all }
    }
}

/// Returns name and value of the first line of a setting.
fn value_line(line: &str) -> Option<(&str, &str)> {
    let (name, value) = line.split_once(" =")?;
    let is_name = !name.is_empty()
        && name.len() <= MAX_NAME
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    is_name.then(|| (name, value.trim()))
}

fn take_detail(setting: &mut CraftSetting, line: &str) {
    if let Some(range) = line.strip_prefix(RANGE) {
        let limits = range.trim().split_once(" - ");
        let limits = limits.and_then(|(min, max)| Some((min.trim().parse().ok()?, max.trim().parse().ok()?)));
        if let Some((min, max)) = limits.filter(|(min, max)| min <= max) {
            setting.allowed = Allowed::Number { min, max };
        }
    } else if let Some(words) = line.strip_prefix(WORDS) {
        let words = words.split(',').map(str::trim).filter(|word| !word.is_empty());
        setting.allowed = Allowed::Words(words.take(MAX_WORDS).map(str::to_owned).collect());
    } else if let Some(length) = line.strip_prefix(LENGTH) {
        setting.allowed = length.trim().parse().map_or(Allowed::Unknown, Allowed::Numbers);
    } else if let Some(length) = line.strip_prefix(TEXT) {
        let most = length.rsplit(" - ").next().unwrap_or_default();
        setting.allowed = most.trim().parse().map_or(Allowed::Unknown, Allowed::Text);
    } else if let Some(default) = line.strip_prefix(DEFAULT) {
        setting.default = Some(default.trim().to_owned());
    } else if is_profile(line) {
        line.clone_into(&mut setting.profile);
    } else if line == "No effect here" {
        setting.is_carried = true;
    }
}

fn is_profile(line: &str) -> bool {
    let number = |rest: &str| !rest.is_empty() && rest.bytes().all(|byte| byte.is_ascii_digit());
    line.split_once(' ').is_some_and(|(word, rest)| PROFILES.contains(&word) && number(rest))
}

#[cfg(test)]
mod tests {
    use super::super::OTHERS;
    use super::*;
    use crate::firmware::cli::Interpreter;
    use crate::firmware::config::Configuration;
    use crate::firmware::{Firmware, FirmwareOptions};
    use proptest::prelude::*;

    const OUTPUT: &str = "ap_new_thing = 5\r\nAllowed range: 0 - 9\r\n\r\n\
        p_roll = 60\r\nprofile 0\r\nAllowed range: 0 - 250\r\nDefault value: 45\r\n\r\n\
        gyro_lpf1_type = PT1\r\nAllowed values: PT1, BIQUAD, PT2, PT3\r\n\r\n\
        acc_calibration = 0,0,0,0\r\nArray length: 4\r\n\r\n\
        craft_name = \r\nString length: 1 - 16\r\n";

    #[test]
    fn the_output_of_another_firmware_is_read_in_the_order_of_the_reference() {
        let read = CraftSettings::from_get(OUTPUT);
        let names: Vec<&str> = read.all.iter().map(|setting| setting.name.as_str()).collect();
        assert_eq!(names, ["gyro_lpf1_type", "acc_calibration", "p_roll", "craft_name", "ap_new_thing"]);
        let roll = read.find("p_roll").unwrap();
        assert_eq!((roll.value.as_str(), roll.default.as_deref()), ("60", Some("45")));
        assert_eq!((roll.profile.as_str(), roll.is_changed()), ("profile 0", true));
        assert!(!roll.help.is_empty() && roll.group == "PID profile");
        let new = read.find("ap_new_thing").unwrap();
        assert_eq!((new.group, new.help, new.is_changed()), (OTHERS, "", false));
        assert_eq!(new.allowed, Allowed::Number { min: 0, max: 9 });
        assert_eq!(read.find("acc_calibration").unwrap().allowed, Allowed::Numbers(4));
        assert_eq!(read.find("craft_name").unwrap().allowed, Allowed::Text(16));
        assert!(
            matches!(&read.find("gyro_lpf1_type").unwrap().allowed, Allowed::Words(words) if words.len() == 4)
        );
        assert_eq!(CraftSettings::from_get("###ERROR: CLOSED###\r\n"), CraftSettings::default());
    }

    #[test]
    fn what_the_embedded_firmware_prints_is_what_it_has() {
        let mut firmware = Firmware::new(Configuration::default(), FirmwareOptions::default());
        let mut console = Interpreter::default();
        firmware.run_cli(&mut console, "set ap_max_angle = 25");
        firmware.run_cli(&mut console, "set rc_smoothing = OFF");
        let printed = CraftSettings::from_get(&firmware.run_cli(&mut console, "get").text);
        let held = CraftSettings::from_configuration(firmware.configuration(), None);
        assert_eq!(printed.all.len(), held.all.len());
        for (printed, held) in std::iter::zip(&printed.all, &held.all) {
            // Ports have no line with their range, and the role is not printed for most settings.
            let is_port = printed.allowed == Allowed::Unknown;
            let allowed = if is_port { &Allowed::Unknown } else { &held.allowed };
            assert_eq!(&printed.allowed, allowed, "{}", held.name);
            let held =
                CraftSetting { allowed: allowed.clone(), is_carried: printed.is_carried, ..held.clone() };
            assert_eq!(*printed, held);
        }
    }

    proptest! {
        #[test]
        fn any_output_is_read(lines in prop::collection::vec("[a-z_0-9]{0,8}( = |: | - |,| )?[-0-9A-Za-z, ]{0,12}", 0..40)) {
            let read = CraftSettings::from_get(&lines.join("\r\n"));
            prop_assert!(read.all.len() <= lines.len());
            for setting in &read.all {
                let _ = (setting.read("1"), setting.nudged(1), setting.allowed.to_string());
            }
        }
    }
}
