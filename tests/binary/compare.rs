//! `compare`: the reports before anything flies, and the treatment of existing files.

use std::net::{TcpListener, UdpSocket};

use crate::support::{PROGRAM, Ran, Sandbox};

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
    ] {
        let ran = sandbox.run(&[&["compare", "square"], options].concat()).exits(2);
        assert!(ran.err.contains(part), "{options:?}: {}", ran.err);
    }
}
