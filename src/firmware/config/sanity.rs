//! Corrections made at boot and before every save, so that a configuration cannot contradict itself. Each is silent;
//! the next `diff` shows the corrected value.

use strum::IntoEnumIterator;

use super::{Configuration, Feature, ModeCondition};
use crate::firmware::modes::boxes;
use crate::firmware::settings::{Scope, Value, find};

/// The receiver features. The last one that is on wins.
const RECEIVERS: [Feature; 6] = [
    Feature::RxPpm,
    Feature::RxMsp,
    Feature::RxSerial,
    Feature::RxSpi,
    Feature::RxParallelPwm,
    Feature::RxUdp,
];

/// The values of `gps_provider` for the receivers on a serial port: NMEA, UBLOX.
const SERIAL_GPS_PROVIDERS: std::ops::RangeInclusive<i64> = 0..=1;

/// Makes a configuration consistent.
pub fn correct(configuration: &mut Configuration) {
    features(configuration);
    rescue(configuration);
    modes(configuration);
    for profile in 0..Scope::RateProfile.instances() {
        rates(configuration, profile);
    }
    notch(configuration, 0, "gyro_notch1_hz", "gyro_notch1_cutoff");
    notch(configuration, 0, "gyro_notch2_hz", "gyro_notch2_cutoff");
    not_above(configuration, 0, "gyro_lpf1_dyn_min_hz", "gyro_lpf1_dyn_max_hz");
    for profile in 0..Scope::Profile.instances() {
        notch(configuration, profile, "dterm_notch_hz", "dterm_notch_cutoff");
        not_above(configuration, profile, "dterm_lpf1_dyn_min_hz", "dterm_lpf1_dyn_max_hz");
        for axis in ["roll", "pitch", "yaw"] {
            let (d, d_max) = (format!("d_{axis}"), format!("d_max_{axis}"));
            if number(configuration, &d_max, profile) < number(configuration, &d, profile) {
                put(configuration, &d_max, profile, 0);
            }
        }
    }
}

fn number(configuration: &Configuration, name: &str, instance: u8) -> i64 {
    match find(name).and_then(|setting| configuration.settings.value(setting, instance)) {
        Some(Value::Number(number)) => *number,
        _ => 0,
    }
}

fn put(configuration: &mut Configuration, name: &str, instance: u8, number: i64) {
    if let Some(setting) = find(name) {
        // A correction outside the range of a setting changes nothing.
        let _refused = configuration.settings.put(setting, instance, Value::Number(number));
    }
}

fn features(configuration: &mut Configuration) {
    for feature in Feature::iter().filter(|feature| !feature.is_available()) {
        configuration.features.set(feature, false);
    }
    let known = Feature::iter().fold(0, |mask, feature| mask | feature.bit());
    configuration.features.0 &= known;
    let chosen = RECEIVERS.into_iter().rev().find(|feature| configuration.features.has(*feature));
    for receiver in RECEIVERS {
        configuration.features.set(receiver, Some(receiver) == chosen.or(Some(Feature::RxUdp)));
    }
    let settings = &configuration.settings;
    if SERIAL_GPS_PROVIDERS.contains(&settings.number("gps_provider")) && settings.number("gps_uart") == 0 {
        configuration.features.set(Feature::Gps, false);
    }
}

fn rescue(configuration: &mut Configuration) {
    if configuration.features.has(Feature::Gps) && !configuration.features.has(Feature::ThreeD) {
        return;
    }
    if configuration.settings.text("failsafe_procedure") == "GPS-RESCUE"
        && let Some(procedure) = find("failsafe_procedure")
    {
        let _always_valid = configuration.settings.assign(procedure, "DROP");
    }
    for condition in &mut configuration.modes {
        if condition.box_id == boxes::GPS_RESCUE && condition.is_usable() {
            *condition = ModeCondition::default();
        }
    }
}

/// Resets conditions with links deeper than one level, and links of ARM, which follows a switch only.
fn modes(configuration: &mut Configuration) {
    let before = configuration.modes;
    let is_linked = |id: u8| before.iter().any(|condition| condition.box_id == id && condition.linked != 0);
    for condition in &mut configuration.modes {
        if condition.linked != 0 && (condition.box_id == 0 || is_linked(condition.linked)) {
            *condition = ModeCondition::default();
        }
    }
}

/// The largest rc_rate, srate and expo of each rates type, in the order of its words.
const RATE_LIMITS: [[i64; 3]; 5] =
    [[255, 100, 100], [200, 255, 100], [255, 99, 100], [200, 200, 100], [255, 200, 100]];

fn rates(configuration: &mut Configuration, profile: u8) {
    let kind = number(configuration, "rates_type", profile);
    let Some(limits) = usize::try_from(kind).ok().and_then(|kind| RATE_LIMITS.get(kind)) else { return };
    for axis in ["roll", "pitch", "yaw"] {
        for (what, limit) in ["rc_rate", "srate", "expo"].into_iter().zip(limits) {
            let name = format!("{axis}_{what}");
            if number(configuration, &name, profile) > *limit {
                put(configuration, &name, profile, *limit);
            }
        }
    }
}

/// Turns a notch off if its cutoff is not below its centre.
fn notch(configuration: &mut Configuration, instance: u8, centre: &str, cutoff: &str) {
    if number(configuration, cutoff, instance) >= number(configuration, centre, instance) {
        put(configuration, centre, instance, 0);
    }
}

/// Makes a dynamic low-pass static if its minimum is above its maximum.
fn not_above(configuration: &mut Configuration, instance: u8, min: &str, max: &str) {
    if number(configuration, min, instance) > number(configuration, max, instance) {
        put(configuration, min, instance, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corrected(change: impl FnOnce(&mut Configuration)) -> Configuration {
        let mut configuration = Configuration::default();
        change(&mut configuration);
        correct(&mut configuration);
        let once = configuration.clone();
        correct(&mut configuration);
        assert_eq!(configuration, once, "correcting twice changes nothing more");
        configuration
    }

    #[test]
    fn a_fresh_vehicle_is_consistent() {
        assert_eq!(corrected(|_| ()), Configuration::default());
    }

    #[test]
    fn exactly_one_receiver_is_on() {
        for (on, expected) in [
            (vec![], Feature::RxUdp),
            (vec![Feature::RxMsp], Feature::RxMsp),
            (vec![Feature::RxMsp, Feature::RxUdp], Feature::RxUdp),
            (vec![Feature::RxSerial, Feature::Osd], Feature::RxUdp),
        ] {
            let features = corrected(|configuration| {
                configuration.features.0 = on.iter().fold(0, |mask, feature| mask | feature.bit());
            })
            .features;
            assert_eq!(features.0, expected.bit(), "{on:?}");
        }
    }

    #[test]
    fn a_serial_gps_needs_a_port() {
        let with = |provider, port| {
            corrected(|configuration| {
                configuration.settings.set_number("gps_provider", provider).expect("allowed");
                configuration.settings.set_number("gps_uart", port).expect("allowed");
            })
            .features
            .has(Feature::Gps)
        };
        assert_eq!(
            [with(0, 0), with(1, 0), with(1, 2), with(2, 0), with(3, 0)],
            [false, false, true, true, true]
        );
    }

    #[test]
    fn a_rescue_needs_gps() {
        let rescue = ModeCondition { box_id: 46, start_us: 1700, end_us: 2100, ..ModeCondition::default() };
        let configuration = corrected(|configuration| {
            configuration.settings.set_number("failsafe_procedure", 2).expect("allowed");
            configuration.modes[3] = rescue;
            configuration.features.set(Feature::Gps, false);
        });
        assert_eq!(configuration.settings.text("failsafe_procedure"), "DROP");
        assert_eq!(configuration.modes[3], ModeCondition::default());
    }

    #[test]
    fn links_are_one_level_deep_and_never_on_arm() {
        let link = |box_id, linked| ModeCondition { box_id, linked, ..ModeCondition::default() };
        let configuration = corrected(|configuration| {
            configuration.modes[0] = link(0, 1);
            configuration.modes[1] = link(3, 11);
            configuration.modes[2] = link(11, 1);
        });
        assert_eq!(configuration.modes[..3], [link(0, 0), link(0, 0), link(11, 1)]);
    }

    #[test]
    fn values_that_contradict_each_other_are_corrected_in_every_profile() {
        let configuration = corrected(|configuration| {
            let settings = &mut configuration.settings;
            assert!(settings.select(Scope::Profile, 3) && settings.select(Scope::RateProfile, 2));
            for (name, number) in [
                ("gyro_notch1_hz", 200),
                ("gyro_notch1_cutoff", 200),
                ("dterm_notch_hz", 100),
                ("dterm_notch_cutoff", 99),
                ("dterm_lpf1_dyn_min_hz", 200),
                ("d_roll", 41),
                ("roll_srate", 255),
                ("yaw_rc_rate", 255),
            ] {
                settings.set_number(name, number).expect("allowed");
            }
        });
        let number = |name| configuration.settings.number(name);
        let found = [
            "gyro_notch1_hz",
            "dterm_notch_hz",
            "dterm_lpf1_dyn_min_hz",
            "d_max_roll",
            "roll_srate",
            "yaw_rc_rate",
        ];
        assert_eq!(found.map(number), [0, 100, 0, 0, 200, 200]);
    }
}
