//! The mounting of the magnetometer, as its settings state it.

use nalgebra::Rotation3;

use crate::firmware::settings::Settings;
use crate::telemetry::FirmwareProfile;

/// Radians of a tenth of a degree.
const DECIDEGREE: f64 = std::f64::consts::PI / 1800.0;
/// Roll, pitch and yaw of the mountings with a name, degrees, anticlockwise seen from above.
const NAMED_DEG: [(&str, [f64; 3]); 8] = [
    ("CW0", [0.0, 0.0, 0.0]),
    ("CW90", [0.0, 0.0, -90.0]),
    ("CW180", [0.0, 0.0, 180.0]),
    ("CW270", [0.0, 0.0, 90.0]),
    ("CW0FLIP", [0.0, 180.0, 0.0]),
    ("CW90FLIP", [0.0, 180.0, -90.0]),
    ("CW180FLIP", [0.0, 180.0, 180.0]),
    ("CW270FLIP", [0.0, 180.0, 90.0]),
];

/// Returns the rotation from the axes of the sensor to those of the body (forward, left, up): first about the roll axis,
/// then pitch, then yaw. The signs were measured on master's SITL target. `None` in a profile that does not use it.
pub(super) fn mag_alignment(settings: &Settings) -> Option<Rotation3<f64>> {
    if settings.profile() != FirmwareProfile::Master {
        return None;
    }
    let chosen = settings.text("align_mag");
    let [roll, pitch, yaw] = if chosen == "CUSTOM" {
        ["mag_align_roll", "mag_align_pitch", "mag_align_yaw"]
            .map(|name| settings.number(name) as f64 * DECIDEGREE)
    } else {
        // DEFAULT is that of the simulated sensor, which is not turned.
        let (_, angles) = NAMED_DEG.iter().find(|(name, _)| *name == chosen)?;
        angles.map(f64::to_radians)
    };
    Some(Rotation3::from_euler_angles(roll, pitch, yaw))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::firmware::settings::{Kind, find};

    const CUSTOM: &str = "CUSTOM";

    /// Returns the compass heading (degrees) of a craft that points north, with 60° of dip.
    fn heading_deg(mounting: &str, custom: [i64; 3], profile: FirmwareProfile) -> Option<f64> {
        let mut settings = Settings::default();
        let Some(Kind::Choice { words, .. }) = find("align_mag").map(|setting| setting.kind) else {
            return None;
        };
        let at = words.iter().position(|word| *word == mounting)?;
        let [roll, pitch, yaw] = custom;
        for (name, number) in [
            ("ap_profile", i64::from(profile == FirmwareProfile::Master)),
            ("align_mag", at as i64),
            ("mag_align_roll", roll),
            ("mag_align_pitch", pitch),
            ("mag_align_yaw", yaw),
        ] {
            settings.set_number(name, number).expect("allowed");
        }
        let field = mag_alignment(&settings)? * Vector3::new(0.5, 0.0, -0.75_f64.sqrt());
        Some(crate::math::atan2(field.y, field.x).to_degrees().rem_euclid(360.0))
    }

    #[test]
    fn the_mounting_turns_the_heading_as_in_the_executable() {
        for (mounting, custom, measured_deg) in [
            ("CW90", [0; 3], 271.0),
            ("CW270", [0; 3], 91.0),
            ("CW0FLIP", [0; 3], 185.0),
            ("CW90FLIP", [0; 3], 95.0),
            ("CW180FLIP", [0; 3], 5.0),
            (CUSTOM, [0, 0, 300], 30.0),
            (CUSTOM, [0, 0, 1800], 180.0),
            (CUSTOM, [450, 0, 300], 83.0),
            (CUSTOM, [0, 450, 300], 220.0),
        ] {
            let heading = heading_deg(mounting, custom, FirmwareProfile::Master).expect("a rotation");
            let error = (heading - measured_deg + 180.0).rem_euclid(360.0) - 180.0;
            assert!(error.abs() < 11.0, "{mounting} {custom:?}: {heading} instead of {measured_deg}");
        }
    }

    #[test]
    fn the_profile_guide_and_the_default_mounting_turn_nothing() {
        assert_eq!(heading_deg("CW90", [0; 3], FirmwareProfile::Guide), None);
        assert_eq!(heading_deg("DEFAULT", [0, 0, 900], FirmwareProfile::Master), None);
    }
}
