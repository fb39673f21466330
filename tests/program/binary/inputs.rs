//! The options of `fly`: failures, sticks, air, rates, and the files that are written.

use crate::binary::support::{Flown, Sandbox};

fn fly(arguments: &[&str]) -> Flown {
    Sandbox::new().fly(arguments)
}

/// Returns the time of the first transition into a state, counted from engagement.
fn entered(flown: &Flown, state: &str) -> Option<f64> {
    let line = flown.all("state").find(|line| line.text("to") == state)?;
    Some(line.time() - flown.engaged_at())
}

#[test]
fn a_lost_radio_link_lands_the_craft_here_when_the_policy_says_so() {
    let flown = fly(&["square", "--rx-loss-at", "20", "--set", "ap_rx_loss_policy=LAND"]).ends(1, "landed");
    let loss = flown.first("rx_loss").time() - flown.engaged_at();
    assert!((20.0..21.5).contains(&loss), "lost after {loss} s");
    assert_eq!(
        flown.all("plan").next_back().map(|line| line.text("source").to_owned()),
        Some("emergency".to_owned())
    );
    assert!(entered(&flown, "LANDING").expect("a landing") < 25.0);
    assert_eq!(flown.first("disarmed").text("reason"), "LANDING");
}

#[test]
fn a_short_gap_of_the_radio_link_changes_nothing() {
    let flown = fly(&["hold-none", "--rx-loss-at", "8,0.1"]).ends(0, "complete");
    assert_eq!(flown.all("failsafe").filter(|line| line.number("stage") > 1.0).count(), 0);
}

#[test]
fn a_lost_gps_ends_the_mission() {
    let flown = fly(&["square", "--gps-loss-at", "10"]).ends(1, "aborted");
    let lost = flown.first("gps_lost").time() - flown.engaged_at();
    assert!((10.0..13.0).contains(&lost), "lost after {lost} s");
    assert!(entered(&flown, "IDLE").expect("an IDLE") < 14.0);
}

#[test]
fn faults_are_reported_with_their_times_and_boot_times_count_from_boot() {
    let flown = fly(&["hold-none", "--fault", "motor@5,4,2:0.9", "--fault", "gust@boot+4,2,3@90"]);
    let faults: Vec<(String, f64, bool)> = flown
        .all("fault")
        .map(|line| (line.text("name").to_owned(), line.time(), line.value("on").as_bool().expect("a flag")))
        .collect();
    let at = |name: &str, on: bool| {
        let found = faults.iter().find(|fault| fault.0 == name && fault.2 == on);
        found.unwrap_or_else(|| panic!("{name} {on} in {faults:?}")).1
    };
    let engaged = flown.engaged_at();
    assert!(
        (at("motor", true) - engaged - 5.0).abs() < 0.01 && (at("motor", false) - engaged - 9.0).abs() < 0.01
    );
    assert!((at("gust", true) - 4.0).abs() < 0.01 && (at("gust", false) - 6.0).abs() < 0.01);
    flown.ends(0, "complete");
}

#[test]
fn the_arm_switch_taken_back_in_flight_ends_the_flight() {
    let flown = fly(&["square", "--stick", "aux1=1000@10"]).ends(1, "disarmed");
    let disarmed = flown.first("disarmed");
    assert_eq!(disarmed.text("reason"), "SWITCH");
    assert!((disarmed.time() - flown.engaged_at() - 10.0).abs() < 0.5);
}

#[test]
fn a_dead_motor_is_a_crash() {
    let flown = fly(&["square", "--fault", "motor@10,,1:0"]).ends(1, "crashed");
    assert!(flown.first("crash").text("cause").contains("ground"), "{:?}", flown.first("crash"));
}

#[test]
fn the_autopilot_switched_off_for_a_while_resumes() {
    let flown = fly(&["square", "--stick", "aux2=1000@5,4"]).ends(0, "complete");
    let first: Vec<String> = flown.states().into_iter().take(3).collect();
    assert_eq!(first, ["APPROACHING 0", "IDLE 0", "APPROACHING 0"]);
    assert!((entered(&flown, "IDLE").expect("an IDLE") - 5.0).abs() < 0.2);
}

#[test]
fn takeoff_zero_leaves_the_climb_to_the_autopilot() {
    let flown = fly(&["takeoff", "--takeoff", "0", "--samples", "10"]).ends(0, "complete");
    let engaged = flown.engaged_at();
    let start = flown.all("sample").find(|line| line.time() >= engaged).expect("a sample");
    assert!(start.number("alt") < 2.0, "{}", start.number("alt"));
    assert_eq!(flown.states()[..3], ["APPROACHING 0", "ARRIVED 0", "APPROACHING 1"]);
}

#[test]
fn every_rate_flies_the_square() {
    for rate in ["400", "500", "1000", "2000", "4000", "8000"] {
        let flown = fly(&["square", "--rate", rate]).ends(0, "complete");
        assert_eq!(flown.first("boot").number("rate").to_string(), rate);
        assert_eq!(
            flown.all("disarmed").map(|line| line.text("reason")).collect::<Vec<_>>(),
            ["LANDING"],
            "{rate}"
        );
    }
}

#[test]
fn the_air_is_what_was_asked_for() {
    let flown = fly(&["square", "--wind", "5@270", "--world", "wind_profile=flat", "--samples", "2"])
        .ends(0, "complete");
    for line in flown.all("sample").filter(|line| line.number("alt") > 5.0) {
        assert!((line.number("wind_e") - 5.0).abs() < 0.01 && line.number("wind_n").abs() < 0.01, "{line:?}");
    }
    let rough = fly(&["square", "--wind", "4@45", "--gust", "2", "--turbulence", "light", "--samples", "2"]);
    let rough = rough.ends(0, "complete");
    let speeds: Vec<f64> = rough
        .all("sample")
        .filter(|line| line.number("alt") > 5.0)
        .map(|line| line.number("wind_n").hypot(line.number("wind_e")))
        .collect();
    let (low, high) = speeds.iter().fold((f64::MAX, 0.0_f64), |(low, high), &v| (low.min(v), high.max(v)));
    assert!(high - low > 1.0, "gusts from {low:.1} to {high:.1} m/s");
}

#[test]
fn both_airframes_and_both_attitudes_fly() {
    for arguments in [["--airframe", "five-inch"], ["--airframe", "iris"], ["--attitude", "truth"]] {
        let flown = fly(&[&["hold-none"], arguments.as_slice()].concat());
        assert_eq!(flown.code, Some(0), "{arguments:?}: {}", flown.err);
    }
}

#[test]
fn the_craft_is_drawn_where_and_as_it_is_reported() {
    let flown = fly(&["hold-none", "--home", "40.4634,-79.5181,120", "--heading", "90", "--samples", "1"]);
    let first = flown.first("sample");
    assert!((first.number("lat") - 40.4634).abs() < 1e-7 && (first.number("lon") + 79.5181).abs() < 1e-7);
    assert!((first.number("heading") - 90.0).abs() < 0.5, "{first:?}");
    assert!(
        first.number("n").abs() < 0.01 && first.number("e").abs() < 0.01 && first.number("alt").abs() < 0.1
    );
    flown.ends(0, "complete");
}

#[test]
fn settings_come_from_plan_file_and_command_line_and_the_later_wins() {
    let sandbox = Sandbox::new();
    sandbox.write("diff.txt", "# diff all\nset ap_max_distance_from_home = 40\nsave\n");
    // The plan allows 500 m and the file allows 40 m. The farthest waypoint is farther than 40 m.
    sandbox.fly(&["square", "--settings", "diff.txt"]).ends(1, "refused");
    sandbox
        .fly(&["square", "--settings", "diff.txt", "--set", "ap_max_distance_from_home=300"])
        .ends(0, "complete");
}

#[test]
fn the_pilot_uses_the_switches_of_the_craft() {
    let sandbox = Sandbox::new();
    // ARM on AUX4, AUTOPILOT in the middle of AUX6, ANGLE, ALTHOLD and POS HOLD on AUX7.
    let levelling = "aux 2 1 6 1700 2100 0 0\naux 3 3 6 1700 2100 0 0\naux 4 11 6 1700 2100 0 0\n";
    let switches = "aux 0 0 3 1700 2100 0 0\naux 1 56 5 1300 1700 0 0\n";
    sandbox.write("modes.txt", &format!("{switches}{levelling}"));
    sandbox.fly(&["hold-none", "--settings", "modes.txt"]).ends(0, "complete");
}

#[test]
fn a_craft_that_is_given_a_mode_gets_no_starter_modes_beside_it() {
    let sandbox = Sandbox::new();
    // Only ARM has a switch, on AUX4. AUTOPILOT has none.
    sandbox.write("modes.txt", "aux 0 0 3 1700 2100 0 0\n");
    let ran = sandbox.run(&["fly", "hold-none", "--settings", "modes.txt"]).exits(2);
    assert!(ran.err.contains("no channel switches AUTOPILOT"), "{}", ran.err);
    // A file with settings alone defines no modes.
    sandbox.write("settings.txt", "set ap_max_angle = 25\n");
    sandbox.fly(&["hold-none", "--settings", "settings.txt"]).ends(0, "complete");
}

#[test]
fn json_and_gpx_go_to_the_files_and_nothing_else_is_written() {
    let sandbox = Sandbox::new();
    let ran = sandbox
        .run(&["fly", "land", "--json", "flight.json", "--samples", "5", "--gpx", "track.gpx"])
        .exits(0);
    assert_eq!(ran.out, "");
    let lines = crate::binary::lines::Line::read_all(&sandbox.read("flight.json"));
    let samples: Vec<f64> =
        lines.iter().filter(|line| line.event() == "sample").map(crate::binary::lines::Line::time).collect();
    assert!(samples.len() > 100);
    assert!(samples.windows(2).all(|pair| (pair[1] - pair[0] - 0.2).abs() < 1e-6));
    let gpx = sandbox.read("track.gpx");
    assert!(gpx.starts_with("<?xml") && gpx.trim_end().ends_with("</gpx>"), "{}", &gpx[..200]);
    assert!(gpx.matches("<trkpt ").count() > 30, "{}", gpx.matches("<trkpt ").count());
    let mut names = sandbox.names();
    names.sort();
    assert_eq!(names, ["flight.json", "track.gpx"]);
}

#[test]
fn tracks_of_equal_flights_are_equal() {
    let sandbox = Sandbox::new();
    let fly = |name: &str| {
        let [kml, geojson] = [format!("{name}.kml"), format!("{name}.geojson")];
        let options = ["fly", "land", "--kml", &kml, "--geojson", &geojson, "--track-hz", "2"];
        sandbox.run(&options).exits(0);
        (sandbox.read(&kml), sandbox.read(&geojson))
    };
    let (kml, geojson) = fly("a");
    assert!(kml.matches("<gx:coord>").count() > 60, "{kml}");
    assert_eq!(kml.matches("<gx:coord>").count(), kml.matches("<when>").count());
    assert!(kml.contains("<styleUrl>#LANDING</styleUrl>") && geojson.contains("\"name\":\"LANDING\""));
    assert_eq!(fly("b"), (kml, geojson));
}

#[test]
fn without_json_events_are_sentences_and_the_summary_goes_to_standard_error() {
    let ran = Sandbox::new().run(&["fly", "land"]).exits(0);
    for sentence in ["Booted", "GPS fix", "Armed.", "LANDING → COMPLETE", "Disarmed: landed."] {
        assert!(ran.out.contains(sentence), "no {sentence:?} in\n{}", ran.out);
    }
    let summary: Vec<&str> = ran.err.lines().collect();
    assert!(summary[0].starts_with("complete: ") && summary[1].contains("x real time)"), "{summary:?}");
}

#[test]
fn a_mistyped_state_directory_is_reported_and_not_made() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run(&["fly", "square", "--state-dir", "statte"]);
    assert_eq!(ran.code, Some(2), "{}", ran.err);
    assert!(ran.err.contains("--state-dir statte is not a directory"), "{}", ran.err);
    assert!(!sandbox.path("statte").exists());
}

#[cfg(unix)]
#[test]
fn a_pipe_or_device_in_the_place_of_a_file_is_refused_at_once() {
    let sandbox = Sandbox::new();
    let fifo = sandbox.path("fifo.txt");
    let made = std::process::Command::new("mkfifo").arg(&fifo).status().expect("mkfifo");
    assert!(made.success());
    sandbox.write("plan.txt", "waypoint insert 0 40.4635901 -79.5182000 2000 500 LAND 0 NONE\n");
    std::os::unix::fs::symlink("/dev/zero", sandbox.path("zero.txt")).expect("a link");
    let fifo = fifo.to_str().expect("a name");
    let refused: [&[&str]; 6] = [
        &["fly", fifo],
        &["fly", "zero.txt"],
        &["plan", "show", "zero.txt"],
        &["convert", fifo, "out.toml"],
        &["fly", "plan.txt", "--settings", fifo],
        &["sitl", "--config", fifo],
    ];
    for arguments in refused {
        let ran = sandbox.run(arguments);
        assert!(matches!(ran.code, Some(1 | 2)), "{arguments:?}: {ran:?}");
        assert!(format!("{}{}", ran.out, ran.err).contains("is a device or a pipe, not a file"), "{ran:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_that_the_shell_gives_is_read() {
    let sandbox = Sandbox::new();
    let line = "waypoint insert 0 40.4635901 -79.5182000 2000 500 LAND 0 NONE\n";
    for path in ["-", "/dev/stdin", "/dev/fd/0"] {
        let ran = sandbox.run_with(&["plan", "show", path], line).exits(0);
        assert!(ran.out.contains("LAND"), "{path}: {ran:?}");
    }
    sandbox.run_with(&["fly", "land", "--settings", "/dev/fd/0"], "set ap_max_angle = 30\n").exits(0);
}

#[cfg(unix)]
#[test]
fn no_output_is_written_over_an_input_by_any_link() {
    let sandbox = Sandbox::new();
    let text = "waypoint insert 0 40.4635901 -79.5182000 2000 500 LAND 0 NONE\n";
    sandbox.write("plan.txt", text);
    std::fs::hard_link(sandbox.path("plan.txt"), sandbox.path("hard.jsonl")).expect("a link");
    std::os::unix::fs::symlink("plan.txt", sandbox.path("soft.gpx")).expect("a link");
    let refused: [&[&str]; 5] = [
        &["fly", "plan.txt", "--json", "hard.jsonl"],
        &["fly", "plan.txt", "--gpx", "soft.gpx"],
        &["fly", "plan.txt", "--gpx", "./plan.txt"],
        &["convert", "plan.txt", "hard.jsonl", "--to", "toml", "--force"],
        &["fly", "plan.txt", "--state-dir", ".", "--json", "eeprom.bin"],
    ];
    for arguments in refused {
        let ran = sandbox.run(arguments);
        assert_eq!(ran.code, Some(2), "{arguments:?}: {ran:?}");
        assert!(ran.err.contains("would overwrite"), "{ran:?}");
        assert_eq!(sandbox.read("plan.txt"), text);
    }
}

#[test]
fn nothing_from_a_plan_file_reaches_the_terminal_raw() {
    let sandbox = Sandbox::new();
    let name = format!("\\u001B[2J\\u202E{}", "x".repeat(500));
    let plan = format!(
        "name = \"{name}\"\nformat = 1\n[[waypoint]]\ntype = \"LAND\"\nlat = 40.4635\nlon = -79.5182\nalt = 20.0\nnonsense\u{202e} = 1\n"
    );
    sandbox.write("evil.toml", &plan);
    for arguments in [["plan", "show", "evil.toml"], ["fly", "evil.toml", "--fresh"]] {
        let ran = sandbox.run(&arguments);
        for text in [&ran.out, &ran.err] {
            let raw: Vec<char> =
                text.chars().filter(|c| c.is_control() && *c != '\n' || *c == '\u{202e}').collect();
            assert_eq!(raw, [], "{arguments:?}: {text:?}");
            assert!(text.lines().all(|line| line.chars().count() <= 400), "{text}");
        }
    }
}

#[test]
fn a_state_directory_is_used_only_when_named() {
    let sandbox = Sandbox::new();
    sandbox.run(&["fly", "land"]).exits(0);
    assert_eq!(sandbox.names(), Vec::<String>::new());
    std::fs::create_dir(sandbox.path("state")).expect("a directory");
    sandbox.run(&["fly", "land", "--state-dir", "state"]).exits(0);
    assert_eq!(std::fs::read_dir(sandbox.path("state")).expect("a directory").count(), 0, "it only reads");
    let ran = sandbox.run(&["fly", "land", "--state-dir", "state", "--fresh"]).exits(2);
    assert!(ran.err.contains("--fresh") && ran.err.contains("--state-dir"), "{}", ran.err);
}
