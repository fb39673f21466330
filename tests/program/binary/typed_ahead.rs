//! Keys typed ahead, as over a slow line: many of them arrive in one piece and act in order on what they were meant for.

use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;

#[test]
fn keys_that_arrive_in_one_piece_act_in_order_on_popups_fields_and_panels() {
    let sandbox = Sandbox::new();
    let state = sandbox.path("state").display().to_string();
    let mut terminal = Terminal::betadeck(120, 40, &["--no-ports", "--state-dir", &state]);
    terminal.until_shown("DISARMED");
    // Two command lines, a waypoint added to the plan, the settings searched, the panels arranged, a layout saved from
    // there and another one shown, and the search of the log found by its letters and used. Each letter is a key of its own
    // elsewhere.
    terminal.send(concat!(
        ":wind 5@270\r",
        ":speed 4\r",
        "2i",
        "9/fence\r",
        "\x0csw",
        "mine\r",
        ":layout x\x15layout debugging\r",
        "\x10units\x15show log\rGPS\r",
    ));
    let kept = |name: &str| std::fs::read_to_string(sandbox.path(name)).unwrap_or_default();
    terminal.until("the search of the log, at four times real time", |terminal| {
        terminal.screen().contains("▸8 Log — /GPS") && terminal.row(1).contains("4×")
    });
    terminal.until("the rest", |terminal| {
        let screen = terminal.screen();
        kept("state/layouts.jsonl").contains("\"mine\"")
            && screen.contains("7 World")
            && screen.contains("270°")
    });
    terminal.send("2");
    terminal.until("the plan with one more waypoint", |terminal| terminal.screen().contains("  4  LAND"));
    terminal.send("9");
    terminal.until("the searched settings", |terminal| terminal.screen().contains("ap_max_distance_from"));
}

const PLAN: &str = "waypoint insert 0 40.4640000 -79.5175000 1000 0 FLYOVER 0 NONE\nwaypoint insert 1 40.4636 -79.5182 1000 0 LAND 0 NONE\n";

#[test]
fn keys_typed_ahead_of_a_listing_choose_the_file_there_and_edit_the_plan_that_it_opens() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("plans")).unwrap();
    sandbox.write("plans/a.txt", PLAN);
    sandbox.write("plans/b.txt", PLAN);
    let plan = sandbox.path("plans/a.txt").display().to_string();
    let mut terminal = Terminal::betadeck(120, 40, &["--no-ports", "--fresh", &plan]);
    terminal.until_shown("Plan — a.txt");
    // Opens the other plan of that directory, deletes its first waypoint, and saves it there under a third name.
    terminal.send("2ob.txt\rdSc.txt\r");
    terminal.until_shown("2/2 — c.txt");
    let saved = sandbox.read("plans/c.txt");
    assert!(saved.contains("LAND") && !saved.contains("FLYOVER"), "{saved}");
    assert_eq!(sandbox.read("plans/a.txt"), PLAN);
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn keys_typed_ahead_of_a_download_edit_the_plan_of_the_craft() {
    let sandbox = Sandbox::new();
    sandbox.write("a.txt", PLAN);
    let plan = sandbox.path("a.txt").display().to_string();
    let mut terminal = Terminal::betadeck(120, 40, &["--no-ports", "--fresh", &plan]);
    terminal.until_shown("Plan — a.txt");
    // The plan gets a third waypoint and goes to the craft. One of the three is deleted, the plan of the craft comes back,
    // and one of its waypoints is deleted.
    terminal.send("2iUdDd");
    terminal.until_shown("Downloaded 3 waypoints");
    terminal.until_shown("1 [LAND]");
    terminal.send("qd");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn keys_typed_ahead_of_the_settings_and_of_an_earlier_instant_act_there() {
    let mut terminal = Terminal::betadeck(120, 40, &["--no-ports", "--fresh"]);
    terminal.until_shown("DISARMED");
    // The first reading of the settings, the search, and two changes in place.
    terminal.send("9/fence\r++");
    terminal.until_shown("200            m");
    terminal.send("F]]]");
    terminal.until("the mission", |terminal| terminal.screen().contains("◆ APPROACHING"));
    // Back by one event and on from there: without the earlier instant there is nothing to fly on from.
    terminal.send(",b");
    terminal.until_shown("Flying on from here");
    terminal.until("the flight", |terminal| !terminal.screen().contains("REWOUND"));
    terminal.send("qy");
    assert_eq!(terminal.end(), 0);
}
