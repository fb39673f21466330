//! `fly --csv`: the samples of a flight as rows.

use std::collections::BTreeMap;

use crate::binary::support::Sandbox;

/// Returns the rows of a table, each as cells by name.
fn rows(text: &str) -> Vec<BTreeMap<String, String>> {
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    lines
        .map(|cells| {
            assert_eq!(cells.len(), header.len());
            header.iter().cloned().zip(cells).collect()
        })
        .collect()
}

#[test]
fn rows_have_the_numbers_of_the_json_samples() {
    let sandbox = Sandbox::new();
    let options = ["--json", "flight.json", "--csv", "flight.csv", "--samples", "4", "--wind", "3@200"];
    sandbox.run(&[&["fly", "land"][..], &options].concat()).exits(0);
    let json = sandbox.read("flight.json");
    let json: Vec<serde_json::Value> =
        json.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let samples: Vec<_> = json.iter().filter(|line| line["event"] == "sample").collect();
    let rows = rows(&sandbox.read("flight.csv"));
    assert_eq!(rows.len(), samples.len());
    assert!(rows.len() > 100);
    for (row, sample) in rows.iter().zip(samples) {
        for (name, key) in [
            ("boot_time (s)", "t"),
            ("lat (deg)", "lat"),
            ("north (m)", "n"),
            ("est_north (m)", "est_n"),
            ("climb (m/s)", "vu"),
            ("reported_charge (mAh)", "battery_mah"),
            ("wind_north (m/s)", "wind_n"),
        ] {
            let cell: Option<f64> = row[name].parse().ok();
            assert_eq!(cell, sample[key].as_f64(), "{name} at {}", sample["t"]);
        }
        assert_eq!(row["state"], sample["state"].as_str().expect("a state"));
    }
    let engaged = rows.iter().find(|row| !row["time (s)"].is_empty()).expect("an engagement");
    let after: f64 = engaged["time (s)"].parse().expect("a time");
    assert!((0.0..0.25).contains(&after), "{after}");
}

#[test]
fn rows_on_standard_output_take_the_place_of_the_sentences() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run(&["fly", "land", "--csv", "-"]).exits(0);
    let rows = rows(&ran.out);
    let last: f64 = rows.last().expect("rows")["boot_time (s)"].parse().expect("a time");
    assert!((rows.len() as f64 - 10.0 * last).abs() <= 1.0, "{} rows in {last} s", rows.len());
    assert!(ran.err.starts_with("complete: "), "{}", ran.err);
    let both = sandbox.run(&["fly", "land", "--csv", "-", "--json", "-"]).exits(2);
    assert!(both.err.contains("both go to standard output"), "{}", both.err);
}

#[test]
fn a_table_is_whole_or_not_there() {
    let sandbox = Sandbox::new();
    sandbox.run(&["fly", "land", "--timeout=2", "--csv", "flight.csv"]).exits(1);
    sandbox.run(&["fly", "missing.toml", "--csv", "flight.csv"]).exits(3);
    assert_eq!(sandbox.names(), [""; 0], "it is that of the earlier flight");
    sandbox.write("flight.csv", "latitude,longitude,altitude(m)\n");
    sandbox.run(&["fly", "missing.toml", "--csv", "flight.csv"]).exits(2);
    assert_eq!(sandbox.names(), ["flight.csv"], "it is the user's");
    #[cfg(target_os = "linux")]
    {
        let ran = sandbox.run(&["fly", "land", "--csv", "/dev/full", "--samples", "100"]).exits(3);
        assert!(ran.err.starts_with("cannot write /dev/full: No space"), "{}", ran.err);
    }
}
