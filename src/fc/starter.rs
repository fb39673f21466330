//! The configuration of a remote firmware before a flight.

use super::ProvisionLines;
use crate::firmware::cli::Interpreter;
use crate::firmware::config::Configuration;
use crate::firmware::{Firmware, FirmwareOptions};
use crate::plan::builtin::{BuiltinPlan, DEMO};

/// GPS RESCUE on AUX4. The embedded firmware flies home by a command, a remote one by this switch only.
const RESCUE: &str = "aux 5 46 3 1700 2100 0 0";

/// The end of a row of `aux` that binds no switch.
const UNUSED: &str = "900 900 0 0";

/// Without a trusted compass, a craft has no heading until it first flies forward. The SITL computes a magnetic field
/// that points 2° east.
const COMPASS: [&str; 2] = ["set trust_mag = ON", "set mag_declination = 20"];

/// Returns the command lines for a firmware. For a firmware without a configuration of its own, the guide's settings
/// and a compass come first, and the starter modes unless the user's lines bind switches.
pub fn starter_lines(wanted: &ProvisionLines, is_fresh: bool) -> Result<ProvisionLines, &'static str> {
    let mut lines = ProvisionLines { usual: Vec::new(), of_user: wanted.of_user.clone() };
    if is_fresh {
        lines.usual.extend(guide_settings()?.into_iter().map(|setting| format!("set {setting}")));
        lines.usual.extend(COMPASS.map(str::to_owned));
        if !wanted.of_user.iter().any(|line| line.trim_start().starts_with("aux ")) {
            lines.usual.extend(starter_modes());
        }
    }
    lines.usual.extend_from_slice(&wanted.usual);
    Ok(lines)
}

/// Returns the settings of the plan that the guide flies.
pub fn guide_settings() -> Result<Vec<String>, &'static str> {
    let plan = BuiltinPlan::find(DEMO).and_then(|plan| plan.read().ok()).ok_or("the demo plan is missing")?;
    Ok(plan.settings)
}

/// Returns the rows of `aux` that the embedded firmware gets at its first boot, and one for the return home.
fn starter_modes() -> Vec<String> {
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    let mut firmware = Firmware::new(configuration, FirmwareOptions::default());
    let rows = firmware.run_cli(&mut Interpreter::default(), "aux").text;
    let bound = rows.lines().filter(|row| row.starts_with("aux") && !row.ends_with(UNUSED));
    bound.chain([RESCUE]).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_firmware_without_a_configuration_gets_the_guides_and_switches() {
        let of_user = ProvisionLines { usual: Vec::new(), of_user: vec!["set ap_max_angle = 30".to_owned()] };
        assert_eq!(starter_lines(&of_user, false).expect("lines"), of_user);
        let fresh = starter_lines(&of_user, true).expect("lines");
        assert_eq!(fresh.of_user, of_user.of_user);
        let fresh = fresh.usual;
        assert_eq!(fresh.iter().filter(|line| line.starts_with("set ap_")).count(), 24);
        assert!(fresh.contains(&"set trust_mag = ON".to_owned()), "{fresh:?}");
        let aux: Vec<&str> =
            fresh.iter().map(String::as_str).filter(|line| line.starts_with("aux")).collect();
        assert_eq!(
            aux,
            [
                "aux 0 0 0 1700 2100 0 0",
                "aux 1 56 1 1700 2100 0 0",
                "aux 2 1 2 1700 2100 0 0",
                "aux 3 3 2 1700 2100 0 0",
                "aux 4 11 2 1700 2100 0 0",
                "aux 5 46 3 1700 2100 0 0"
            ]
        );
        let bound = ProvisionLines { usual: Vec::new(), of_user: vec!["aux 0 0 3 1700 2100 0 0".to_owned()] };
        let fresh = starter_lines(&bound, true).expect("lines");
        assert!(!fresh.usual.iter().any(|line| line.starts_with("aux")), "{fresh:?}");
    }
}
