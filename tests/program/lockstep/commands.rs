//! The other commands on copies of the flying stand-in: `compare`, `check --bisect`, `campaign`, `open`, and the screen.

use super::flying::{FLYING, WORSE};
use super::lab::{Bench, text};
use crate::binary::pty::Terminal;

/// 20 m north, and down at 1 m/s.
const PLAN: &str = r#"
name = "north"
settings = ["ap_landing_descent_rate = 100"]
[home]
lat_deg = 40.4635
lon_deg = -79.5182
alt_amsl_m = 300
[[waypoint]]
type = "LAND"
lat_deg = 40.46368
lon_deg = -79.5182
alt_m = 4
"#;

fn bench() -> Bench {
    let bench = Bench::new();
    std::fs::write(bench.path("north.toml"), PLAN).unwrap();
    bench
}

#[test]
fn compare_shows_that_one_build_comes_down_faster() {
    let worse = format!("./{WORSE}.elf");
    let bench = bench();
    let compare = |other: &str| {
        text(&bench.run(&[
            "compare",
            "north.toml",
            "--seeds",
            "1..2",
            "--firmware",
            "./old.elf",
            "--firmware",
            other,
        ]))
    };
    let said = compare(&worse);
    let time = said.lines().find(|line| line.starts_with("time to the end")).expect(&said);
    assert!(time.trim_end().ends_with('*'), "{said}");
    let same = compare("./old.elf");
    assert!(!same.lines().any(|line| line.trim_end().ends_with('*')), "{same}");
}

#[test]
fn the_exit_code_for_bisect_says_that_a_build_is_good_or_bad_or_cannot_be_flown() {
    let bench = bench();
    for (build, code) in [("./old.elf", 0), (&format!("./{WORSE}.elf")[..], 1), ("./missing.elf", 125)] {
        let output = bench.run(&["check", "hop.toml", "--bisect", "--firmware", build]);
        assert_eq!(output.status.code(), Some(code), "{build}: {}", text(&output));
    }
}

#[test]
fn a_flight_of_a_campaign_opens_and_is_flown_on_by_another_process() {
    let bench = bench();
    let output = bench.run(&[
        "campaign",
        "north.toml",
        "--flights",
        "2",
        "--vary",
        "mass_pct=+-3",
        "--out",
        "run.jsonl",
        "--firmware",
        "./old.elf",
    ]);
    assert!(output.status.success(), "{}", text(&output));
    let flight = format!("{}:2", bench.path("run.jsonl").display());
    let mut terminal = Terminal::betadeck(160, 40, &["open", &flight, "--yes", "--at", "8"]);
    terminal.until_shown("REWOUND");
    // The end of the flight, and back to the instant.
    terminal.send("e");
    let landed = landing(&mut terminal);
    terminal.send("<");
    terminal.until_shown("REWOUND");
    terminal.send("<");
    terminal.until("the flight", |terminal| terminal.screen().contains("◆ APPROACHING WP0"));
    terminal.send("b");
    terminal.until("the new branch", |terminal| !terminal.screen().contains("REWOUND"));
    terminal.send(":speed 20\r");
    // The screen asks the firmware for more than `campaign` does.
    let again = landing(&mut terminal);
    assert!((again - landed).abs() < 0.3, "{landed} s, {again} s");
}

/// Waits for the line of the landing in the log, and returns its time, s.
fn landing(terminal: &mut Terminal) -> f64 {
    terminal.until("the landing in the log", |terminal| landing_time(&terminal.screen()).is_some());
    landing_time(&terminal.screen()).expect("the screen is as before")
}

/// Returns the time of the landing, s, if the log shows it. Other panels and a screen that is half drawn have no time.
fn landing_time(screen: &str) -> Option<f64> {
    screen.lines().find_map(|line| {
        let (before, _) = line.split_once("Disarmed: landed")?;
        let (minutes, seconds) = before.trim_start_matches('│').split_whitespace().next()?.split_once(':')?;
        Some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
    })
}

/// Returns the screen over the flying stand-in.
fn live(bench: &Bench) -> Terminal {
    let (plan, build) = (bench.path("north.toml"), bench.path("old.elf"));
    let mut terminal = Terminal::betadeck(
        160,
        40,
        &[
            plan.to_str().unwrap(),
            "--firmware",
            build.to_str().unwrap(),
            "--firmware-arg",
            FLYING,
            "--fresh",
            "--no-ports",
        ],
    );
    terminal.until_shown("GPS fix with 12 satellites");
    terminal
}

#[test]
fn the_live_flight_of_an_executable_is_flown_on_from_an_earlier_instant_and_again_from_there() {
    let bench = bench();
    let mut terminal = live(&bench);
    terminal.send(":speed 20\r");
    terminal.send("F");
    let landed = landing(&mut terminal);
    for _ in 0..2 {
        terminal.send("{");
        terminal.until_shown("REWOUND");
        // State by state back to the approach.
        while !terminal.screen().contains("◆ APPROACHING WP0") {
            let shown = terminal.row(1);
            terminal.send("{");
            terminal.until("another state", |terminal| terminal.row(1) != shown);
        }
        terminal.send("b");
        terminal.until("the new branch", |terminal| !terminal.screen().contains("REWOUND"));
        // The screen asks the firmware at other steps than before.
        let again = landing(&mut terminal);
        assert!((again - landed).abs() < 0.3, "{landed} s, {again} s");
    }
}

#[test]
fn the_live_flight_of_an_executable_is_looked_ahead_with_and_without_a_fault() {
    let bench = bench();
    let mut terminal = live(&bench);
    terminal.send(":what-if rx-loss\r");
    terminal.until_shown("so there is no flight to look ahead to");
    terminal.send("F");
    terminal.until_shown("◆ APPROACHING WP0");
    terminal.send(":sim.pause\r");
    terminal.send(":what-if mag-bias\r");
    terminal.until_shown("gets no magnetometer data");
    terminal.send(":what-if wind\r");
    terminal.until_shown("What if wind +8 m/s: ");
    terminal.send("L");
    // Its line on the map ends with "COMPLETE in 0:21, 98 % left".
    let ahead = |screen: &str| time_after(screen, "look-ahead: COMPLETE in ");
    terminal.until("the look-ahead", |terminal| ahead(&terminal.screen()).is_some());
    let left = ahead(&terminal.screen()).expect("the screen is as before");
    let now = time_after(&terminal.screen(), "m left ").expect("the time of the flight");
    terminal.send("L:sim.pause\r:speed 20\r");
    let landed = landing(&mut terminal);
    assert!((now + left - landed).abs() < 2.0, "{left} s after {now} s, landed at {landed} s");
}

/// Returns the time in minutes and seconds behind these words, s.
fn time_after(screen: &str, words: &str) -> Option<f64> {
    let (_, rest) = screen.split_once(words)?;
    let time =
        rest.trim_start().split(|letter: char| !(letter.is_ascii_digit() || letter == ':' || letter == '.'));
    let (minutes, seconds) = time.into_iter().next()?.split_once(':')?;
    Some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
}
