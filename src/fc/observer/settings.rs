//! The settings of a remote flight controller, as far as they were read.

use std::sync::Arc;

use crate::fc::telemetry::settings;
use crate::firmware::cli::Interpreter;
use crate::firmware::config::Configuration;
use crate::firmware::{Firmware, FirmwareOptions};
use crate::telemetry::snapshot::SettingsView;

/// A setting that exists only in firmware with waypoint altitudes above home. Other firmware uses altitudes
/// above sea level.
const COUNTS_FROM_HOME: &str = "ap_velocity_p";
/// The prefix of the autopilot's settings.
const AUTOPILOT: &str = "ap_";

/// The setting that makes it use its magnetometer.
const TRUSTS_MAG: &str = "trust_mag";

/// The settings that one flight controller has reported. An embedded firmware with the same settings shows
/// their consequences.
#[derive(Debug, Clone, Default)]
pub(super) struct Settings {
    twin: Option<Box<Firmware>>,
    /// The configuration of the twin after the last answer.
    configuration: Option<Arc<Configuration>>,
    /// `true` if the autopilot's settings were among them.
    knows_autopilot: bool,
    waypoints_from_home: bool,
    trusts_mag: bool,
}

impl Settings {
    /// Takes the output of `get`. Settings that this program does not know or allow have no effect on the
    /// display.
    pub(super) fn read(&mut self, output: &str) {
        let twin = self.twin.get_or_insert_with(|| {
            Box::new(Firmware::new(Configuration::default(), FirmwareOptions::default()))
        });
        for (name, value) in settings(output) {
            self.knows_autopilot |= name.starts_with(AUTOPILOT);
            self.waypoints_from_home |= name == COUNTS_FROM_HOME;
            if name == TRUSTS_MAG {
                self.trusts_mag = value == "ON";
            }
            twin.run_cli(&mut Interpreter::default(), &format!("set {name} = {value}"));
        }
        let profile = if self.knows_autopilot && !self.waypoints_from_home { "MASTER" } else { "GUIDE" };
        twin.run_cli(&mut Interpreter::default(), &format!("set ap_profile = {profile}"));
        self.configuration = Some(Arc::new(twin.configuration().clone()));
    }

    /// Returns the configuration of an embedded firmware with these settings; `None` until those of the autopilot are known.
    pub(super) fn configuration(&self) -> Option<Arc<Configuration>> {
        self.configuration.clone().filter(|_| self.knows_autopilot)
    }

    pub(super) fn view(&self) -> Option<SettingsView> {
        self.twin.as_ref().map(|twin| twin.settings_view())
    }

    /// Returns `true` if its heading comes from the magnetometer.
    pub(super) fn trusts_mag(&self) -> bool {
        self.trusts_mag
    }

    /// Returns `true` if the reference of waypoint altitudes is known.
    pub(super) fn report_altitude_reference(&self) -> bool {
        self.knows_autopilot
    }

    pub(super) fn waypoints_from_home(&self) -> bool {
        self.waypoints_from_home
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::FirmwareProfile;

    #[test]
    fn what_was_read_is_shown_and_the_rest_is_as_usual() {
        let mut read = Settings::default();
        assert!(read.view().is_none() && !read.report_altitude_reference());
        read.read("alt_hold_climb_rate = 50\r\n");
        assert!(!read.report_altitude_reference());
        read.read(
            "ap_waypoint_arrival_radius = 700\r\nAllowed range: 100 - 10000\r\n\r\nap_new_thing = 5\r\n",
        );
        let view = read.view().unwrap();
        assert!((view.arrival_radius_m - 7.0).abs() < 1e-9 && !read.waypoints_from_home());
        assert!(read.report_altitude_reference());
        assert_eq!(view.profile, FirmwareProfile::Master);
        read.read("ap_velocity_p = 30\r\n");
        assert!(read.waypoints_from_home());
        assert_eq!(read.view().unwrap().profile, FirmwareProfile::Guide);
    }
}
