//! Settings whose range or default depends on the profile of the autopilot.

use super::{Kind, Role, Setting};
use crate::telemetry::FirmwareProfile;

/// The name of the setting that chooses the profile.
pub(super) const NAME: &str = "ap_profile";

/// The rows of the profile `master`: name, least and greatest value, default.
const MASTER: [(&str, i64, i64, i64); 4] = [
    ("ap_altitude_p", 0, 200, 30),
    ("ap_altitude_i", 0, 200, 30),
    ("ap_position_cutoff", 10, 50, 30),
    ("ap_velocity_drag_coeff", 0, 100, 50),
];

/// Returns the settings that depend on the profile.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    MASTER.iter().map(|(name, ..)| *name)
}

/// Returns a setting with the permitted values, the default and the role that it has in a profile.
pub(super) fn resolved(setting: &Setting, profile: FirmwareProfile) -> Setting {
    let row = MASTER.iter().find(|(name, ..)| *name == setting.name);
    let kind = match (profile, row) {
        (FirmwareProfile::Master, Some(&(_, min, max, default))) => Kind::Number { min, max, default },
        (FirmwareProfile::Master, None) | (FirmwareProfile::Guide, _) => setting.kind,
    };
    let role = match setting.role {
        Role::Only(only) if only == profile => Role::Live,
        Role::Only(_) => Role::Carry,
        role => role,
    };
    Setting { kind, role, ..*setting }
}

#[cfg(test)]
mod tests {
    use super::super::{Settings, find};
    use super::*;

    #[test]
    fn the_profile_changes_defaults_but_no_value_that_was_set() {
        let mut settings = Settings::default();
        settings.set_number("ap_altitude_i", 44).expect("allowed");
        settings.set_number("ap_velocity_drag_coeff", 700).expect("allowed");
        settings.set_number(NAME, 1).expect("allowed");
        let now = |settings: &Settings| {
            ["ap_altitude_p", "ap_altitude_i", "ap_velocity_drag_coeff"].map(|name| settings.number(name))
        };
        assert_eq!(now(&settings), [30, 44, 100], "a value beyond the range is limited");
        settings.set_number(NAME, 0).expect("allowed");
        assert_eq!(now(&settings), [15, 44, 100]);
    }

    #[test]
    fn a_setting_acts_in_its_profile() {
        let role = |name: &str, profile| resolved(find(name).expect("a setting"), profile).role;
        for (name, guide, master) in [
            ("ap_l1_period", Role::Live, Role::Carry),
            ("ap_nav_corner_speed", Role::Carry, Role::Live),
            ("ap_max_angle", Role::Live, Role::Live),
        ] {
            let roles = (role(name, FirmwareProfile::Guide), role(name, FirmwareProfile::Master));
            assert_eq!(roles, (guide, master), "{name}");
        }
    }
}
