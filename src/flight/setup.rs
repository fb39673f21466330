//! The initial conditions of a flight, as plain data, and the vehicle at boot that they give.
//!
//! Arguments, configuration files and tests produce a [`FlightSetup`]; files have been read before. This module
//! decides the consequences: the place of the craft, the order of the settings, the need for starter modes, and the
//! changes of the firmware for an external physics.

mod boot_lines;
mod home;
mod log_lines;
mod master_settings;
mod notice;

pub use boot_lines::BootLines;
pub use log_lines::{LoggedSetting, logged_settings, settings_of_log};
pub use master_settings::{replace_settings, replaced_reported, replacement};
pub use notice::SetupNotice;

use crate::firmware::cli::BuildInfo;
use crate::firmware::config::Configuration;
use crate::firmware::{AttitudeSource, FirmwareOptions, settings};
use crate::pilot::StickInput;
use crate::plan::format::{self, HomePosition, PlanError, PlanFile, SettingFault};
use crate::sim::{WorldConfig, WorldError};
use crate::telemetry::FirmwareProfile;
use crate::vehicle::{Vehicle, VehicleCommand, VehicleConfig};

/// The silence of the GPS that ends the fix while an external simulator moves the craft, s. Its packets may stall.
const EXTERNAL_GPS_TIMEOUT_S: f64 = 2.5;

/// The declination of the field for the virtual magnetometer while an external simulator moves the craft, degrees
/// east.
const EXTERNAL_DECLINATION_DEG: f64 = 2.0;

/// The source of the line that chooses a profile.
const OF_PROFILE: &str = "--profile";

/// The physics that moves the craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PhysicsSource {
    /// The world of this program.
    #[default]
    Embedded,
    /// A simulator over UDP.
    External,
}

/// The initial conditions of a flight.
#[derive(Debug, Clone, Default)]
pub struct FlightSetup {
    /// Physics that moves the craft.
    pub physics: PhysicsSource,
    /// The craft, the air, step rate, seed and faults. Its home is the default home and gives the heading at boot.
    /// With an external physics only step rate, seed and faults are used.
    pub world: WorldConfig,
    /// Place of the craft, whatever the plan says.
    pub home: Option<HomePosition>,
    /// Plan. Its home is the place of the craft unless `home` is set. Its settings are applied at boot.
    pub plan: PlanFile,
    /// `true` if the flight controller is remote, with a configuration of its own.
    pub remote_controller: bool,
    /// Source of the attitude; `None` = the estimator, or the truth of the simulator with an external physics.
    pub attitude: Option<AttitudeSource>,
    /// `true` to relax the arming rules for RC from UDP.
    pub arm_assist: bool,
    /// Configuration that the craft has stored.
    pub stored: Configuration,
    /// Command lines that are applied at boot, after the stored configuration and the plan's settings. Later ones
    /// take precedence.
    pub boot_lines: Vec<BootLines>,
    /// Channels that are forced to values for a while, whatever flies.
    pub stick_inputs: Vec<StickInput>,
    /// `true` if other programs can influence the flight, so that it is not repeatable.
    pub live: bool,
    /// Version and build that `version` and MSP report.
    pub build: BuildInfo,
}

/// The reason why a vehicle cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetupError {
    /// Command lines that the firmware refuses, each with its place. `Display` is the whole report.
    #[error("{}", format::report(.0))]
    BootLines(Vec<PlanError>),
    /// The world cannot be built.
    #[error(transparent)]
    World(#[from] WorldError),
}

impl FlightSetup {
    /// Returns the options of the firmware.
    pub fn firmware_options(&self) -> FirmwareOptions {
        let usual = FirmwareOptions {
            rate_hz: self.world.rate_hz,
            arm_assist: self.arm_assist,
            ..FirmwareOptions::default()
        };
        match self.physics {
            PhysicsSource::Embedded => {
                FirmwareOptions { attitude: self.attitude.unwrap_or(AttitudeSource::Estimated), ..usual }
            }
            PhysicsSource::External => FirmwareOptions {
                attitude: self.attitude.unwrap_or(AttitudeSource::Truth),
                gps_timeout_s: EXTERNAL_GPS_TIMEOUT_S,
                declination_deg: EXTERNAL_DECLINATION_DEG,
                ..usual
            },
        }
    }

    /// Returns the configuration of the craft at boot: the stored one, the plan's settings, the boot lines, and the
    /// starter modes if none of these has a mode condition. The second value is `true` if the craft got the starter
    /// modes.
    ///
    /// # Errors
    /// Fails with all lines that the firmware refuses, of the first source that has any.
    pub fn configuration(&self) -> Result<(Configuration, bool), SetupError> {
        let (configuration, notices) = self.configure()?;
        Ok((configuration, notices.contains(&SetupNotice::StarterModes)))
    }

    /// Flies by the laws of a profile, whatever the stored configuration says. If the lines are not the `own_lines` of the
    /// user, settings of the guide with which that profile does not fly as expected are replaced.
    pub fn use_profile(&mut self, profile: FirmwareProfile, own_lines: bool) {
        self.boot_lines.retain(|lines| !lines.choose_profile());
        if profile == FirmwareProfile::Master && !own_lines {
            self.boot_lines.iter_mut().for_each(BootLines::replace_settings);
        }
        let mut settings = vec![profile.setting()];
        if profile == FirmwareProfile::Master {
            // It trusts the compass only on request.
            settings.push("trust_mag = ON".to_owned());
        }
        self.boot_lines.insert(0, BootLines::settings(OF_PROFILE, &settings));
    }

    /// Returns the configuration of the craft at boot, and the notices for its user.
    fn configure(&self) -> Result<(Configuration, Vec<SetupNotice>), SetupError> {
        let mut notices = Vec::new();
        let mut configuration = self.stored.clone();
        let site_alt_m = self.boot_home().0.alt_amsl_m;
        let (of_profile, others): (Vec<_>, Vec<_>) =
            self.boot_lines.iter().partition(|lines| lines.choose_profile());
        for lines in of_profile {
            lines.apply(&mut configuration, site_alt_m).map_err(SetupError::BootLines)?;
        }
        let mut of_plan =
            BootLines::settings(format!("settings of plan {}", self.plan.name), &self.plan.settings);
        if configuration.settings.profile() == FirmwareProfile::Master {
            of_plan.replace_settings();
        }
        for lines in std::iter::once(&of_plan).chain(others) {
            let reported = lines.apply(&mut configuration, site_alt_m).map_err(SetupError::BootLines)?;
            // Two sources may give the same value.
            for notice in reported.into_iter().map(SetupNotice::Firmware) {
                if !notices.contains(&notice) {
                    notices.push(notice);
                }
            }
        }
        notices.extend(configuration.starter_modes().then_some(SetupNotice::StarterModes));
        Ok((configuration, notices))
    }

    /// Returns the vehicle at boot, and the notices for its user.
    ///
    /// # Errors
    /// Fails if the firmware refuses a line, or if the world cannot be built.
    pub fn build(self) -> Result<(Vehicle, Vec<SetupNotice>), SetupError> {
        if self.remote_controller {
            return self.build_remote();
        }
        let (configuration, notices) = self.configure()?;
        let (home, home_notice) = match self.physics {
            PhysicsSource::Embedded => self.boot_home(),
            PhysicsSource::External => (self.world.home, None),
        };
        let firmware = FirmwareOptions { site_alt_m: home.alt_amsl_m, ..self.firmware_options() };
        let world = WorldConfig { home, ..self.world };
        let config = VehicleConfig { world, firmware, configuration, live: self.live };
        let mut vehicle = match self.physics {
            PhysicsSource::Embedded => Vehicle::new(config),
            PhysicsSource::External => Vehicle::with_external_physics(config),
        }?;
        vehicle.set_build(self.build);
        hold_channels(&mut vehicle, &self.stick_inputs);
        Ok((vehicle, home_notice.into_iter().chain(notices).collect()))
    }

    /// Returns the vehicle at boot with a remote flight controller.
    fn build_remote(self) -> Result<(Vehicle, Vec<SetupNotice>), SetupError> {
        let (home, notice) = self.boot_home();
        let WorldConfig { faults, switches, .. } = &self.world;
        let idle = faults.iter().filter(|scheduled| !scheduled.fault.acts_on_remote_controller(switches));
        let mut notices: Vec<SetupNotice> = notice.into_iter().collect();
        for notice in idle.map(|scheduled| SetupNotice::IdleFault(scheduled.fault.kind())) {
            if !notices.contains(&notice) {
                notices.push(notice);
            }
        }
        let mut vehicle = Vehicle::with_remote_controller(WorldConfig { home, ..self.world })?;
        hold_channels(&mut vehicle, &self.stick_inputs);
        Ok((vehicle, notices))
    }
}

fn hold_channels(vehicle: &mut Vehicle, inputs: &[StickInput]) {
    for input in inputs {
        vehicle.apply(&VehicleCommand::HoldChannel(*input));
    }
}

/// Checks that the firmware accepts the value of a setting.
///
/// # Errors
/// Fails with the problem and the permitted values.
pub fn check_setting(name: &str, value: &str) -> Result<(), SettingFault> {
    settings::judge(name, value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::Mode;

    fn with_lines(text: &str) -> FlightSetup {
        let lines = BootLines { source: "craft.txt".to_owned(), text: text.to_owned() };
        FlightSetup { boot_lines: vec![lines], ..FlightSetup::default() }
    }

    /// Returns the modes with a condition, in their order. The second value is `true` if a notice says that they are
    /// the starter modes.
    fn modes(setup: FlightSetup) -> (Vec<&'static str>, bool) {
        let (vehicle, notices) = setup.build().unwrap();
        let names =
            vehicle.embedded().unwrap().mode_ranges().iter().map(|range| range.mode_box.into()).collect();
        (names, notices.contains(&SetupNotice::StarterModes))
    }

    #[test]
    fn a_craft_without_modes_gets_the_starter_modes_and_is_reported() {
        let starter = ["ARM", "AUTOPILOT", "ANGLE", "ALTHOLD", "POS HOLD"];
        assert_eq!(modes(FlightSetup::default()), (starter.to_vec(), true));
        assert_eq!(modes(with_lines("set ap_max_angle = 25")), (starter.to_vec(), true));
    }

    #[test]
    fn a_given_value_that_current_firmware_refuses_is_reported() {
        let reported = |lines: &str| -> Vec<String> {
            let notices = with_lines(lines).build().unwrap().1;
            let firmware = notices.iter().filter(|notice| matches!(notice, SetupNotice::Firmware(_)));
            firmware.map(ToString::to_string).collect()
        };
        let notices = reported("set ap_position_cutoff = 5\nset ap_max_angle = 25");
        assert_eq!(notices.len(), 1, "{notices:?}");
        assert!(notices[0].starts_with("ap_position_cutoff = 5 is taken here"), "{notices:?}");
        assert_eq!(reported("set ap_position_cutoff = 30"), [""; 0]);
    }

    #[test]
    fn a_value_that_two_sources_give_is_reported_once() {
        let mut setup = with_lines("set ap_position_cutoff = 5");
        setup.boot_lines.push(BootLines::settings("--set", &["ap_position_cutoff = 5".to_owned()]));
        let notices = setup.build().unwrap().1;
        assert_eq!(notices.iter().filter(|notice| notice.to_string().contains("is taken here")).count(), 1);
    }

    #[test]
    fn one_mode_condition_in_the_given_lines_keeps_the_starter_modes_away() {
        assert_eq!(modes(with_lines("aux 3 0 0 1700 2100 0 0")), (vec!["ARM"], false));
    }

    #[test]
    fn one_stored_mode_condition_keeps_the_starter_modes_away() {
        let (stored, _) = with_lines("aux 0 0 4 1700 2100 0 0").configuration().unwrap();
        let setup = FlightSetup { stored: stored.clone(), ..FlightSetup::default() };
        assert_eq!(modes(setup), (vec!["ARM"], false));
        let removed = FlightSetup { stored, ..with_lines("defaults nosave") };
        assert_eq!(modes(removed).0.len(), 5, "what was removed again does not count");
    }

    #[test]
    fn stored_settings_yield_to_the_plans_and_those_to_the_given_ones() {
        let (stored, _) =
            with_lines("set ap_max_angle = 20\nset ap_max_velocity = 700").configuration().unwrap();
        let plan = PlanFile {
            settings: vec!["ap_max_angle = 30".to_owned(), "ap_landing_descent_rate = 70".to_owned()],
            ..PlanFile::default()
        };
        let set = BootLines::settings("--set", &["ap_max_angle = 50".to_owned()]);
        let mut setup = FlightSetup { stored, plan, ..with_lines("set ap_max_angle = 40") };
        let number = |setup: &FlightSetup, name| setup.configuration().unwrap().0.settings.number(name);
        assert_eq!(number(&setup, "ap_max_angle"), 40);
        setup.boot_lines.push(set);
        assert_eq!(number(&setup, "ap_max_angle"), 50);
        assert_eq!(number(&setup, "ap_max_velocity"), 700);
        assert_eq!(number(&setup, "ap_landing_descent_rate"), 70);
        setup.boot_lines.clear();
        assert_eq!(number(&setup, "ap_max_angle"), 30);
    }

    #[test]
    fn refused_lines_are_all_reported_with_their_places() {
        let error = with_lines("set ap_max_angle = 25\nset ap_max_angel = 9\nset ap_max_angle = 999")
            .build()
            .unwrap_err();
        let report = error.to_string();
        assert!(report.starts_with("craft.txt:2:5: "), "{report}");
        assert!(
            report.contains("did you mean ap_max_angle?") && report.contains("\ncraft.txt:3:20: "),
            "{report}"
        );
        assert!(report.ends_with("craft.txt: 2 problems; nothing was changed"), "{report}");
    }

    #[test]
    fn an_external_physics_changes_what_the_firmware_believes() {
        let embedded = FlightSetup::default();
        assert_eq!(embedded.firmware_options().attitude, AttitudeSource::Estimated);
        let external = FlightSetup { physics: PhysicsSource::External, ..embedded };
        let options = external.firmware_options();
        assert_eq!(options.attitude, AttitudeSource::Truth);
        assert!((options.gps_timeout_s - 2.5).abs() < 1e-9 && (options.declination_deg - 2.0).abs() < 1e-9);
        let asked = FlightSetup { attitude: Some(AttitudeSource::Estimated), ..external };
        assert_eq!(asked.firmware_options().attitude, AttitudeSource::Estimated);
        let (vehicle, _) = asked.build().unwrap();
        assert!(!vehicle.embedded().unwrap().modes().has(Mode::Arm));
    }

    #[test]
    fn a_fault_that_a_remote_firmware_cannot_notice_is_reported_at_the_start() {
        let reported = |switches: &str, remote_controller: bool| {
            let faults = ["mag-off@20", "gps-loss@20", "mag-bias@1,,30", "battery@5", "battery@9", "motor@9"];
            let mut setup = FlightSetup { remote_controller, ..FlightSetup::default() };
            setup.world.faults = faults.map(|fault| fault.parse().unwrap()).to_vec();
            setup.world.switches.set(switches).unwrap();
            let notices = setup.build().unwrap().1;
            let faults = notices.iter().filter(|notice| matches!(notice, SetupNotice::IdleFault(_)));
            faults.map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(reported("battery_sag=off", false), [""; 0]);
        let notices = reported("battery_sag=off", true);
        assert_eq!(
            notices[0],
            "The fault mag-off has no effect: a remote firmware gets no magnetometer data."
        );
        let named = |name: &str| notices.iter().filter(|notice| notice.contains(name)).count();
        assert_eq!((notices.len(), named("mag-bias"), named("battery_sag=on")), (3, 1, 1), "{notices:?}");
        assert_eq!(reported("battery_sag=on", true).len(), 2);
    }
}
