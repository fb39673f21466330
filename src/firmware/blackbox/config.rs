//! The settings of the flight recorder.

use super::debug::DebugSource;
use crate::firmware::config::{Configuration, ModeCondition};
use crate::firmware::modes::boxes;
use crate::firmware::settings::Settings;

/// The groups of fields that a setting leaves out of logs, by their bit in `fields_disabled_mask`.
pub const DISABLED_FIELDS: [(u32, &str); 14] = [
    (0, "blackbox_disable_pids"),
    (1, "blackbox_disable_rc"),
    (2, "blackbox_disable_setpoint"),
    (3, "blackbox_disable_bat"),
    (4, "blackbox_disable_mag"),
    (5, "blackbox_disable_alt"),
    (6, "blackbox_disable_rssi"),
    (7, "blackbox_disable_gyro"),
    (8, "blackbox_disable_attitude"),
    (9, "blackbox_disable_acc"),
    (10, "blackbox_disable_debug"),
    (11, "blackbox_disable_motors"),
    (12, "blackbox_disable_gps"),
    (14, "blackbox_disable_gyrounfilt"),
];

/// Returns the bits of the groups that are left out of logs.
pub fn disabled_mask(settings: &Settings) -> u32 {
    let disabled = DISABLED_FIELDS.iter().filter(|(_, name)| settings.flag(name));
    disabled.fold(0, |mask, (bit, _)| mask | 1 << bit)
}

/// The place of the logs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LogDevice {
    /// Nothing is logged. This includes the devices that a simulated craft does not have.
    #[default]
    None,
    /// The flash memory, which MSP reads.
    Flash,
    /// The flash memory and a file for each log.
    Files,
}

/// The condition under which a log is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum LogMode {
    /// From arming to disarming.
    #[default]
    Normal,
    /// Also while a motor of the disarmed craft runs.
    MotorTest,
    /// From boot on.
    Always,
}

/// The settings of the flight recorder.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LogConfig {
    pub device: LogDevice,
    pub(super) mode: LogMode,
    /// The power of two of the loops from one main frame to the next.
    pub(super) rate_power: u8,
    /// The bits of the groups of fields that are left out.
    disabled: u32,
    /// `true` if sticks, setpoints and gyro have one more digit.
    pub(super) high_resolution: bool,
    /// The values of the fields `debug`; `None` = there are no such fields.
    pub(super) debug: Option<DebugSource>,
    /// `true` if a switch pauses the log.
    pub(super) has_switch: bool,
}

impl LogConfig {
    /// Reads the settings. With `is_forced`, logs are written without a device, too.
    pub fn new(configuration: &Configuration, is_forced: bool) -> Self {
        let settings = &configuration.settings;
        let device = match settings.text("blackbox_device") {
            "VIRTUAL" => LogDevice::Files,
            "SPIFLASH" => LogDevice::Flash,
            _ if is_forced => LogDevice::Flash,
            _ => LogDevice::None,
        };
        let is_switch =
            |condition: &ModeCondition| condition.box_id == boxes::BLACKBOX && condition.is_usable();
        Self {
            device,
            mode: match settings.text("blackbox_mode") {
                "MOTOR_TEST" => LogMode::MotorTest,
                "ALWAYS" => LogMode::Always,
                _ => LogMode::Normal,
            },
            rate_power: settings.number("blackbox_sample_rate").clamp(0, 4) as u8,
            disabled: disabled_mask(settings),
            high_resolution: settings.flag("blackbox_high_resolution"),
            debug: DebugSource::new(settings.text("debug_mode")),
            has_switch: configuration.modes.iter().any(is_switch),
        }
    }

    /// Returns `true` if logs are written.
    pub fn is_on(&self) -> bool {
        self.device != LogDevice::None
    }

    /// Returns `true` if the group of fields with this bit is not left out.
    pub(super) fn has(&self, bit: u32) -> bool {
        self.disabled & (1 << bit) == 0
    }
}
