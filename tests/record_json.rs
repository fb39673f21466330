//! The JSON lines of real flights: their form, and that equal flights give equal bytes.

use std::path::Path;

/// Standard output of `betadeck fly` with these arguments.
fn fly(arguments: &[&str]) -> String {
    let output = assert_cmd::Command::cargo_bin("betadeck")
        .expect("the program")
        .env_clear()
        .arg("fly")
        .args(arguments)
        .output()
        .expect("a flight");
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn keys(line: &str) -> Vec<String> {
    // The order of keys matters, and a map would sort them.
    let mut keys = Vec::new();
    let mut depth = 0;
    let mut rest = line;
    while let Some(at) = rest.find(['"', '{', '}', '[', ']']) {
        let (byte, after) = (rest.as_bytes()[at], &rest[at + 1..]);
        rest = after;
        match byte {
            b'{' | b'[' => depth += 1,
            b'}' | b']' => depth -= 1,
            _ => {
                let (text, after) = after.split_once('"').expect("a closing quote");
                rest = after;
                if depth == 1 && rest.starts_with(':') {
                    keys.push(text.to_owned());
                }
            }
        }
    }
    keys
}

const SAMPLE: &str = "t event lat lon alt n e vn ve vu roll pitch heading est_n est_e est_alt throttle_us motors \
    battery_v battery_a battery_mah state wp wp_type dist_m bearing xte_m l1_mode target_n target_e target_alt \
    hold_remaining_ds wind_n wind_e";

#[test]
fn every_line_has_its_keys_in_their_order() {
    let text = fly(&["hold-none", "--json", "-", "--samples", "5", "--fault", "baro-spike@5,1,50"]);
    let mut seen = std::collections::BTreeSet::new();
    for line in text.lines() {
        let value: serde_json::Value = serde_json::from_str(line).expect("a JSON object");
        let event = value["event"].as_str().expect("a name").to_owned();
        let expected = match event.as_str() {
            "boot" => "t event version seed rate airframe live",
            "gps_fix" => "t event sats",
            "armed" => "t event",
            "disarmed" => "t event reason",
            "mode" => "t event active",
            "plan" => "t event source count waypoints",
            "state" => "t event from to wp type reason guard target_lat target_lon target_alt",
            "fault" => "t event name on value",
            "contact" => "t event impact_mps",
            "touchdown" => "t event impact_mps peak_mps2",
            "notice" => "t event text",
            "sample" => SAMPLE,
            "end" => "t event result reason flown_s wall_s speed_ratio",
            other => panic!("{other}: {line}"),
        };
        assert_eq!(keys(line).join(" "), expected, "{line}");
        seen.insert(event);
    }
    for event in ["boot", "plan", "state", "fault", "contact", "touchdown", "disarmed", "sample", "end"] {
        assert!(seen.contains(event), "no {event} in the flight");
    }
}

#[test]
fn time_never_runs_backwards_and_samples_are_even() {
    let text = fly(&["land", "--json", "-", "--samples", "10"]);
    let mut last = 0.0;
    let mut samples = Vec::new();
    for line in text.lines() {
        let value: serde_json::Value = serde_json::from_str(line).expect("a JSON object");
        let t = value["t"].as_f64().expect("a time");
        assert!(t >= last, "{line}");
        last = t;
        if value["event"] == "sample" {
            samples.push(t);
        }
    }
    assert!(samples.len() > 100);
    assert!(samples.windows(2).all(|pair| (pair[1] - pair[0] - 0.1).abs() < 1e-6), "{samples:?}");
}

#[test]
fn equal_flights_give_equal_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |name: &str| {
        let track = folder.path().join(name);
        let path = track.to_str().expect("a plain path");
        let text = fly(&[
            "flyby",
            "--json",
            "-",
            "--samples",
            "20",
            "--wind",
            "4@200",
            "--gust",
            "2",
            "--gpx",
            path,
        ]);
        let without_end: String = text.lines().filter(|line| !line.contains("\"event\":\"end\"")).collect();
        (without_end, std::fs::read_to_string(Path::new(path)).expect("a track"))
    };
    let (first, second) = (run("1.gpx"), run("2.gpx"));
    assert!(first.0.len() > 100_000 && first.1.contains("</gpx>"));
    assert!(first == second, "the flights differ");
}
