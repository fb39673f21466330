//! The lines before the frames.

use crate::log_writer::flown::Flown;
use crate::log_writer::judge;

fn lines(log: &[u8]) -> Vec<String> {
    let end = log.windows(2).position(|pair| pair == b"\nI").unwrap();
    String::from_utf8(log[..end].to_vec()).unwrap().lines().map(str::to_owned).collect()
}

fn value<'a>(lines: &'a [String], name: &str) -> &'a str {
    let start = format!("H {name}:");
    lines.iter().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("no line {name}"))
}

#[test]
fn the_header_has_the_lines_that_decoders_need() {
    let settings = ["blackbox_sample_rate = 1/4", "craft_name = Bee 7", "ap_max_angle = 31"];
    let mut flown = Flown::boot(2000, &settings);
    flown.hop(0.25);
    let lines = lines(&flown.logs[0]);
    assert!(lines.iter().all(|line| line.starts_with("H ") && line.len() < 1024), "{lines:#?}");
    assert_eq!(lines[0], "H Product:Blackbox flight data recorder by Nicholas Sherlock");
    assert_eq!(lines[1], "H Data version:2");
    assert!(lines[2].starts_with("H Field I name:loopIteration,time,axisP[0]"), "{}", lines[2]);
    let at = |start: &str| lines.iter().position(|line| line.starts_with(start)).unwrap();
    let frames = ["H Field I ", "H Field P ", "H Field H ", "H Field G ", "H Field S ", "H Firmware type"];
    assert!(frames.map(at).is_sorted(), "the order of the real log");
    let fields = |name: &str| value(&lines, name).split(',').count();
    assert_eq!(fields("Field P predictor"), fields("Field I name"));
    for (name, expected) in [
        ("Firmware type", "Betaflight"),
        ("Craft name", "Bee 7"),
        ("I interval", "64"),
        ("P interval", "4"),
        ("P ratio", "16"),
        ("gyro_scale", "0x3f800000"),
        ("acc_1G", "256"),
        ("motorOutput", "1000,2000"),
        ("looptime", "500"),
        ("gyro_sync_denom", "1"),
        ("pid_process_denom", "1"),
        ("rollPID", "45,80,30"),
        ("rates_type", "3"),
        ("ap_max_angle", "31"),
        ("fields_disabled_mask", "0"),
        ("vbatcellvoltage", "330,350,430"),
    ] {
        assert_eq!(value(&lines, name), expected, "{name}");
    }
    assert!(value(&lines, "Firmware revision").starts_with("Betaflight 2026.12.0-alpha ("));
    let volts: f64 = value(&lines, "vbatref").parse().unwrap();
    let measured = 100.0 * flown.firmware().battery().sample().unwrap().voltage_v;
    assert!((volts - measured).abs() < 30.0, "{volts} {measured}");
    let date = value(&lines, "Log start datetime");
    assert!(date.starts_with("2026-01-01T00:00:0") && date.ends_with("+00:00"), "{date}");
}

#[test]
fn a_version_by_year_is_all_that_the_crate_refuses() {
    let mut flown = Flown::boot(1000, &[]);
    flown.hop(0.25);
    let refused = blackbox_log::File::new(&flown.logs[0]).parse(0).unwrap().unwrap_err();
    assert!(refused.to_string().contains("could not parse firmware"), "{refused}");
    let known = judge::with_known_version(&flown.logs[0]);
    let file = blackbox_log::File::new(&known);
    assert_eq!(file.parse(0).unwrap().unwrap().unknown()["ap_max_angle"], "50");
}

#[test]
fn every_setting_has_one_line_at_most() {
    let mut flown = Flown::boot(1000, &[]);
    flown.hop(0.25);
    let lines = lines(&flown.logs[0]);
    let mut names: Vec<_> = lines.iter().filter_map(|line| line.split(':').next()).collect();
    names.sort_unstable();
    let all = names.len();
    names.dedup();
    assert_eq!(names.len(), all);
    let bytes: usize = lines.iter().map(|line| line.len() + 1).sum();
    assert!((2500..9000).contains(&bytes), "{bytes}");
}
