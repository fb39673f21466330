//! Replacement of settings of the test guide with which upstream's master does not fly as the guide expects.
//!
//! Master's waypoint altitudes count from sea level. It sets the target of LAND 200 m below the craft and limits neither the
//! error of its altitude loop nor the answer to it: 20 000 cm · 0.005 µs/cm · `ap_altitude_p` is 5000 µs with the guide's
//! 50. The motors go to `ap_throttle_min`, and the craft comes down at 18 m/s. With little P against much D it comes down at
//! 2 m/s (measured). It refuses a cutoff of the position loop below 1 Hz (10), and 1 Hz makes it swing about
//! the legs (measured), so it keeps its own 3 Hz (30).

/// A setting of the guide with its replacement.
struct Replaced {
    name: &'static str,
    of_guide: &'static str,
    for_master: &'static str,
}

const REPLACED: [Replaced; 3] = [
    Replaced { name: "ap_altitude_p", of_guide: "50", for_master: "2" },
    Replaced { name: "ap_altitude_d", of_guide: "20", for_master: "200" },
    Replaced { name: "ap_position_cutoff", of_guide: "5", for_master: "30" },
];

/// Returns the replacement `NAME = VALUE` for a setting of the guide. Other values are the user's choice.
pub fn replacement(setting: &str) -> Option<String> {
    let (name, value) = setting.split_once('=')?;
    let (name, value) = (name.trim(), value.trim());
    let replaced = REPLACED
        .iter()
        .find(|replaced| replaced.name.eq_ignore_ascii_case(name) && replaced.of_guide == value)?;
    Some(format!("{} = {}", replaced.name, replaced.for_master))
}

/// Replaces such settings. Returns the replacements.
pub fn replace_settings(settings: &mut [String]) -> Vec<String> {
    let mut replaced = Vec::new();
    for setting in settings {
        if let Some(instead) = replacement(setting) {
            setting.clone_from(&instead);
            replaced.push(instead);
        }
    }
    replaced
}

/// Returns the notice that these settings replaced the guide's; `None` if there are none.
pub fn replaced_reported(settings: &[String]) -> Option<String> {
    (!settings.is_empty()).then(|| {
        format!(
            "This firmware falls in LAND with the guide's altitude gains and refuses its position cutoff, so it gets {} \
             instead; your own settings are left unchanged.",
            settings.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_guides_settings_are_replaced_and_those_somebody_chose_stay() {
        assert_eq!(replacement("ap_altitude_p = 50").as_deref(), Some("ap_altitude_p = 2"));
        assert_eq!(replacement("AP_ALTITUDE_D=20").as_deref(), Some("ap_altitude_d = 200"));
        assert_eq!(replacement("ap_position_cutoff = 5").as_deref(), Some("ap_position_cutoff = 30"));
        for stays in ["ap_altitude_p = 30", "ap_altitude_i = 30", "ap_altitude_p", "ap_altitude_p = 500"] {
            assert_eq!(replacement(stays), None, "{stays}");
        }
        let mut settings = ["ap_altitude_p = 50", "ap_altitude_d = 60"].map(str::to_owned);
        assert_eq!(replace_settings(&mut settings), ["ap_altitude_p = 2"]);
        assert_eq!(settings, ["ap_altitude_p = 2", "ap_altitude_d = 60"]);
    }
}
