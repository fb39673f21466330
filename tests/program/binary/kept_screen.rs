//! The screen that comes back: after a kill, after a quit, and not with `--fresh-screen`.

use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;

const PLAN: &str = "waypoint insert 0 40.4640000 -79.5175000 1000 0 FLYOVER 0 NONE\nwaypoint insert 1 40.4636 -79.5182 1000 0 LAND 0 NONE\n";

fn is_zoomed_on_graphs(terminal: &Terminal) -> bool {
    let screen = terminal.screen();
    screen.contains("▸6 Graphs") && !screen.contains("┌3 State")
}

#[test]
fn the_screen_comes_back_as_it_was_left() {
    let sandbox = Sandbox::new();
    sandbox.write("mine.txt", PLAN);
    let plan = sandbox.path("mine.txt").display().to_string();
    let state = sandbox.path("state").display().to_string();
    let arguments = ["--no-ports", "--state-dir", &state];
    let mut terminal = Terminal::betadeck(120, 40, &[&[plan.as_str()], &arguments[..]].concat());
    terminal.until_shown("DISARMED");
    terminal.send("6z");
    terminal.until("zoomed graphs", is_zoomed_on_graphs);
    let file = sandbox.path("state/screen.json");
    terminal.until("the screen is kept", |_| {
        let kept = std::fs::read_to_string(&file).unwrap_or_default();
        ["\"Graphs\"", "mine.txt"].iter().all(|part| kept.contains(part))
    });
    terminal.signal("KILL");
    terminal.end();

    let mut terminal = Terminal::betadeck(120, 40, &arguments);
    terminal.until("the zoomed graphs are back", is_zoomed_on_graphs);
    terminal.send("z2");
    terminal.until_shown("Plan — mine.txt");
    terminal.send("q");
    assert_eq!(terminal.end(), 0);

    let mut terminal = Terminal::betadeck(120, 40, &arguments);
    terminal.until("the plan has the focus after a quit, too", |terminal| {
        terminal.screen().contains("▸2 Plan — mine.txt")
    });
    terminal.send("q");
    assert_eq!(terminal.end(), 0);

    let mut terminal = Terminal::betadeck(120, 40, &[&arguments[..], &["--fresh-screen"]].concat());
    terminal.until("the demo plan on the default screen", |terminal| {
        let screen = terminal.screen();
        screen.contains("▸1 Map") && screen.contains("Plan — square")
    });
    assert!(!terminal.screen().contains("As you left"), "{}", terminal.screen());
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn a_screen_that_is_damaged_or_of_a_later_version_does_not_stop_the_start_and_is_not_lost() {
    let sandbox = Sandbox::new();
    let state = sandbox.path("state").display().to_string();
    let arguments = ["--no-ports", "--state-dir", &state];
    let later = r#"{"version": 99, "focus": {"panels": ["Map"]}}"#;
    std::fs::create_dir(sandbox.path("state")).unwrap();
    for (text, sentence, kept) in [
        ("{ \"focus\": \"Gra", "is damaged. It is kept as", "state/screen.bad"),
        (later, "was written by a later version of betadeck.", "state/screen.json"),
    ] {
        sandbox.write("state/screen.json", text);
        let mut terminal = Terminal::betadeck(200, 60, &arguments);
        terminal.until("the default screen", |terminal| terminal.screen().contains("▸1 Map"));
        terminal.until("the reason", |terminal| {
            // The first panel of each row: the log, whose lines are wrapped.
            let rows = terminal.screen();
            let first: Vec<&str> = rows.lines().filter_map(|row| row.split('│').nth(1)).collect();
            let shown = first.join(" ").split_whitespace().collect::<Vec<_>>().join(" ");
            shown.contains("The screen starts clean") && shown.contains(sentence)
        });
        terminal.send("6q");
        assert_eq!(terminal.end(), 0);
        assert_eq!(std::fs::read_to_string(sandbox.path(kept)).unwrap(), text);
    }
}

#[test]
fn panels_are_resized_by_keys_and_by_the_mouse_and_a_saved_layout_comes_back() {
    let sandbox = Sandbox::new();
    let state = sandbox.path("state").display().to_string();
    let arguments = ["--no-ports", "--state-dir", &state];
    // The column after the map, whose frame is at the left.
    let edge = |terminal: &Terminal| terminal.row(2).chars().position(|c| c == '┐');
    let mut terminal = Terminal::betadeck(80, 24, &arguments);
    terminal.until("the frame of the map", |terminal| edge(terminal).is_some());
    let before = edge(&terminal).expect("the frame of the map");
    terminal.send("\x0c\x1b[D\x1b[D");
    terminal.until("a narrower map", |terminal| edge(terminal) == Some(before - 4));
    terminal.send("\r:layout save mine\r");
    terminal.until_shown("`:layout mine` shows this layout.");
    // Presses on the border, drags it twelve columns to the left, and lets go.
    let (column, row) = (before - 4 + 1, 8);
    terminal.send(&format!(
        "\x1b[<0;{column};{row}M\x1b[<32;{};{row}M\x1b[<0;{};{row}m",
        column - 12,
        column - 12
    ));
    terminal.until("an even narrower map", |terminal| edge(terminal) < Some(before - 12));
    let dragged = edge(&terminal);
    let file = sandbox.path("state/screen.json");
    terminal.until("the sizes are kept", |_| {
        let kept = std::fs::read_to_string(&file).unwrap_or_default();
        let kept: serde_json::Value = serde_json::from_str(&kept).unwrap_or_default();
        kept["arrangement"]["sizes"][0].as_u64().is_some_and(|share| share > 400)
    });
    terminal.signal("KILL");
    terminal.end();

    let mut terminal = Terminal::betadeck(80, 24, &arguments);
    terminal.until("the map as it was dragged", |terminal| edge(terminal) == dragged);
    terminal.send("q");
    assert_eq!(terminal.end(), 0);

    let mut terminal = Terminal::betadeck(80, 24, &[&arguments[..], &["--fresh-screen"]].concat());
    terminal.until("the usual map", |terminal| edge(terminal) == Some(before));
    terminal.send(":layout mine\r");
    terminal.until("the saved one", |terminal| edge(terminal) == Some(before - 4));
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn edits_of_a_plan_without_a_file_are_shown_first_after_a_restart() {
    let sandbox = Sandbox::new();
    let state = sandbox.path("state").display().to_string();
    let arguments = ["--no-ports", "--state-dir", &state];
    let mut terminal = Terminal::betadeck(120, 40, &arguments);
    terminal.until_shown("DISARMED");
    terminal.send("2\x1b[C\x1b[C\x1b[C+");
    terminal.until_shown("[51.0]");
    let file = sandbox.path("state/screen.json");
    terminal.until("the screen is kept", |_| {
        std::fs::read_to_string(&file).unwrap_or_default().contains("\"Plan\"")
    });
    terminal.signal("KILL");
    terminal.end();

    let mut terminal = Terminal::betadeck(120, 40, &arguments);
    terminal.until("the edited plan", |terminal| {
        let screen = terminal.screen();
        screen.contains("▸2 Plan 2/2 — square") && screen.contains("51.0")
    });
    terminal.send("u");
    terminal.until("the plan as it was", |terminal| !terminal.screen().contains("51.0"));
    terminal.send("qy");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn edits_that_are_kept_nowhere_are_not_offered_for_later() {
    let mut terminal = Terminal::betadeck(120, 40, &["--no-ports", "--fresh"]);
    terminal.until_shown("DISARMED");
    terminal.send("2\x1b[C\x1b[C\x1b[C+");
    terminal.until_shown("[51.0]");
    terminal.send("q");
    terminal.until_shown("cannot be");
    assert!(!terminal.screen().contains("keep the edits"), "{}", terminal.screen());
    terminal.send("d");
    assert_eq!(terminal.end(), 0);
}
