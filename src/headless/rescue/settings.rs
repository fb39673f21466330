//! The settings of a pilot's craft, from the text of its command line.

use crate::flight::setup::check_setting;
use crate::telemetry::FirmwareProfile;

/// The first release whose rescue is a plan of the autopilot: year and month.
const PLANNED: (u32, u32) = (2026, 12);

/// The settings that the rescue uses, and what was left out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PilotSettings {
    /// `NAME = VALUE`, in order.
    pub(super) lines: Vec<String>,
    pub(super) profile: FirmwareProfile,
    /// The version in the heading, if there is one.
    version: Option<String>,
    /// `true` if that version flies the rescue by laws that are not modelled.
    has_own_rescue: bool,
    refused: Vec<String>,
}

impl PilotSettings {
    /// Reads the `set` lines. `profile` is the user's choice.
    pub(super) fn read(text: &str, profile: Option<FirmwareProfile>) -> Self {
        let version = text.lines().find_map(version_in);
        let release = version.as_deref().and_then(release);
        let has_own_rescue = release.is_some_and(|release| release < PLANNED);
        let by_version = match release {
            Some(release) if release >= PLANNED => FirmwareProfile::Master,
            Some(_) | None if text.contains("ap_nav_") => FirmwareProfile::Master,
            Some(_) | None => FirmwareProfile::Guide,
        };
        let (mut lines, mut refused) = (Vec::new(), Vec::new());
        for line in text.lines() {
            let Some((name, value)) = line.trim().strip_prefix("set ").and_then(|rest| rest.split_once('='))
            else {
                continue;
            };
            let (name, value) = (name.trim(), value.trim());
            // The simulated craft has motors and a compass of its own, which is not turned.
            let is_own = matches!(name, "ap_profile" | "motor_pwm_protocol" | "mag_hardware" | "align_mag");
            if is_own || name.starts_with("mag_align_") {
                continue;
            }
            let setting = format!("{name} = {value}");
            let fits = check_setting(name, value).is_ok();
            if fits { lines.push(setting) } else { refused.push(setting) }
        }
        Self { lines, profile: profile.unwrap_or(by_version), version, has_own_rescue, refused }
    }

    /// Returns what the user should know before the flights, as sentences.
    pub(super) fn notices(&self) -> Vec<String> {
        let mut notices = Vec::new();
        match &self.version {
            Some(version) if self.has_own_rescue => notices.push(format!(
                "Betaflight {version} flies GPS RESCUE by laws of its own, which are not modelled: the flights show the \
                 rescue of the profile {}, with these settings.",
                self.profile
            )),
            Some(version) => notices.push(format!("Betaflight {version}: profile {}.", self.profile)),
            None => {
                notices.push(format!("The text names no version: profile {} is flown.", self.profile));
            }
        }
        if self.lines.is_empty() {
            notices.push("The text has no `set` line: the defaults are flown.".to_owned());
        }
        if !self.refused.is_empty() {
            notices.push(format!("Left out, not accepted here: {}.", self.refused.join(", ")));
        }
        notices
    }
}

/// Returns the version in a heading such as `# Betaflight / SITL (SITL) 2026.12.0-alpha Nov 20 2026 …`.
fn version_in(line: &str) -> Option<String> {
    let rest = line.trim().strip_prefix("# Betaflight")?;
    rest.split_whitespace().find(|word| release(word).is_some()).map(str::to_owned)
}

/// Returns the first two numbers of a version.
fn release(version: &str) -> Option<(u32, u32)> {
    let mut parts = version.split('.');
    let (major, minor) = (parts.next()?.parse().ok()?, parts.next()?.parse().ok()?);
    parts.next().map(|_| (major, minor))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_version_decides_about_the_laws() {
        let read = |heading: &str| PilotSettings::read(&format!("{heading}\nset ap_max_angle = 40\n"), None);
        let new =
            read("# Betaflight / STM32H743 (SH74) 2026.12.0 Dec  1 2026 / 10:00:00 (abc) MSP API: 1.49");
        assert_eq!((new.profile, new.has_own_rescue), (FirmwareProfile::Master, false));
        let old =
            read("# Betaflight / STM32F7X2 (S7X2) 4.5.1 Jul 27 2024 / 04:05:30 (77d01ba3b) MSP API: 1.46");
        assert_eq!((old.profile, old.has_own_rescue), (FirmwareProfile::Guide, true));
        assert!(old.notices()[0].contains("not modelled"), "{:?}", old.notices());
        assert_eq!(new.lines, ["ap_max_angle = 40"]);
    }

    #[test]
    fn what_is_no_setting_here_is_named_and_the_craft_keeps_its_own_motors() {
        let text =
            "set motor_pwm_protocol = DSHOT600\nset gps_rescue_return_alt = 9999\naux 0 0 0 1700 2100 0 0\n";
        let read = PilotSettings::read(text, None);
        assert_eq!(read.lines, [""; 0]);
        assert!(read.notices().iter().any(|notice| notice.contains("gps_rescue_return_alt = 9999")));
    }
}
