//! Replacement of the test guide's altitude gains on firmware that falls in LAND with them.
//!
//! Upstream's master, whose waypoint altitudes count from sea level, sets the target of LAND 200 m below the craft and limits
//! neither the error of its altitude loop nor the answer to it: 20 000 cm · 0.005 µs/cm · `ap_altitude_p` is 5000 µs with
//! the guide's 50. The motors go to `ap_throttle_min`, and the craft comes down at 18 m/s. With little P against much D it
//! comes down at 2 m/s (measured).

/// A gain of the guide with its replacement for landing.
struct Gain {
    name: &'static str,
    of_guide: &'static str,
    for_landing: &'static str,
}

const GAINS: [Gain; 2] = [
    Gain { name: "ap_altitude_p", of_guide: "50", for_landing: "2" },
    Gain { name: "ap_altitude_d", of_guide: "20", for_landing: "200" },
];

/// Returns the replacement `NAME = VALUE` for a setting of the guide that lets such a firmware fall. Other
/// values are the user's choice.
pub(super) fn landing_gain(setting: &str) -> Option<String> {
    let (name, value) = setting.split_once('=')?;
    let (name, value) = (name.trim(), value.trim());
    let gain = GAINS.iter().find(|gain| gain.name.eq_ignore_ascii_case(name) && gain.of_guide == value)?;
    Some(format!("{} = {}", gain.name, gain.for_landing))
}

/// Replaces such settings. Returns the replacements.
pub fn replace_falling_gains(settings: &mut [String]) -> Vec<String> {
    let mut replaced = Vec::new();
    for setting in settings {
        if let Some(instead) = landing_gain(setting) {
            setting.clone_from(&instead);
            replaced.push(instead);
        }
    }
    replaced
}

/// Returns the notice that these settings replaced the guide's; `None` if there are none.
pub(super) fn landing_gains_reported(settings: &[String]) -> Option<String> {
    (!settings.is_empty()).then(|| {
        format!(
            "This firmware falls in LAND with the guide's altitude gains, so it gets {} instead; your own gains are \
             left unchanged.",
            settings.join(" and ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_guides_gains_are_replaced_and_those_somebody_chose_stay() {
        assert_eq!(landing_gain("ap_altitude_p = 50").as_deref(), Some("ap_altitude_p = 2"));
        assert_eq!(landing_gain("AP_ALTITUDE_D=20").as_deref(), Some("ap_altitude_d = 200"));
        for stays in ["ap_altitude_p = 30", "ap_altitude_i = 30", "ap_altitude_p", "ap_altitude_p = 500"] {
            assert_eq!(landing_gain(stays), None, "{stays}");
        }
        let mut settings = ["ap_altitude_p = 50", "ap_altitude_d = 60"].map(str::to_owned);
        assert_eq!(replace_falling_gains(&mut settings), ["ap_altitude_p = 2"]);
        assert_eq!(settings, ["ap_altitude_p = 2", "ap_altitude_d = 60"]);
    }
}
