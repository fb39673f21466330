//! The library of recorded flights on the screen and without one.

use crate::binary::plain::Dialogue;
use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;

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

/// Returns a home whose library has two flights and a damaged file.
fn with_library() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", HOP);
    std::fs::create_dir_all(sandbox.path("state/flights")).expect("a folder");
    for (name, wind) in [("calm", "0@0"), ("windy", "3@250")] {
        sandbox.write(&format!("{name}.toml"), HOP);
        let (plan, file) = (format!("{name}.toml"), format!("state/flights/{name}.flight"));
        let fly = ["fly", &plan, "--takeoff=4", "--rate=400", "--wind", wind, "--record", &file];
        sandbox.run(&fly).exits(0);
    }
    sandbox.write("state/flights/damaged.flight", "GPS");
    sandbox
}

#[test]
fn a_flight_of_the_library_is_shown_compared_and_deleted_on_the_screen() {
    let state = "--state-dir=state";
    let mut terminal =
        Terminal::start_in(with_library(), 80, 24, crate::binary::support::PROGRAM, &["--no-ports", state]);
    terminal.until_shown("DISARMED");
    // A flight on this screen, by keys typed ahead of the list, and back to the list.
    terminal.send("\u{6}windy\r>>");
    terminal.until_shown("REPLAY");
    terminal.send("q");
    // The keys typed ahead of the replay are not in the search field.
    terminal.until_shown("Recorded flights — 1 of 3");
    // Two of them beside each other.
    terminal.send("\u{7f}\u{7f}\u{7f}\u{7f}\u{7f}");
    terminal.until_shown("Recorded flights — 3");
    assert!(terminal.screen().contains("unreadable"), "{}", terminal.screen());
    terminal.send("\t\u{1b}[B\t");
    terminal.until_shown("compare A and B");
    terminal.send("\r");
    terminal.until_shown("aligned at the engagement");
    terminal.send("q");
    terminal.until_shown("compare A and B");
    // The damaged file goes.
    terminal.send("unread\u{1b}[3~");
    terminal.until_shown("Delete the recording damaged.flight?");
    terminal.send("y");
    terminal.until_shown("damaged.flight is deleted.");
    assert!(!terminal.home().path("state/flights/damaged.flight").exists());
    assert!(terminal.home().path("state/flights/calm.flight").exists());
    terminal.send("\u{1b}");
    terminal.until("the list is closed", |terminal| !terminal.screen().contains("Recorded flights"));
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn the_library_is_listed_and_a_flight_deleted_without_a_screen() {
    let sandbox = with_library();
    let mut plain = Dialogue::start(&sandbox, &["--plain", "--no-ports", "--state-dir=state"]);
    plain.say("app.flights");
    let heard = plain.hear("`delete N` deletes one").join("\n");
    assert!(heard.contains("Recorded flights, the newest first:") && heard.contains("windy"), "{heard}");
    assert!(heard.contains("3 damaged.flight  unreadable: it is not a recording"), "{heard}");
    plain.say("1");
    plain.hear("On a screen: betadeck replay ");
    plain.say("again 2");
    plain.hear("On a screen: betadeck open ");
    plain.say("compare 1 2");
    plain.hear(".flight");
    plain.say("delete 9");
    plain.hear("A number shows a flight");
    plain.say("delete 3");
    plain.hear("Delete the recording damaged.flight? y yes, n no.");
    plain.say("y");
    plain.hear("damaged.flight is deleted.");
    plain.say("");
    plain.say("quit");
    assert_eq!(plain.end(), Some(0));
    assert!(!sandbox.path("state/flights/damaged.flight").exists());
}
