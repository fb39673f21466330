//! Small inputs of `tests/cases` that once had the wrong outcome: each with the right one.

use std::path::PathBuf;

use crate::binary::support::Sandbox;

/// Returns a file of `tests/cases`.
fn case(name: &str) -> PathBuf {
    test_support::path("tests/cases").join(name)
}

/// Returns a folder with these files of `tests/cases`.
fn folder(names: &[&str]) -> Sandbox {
    let sandbox = Sandbox::new();
    for name in names {
        std::fs::copy(case(name), sandbox.path(name)).expect("a case");
    }
    sandbox
}

#[test]
fn a_rescue_by_switch_goes_on_when_the_autopilot_switch_goes_off() {
    let sandbox = folder(&["rescue-then-autopilot-off.toml", "guide.txt"]);
    sandbox.run(&["check", "rescue-then-autopilot-off.toml"]).exits(0);
}

#[test]
fn a_craft_whose_gyro_steps_is_held_and_says_that_gyro_and_accelerometer_disagree() {
    let sandbox = folder(&["bf-15724-gyro-step.toml", "guide.txt"]);
    sandbox.run(&["check", "bf-15724-gyro-step.toml"]).exits(0);
}

#[test]
fn an_inav_file_with_missions_whose_indices_begin_again_is_read_whole() {
    let sandbox = folder(&["inav-6765.txt"]);
    for (mission, latitude) in [("1", "40.4640000"), ("2", "40.4641000"), ("3", "40.4642000")] {
        let home = "40.4635,-79.5182";
        let ran = sandbox.run(&[
            "convert",
            "inav-6765.txt",
            "out.toml",
            "--mission",
            mission,
            "--force",
            "--home",
            home,
        ]);
        let plan = sandbox.read("out.toml");
        assert!(plan.contains(latitude), "{mission}: {plan}\n{ran:?}");
        let said = format!("{}{}", ran.out, ran.err);
        for (other, count) in [("1", 4), ("2", 5), ("3", 3)] {
            let named = format!("mission {other} ({count} items)");
            assert_eq!(said.contains(&named), other != mission, "{named} of {mission}: {said}");
        }
    }
}

#[test]
fn an_implausible_home_costs_a_finding_and_a_change_of_the_altitude_s_reference_is_reported() {
    let sandbox = folder(&["tower-481.waypoints", "mp-953.waypoints"]);
    let ran = sandbox.run(&["convert", "tower-481.waypoints", "tower.toml"]);
    let said = format!("{}{}", ran.out, ran.err);
    assert!(said.contains("29064.96") && said.contains("allowed: -500 to 9000 m"), "{said}");
    assert_eq!(sandbox.read("tower.toml").matches("[[waypoint]]").count(), 2, "{said}");
    let ran = sandbox.run(&["convert", "mp-953.waypoints", "mp.toml"]);
    let said = format!("{}{}", ran.out, ran.err);
    assert!(said.contains("30 m above sea level → 10 m above home"), "{said}");
}

#[test]
fn the_results_of_a_campaign_start_no_executable_unasked() {
    let sandbox = Sandbox::new();
    let plan = "waypoint insert 0 40.4635901 -79.5182000 2000 500 LAND 0 NONE\n";
    sandbox.write("plan.txt", plan);
    sandbox.run(&["campaign", "plan.txt", "--flights", "2", "--timeout", "1", "--out", "run.jsonl"]);
    let run = sandbox.read("run.jsonl");
    let mut lines = run.lines();
    let header: serde_json::Value = serde_json::from_str(lines.next().expect("a header")).expect("JSON");
    let flight = lines.next().expect("a flight");
    let evil = sandbox.path("evil.sh");
    std::fs::write(&evil, format!("#!/bin/sh\ntouch {}\n", sandbox.path("STARTED").display()))
        .expect("written");
    std::fs::set_permissions(&evil, std::os::unix::fs::PermissionsExt::from_mode(0o755)).expect("executable");
    sandbox.write("bl.txt", &format!("[Betaloop]\nBetaflightElf={}\n", evil.display()));
    let (evil, list) = (evil.display().to_string(), sandbox.path("bl.txt").display().to_string());
    for words in [
        vec!["--firmware".to_owned(), evil.clone()],
        vec![format!("--firmware={evil}")],
        vec![format!("--betaloop={list}")],
        vec!["--firmware-arg".to_owned(), "./mine.elf".to_owned(), format!("--firmware={evil}")],
        vec![format!("--firmware={evil}"), "--yes".to_owned()],
    ] {
        for is_versus in [false, true] {
            let mut edited = header.clone();
            let definition = &mut edited["definition"];
            if is_versus {
                definition["versus"] =
                    serde_json::json!({ "settings": [], "has_firmware": true, "firmware": words });
            } else {
                definition["firmware"] = serde_json::json!(words);
            }
            sandbox.write("evil.jsonl", &format!("{edited}\n{flight}\n"));
            for line in [
                &["campaign", "evil.jsonl"][..],
                &["campaign", "evil.jsonl", "--firmware", "./mine.elf"],
                &["open", "evil.jsonl:1", "--plain"],
            ] {
                let ran = sandbox.run(line);
                assert!(!sandbox.path("STARTED").exists(), "{words:?} {line:?}: {ran:?}");
                assert!(is_versus || matches!(ran.code, Some(2 | 3)), "{words:?} {line:?}: {ran:?}");
            }
        }
    }
}

#[test]
fn a_scenario_shows_no_text_of_a_file_that_is_no_plan_and_reads_none_of_another_folder_unasked() {
    let sandbox = Sandbox::new();
    let [credentials, key] = [
        "[default]\naws_access_key_id = SECRET\naws_secret_access_key = \"SECRET\"\n",
        "12 SECRET 4\n-----BEGIN KEY-----\nSECRET==\n",
    ];
    std::fs::create_dir(sandbox.path("from-others")).expect("a folder");
    sandbox.write("credentials.toml", credentials);
    sandbox.write("plan.txt", "waypoint insert 0 40.4640000 -79.5182000 2000 500 LAND 0 NONE\n");
    sandbox.write("from-others/credentials", credentials);
    sandbox.write("from-others/key", key);
    let end = "[[expect]]\nresult = \"complete\"\n";
    let named = |name: &str| {
        [
            format!("format = 1\n[plan]\nfile = \"{name}\"\n{end}"),
            format!(
                "format = 1\n[plan]\nbuiltin = \"square\"\n[[input]]\nat = \"1 s\"\ndo = \"upload {name}\"\n{end}"
            ),
            format!("format = 1\n[plan]\nbuiltin = \"square\"\n[craft]\nsettings_file = \"{name}\"\n{end}"),
            format!("format = 1\n[plan]\nbuiltin = \"square\"\n[craft]\nairframe = \"{name}\"\n{end}"),
        ]
    };
    for name in ["credentials", "key", "../credentials.toml", "../../../../../etc/passwd", "/etc/passwd"] {
        for (kind, scenario) in named(name).iter().enumerate() {
            sandbox.write("from-others/s.toml", scenario);
            let is_outside = name.starts_with(['.', '/']) && (kind != 3 || name.ends_with(".toml"));
            for line in [
                &["check", "from-others/s.toml"][..],
                &["campaign", "from-others/s.toml", "--flights", "2"],
                &["open", "from-others/s.toml", "--plain"],
            ] {
                let ran = sandbox.run(line);
                assert_eq!(ran.code, Some(2), "{scenario} {line:?} {ran:?}");
                let all = format!("{}{}", ran.out, ran.err);
                assert!(!all.contains("SECRET") && !all.contains("root:"), "{scenario} {line:?} {all}");
                assert_eq!(all.contains("--any-folder"), is_outside, "{scenario} {line:?} {all}");
            }
        }
    }
    let [scenario, ..] = named("../plan.txt");
    sandbox.write("from-others/s.toml", &scenario);
    sandbox.run(&["check", "from-others/s.toml", "--list"]).exits(2);
    sandbox.run(&["check", "from-others/s.toml", "--list", "--any-folder"]).exits(0);
}

/// Writes the table of a log of `tests/cases`. Returns what was said and the cells by row; the first row has the names.
fn table(name: &str) -> (String, Vec<Vec<String>>) {
    let sandbox = folder(&[name]);
    let ran = sandbox.run(&["replay", name, "--csv", "values.csv"]).exits(0);
    let text = sandbox.read("values.csv");
    let mut rows = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    let cells = |row: csv::Result<csv::StringRecord>| row.expect("a row").iter().map(str::to_owned).collect();
    (ran.err, rows.records().map(cells).collect())
}

/// Returns the cells of a column below its name.
fn column<'a>(rows: &'a [Vec<String>], name: &str) -> Vec<&'a str> {
    let at = rows[0].iter().position(|known| known == name);
    let at = at.unwrap_or_else(|| panic!("{name} is not in {:?}", rows[0]));
    rows[1..].iter().map(|row| row[at].as_str()).collect()
}

#[test]
fn a_log_without_the_encodings_of_its_gps_frames_is_read_and_the_missing_line_is_named() {
    let (said, rows) = table("bbl-inav42-no-g-encoding.bfl");
    assert!(said.contains("The header has no line `Field G encoding`: "), "{said}");
    assert!(said.contains("assumed for G frames") && !said.contains("damaged"), "{said}");
    let places = column(&rows, "GPS_coord[0] (°, assumed)");
    assert!(
        rows.len() > 120 && places.last().is_some_and(|place| place.starts_with("40.4635")),
        "{places:?}"
    );
}

#[test]
fn a_log_with_an_interval_of_zero_is_read_and_what_is_assumed_is_named() {
    let (said, rows) = table("bbl-253-p-interval-zero.bfl");
    assert!(said.contains("`P interval:1/0`") && said.contains("an interval of 4 is assumed"), "{said}");
    assert!(said.contains("These values rest on what is assumed: loopIteration."), "{said}");
    let iterations: Vec<u32> =
        column(&rows, "loopIteration (assumed)").iter().map(|cell| cell.parse().expect("a number")).collect();
    assert!(
        iterations.len() > 100 && iterations.windows(2).all(|pair| pair[1] - pair[0] == 4),
        "{iterations:?}"
    );
}

#[test]
fn gps_frames_of_a_log_without_a_home_are_no_gap_and_stay_raw() {
    let (said, rows) = table("bbl-157-no-home-fields.bfl");
    assert!(
        said.contains("`Field H …`: H frames are passed, and places count from an unknown home"),
        "{said}"
    );
    assert!(!said.contains("damaged"), "{said}");
    let (_, whole) = table("bbl-253-p-interval-zero.bfl");
    assert_eq!(column(&rows, "motor[0] (%)"), column(&whole, "motor[0] (%)"));
    assert_eq!(column(&rows, "speed (m/s)"), column(&whole, "speed (m/s)"));
    let place = column(&rows, "GPS_coord[0] (°, assumed)");
    assert!(place.last().is_some_and(|place| place.starts_with("0.00000")), "{place:?}");
    assert_eq!(column(&rows, "north (m, assumed)").concat(), "");
}

#[test]
fn a_gap_in_a_header_is_named_with_the_lines_that_it_took() {
    let (said, rows) = table("header-gap.bbl");
    assert!(said.contains("The line `Firmware type:Be` of the header"), "{said}");
    for line in
        ["Firmware revision", "I interval", "P interval", "vbatref", "motorOutput", "gyro_scale", "acc_1G"]
    {
        assert!(said.contains(&format!("The header has no line `{line}`: ")), "{line} in {said}");
    }
    assert!(said.contains("These values rest on what is assumed: battery, loopIteration, "), "{said}");
    let assumed = ["motor[0] (%, assumed)", "gyroADC[0] (°/s, assumed)", "accSmooth[0] (assumed)"];
    assert!(assumed.iter().all(|name| rows[0].iter().any(|known| known == name)), "{:?}", rows[0]);
    assert!(rows.len() > 100 && column(&rows, "motor[0] (%, assumed)")[9].starts_with('5'), "{rows:?}");
    let sandbox = folder(&["header-gap.bbl"]);
    let shown = sandbox.run(&["replay", "header-gap.bbl", "--plain", "--at", "0"]);
    assert!(shown.out.contains("`Firmware type:Be`"), "{}", shown.out);
}
