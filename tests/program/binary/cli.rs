//! The command line: bad input, help, the small commands, and readers that close the pipe.

use std::io::{BufRead as _, BufReader};
use std::process::Stdio;

use crate::binary::support::{Sandbox, plan};

const BAD: &str = "\
waypoint insert 0 4O.4640000 -79.5175000 5000 0 FLYOVER 0 ORBIT
waypoint insert 1 40.4630000 -279.5175000 5000 0 FLYBYE 0 ORBIT
# a comment
waypoint insert 7 40.4630000 -79.5175000 5000 99999 FLYBY 0 ORBITT
waypoint insert 3 40.4630000 -79.5175000 5000 0
";

#[test]
fn every_error_of_a_plan_has_its_place_and_the_allowed_range() {
    let sandbox = Sandbox::new();
    sandbox.write("bad.txt", BAD);
    for arguments in [
        &["fly", "bad.txt"][..],
        &["plan", "show", "bad.txt"],
        &["convert", "bad.txt", "out.toml"],
        &["fly", "--json", "out.json", "bad.txt"],
    ] {
        let ran = sandbox.run(arguments).exits(2);
        assert_eq!(ran.out, "");
        for place in ["1:19", "2:30", "2:50", "4:17", "4:47", "4:61", "5:"] {
            assert!(ran.err.contains(&format!("bad.txt:{place}")), "no {place} in\n{}", ran.err);
        }
        for help in [
            "4O.4640000 is not a number",
            "allowed: -90.0000000 to 90.0000000",
            "allowed: -180.0000000 to 180.0000000",
            "did you mean FLYBY?",
            "did you mean ORBIT?",
            "allowed: 0 to 65535 cm/s",
        ] {
            assert!(ran.err.contains(help), "no {help:?} in\n{}", ran.err);
        }
        // The caret is under the place.
        let lines: Vec<&str> = ran.err.lines().collect();
        let shown = lines.iter().position(|line| line.contains("insert 0 4O.46")).expect("the line");
        assert_eq!(lines[shown].find("4O"), lines[shown + 1].find('^'), "{}", ran.err);
    }
    assert_eq!(sandbox.names(), ["bad.txt"], "nothing is written");
}

#[test]
fn errors_of_a_toml_plan_have_their_places_too() {
    let sandbox = Sandbox::new();
    sandbox.write(
        "bad.toml",
        "nmae = \"x\"\n\n[[waypoint]]\ntype = \"FLYOVR\"\nlat_deg = 140.0\nlon_deg = \"a\"\nalt_m = 1e9\nspede = 3\n",
    );
    let ran = sandbox.run(&["fly", "bad.toml"]).exits(2);
    for place in ["1:1", "4:8", "5:11", "6:11", "7:9", "8:1"] {
        assert!(ran.err.contains(&format!("bad.toml:{place}: ")), "no {place} in\n{}", ran.err);
    }
    assert!(ran.err.contains("did you mean FLYOVER?"), "{}", ran.err);
    sandbox.write("broken.toml", "name = \"x\n");
    let ran = sandbox.run(&["fly", "broken.toml"]).exits(2);
    assert!(ran.err.contains("broken.toml:1:"), "{}", ran.err);
}

#[test]
fn bad_settings_say_what_is_allowed() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run(&["fly", "square", "--set", "ap_max_angle=999"]).exits(2);
    assert!(ran.err.contains("ap_max_angle 999 is out of range; allowed: 10 to 70"), "{}", ran.err);
    let ran = sandbox.run(&["fly", "square", "--set", "ap_max_angel=20"]).exits(2);
    assert!(ran.err.contains("did you mean ap_max_angle?"), "{}", ran.err);
    sandbox.write(
        "diff.txt",
        "# comment\nset ap_max_angle = 25\nset ap_l1_enable = MAYBE\nfrobnicate\nsett a = 1\n",
    );
    let ran = sandbox.run(&["fly", "square", "--settings", "diff.txt"]).exits(2);
    for part in [
        "diff.txt:3:20: MAYBE is not a value of ap_l1_enable",
        "^^^^^ allowed: OFF, ON",
        "diff.txt:4:1: ",
        "diff.txt:5:1: ",
        "Did you mean set?",
        "diff.txt: 3 problems; nothing was changed",
    ] {
        assert!(ran.err.contains(part), "no {part:?} in\n{}", ran.err);
    }
}

#[test]
fn settings_of_a_plan_are_judged_where_they_stand_by_every_command() {
    let sandbox = Sandbox::new();
    sandbox.write(
        "bad.toml",
        "settings = [\n  \"ap_max_angle = 999\",\n  \"ap_max_angel = 20\",\n]\n[[waypoint]]\ntype = \"LAND\"\n\
         lat_deg = 40.4635\nlon_deg = -79.5182\nalt_m = 10\n",
    );
    for arguments in
        [&["fly", "bad.toml"][..], &["plan", "show", "bad.toml"], &["convert", "bad.toml", "out.txt"]]
    {
        let ran = sandbox.run(arguments).exits(2);
        for part in
            ["bad.toml:2:19: ap_max_angle 999 is out of range", "bad.toml:3:4: ap_max_angel is not a setting"]
        {
            assert!(ran.err.contains(part), "no {part:?} in\n{}", ran.err);
        }
    }
    assert_eq!(sandbox.names(), ["bad.toml"]);
}

#[test]
fn wrong_usage_is_exit_code_2_with_a_suggestion() {
    let sandbox = Sandbox::new();
    for (arguments, hint) in [
        (&["fly", "square", "--sede", "3"][..], "--seed"),
        (&["fly", "sqare"], "square"),
        (&["flyy", "square"], "fly"),
        (&["fly"], "<PLAN>"),
        (&["fly", "square", "--rate", "100"], "400, 500, 1000, 2000, 4000"),
        (&["fly", "square", "--home", "91,0"], "-90"),
        (&["fly", "square", "--fault", "motr@3"], "motor"),
        (&["fly", "square", "--stick", "aux1=1000@x"], "x"),
        (&["fly", "square", "--samples", "10"], "--json"),
        (&["fly", "square", "--airframe", "irs"], "iris"),
        (&["fly", "square", "--wind", "5"], "--wind"),
        (&["fly", "square", "--speed", "fast"], "--speed"),
        (&["fly", "square", "--world", "foo=1"], "wind_profile"),
        (&["fly", "square", "--stick", "foo=x@3"], "foo is not a channel"),
        (&["fly", "square", "--fault", "stall@3"], "leave it out"),
        (&["fly", "square", "--gpx", "-"], "not to standard output"),
        (&["convert", "square", "x.doc"], "--to"),
    ] {
        let ran = sandbox.run(arguments).exits(2);
        assert!(ran.err.contains(hint), "no {hint:?} in\n{}", ran.err);
        assert_eq!(ran.out, "", "{arguments:?}");
    }
    let offered = sandbox.run(&["fly", "square", "--fault", "banana@3"]).exits(2).err;
    assert!(offered.contains("payload") && !offered.contains("fdm-loss"), "{offered}");
    assert_eq!(sandbox.names(), Vec::<String>::new());
}

#[test]
fn a_plan_that_no_craft_flies_is_refused_at_once() {
    let sandbox = Sandbox::new();
    sandbox.write("empty.txt", "# nothing\nset ap_max_angle = 25\n");
    let sentence = "refused: the plan has no waypoints";
    let shown = sandbox.run(&["plan", "show", "empty.txt"]).exits(2);
    assert!(shown.out.contains(sentence), "{}", shown.out);
    let ran = sandbox.run(&["fly", "empty.txt", "--json", "flight.json"]).exits(2);
    assert!(ran.err.contains(&format!("empty: {sentence}")) && ran.err.contains("`set` line"), "{}", ran.err);
    assert_eq!((ran.out.as_str(), sandbox.names().len()), ("", 1));
}

#[test]
fn a_flight_writes_over_none_of_its_own_files() {
    let sandbox = Sandbox::new();
    let text = std::fs::read_to_string(plan("land.toml")).expect("a plan");
    sandbox.write("land.toml", &text);
    sandbox.write("diff.txt", "set ap_max_angle = 25\n");
    for arguments in [
        &["--json", "land.toml"][..],
        &["--json", "./land.toml"],
        &["--gpx", "land.toml"],
        &["--settings", "diff.txt", "--gpx", "diff.txt"],
        &["--json", "same", "--gpx", "same"],
    ] {
        let ran = sandbox.run(&[&["fly", "land.toml"], arguments].concat()).exits(2);
        assert!(ran.err.contains("would overwrite"), "{}", ran.err);
    }
    assert_eq!(sandbox.read("land.toml"), text);
    assert_eq!(sandbox.names().len(), 2);
    // A target that holds no data may be named twice.
    sandbox.run(&["fly", "land.toml", "--json", "/dev/null", "--gpx", "/dev/null"]).exits(0);
}

#[test]
fn convert_replaces_a_file_only_with_force() {
    let sandbox = Sandbox::new();
    sandbox.write("plan.toml", "mine\n");
    let ran = sandbox.run(&["convert", "square", "plan.toml"]).exits(3);
    assert!(ran.err.contains("plan.toml exists") && ran.err.contains("--force"), "{}", ran.err);
    assert_eq!(sandbox.read("plan.toml"), "mine\n");
    sandbox.run(&["convert", "square", "plan.toml", "--force"]).exits(0);
    assert!(sandbox.read("plan.toml").contains("[[waypoint]]"));
    sandbox.run(&["convert", "square", "/dev/null", "--to", "txt"]).exits(0);
}

#[test]
fn a_file_without_waypoints_is_not_converted() {
    let sandbox = Sandbox::new();
    sandbox.write("settings.txt", "set ap_max_angle = 30\nsave\n");
    let ran = sandbox.run(&["convert", "settings.txt", "plan.toml"]).exits(2);
    assert!(ran.err.contains("settings.txt has no waypoints: there is nothing to convert"), "{}", ran.err);
    assert!(!sandbox.path("plan.toml").exists());
}

#[test]
fn standard_input_shows_its_format() {
    let sandbox = Sandbox::new();
    let text = std::fs::read_to_string(plan("land.toml")).expect("a plan");
    let ran = sandbox.run_with(&["plan", "show", "-"], &text).exits(0);
    assert!(ran.out.starts_with("land: "), "{}", ran.out);
    let ran = sandbox.run_with(&["convert", "-", "-", "--from", "txt", "--to", "toml"], &text).exits(2);
    assert!(ran.err.contains("[[waypoint]] is not a command"), "{}", ran.err);
}

#[test]
fn a_simulation_that_leaves_its_range_is_exit_code_4() {
    let far: Vec<String> =
        (0..12).map(|i| format!("--fault=teleport@boot+{},,10000,0,0", 3.0 + 0.1 * f64::from(i))).collect();
    let far: Vec<&str> = far.iter().map(String::as_str).collect();
    Sandbox::new().fly(&[&["land"], far.as_slice()].concat()).ends(4, "diverged");
}

#[test]
fn files_that_cannot_be_read_or_written_are_exit_code_3() {
    let sandbox = Sandbox::new();
    for arguments in [
        &["fly", "missing.toml"][..],
        &["plan", "show", "missing.txt"],
        &["fly", "square", "--settings", "missing.txt"],
        &["fly", "square", "--airframe", "missing.toml"],
        &["fly", "square", "--json", "missing/flight.json"],
        &["fly", "square", "--gpx", "missing/track.gpx"],
        &["convert", "square", "missing/out.txt"],
    ] {
        let ran = sandbox.run(arguments).exits(3);
        assert!(ran.err.contains("missing"), "{}", ran.err);
    }
}

#[test]
fn the_user_interface_without_a_terminal_names_fly() {
    for arguments in [&[][..], &["square"]] {
        let ran = Sandbox::new().run(arguments).exits(3);
        assert_eq!(ran.err.lines().count(), 1, "{}", ran.err);
        assert!(ran.err.contains("terminal") && ran.err.contains("betadeck fly"), "{}", ran.err);
        assert_eq!(ran.out, "");
    }
}

#[test]
fn an_unreachable_mission_ends_at_the_timeout_with_the_reason() {
    let flown = Sandbox::new().fly(&["square", "--timeout", "30"]).ends(1, "timeout");
    let reason = flown.first("end").text("reason");
    assert!(reason.contains("30 s") && reason.contains("APPROACHING"), "{reason}");
    assert!(flown.err.starts_with("timeout: "), "{}", flown.err);
}

#[test]
fn plan_show_prints_the_table_and_judges_the_plan() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run(&["plan", "show", "square"]).exits(0);
    for word in ["FLYOVER", "FLYBY", "HOLD", "LAND", "40.4640000", "-79.5175000"] {
        assert!(ran.out.contains(word), "no {word} in\n{}", ran.out);
    }
    sandbox.write(
        "fence.toml",
        &std::fs::read_to_string(plan("square.toml")).expect("a plan").replace("home = 500", "home = 50"),
    );
    let refused = sandbox.run(&["plan", "show", "fence.toml"]).exits(2);
    assert!(refused.out.contains("refused: waypoint 0 is "), "{}", refused.out);
    let ran = sandbox
        .run_with(&["plan", "show", "-"], "waypoint insert 0 40.4637 -79.5182 1200 0 HOLD 10 FIGURE8\n");
    assert!(ran.exits(0).out.contains("FIGURE8"));
}

#[test]
fn converting_there_and_back_keeps_the_plan() {
    let sandbox = Sandbox::new();
    for name in
        ["square.toml", "alt-change.toml", "delay.toml", "yaw-rate.toml", "takeoff.toml", "guide-square.txt"]
    {
        let source = plan(name);
        for (from, to) in [(source.as_str(), "a.txt"), ("a.txt", "b.toml"), ("b.toml", "c.txt")] {
            sandbox.run(&["convert", from, to, "--force"]).exits(0);
        }
        let waypoints = |name: &str| -> Vec<String> {
            let text = sandbox.read(name);
            text.lines().filter(|line| line.starts_with("waypoint insert")).map(str::to_owned).collect()
        };
        assert!(!waypoints("a.txt").is_empty(), "{name}");
        assert_eq!(waypoints("a.txt"), waypoints("c.txt"), "{name}");
    }
    let ran = sandbox.run(&["convert", "guide-square.txt", "-", "--to", "toml"]);
    assert_eq!(ran.code, Some(3), "the file is in another directory: {ran:?}");
    let ran = sandbox.run(&["convert", &plan("guide-square.txt"), "-", "--to", "toml"]).exits(0);
    assert!(ran.out.contains("[[waypoint]]"), "{}", ran.out);
    assert!(ran.err.contains("save"), "what is skipped is said: {}", ran.err);
}

#[test]
fn a_converted_plan_flies_as_the_original() {
    let sandbox = Sandbox::new();
    sandbox.run(&["convert", &plan("guide-square.txt"), "square.toml"]).exits(0);
    let (a, b) = (sandbox.fly(&[&plan("guide-square.txt")]), sandbox.fly(&["square.toml"]));
    let states = |flown: &crate::binary::support::Flown| flown.all("state").cloned().collect::<Vec<_>>();
    assert_eq!(states(&a), states(&b));
}

#[test]
fn help_version_completions_and_man() {
    let sandbox = Sandbox::new();
    let version = sandbox.run(&["--version"]).exits(0).out;
    assert_eq!(version.trim_end(), format!("betadeck {}", env!("CARGO_PKG_VERSION")));
    for arguments in [
        &["--help"][..],
        &["-h"],
        &["fly", "--help"],
        &["plan", "show", "--help"],
        &["convert", "-h"],
        &["help", "fly"],
    ] {
        let ran = sandbox.run(arguments).exits(0);
        assert!(ran.out.contains("Usage: betadeck") && ran.err.is_empty(), "{arguments:?}");
    }
    for (shell, part) in [("bash", "complete -F"), ("zsh", "#compdef"), ("fish", "complete -c betadeck")] {
        assert!(sandbox.run(&["completions", shell]).exits(0).out.contains(part), "{shell}");
    }
    let man = sandbox.run(&["man"]).exits(0).out;
    assert!(man.contains(".TH") && man.contains("betadeck"), "{}", &man[..200]);
    sandbox.run(&["completions", "cmd"]).exits(2);
    assert_eq!(sandbox.names(), Vec::<String>::new(), "none of them writes a file");
}

/// Writes a configuration file with these lines.
fn configured(sandbox: &Sandbox, lines: &str) {
    std::fs::create_dir_all(sandbox.path(".config/betadeck")).expect("a directory");
    sandbox.write(".config/betadeck/config.toml", lines);
}

#[test]
fn the_doctor_finds_what_is_wrong() {
    const ANY_PORT: &str = "ws-port = 0\ntcp-port = 0\nudp-ports = \"0,0,0,0\"\n";
    let sandbox = Sandbox::new();
    configured(&sandbox, ANY_PORT);
    let well = sandbox.run(&["doctor"]).exits(0).out;
    for part in [env!("CARGO_PKG_VERSION"), "(present)", "state directory", "terminal", "port TCP"] {
        assert!(well.contains(part), "no {part} in\n{well}");
    }
    assert!(!well.contains('✗'), "{well}");
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = taken.local_addr().expect("an address").port();
    configured(&sandbox, &ANY_PORT.replace("tcp-port = 0", &format!("tcp-port = {port}")));
    let busy = sandbox.run(&["doctor"]).exits(3).out;
    assert!(busy.contains(&format!("{port} is in use")) && busy.contains("--tcp-port"), "{busy}");
    configured(&sandbox, &format!("sede = 1\nrate = 3\n{ANY_PORT}"));
    let wrong = sandbox.run(&["doctor"]).exits(3).out;
    assert!(wrong.contains("did you mean seed?") && wrong.contains("2.5 ms"), "{wrong}");
    configured(&sandbox, "seed = ");
    assert!(sandbox.run(&["doctor"]).out.contains("config.toml: "), "a broken file is reported");
    assert_eq!(sandbox.names(), [".config"], "it writes nothing");
}

#[test]
fn options_come_from_the_environment_and_the_configuration_file_too() {
    let sandbox = Sandbox::new();
    let boot = |environment: &[(&str, &str)], arguments: &[&str]| -> (i64, i64) {
        let mut command = sandbox.command(&[&["fly", "land", "--json", "-"], arguments].concat());
        command.envs(environment.iter().copied());
        let output = assert_cmd::Command::from_std(command).output().expect("a flight");
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        let line: serde_json::Value =
            serde_json::from_str(text.lines().next().expect("a line")).expect("JSON");
        (line["seed"].as_i64().expect("a seed"), line["rate"].as_i64().expect("a rate"))
    };
    assert_eq!(boot(&[], &[]), (1, 1000));
    configured(&sandbox, "seed = 7\nrate = 500\n");
    assert_eq!(boot(&[], &[]), (7, 500));
    assert_eq!(boot(&[("BETADECK_SEED", "8")], &[]), (8, 500));
    assert_eq!(boot(&[("BETADECK_SEED", "8")], &["--seed", "9"]), (9, 500));
    configured(&sandbox, "sede = 7\n");
    // Commands that need no option ignore the mistake.
    sandbox.run(&["plan", "list"]).exits(0);
    sandbox.run(&["completions", "bash"]).exits(0);
    let ran = sandbox.run(&["fly", "land"]).exits(2);
    assert!(ran.err.contains("config.toml") && ran.err.contains("seed"), "{}", ran.err);
}

#[test]
fn the_configuration_file_is_written_shown_and_found() {
    let sandbox = Sandbox::new();
    let path = sandbox.run(&["config", "path"]).exits(0).out;
    assert!(path.trim_end().ends_with(".config/betadeck/config.toml"), "{path}");
    assert_eq!(sandbox.names(), Vec::<String>::new(), "nothing is written unasked");
    assert_eq!(sandbox.run(&["config", "init"]).exits(0).out, path);
    let written = sandbox.read(".config/betadeck/config.toml");
    assert!(written.contains("#\"flight.arm\" = \"a\"") && written.contains("#wind = "), "{written}");
    sandbox.run(&["fly", "land"]).exits(0);
    let again = sandbox.run(&["config", "init"]).exits(3);
    assert!(again.err.contains("--force"), "{}", again.err);

    configured(&sandbox, "seed = 7\n[keys]\n\"flight.arm\" = \"A\"\n");
    let shown = sandbox.run(&["config", "show"]).exits(0).out;
    let line = |name: &str| {
        let found =
            shown.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{name}\n{shown}"));
        found.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(line("seed ")[1], "7");
    assert!(line("seed ")[2].ends_with("config.toml:"));
    assert_eq!(line("units ")[1..], ["metric", "default"]);
    assert!(line("keys.flight.arm ")[2].ends_with("config.toml:3"));
    sandbox.run(&["config", "init", "--force"]).exits(0);
    assert_eq!(sandbox.read(".config/betadeck/config.toml"), written);
}

#[test]
fn wrong_keys_in_the_configuration_file_are_reported_with_their_lines() {
    let sandbox = Sandbox::new();
    configured(
        &sandbox,
        "[keys]\n\"flight.amr\" = \"b\"\n\"flight.arm\" = \"hyper-x\"\n\"sim.step\" = \"g\"\n",
    );
    let ran = sandbox.run(&["fly", "land"]).exits(2);
    let lines: Vec<&str> = ran.err.lines().collect();
    assert_eq!(lines.len(), 3, "{}", ran.err);
    for (line, part) in [
        (0, "config.toml:2: there is no action flight.amr; did you mean flight.arm?"),
        (1, "config.toml:3: \"hyper-x\" is no key"),
        (2, "config.toml:4: g means sim.step and flight.autopilot"),
    ] {
        assert!(lines[line].contains(part), "{}", ran.err);
    }
    assert!(sandbox.run(&["doctor"]).out.contains("flight.amr"), "the doctor tells it, too");
    sandbox.run(&["plan", "show", "land"]).exits(0);
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    for stream in ["out", "err"] {
        let sandbox = Sandbox::new();
        let mut command = sandbox.command(&["fly", "square", "--json", "-", "--samples", "100"]);
        let (out, err) =
            if stream == "out" { (Stdio::piped(), Stdio::null()) } else { (Stdio::null(), Stdio::piped()) };
        let mut child =
            command.stdin(Stdio::null()).stdout(out).stderr(err).spawn().expect("the executable runs");
        if let Some(out) = child.stdout.take() {
            let mut reader = BufReader::new(out);
            let mut line = String::new();
            reader.read_line(&mut line).expect("a line");
            assert!(line.contains("\"boot\""), "{line}");
        }
        drop(child.stderr.take());
        assert_eq!(child.wait().expect("an end").code(), Some(0), "standard {stream}put closed");
    }
    // A long answer of a small command.
    let sandbox = Sandbox::new();
    let mut command = sandbox.command(&["man"]);
    let mut child = command.stdout(Stdio::piped()).spawn().expect("the executable runs");
    drop(child.stdout.take());
    assert_eq!(child.wait().expect("an end").code(), Some(0));
}

#[test]
fn a_full_disk_is_exit_code_3() {
    if !std::path::Path::new("/dev/full").exists() {
        return;
    }
    let sandbox = Sandbox::new();
    for option in
        ["--json", "--csv", "--gpx", "--kml", "--geojson", "--record", "--blackbox", "--report", "--markdown"]
    {
        let ran = sandbox.run(&["fly", "land", "--timeout=12", option, "/dev/full"]).exits(3);
        assert!(ran.err.contains("cannot write /dev/full: No space left"), "{option}: {}", ran.err);
    }
    let ran = sandbox.run(&["serve", "--no-ports", "--fresh", "--json", "/dev/full"]).exits(3);
    assert!(ran.err.contains("cannot write /dev/full: No space left"), "{}", ran.err);
}

#[test]
fn a_configuration_file_that_is_none_is_refused_and_nothing_is_stored() {
    let sandbox = Sandbox::new();
    sandbox.write("large.txt", &"#".repeat((4 << 20) + 1));
    for (file, said) in [
        ("missing.txt", "[SITL] Config file not found: missing.txt"),
        ("large.txt", "[SITL] Config file not used: large.txt is larger than 4 MiB"),
        ("/dev/zero", "[SITL] Config file not used: /dev/zero is a device or a pipe, not a file"),
    ] {
        let ran = sandbox.run(&["sitl", "--config", file]).exits(1);
        assert!(ran.err.contains(said), "{}", ran.err);
    }
    assert!(!sandbox.names().contains(&"eeprom.bin".to_owned()));
}

#[test]
fn sitl_flies_by_the_profile_of_its_options_and_keeps_it() {
    let sandbox = Sandbox::new();
    sandbox.write("ask.txt", "get ap_profile\n");
    let ran = sandbox.run(&["sitl", "--config", "ask.txt"]).exits(0);
    assert!(ran.out.contains("ap_profile = GUIDE"), "{}", ran.out);
    for profile in [&["--profile", "master"][..], &[]] {
        let ran = sandbox.run(&[&["sitl", "--config", "ask.txt"], profile].concat()).exits(0);
        assert!(ran.out.contains("ap_profile = MASTER"), "{profile:?}: {}", ran.out);
    }
}
