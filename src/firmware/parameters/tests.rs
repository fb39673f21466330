use super::*;
use crate::firmware::settings::{Kind, Role, SETTINGS, Setting, Value, find, needs_restart};

#[test]
fn defaults_of_settings_and_modules_agree() {
    let configuration = Configuration::default();
    let boot = BootChoices::new(&configuration);
    let parameters = Parameters::new(&configuration, &boot, &FirmwareOptions::default());
    assert_eq!(parameters.rx, RxConfig::default());
    assert_eq!(parameters.link, LinkConfig::default());
    assert_eq!(parameters.failsafe, FailsafeConfig::default());
    assert_eq!(parameters.runaway, RunawayConfig::default());
    assert_eq!(parameters.nav, Params::default());
    assert_eq!(parameters.battery, BatteryConfig::default());
    let arming = ArmingConfig {
        has_arm_condition: false,
        small_angle_rad: Some(25_f64.to_radians()),
        ..ArmingConfig::default()
    };
    assert_eq!(parameters.arming, arming);
}

/// Live settings that are used in other places, with those places.
const ELSEWHERE: [(&str, &str); 7] = [
    ("profile_name", "shown by MSP"),
    ("rateprofile_name", "shown by MSP"),
    ("battery_profile_name", "shown by MSP"),
    ("craft_name", "shown by MSP and dumps"),
    ("bat_capacity", "reported by MSP with the charge drawn"),
    ("task_statistics", "columns of the tasks command"),
    ("gps_provider", "a real receiver without a port turns the feature GPS off at boot"),
];

/// Returns the values of a setting that are worth a test.
fn values(setting: &Setting) -> Vec<Value> {
    match setting.kind {
        Kind::Number { min, max, .. } => vec![Value::Number(min), Value::Number(max)],
        Kind::Choice { words, .. } => (0..words.len() as i64).map(Value::Number).collect(),
        Kind::Array { default } => vec![Value::Array(vec![7; default.len()])],
        Kind::Text { .. } => vec![Value::Text("x".to_owned())],
        Kind::Port { .. } => vec![Value::Number(0), Value::Number(1)],
    }
}

/// Returns configurations in which a setting may have an effect. Some settings matter only together with others.
fn stages() -> [Configuration; 4] {
    let with = |changes: &[(&str, i64)], off: &[Feature], on: &[Feature]| {
        let mut configuration = Configuration::default();
        for (name, value) in changes {
            configuration.settings.set_number(name, *value).unwrap();
        }
        for feature in off {
            configuration.features.set(*feature, false);
        }
        for feature in on {
            configuration.features.set(*feature, true);
        }
        configuration
    };
    [
        Configuration::default(),
        with(&[("gyro_lpf1_dyn_min_hz", 0), ("dterm_lpf1_dyn_min_hz", 0)], &[], &[]),
        with(&[("enable_stick_arming", 1)], &[Feature::AirMode], &[Feature::MotorStop]),
        with(&[("d_max_gain", 30)], &[], &[]),
    ]
}

#[test]
fn live_settings_change_the_parameters_and_carried_ones_do_not() {
    let parameters = |configuration: &Configuration| {
        let boot = BootChoices::new(configuration);
        Parameters::new(configuration, &boot, &FirmwareOptions::default())
    };
    let stages = stages().map(|stage| (parameters(&stage), stage));
    for setting in &SETTINGS {
        let changes = stages.iter().any(|(before, stage)| {
            values(setting).into_iter().any(|value| {
                let mut changed = stage.clone();
                changed.settings.set(setting.name, value).unwrap();
                parameters(&changed) != *before
            })
        });
        let elsewhere = ELSEWHERE.iter().any(|(name, _)| *name == setting.name);
        let acts = changes || elsewhere;
        // The navigator's own table has rows that it stores only for the other firmware.
        let stored_only = setting.name.starts_with("ap_") && setting.role != Role::Live;
        assert!(acts == (setting.role == Role::Live) || stored_only, "{}: {}", setting.name, setting.role);
        assert!(!(changes && elsewhere), "{} is not elsewhere", setting.name);
    }
}

#[test]
fn settings_marked_for_a_restart_are_those_that_boot_takes() {
    let booted = BootChoices::new(&Configuration::default());
    for setting in &SETTINGS {
        let taken = values(setting).into_iter().any(|value| {
            let mut changed = Configuration::default();
            changed.settings.set(setting.name, value).unwrap();
            BootChoices::new(&changed) != booted
        });
        assert_eq!(taken, needs_restart(setting.name), "{}", setting.name);
    }
}

#[test]
fn what_needs_a_restart_waits_for_it() {
    let mut configuration = Configuration::default();
    let boot = BootChoices::new(&configuration);
    configuration.settings.set_number("max_aux_channels", 2).unwrap();
    configuration.settings.set_number("mid_rc", 1480).unwrap();
    configuration.mixer = MixerKind::QuadP;
    configuration.settings.set_number("pid_process_denom", 4).unwrap();
    let mag = find("mag_hardware").unwrap();
    configuration.settings.assign(mag, "NONE").unwrap();
    let parameters = Parameters::new(&configuration, &boot, &FirmwareOptions::default());
    assert_eq!(parameters.rx.channels.max_aux, 6);
    assert_eq!(parameters.rx.channels.mid_us, 1480);
    assert_eq!(parameters.control.mixer, Tuning::default().mixer);
    assert_eq!(parameters.control.rate.denominator, 1);
    assert!(parameters.estimator.has_mag);
}

#[test]
fn another_channel_map_acts_at_once() {
    let mut configuration = Configuration::default();
    let boot = BootChoices::new(&configuration);
    let map = crate::firmware::config::ChannelMap::parse("TAER1234").unwrap();
    configuration.channel_map = map;
    assert_eq!(BootChoices::new(&configuration), boot, "no restart is asked for");
    let parameters = Parameters::new(&configuration, &boot, &FirmwareOptions::default());
    assert_eq!(parameters.rx.channels.map, map);
}

#[test]
fn a_yaw_stick_at_rest_is_never_a_full_one() {
    let mut configuration = Configuration::default();
    configuration.settings.set_number("max_check", 750).unwrap();
    let boot = BootChoices::new(&configuration);
    let parameters = Parameters::new(&configuration, &boot, &FirmwareOptions::default());
    assert!(parameters.arming.full_yaw >= 100.0);
}
