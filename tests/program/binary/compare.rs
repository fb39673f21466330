//! `compare`: the reports before anything flies, and the treatment of existing files.

use std::net::{TcpListener, UdpSocket};

use crate::binary::support::{PROGRAM, Ran, Sandbox};

/// The content of the files that an earlier comparison left.
const EARLIER: &str = "of an earlier comparison";

/// A plan that flies a short way north and lands there, low and near.
const HOP: &str = "\
[home]
lat_deg = 40.4635
lon_deg = -79.5182
[[waypoint]]
type = \"LAND\"
lat_deg = 40.4635900
lon_deg = -79.5182
alt_m = 4
";
/// Options that make the flight short.
const QUICKLY: [&str; 3] = ["--takeoff=4", "--rate=400", "--noise=none"];

/// Returns a home with the files of an earlier comparison.
fn with_earlier_files() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.write("tracks.svg", EARLIER);
    sandbox.write("differences.json", EARLIER);
    sandbox.write("hop.toml", HOP);
    sandbox
}

/// Compares the embedded firmware with an executable that finds its port in use when its turn comes.
fn compare_in_vain(sandbox: &Sandbox, plan: &str) -> Ran {
    let taken = TcpListener::bind("127.0.0.1:0").expect("a port");
    let tcp = format!("--tcp-port={}", taken.local_addr().expect("bound").port());
    let udp: [UdpSocket; 4] = std::array::from_fn(|_| UdpSocket::bind("127.0.0.1:0").expect("a port"));
    let udp = udp.map(|socket| socket.local_addr().expect("bound").port().to_string()).join(",");
    let udp = format!("--udp-ports={udp}");
    let outputs = ["--svg", "tracks.svg", "--json", "differences.json"];
    sandbox.run(
        &[&["compare", plan, "--clock=real", "--firmware", PROGRAM, &tcp, &udp][..], &outputs, &QUICKLY]
            .concat(),
    )
}

#[test]
fn a_plan_that_cannot_be_flown_leaves_the_files_of_an_earlier_comparison_alone() {
    let sandbox = with_earlier_files();
    sandbox.write("broken.toml", "name = ");
    for (plan, code) in [("broken.toml", 2), ("missing.toml", 3)] {
        compare_in_vain(&sandbox, plan).exits(code);
        assert_eq!(
            (sandbox.read("tracks.svg"), sandbox.read("differences.json")),
            (EARLIER.into(), EARLIER.into())
        );
    }
}

#[test]
fn what_was_flown_before_an_error_is_reported_and_no_file_is_touched() {
    let sandbox = with_earlier_files();
    let ran = compare_in_vain(&sandbox, "hop.toml").exits(3);
    for part in
        ["Not everything was flown", "A: embedded, one flight", "B: betadeck, not flown", "--tcp-port"]
    {
        assert!(ran.err.contains(part), "{part} in\n{}", ran.err);
    }
    assert_eq!((ran.out.as_str(), sandbox.read("tracks.svg").as_str()), ("", EARLIER));
    assert_eq!(sandbox.read("differences.json"), EARLIER);
}

#[test]
fn a_comparison_replaces_files_as_a_whole_and_writes_to_pipes() {
    let sandbox = with_earlier_files();
    let both = [
        "compare",
        "hop.toml",
        "--firmware",
        "embedded",
        "--firmware",
        "embedded",
        "--firmware-arg=-x",
        "--yes",
    ];
    let ran = sandbox
        .run(&[&both[..], &["--svg", "tracks.svg", "--json", "/dev/stdout"], &QUICKLY].concat())
        .exits(0);
    assert!(
        ran.err.contains("--firmware-arg, --yes have no effect: the firmware is embedded"),
        "{}",
        ran.err
    );
    assert!(ran.out.contains("B − A") && ran.out.contains("\"measures\":["), "{}", ran.out);
    assert!(sandbox.read("tracks.svg").trim_end().ends_with("</svg>"));
    let left = sandbox.names().into_iter().filter(|name| name.starts_with("tracks.svg")).count();
    assert_eq!(left, 1, "{:?}", sandbox.names());
}

#[test]
fn several_seeds_give_the_same_comparison_on_any_number_of_threads() {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", HOP);
    let both = ["compare", "hop.toml", "--firmware", "embedded", "--firmware", "embedded", "--json", "-"];
    let run = |seeds: &str, jobs: &str| {
        let options = ["--takeoff=4", "--rate=400", "--gust=2", "--seeds", seeds, "--jobs", jobs];
        sandbox.run(&[&both[..], &options].concat()).exits(0)
    };
    let (one, four) = (run("3..5", "1"), run("3..5", "4"));
    assert_eq!((&one.out, &one.err), (&four.out, &four.err));
    let flown: Vec<&str> =
        one.err.lines().filter_map(|line| line.split_once(": complete").map(|(flight, _)| flight)).collect();
    let expected: Vec<String> =
        (0..2).flat_map(|_| (3..6).map(|seed| format!("embedded, seed {seed}"))).collect();
    assert_eq!(flown, expected);

    let json: serde_json::Value = serde_json::from_str(&one.out).expect("JSON");
    assert_eq!(json["conditions"], "calm, gusts 2 m/s, seeds 3..5");
    let flights = json["firmware"][1]["flights"].as_array().expect("flights");
    assert_eq!(flights.iter().map(|flight| flight["seed"].as_u64()).collect::<Vec<_>>(), [3, 4, 5].map(Some));
    let flown_s =
        json["measures"].as_array().expect("measures").iter().find(|line| line["measure"] == "flown_s");
    let flown_s = flown_s.expect("the duration");
    let number = |key: &str| flown_s["a"][key].as_f64().expect("a number");
    assert!(number("min") < number("median") && number("median") < number("max"), "{flown_s}");
    assert_eq!((&flown_s["difference"], &flown_s["beyond_spread"]), (&0.0.into(), &false.into()));
    // One seed gives no spread.
    let alone: serde_json::Value = serde_json::from_str(&run("3..3", "2").out).expect("JSON");
    assert_eq!(alone["measures"][0]["beyond_spread"], serde_json::Value::Null);
}

#[test]
fn without_randomness_one_seed_is_flown_and_a_notice_says_so() {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", HOP);
    let both = ["compare", "hop.toml", "--firmware", "embedded", "--firmware", "embedded", "--seeds=2..9"];
    let ran = sandbox.run(&[&both[..], &QUICKLY].concat()).exits(0);
    assert!(ran.err.contains("Only seed 2 is flown:") && !ran.err.contains("seed 3"), "{}", ran.err);
    assert!(ran.out.contains("A: embedded, one flight"), "{}", ran.out);
}

#[test]
fn in_the_folder_of_the_launcher_no_option_names_the_firmware() {
    let sandbox = Sandbox::new();
    sandbox.run(&["compare", "square"]).exits(2);
    sandbox.write("config.txt", "[Betaloop]\nBetaflightElf=./none.elf\n");
    for arguments in [&["compare", "square"][..], &["fly", "square"], &["check", "guide-1"]] {
        let ran = sandbox.run(arguments).exits(3);
        let reported = ran.err.contains("./none.elf: there is no such file")
            && ran.err.contains("comes from config.txt");
        assert!(reported, "{arguments:?}: {}", ran.err);
    }
}

#[test]
fn the_firmware_of_the_configuration_file_and_the_environment_flies_in_every_command() {
    let sandbox = Sandbox::new();
    std::fs::create_dir_all(sandbox.path(".config/betadeck")).expect("a directory");
    sandbox.write(".config/betadeck/config.toml", "firmware = \"./of-file.elf\"\n");
    for arguments in [&["compare", "square"][..], &["fly", "square"], &["check", "guide-1"]] {
        let ran = sandbox.run(arguments).exits(3);
        assert!(ran.err.contains("./of-file.elf: there is no such file"), "{arguments:?}: {}", ran.err);
        let mut command = sandbox.command(arguments);
        let output = command.env("BETADECK_FIRMWARE", "./of-environment.elf").output().expect("a run");
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(err.contains("./of-environment.elf: there is no such file"), "{arguments:?}: {err}");
    }
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let sandbox = Sandbox::new();
    for (options, part) in [
        (&["--firmware", "attach", "--repeat", "3"][..], "write --repeat 1"),
        (&["--firmware", "attach", "--firmware", PROGRAM], "would need the same ports"),
        (&["--firmware", PROGRAM, "--state-dir", "."], "each flight starts from defaults"),
        (&["--firmware", "embedded"], "name the firmware to compare with"),
        (&["--firmware", "attach", "--seeds", "1..3"], "write --repeat 1"),
        (&["--firmware", PROGRAM, "--clock=real", "--seeds", "1..3"], "use --repeat N"),
        (&["--firmware=embedded", "--firmware=embedded", "--seeds=1..6000"], "10000 are allowed"),
    ] {
        let ran = sandbox.run(&[&["compare", "square"], options].concat()).exits(2);
        assert!(ran.err.contains(part), "{options:?}: {}", ran.err);
    }
}

/// Options of a short flight in wind.
const IN_WIND: [&str; 2] = ["--wind=3@250", "--rate=400"];

/// Flies a short flight and writes its log.
fn log_of_hop(sandbox: &Sandbox, log: &str, options: &[&str]) {
    sandbox.write("hop.toml", HOP);
    let fly = ["fly", "hop.toml", "--takeoff=4", "--blackbox", log];
    sandbox.run(&[&fly[..], &IN_WIND, options].concat()).exits(0);
}

#[test]
fn a_log_is_compared_with_the_same_flight_in_the_simulation() {
    let sandbox = Sandbox::new();
    log_of_hop(&sandbox, "hop.bbl", &["--set", "ap_max_velocity=600"]);
    let outputs = ["--json", "-", "--svg", "tracks.svg", "--report", "page.html", "--record", "again.flight"];
    let arguments = [&["compare", "hop.toml", "--log", "hop.bbl"][..], &outputs, &IN_WIND].concat();
    let ran = sandbox.run(&arguments).exits(0);
    assert!(ran.err.contains("settings of its header apply"), "{}", ran.err);
    let compared: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON");
    let [log, simulated] = [0, 1].map(|side| &compared["firmware"][side]);
    assert_eq!((log["name"].as_str(), log["is_log"].as_bool()), (Some("hop.bbl"), Some(true)));
    assert_eq!(simulated["flights"][0]["result"].as_str(), Some("complete"), "{}", ran.out);
    let apart_m = compared["tracks_apart_rms_m"]["between"]["median"].as_f64().expect("a distance");
    assert!(apart_m < 2.0, "{apart_m}");
    assert!(sandbox.read("tracks.svg").contains("hop.bbl"));
    assert!(sandbox.read("page.html").contains("A log and its simulation"));
    // The recording shows both on the screen.
    let shown = sandbox.run(&["replay", "hop.bbl", "again.flight", "--plain"]);
    assert!(shown.out.contains("again.flight is aligned at the engagement"), "{}\n{}", shown.out, shown.err);
    let listed = sandbox.run(&["replay", "again.flight", "--csv", "-"]).exits(0);
    assert!(listed.out.lines().count() > 100, "{}", listed.out);
}

#[test]
fn the_log_of_another_place_or_without_what_a_comparison_needs_is_refused_in_a_sentence() {
    let sandbox = Sandbox::new();
    log_of_hop(&sandbox, "whole.bbl", &[]);
    log_of_hop(&sandbox, "sticks.bbl", &["--set", "blackbox_disable_rc=ON"]);
    log_of_hop(&sandbox, "places.bbl", &["--set", "blackbox_disable_gps=ON"]);
    sandbox.write("far.toml", &HOP.replace("40.4635", "48.4635"));
    sandbox.write("notes.txt", "not a log");
    for (plan, log, part) in [
        ("hop.toml", "notes.txt", "notes.txt has no blackbox log with frames"),
        ("hop.toml", "sticks.bbl", "sticks.bbl: the log has no rcCommand"),
        ("hop.toml", "places.bbl", "places.bbl: the log has no GPS"),
        ("far.toml", "whole.bbl", "whole.bbl was flown 891 km away from the plan far: allowed are 50 km"),
    ] {
        let ran = sandbox.run(&["compare", plan, "--log", log]).exits(2);
        assert!(ran.err.contains(part) && ran.out.is_empty(), "{log}: {}", ran.err);
    }
    sandbox.run(&["compare", "hop.toml", "--log", "whole.bbl", "--record", "whole.bbl"]).exits(2);
    sandbox.run(&["compare", "hop.toml", "--record", "again.flight"]).exits(2);
}

#[test]
fn a_log_that_was_cut_is_compared_as_far_as_it_goes() {
    let sandbox = Sandbox::new();
    log_of_hop(&sandbox, "hop.bbl", &[]);
    let whole = std::fs::read(sandbox.path("hop.bbl")).expect("a log");
    std::fs::write(sandbox.path("cut.bbl"), &whole[..whole.len() / 2]).expect("a file");
    let ran = sandbox.run(&[&["compare", "hop.toml", "--log", "cut.bbl"][..], &IN_WIND].concat()).exits(0);
    assert!(ran.err.contains("The log was cut: it has no end"), "{}", ran.err);
    assert!(ran.out.contains("B: interrupted: the log ends"), "{}", ran.out);
}
