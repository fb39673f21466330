//! Typed parameters of the running firmware, made from the configuration outside the tick.
//!
//! Most follow the configuration at once. Settings that take effect "at boot" are read once, into [`BootChoices`], and
//! kept until the next restart.

use crate::autopilot::Params;

use super::FirmwareOptions;
use super::arming::ArmingConfig;
use super::arming::crash::{CrashAction, CrashConfig};
use super::arming::runaway::RunawayConfig;
use super::battery::BatteryConfig;
use super::blackbox::LogConfig;
use super::config::{
    Configuration, Feature, Features, MAX_MIX_ROWS, MODE_CONDITIONS, MixRow, MixerKind, ModeCondition,
};
use super::control::Tuning;
use super::control::hold::HoldTuning;
use super::estimate::EstimatorTuning;
use super::failsafe::link::LinkConfig;
use super::failsafe::{FailsafeConfig, Procedure, SwitchMode};
use super::modes::boxes;
use super::rx::{ChannelConfig, RxConfig, StickConfig};
use super::settings::Settings;

/// The least deflection of the yaw stick for stick commands, RC units.
const MIN_FULL_YAW: f64 = 100.0;

/// The choices that change only with a restart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BootChoices {
    pub features: Features,
    pub max_aux: u8,
    /// `true` if a magnetometer is present.
    pub mag: bool,
    pub mixer: MixerKind,
    /// The rows of the custom mix.
    pub custom_mix: [MixRow; MAX_MIX_ROWS],
    /// The number of gyro samples per run of the rate loop.
    pub pid_denominator: u8,
    /// `motor_pwm_protocol`, as a number.
    pub motor_protocol: u8,
    /// `true` if the motor protocol is DISABLED, so that the motors cannot turn.
    pub motors_disabled: bool,
    /// `gps_provider`, as a number.
    pub gps_provider: u8,
    /// The ports of `msp_uart_1` to `msp_uart_3`.
    pub msp_ports: [u8; 3],
}

impl BootChoices {
    /// Reads the choices from a configuration.
    pub fn new(configuration: &Configuration) -> Self {
        let settings = &configuration.settings;
        Self {
            features: configuration.features,
            max_aux: small(settings, "max_aux_channels"),
            mag: settings.text("mag_hardware") != "NONE",
            mixer: configuration.mixer,
            custom_mix: configuration.custom_mix,
            pid_denominator: small(settings, "pid_process_denom"),
            motor_protocol: small(settings, "motor_pwm_protocol"),
            motors_disabled: settings.text("motor_pwm_protocol") == "DISABLED",
            gps_provider: small(settings, "gps_provider"),
            msp_ports: ["msp_uart_1", "msp_uart_2", "msp_uart_3"].map(|name| small(settings, name)),
        }
    }
}

/// The altitude of a GPS rescue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RescueAltitude {
    /// The highest altitude of this flight plus the initial climb.
    #[default]
    HighestOfFlight,
    /// A fixed altitude above home.
    Fixed,
    /// The present altitude plus the initial climb.
    Present,
}

/// The condition under which a rescue that makes no progress is aborted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RescueSanity {
    Off,
    On,
    /// Only if the failsafe started it, not the pilot's switch.
    #[default]
    FailsafeOnly,
}

/// The cause of a rescue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RescueCause {
    /// The GPS RESCUE switch.
    Switch,
    Failsafe,
}

/// Settings of GPS rescue.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RescueConfig {
    /// The choice of the return altitude.
    pub altitude: RescueAltitude,
    /// The additional climb, m.
    pub initial_climb_m: f64,
    /// The fixed return altitude above home, m.
    pub return_alt_m: f64,
    /// The climb rate, m/s.
    pub ascend_mps: f64,
    /// The sink rate down to the last metres, m/s.
    pub descend_mps: f64,
    /// The speed on the way home, m/s.
    pub ground_speed_mps: f64,
    /// The distance from home below which it does not climb first, m.
    pub min_start_dist_m: f64,
    /// The condition under which it is aborted.
    pub sanity: RescueSanity,
    /// The number of satellites that make home and rescue trustworthy.
    pub min_sats: u8,
    /// Keeps home at the point of the first arming.
    pub home_once: bool,
}

/// The parameters of all state machines in the firmware.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    pub rx: RxConfig,
    /// The debouncing of the link.
    pub link: LinkConfig,
    pub failsafe: FailsafeConfig,
    pub arming: ArmingConfig,
    pub runaway: RunawayConfig,
    pub crash: CrashConfig,
    /// The jerk that ends a landing, setting units; 0 = off.
    pub landing_disarm_threshold: f64,
    pub modes: [ModeCondition; MODE_CONDITIONS],
    pub rescue: RescueConfig,
    pub battery: BatteryConfig,
    pub gps: bool,
    /// `true` if airmode is always on.
    pub airmode: bool,
    /// `true` if the gains always rise in quick throttle changes.
    pub anti_gravity: bool,
    /// `true` if the motors stop at low throttle.
    pub motor_stop: bool,
    /// The tuning of altitude and position hold.
    pub hold: HoldTuning,
    /// The navigator's parameters.
    pub nav: Params,
    /// The estimator's tuning.
    pub estimator: EstimatorTuning,
    /// The controller's tuning.
    pub control: Tuning,
    /// The flight recorder's settings.
    pub blackbox: LogConfig,
}

impl Parameters {
    /// Computes the parameters from a configuration and the choices made at boot.
    pub fn new(configuration: &Configuration, boot: &BootChoices, options: &FirmwareOptions) -> Self {
        let settings = &configuration.settings;
        let number = |name| settings.number(name) as f64;
        Self {
            rx: receiver(configuration, boot),
            link: LinkConfig {
                delay_s: number("failsafe_delay") / 10.0,
                recovery_delay_s: number("failsafe_recovery_delay") / 10.0,
            },
            failsafe: failsafe(settings),
            arming: arming(configuration, boot, options),
            runaway: RunawayConfig {
                enabled: settings.flag("runaway_takeoff_prevention"),
                deactivate_delay_s: number("runaway_takeoff_deactivate_delay") / 1000.0,
                deactivate_throttle_percent: number("runaway_takeoff_deactivate_throttle_percent"),
            },
            crash: crash(settings),
            landing_disarm_threshold: number("landing_disarm_threshold"),
            modes: configuration.modes,
            rescue: rescue(settings),
            battery: battery(settings),
            gps: boot.features.has(Feature::Gps),
            airmode: boot.features.has(Feature::AirMode),
            anti_gravity: boot.features.has(Feature::AntiGravity),
            motor_stop: boot.features.has(Feature::MotorStop),
            hold: HoldTuning::from_settings(settings),
            nav: navigator(settings),
            estimator: EstimatorTuning { has_mag: boot.mag, ..EstimatorTuning::from_settings(settings) },
            control: control(settings, boot),
            blackbox: LogConfig::new(configuration, options.logs),
        }
    }
}

fn control(settings: &Settings, boot: &BootChoices) -> Tuning {
    let mut tuning = Tuning::from_settings(settings, boot.mixer, &boot.custom_mix);
    tuning.rate.denominator = boot.pid_denominator;
    tuning
}

/// Reads a number that fits a byte. The settings keep to their ranges.
fn small(settings: &Settings, name: &str) -> u8 {
    settings.number(name).clamp(0, 255) as u8
}

/// Reads a pulse, µs.
fn pulse(settings: &Settings, name: &str) -> u16 {
    settings.number(name).clamp(0, i64::from(u16::MAX)) as u16
}

fn receiver(configuration: &Configuration, boot: &BootChoices) -> RxConfig {
    let settings = &configuration.settings;
    let mid_us = pulse(settings, "mid_rc");
    RxConfig {
        channels: ChannelConfig {
            map: configuration.channel_map,
            max_aux: boot.max_aux,
            min_us: pulse(settings, "rx_min_usec"),
            max_us: pulse(settings, "rx_max_usec"),
            mid_us,
            ranges: configuration.rx_ranges,
            fail: configuration.rx_fail.0,
            failsafe_throttle_us: pulse(settings, "failsafe_throttle"),
        },
        sticks: StickConfig {
            mid_us,
            deadband: pulse(settings, "deadband"),
            yaw_deadband: pulse(settings, "yaw_deadband"),
        },
        rssi_channel: small(settings, "rssi_channel").checked_sub(1),
    }
}

fn failsafe(settings: &Settings) -> FailsafeConfig {
    let number = |name| settings.number(name) as f64;
    FailsafeConfig {
        start_s: number("pwr_on_arm_grace"),
        landing_time_s: number("failsafe_landing_time"),
        throttle_low_s: number("failsafe_throttle_low_delay") / 10.0,
        stick_threshold_percent: number("failsafe_stick_threshold"),
        switch_mode: match settings.text("failsafe_switch_mode") {
            "KILL" => SwitchMode::Kill,
            "STAGE2" => SwitchMode::Stage2,
            _ => SwitchMode::Stage1,
        },
        procedure: match settings.text("failsafe_procedure") {
            "AUTO-LAND" => Procedure::AutoLand,
            "GPS-RESCUE" => Procedure::GpsRescue,
            _ => Procedure::Drop,
        },
    }
}

fn arming(configuration: &Configuration, boot: &BootChoices, options: &FirmwareOptions) -> ArmingConfig {
    let motors_stop = boot.features.has(Feature::MotorStop) && !boot.features.has(Feature::AirMode);
    let settings = &configuration.settings;
    let number = |name| settings.number(name) as f64;
    let has =
        |id| configuration.modes.iter().any(|condition| condition.box_id == id && condition.is_usable());
    let min_check_us = number("min_check");
    let raised_part = number("airmode_start_throttle_percent") / 100.0;
    let stick_arming = settings.flag("enable_stick_arming");
    ArmingConfig {
        min_check_us,
        small_angle_rad: Some(number("small_angle").to_radians())
            .filter(|&angle| angle < std::f64::consts::PI),
        boot_grace_s: number("pwr_on_arm_grace"),
        prearm_allow_rearm: settings.flag("prearm_allow_rearm"),
        has_arm_condition: has(boxes::ARM),
        has_prearm_condition: has(boxes::PREARM),
        rescue_configured: has(boxes::GPS_RESCUE) || settings.text("failsafe_procedure") == "GPS-RESCUE",
        rescue_min_sats: small(settings, "gps_rescue_min_sats"),
        rescue_allow_without_fix: settings.flag("gps_rescue_allow_arming_without_fix"),
        // A stick at rest is no command, whatever the value of `max_check`.
        full_yaw: (number("max_check") - number("mid_rc")).max(MIN_FULL_YAW),
        stick_arming,
        auto_disarm_s: (motors_stop && stick_arming)
            .then(|| number("auto_disarm_delay"))
            .filter(|&delay| delay > 0.0),
        raised_throttle_us: min_check_us + raised_part * (2000.0 - min_check_us),
        assist: options.arm_assist,
        calibrate_gyro_first: settings.flag("gyro_cal_on_first_arm"),
        motors_disabled: boot.motors_disabled,
        reboot_required: BootChoices::new(configuration) != *boot,
    }
}

fn crash(settings: &Settings) -> CrashConfig {
    const SLOPE_UNIT_DPS2: f64 = 1000.0;
    let number = |name| settings.number(name) as f64;
    CrashConfig {
        action: match settings.text("crash_recovery") {
            "ON" | "BEEP" => CrashAction::Level,
            "DISARM" => CrashAction::Disarm,
            _ => CrashAction::Off,
        },
        slope_dps2: SLOPE_UNIT_DPS2 * number("crash_dthreshold"),
        error_dps: number("crash_gthreshold"),
        setpoint_dps: number("crash_setpoint_threshold"),
        delay_s: number("crash_delay") / 1000.0,
        time_s: number("crash_time") / 1000.0,
        done_tilt_rad: number("crash_recovery_angle").to_radians(),
        done_rate_dps: number("crash_recovery_rate"),
    }
}

fn rescue(settings: &Settings) -> RescueConfig {
    let number = |name| settings.number(name) as f64;
    RescueConfig {
        altitude: match settings.text("gps_rescue_alt_mode") {
            "FIXED_ALT" => RescueAltitude::Fixed,
            "CURRENT_ALT" => RescueAltitude::Present,
            _ => RescueAltitude::HighestOfFlight,
        },
        initial_climb_m: number("gps_rescue_initial_climb"),
        return_alt_m: number("gps_rescue_return_alt"),
        ascend_mps: number("gps_rescue_ascend_rate") / 100.0,
        descend_mps: number("gps_rescue_descend_rate") / 100.0,
        ground_speed_mps: number("gps_rescue_ground_speed") / 100.0,
        min_start_dist_m: number("gps_rescue_min_start_dist"),
        sanity: match settings.text("gps_rescue_sanity_checks") {
            "RESCUE_SANITY_OFF" => RescueSanity::Off,
            "RESCUE_SANITY_ON" => RescueSanity::On,
            _ => RescueSanity::FailsafeOnly,
        },
        min_sats: small(settings, "gps_rescue_min_sats"),
        home_once: settings.flag("gps_set_home_point_once"),
    }
}

fn battery(settings: &Settings) -> BatteryConfig {
    let volts = |name| settings.number(name) as f64 / 100.0;
    BatteryConfig {
        max_cell_v: volts("vbat_max_cell_voltage"),
        warning_cell_v: volts("vbat_warning_cell_voltage"),
        min_cell_v: volts("vbat_min_cell_voltage"),
        cells: small(settings, "force_battery_cell_count"),
    }
}

/// Reads the navigator's parameters by name. Those with a wider range in the settings are limited.
fn navigator(settings: &Settings) -> Params {
    let mut params = Params::default();
    for field in Params::FIELDS {
        (field.set)(&mut params, settings.number(field.name).clamp(field.min, field.max));
    }
    params
}

#[cfg(test)]
mod tests;
