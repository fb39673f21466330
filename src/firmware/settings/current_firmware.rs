//! Settings that accept more values here than in current Betaflight, which refuses a configuration with such a value.

use super::Setting;
use crate::telemetry::{FirmwareNotice, FirmwareProfile};

/// The name, and the least and greatest value in current firmware.
const RANGES: [(&str, i64, i64); 2] = [("ap_position_cutoff", 10, 50), ("ap_velocity_drag_coeff", 0, 100)];

/// Returns the notice about a setting that was set to `value` (as displayed), if current firmware refuses that value.
pub fn beyond_current_firmware(setting: &Setting, value: &str) -> Option<FirmwareNotice> {
    let &(name, min, max) = RANGES.iter().find(|(name, ..)| *name == setting.name)?;
    let value = value.parse().ok()?;
    (!(min..=max).contains(&value)).then_some(FirmwareNotice::BeyondCurrentFirmware { name, value, min, max })
}

/// Returns the notice that a setting with this prefix, set to `value` (as displayed), acts in the profile `master` only; `None`
/// in that profile and for the default.
pub fn acts_in_master(setting: &Setting, profile: FirmwareProfile, value: &str) -> Option<FirmwareNotice> {
    let is_of_master = setting.name.starts_with("ap_nav_") && profile == FirmwareProfile::Guide;
    let is_changed = value != setting.display(&setting.default_value());
    (is_of_master && is_changed).then_some(FirmwareNotice::ActsInMaster)
}

#[cfg(test)]
mod tests {
    use super::super::{Kind, find};
    use super::*;

    #[test]
    fn every_row_is_a_setting_that_takes_more_here() {
        for (name, min, max) in RANGES {
            let Some(Kind::Number { min: least, max: most, .. }) = find(name).map(|setting| setting.kind)
            else {
                panic!("{name} is no number");
            };
            assert!(least <= min && max <= most && (least, most) != (min, max), "{name}");
        }
    }

    #[test]
    fn only_a_value_that_current_firmware_refuses_is_reported() {
        let cutoff = find("ap_position_cutoff").expect("a setting");
        let said = |value| beyond_current_firmware(cutoff, value).map(|notice| notice.to_string());
        assert_eq!(
            said("5").as_deref(),
            Some(
                "ap_position_cutoff = 5 is taken here, but current Betaflight refuses it: it allows 10 to 50."
            )
        );
        assert!(said("51").is_some());
        assert_eq!((said("10"), said("50")), (None, None));
        let angle = find("ap_max_angle").expect("a setting");
        assert_eq!(beyond_current_firmware(angle, "70"), None);
    }

    #[test]
    fn a_changed_setting_of_master_suggests_its_profile() {
        let speed = find("ap_nav_corner_speed").expect("a setting");
        let notice = Some(FirmwareNotice::ActsInMaster);
        assert_eq!(acts_in_master(speed, FirmwareProfile::Guide, "300"), notice);
        assert_eq!(acts_in_master(speed, FirmwareProfile::Guide, "220"), None);
        assert_eq!(acts_in_master(speed, FirmwareProfile::Master, "300"), None);
    }
}
