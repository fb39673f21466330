//! Every field of every frame within its resolution of the value at that step.

use crate::log_writer::flown::Flown;
use crate::log_writer::judge;
use crate::log_writer::reader::{self, Log, Part};
use betadeck_core::vehicle::VehicleCommand;

/// Settings with which a log has all fields.
const ALL_FIELDS: [&str; 2] = ["rssi_channel = 9", "d_yaw = 20"];

/// Compares all frames with the truth of their step. Returns the number of main frames and of solutions.
fn compare(flown: &Flown, log: &Log) -> (usize, usize) {
    for part in &log.parts {
        let Part::Frame { letter: 'I' | 'P' | 'G', values, .. } = part else { continue };
        let time_us = values["time"];
        let step = flown.truth.get(&time_us).unwrap_or_else(|| panic!("no step at {time_us} µs"));
        for (name, value) in values {
            if ["loopIteration", "time", "GPS_time"].contains(&name.as_str()) || name.starts_with("debug") {
                continue;
            }
            let expected = step.value(name).unwrap_or_else(|| panic!("{name} is unknown"));
            // Altitudes are cut to 0.1 m, not rounded.
            let resolution = if name == "GPS_altitude" { 1.0 } else { 0.5 };
            let error = (*value as f64 - expected).abs();
            let is_full_turn = name == "GPS_ground_course" && error > 3599.0;
            assert!(
                error <= resolution + 1e-6 || is_full_turn,
                "{name} at {time_us} µs: {value}, not {expected}"
            );
        }
    }
    (log.mains().len(), log.frames("G").len())
}

#[test]
fn every_field_is_within_its_resolution_of_the_truth_at_every_rate() {
    for (rate, divider) in [("1/1", 1), ("1/2", 2), ("1/4", 4), ("1/8", 8), ("1/16", 16)] {
        let rate_line = format!("blackbox_sample_rate = {rate}");
        let mut flown = Flown::boot(1000, &[&ALL_FIELDS[..], &[&rate_line]].concat());
        flown.hop(4.0);
        let log = flown.log();
        let (mains, solutions) = compare(&flown, &log);
        let loops = log.mains().last().unwrap()["loopIteration"];
        assert_eq!(mains as i64, loops / divider + 1, "{rate}");
        assert!(solutions > 30, "{rate}: {solutions}");
        assert_eq!(log.mains()[0].len(), 45, "{rate}: {:?}", log.mains()[0]);
    }
}

#[test]
fn high_resolution_has_a_tenth_of_the_unit() {
    let mut flown = Flown::boot(1000, &["blackbox_high_resolution = ON", "blackbox_sample_rate = 1/1"]);
    flown.hop(3.0);
    let log = flown.log();
    compare(&flown, &log);
    assert!(log.mains().iter().any(|values| values["rcCommand[3]"] > 16_000));
}

#[test]
fn logs_of_8_khz_have_frames_of_every_loop() {
    let mut flown = Flown::boot(8000, &["blackbox_sample_rate = 1/1"]);
    flown.hop(2.0);
    let log = flown.log();
    let (mains, _) = compare(&flown, &log);
    assert!(mains > 15_000, "{mains}");
    assert_eq!(log.mains().last().unwrap()["loopIteration"] as usize, mains - 1);
}

#[test]
fn a_divided_rate_loop_counts_its_own_loops() {
    let mut flown = Flown::boot(4000, &["pid_process_denom = 2", "blackbox_sample_rate = 1/2"]);
    flown.hop(2.0);
    let log = flown.log();
    compare(&flown, &log);
    for pair in log.mains().windows(2) {
        assert_eq!(pair[1]["time"] - pair[0]["time"], 1000, "two loops of 500 µs");
        assert_eq!(pair[1]["loopIteration"] - pair[0]["loopIteration"], 2);
    }
}

#[test]
fn a_rate_that_is_slower_than_whole_frames_has_only_whole_frames() {
    let mut flown = Flown::boot(400, &["blackbox_sample_rate = 1/16"]);
    flown.hop(4.0);
    let log = flown.log();
    let (mains, solutions) = compare(&flown, &log);
    assert!(mains > 100 && solutions > 20, "{mains} {solutions}");
    assert!(
        !log.letters().contains('P') && log.letters().starts_with("IEG") | log.letters().starts_with("IEH")
    );
    assert!(log.mains().windows(2).all(|pair| pair[1]["loopIteration"] - pair[0]["loopIteration"] == 12));
}

#[test]
fn groups_of_fields_are_left_out_by_their_settings() {
    let groups = [
        ("pids", "axisP[0]"),
        ("rc", "rcCommand[0]"),
        ("setpoint", "setpoint[0]"),
        ("bat", "vbatLatest"),
        ("mag", "magADC[0]"),
        ("alt", "baroAlt"),
        ("rssi", "rssi"),
        ("gyro", "gyroADC[0]"),
        ("gyrounfilt", "gyroUnfilt[0]"),
        ("acc", "accSmooth[0]"),
        ("attitude", "imuQuaternion[0]"),
        ("debug", "debug[0]"),
        ("motors", "motor[0]"),
    ];
    let with_all = [&ALL_FIELDS[..], &["debug_mode = GYRO_FILTERED"]].concat();
    for (group, field) in groups {
        let setting = format!("blackbox_disable_{group} = ON");
        let mut flown = Flown::boot(1000, &[&with_all[..], &[&setting]].concat());
        flown.hop(0.25);
        let log = flown.log();
        compare(&flown, &log);
        let values = log.mains()[0];
        assert!(!values.contains_key(field), "{group}");
        let mut others = groups.iter().filter(|(other, _)| *other != group);
        assert!(others.all(|(_, field)| values.contains_key(*field)), "{group}: {values:?}");
    }
    let mut flown = Flown::boot(1000, &["blackbox_disable_gps = ON"]);
    flown.hop(0.25);
    assert!(flown.log().frames("GH").is_empty());
}

#[test]
fn a_craft_without_gps_logs_no_solutions() {
    let mut flown = Flown::boot(1000, &[]);
    flown.line("feature -GPS");
    flown.vehicle.apply(&VehicleCommand::ResetCraft);
    flown.hop(2.0);
    let log = flown.log();
    assert!(!log.headers.keys().any(|name| name.starts_with("Field G") || name.starts_with("Field H")));
    let (mains, solutions) = compare(&flown, &log);
    assert!(mains > 400 && solutions == 0, "{mains} {solutions}");
}

#[test]
fn debug_values_are_those_of_the_mode() {
    for (mode, field, name) in [
        ("GYRO_FILTERED", "debug[1]", "gyroADC[1]"),
        ("GYRO_RAW", "debug[2]", "gyroUnfilt[2]"),
        ("BARO", "debug[3]", "baroAlt"),
        ("ALTITUDE", "debug[1]", "baroAlt"),
    ] {
        let mut flown = Flown::boot(1000, &[&format!("debug_mode = {mode}")]);
        flown.hop(4.0);
        let log = judge::read(&flown.logs[0]);
        for values in log.mains() {
            assert_eq!(values[field], values[name], "{mode} at {}", values["time"]);
        }
        assert!(log.mains().iter().any(|values| values[field] != 0), "{mode}");
    }
}

#[test]
fn the_debug_values_of_the_autopilot_show_its_flight() {
    let mut flown = Flown::boot(1000, &["debug_mode = AUTOPILOT_PID"]);
    flown.line("waypoint insert 0 40.4637000 -79.5182000 1000 500 FLYOVER 0 ORBIT");
    flown.vehicle.apply(&VehicleCommand::StartPilot(5.0)).accepted().unwrap();
    flown.fly(30.0);
    // The crate does not know this mode.
    let log = reader::read(&flown.logs[0]);
    let mains = log.mains();
    let approaching: Vec<_> = mains.iter().filter(|values| values["debug[7]"] == 1).collect();
    assert!(approaching.len() > 100, "{}", approaching.len());
    assert!(approaching.iter().any(|values| values["debug[0]"] > 200), "ground speed, cm/s");
    assert!(approaching.iter().any(|values| (300..3000).contains(&values["debug[1]"])), "distance, cm");
}
