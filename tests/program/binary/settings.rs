//! The Settings panel in a pseudo-terminal: everything by keys at 80x24, and by the mouse at 200x60.

use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;
use crate::binary::terminal::state;

/// Returns a program with the panel open.
fn opened(columns: u16, rows: u16) -> Terminal {
    let sandbox = Sandbox::new();
    sandbox.write("given.txt", "set p_roll = 60\n");
    let given = sandbox.path("given.txt").display().to_string();
    let arguments = ["--no-ports", "--fresh", "--settings", &given];
    let mut terminal =
        Terminal::start_in(sandbox, columns, rows, crate::binary::support::PROGRAM, &arguments);
    terminal.until_shown("DISARMED");
    terminal.send("9");
    terminal.until_shown("─ Changed");
    terminal
}

/// Returns the row of the list with a setting.
fn row(terminal: &Terminal, name: &str) -> String {
    let screen = terminal.screen();
    // Names are padded in the list, and only there.
    let is_row = |line: &&str| line.contains(&format!("{name}  ")) && !line.contains('─');
    screen.lines().find(is_row).unwrap_or_default().to_owned()
}

#[track_caller]
fn until_row(terminal: &mut Terminal, name: &str, parts: &[&str]) {
    terminal.until(&format!("{name} with {parts:?}"), |terminal| {
        parts.iter().all(|part| row(terminal, name).contains(part))
    });
}

#[test]
fn settings_are_found_changed_compared_tried_and_saved_by_keys() {
    let mut terminal = opened(80, 24);
    until_row(&mut terminal, "p_roll", &["●o", "60"]);
    terminal.send("/tilt of the auto\r");
    until_row(&mut terminal, "ap_max_angle", &["▸", "deg"]);
    terminal.send("\r999\r");
    terminal.until_shown("✗ 999 is no value of ap_max_angle: 10…70.");
    terminal.send("\x1530\r");
    until_row(&mut terminal, "ap_max_angle", &["●", "30"]);
    terminal.until_shown("ap_max_angle = 30.");
    terminal.send("+");
    until_row(&mut terminal, "ap_max_angle", &["31"]);
    terminal.send("u");
    until_row(&mut terminal, "ap_max_angle", &["30"]);
    terminal.send("\x12");
    until_row(&mut terminal, "ap_max_angle", &["31"]);
    terminal.send("p");
    terminal.until_shown("ap_max_angle = 31 at its upload");
    terminal.send("\x1b");
    terminal.until("the search is over", |terminal| !terminal.screen().contains("/tilt"));
    // Only what differs: from the defaults, then from the plan, then from the flash.
    terminal.send("ff");
    terminal.until_shown("other than the plan's");
    terminal.send("f");
    terminal.until_shown("not saved in flash");
    until_row(&mut terminal, "ap_max_angle", &["31", "50"]);
    terminal.send("\x1b");
    terminal.until("all settings", |terminal| !terminal.screen().contains("not saved in flash"));
    terminal.send("y");
    terminal.until_shown("settings as CLI lines");
    terminal.send("scraft.txt\r");
    terminal.until_shown("settings in craft.txt");
    assert!(terminal.home().read("craft.txt").contains("set ap_max_angle = 31\n"));
    terminal.send("/max_velocity\rw900\r");
    terminal.until_shown("with 900: ");
    terminal.until_shown("battery used");
    terminal.send("1");
    terminal.until_shown("··· ap_max_velocity = 900: ");
    terminal.send("9");
    terminal.until_shown("▸9 Settings — /max_velocity");
    terminal.send("\x1b");
    terminal.until("the search is over", |terminal| !terminal.screen().contains("/max_velocity"));
    terminal.send("Xy");
    terminal.until_shown("settings were set");
    terminal.send("f");
    terminal.until_shown("changed from the defaults");
    terminal.send("5");
    terminal.until_shown("# set ap_max_angle = 50");
    // A key right after Esc would be Alt with that key.
    terminal.until_shown("Esc leave");
    terminal.send("\x1b");
    terminal.until("the panel is left", |terminal| !terminal.screen().contains("Esc leave"));
    terminal.send("q");
    terminal.until_shown("has edits that no file holds");
    terminal.send("d");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}

#[test]
fn a_change_in_flight_is_flown_at_once() {
    let mut terminal = opened(80, 24);
    terminal.send("F]]]");
    terminal.until("the mission", |terminal| state(terminal) == "APPROACHING");
    terminal.send("/ap_max_distance_from\r\r10\r");
    // Ten metres are less than the distance flown, so the fence ends the mission.
    terminal.until("the fence", |terminal| state(terminal) != "APPROACHING");
    terminal.send("q");
    terminal.until_shown("Quit?");
    terminal.send("y");
    assert_eq!(terminal.end(), 0);
}

/// Sends a press and a release of a mouse button (0 left, 2 right) at a cell.
pub(crate) fn click(terminal: &mut Terminal, button: u8, (column, row): (usize, usize)) {
    terminal.send(&format!("\x1b[<{button};{};{}M", column + 1, row + 1));
    terminal.send(&format!("\x1b[<{button};{};{}m", column + 1, row + 1));
}

/// Returns the cell where a text begins.
#[track_caller]
pub(crate) fn place(terminal: &mut Terminal, text: &str) -> (usize, usize) {
    terminal.until_shown(text);
    let screen = terminal.screen();
    let (row, line) = screen.lines().enumerate().find(|(_, line)| line.contains(text)).expect(text);
    let before = line.split(text).next().unwrap_or_default();
    (before.chars().count(), row)
}

#[test]
fn settings_are_selected_changed_compared_and_tried_by_the_mouse() {
    let mut terminal = opened(200, 60);
    let bar = place(&mut terminal, "8 Log");
    click(&mut terminal, 0, (bar.0 + 2, bar.1));
    terminal.until_shown("▸8 Log");
    let bar = place(&mut terminal, "9 Settings ─");
    click(&mut terminal, 0, (bar.0 + 2, bar.1));
    terminal.until_shown("▸9 Settings");
    let setting = place(&mut terminal, "gyro_lpf1_static_hz  ");
    click(&mut terminal, 0, setting);
    until_row(&mut terminal, "gyro_lpf1_static_hz", &["▸", "250"]);
    // Each entry of the menu is a click.
    let choose = |terminal: &mut Terminal, entry: &str| {
        let at = place(terminal, "gyro_lpf1_static_hz  ");
        click(terminal, 2, at);
        let cell = place(terminal, entry);
        click(terminal, 0, cell);
        // The open menu hides the row.
        terminal.until("the menu closed", |terminal| !terminal.screen().contains(entry));
    };
    choose(&mut terminal, "Raise the value, or");
    until_row(&mut terminal, "gyro_lpf1_static_hz", &["260"]);
    choose(&mut terminal, "Undo the last change");
    until_row(&mut terminal, "gyro_lpf1_static_hz", &["250"]);
    choose(&mut terminal, "Redo the change");
    until_row(&mut terminal, "gyro_lpf1_static_hz", &["260"]);
    choose(&mut terminal, "The plan sets this one");
    terminal.until_shown("gyro_lpf1_static_hz = 260 at its upload");
    choose(&mut terminal, "Fly ahead with another");
    terminal.send("300\r");
    terminal.until_shown("with 300: ");
    choose(&mut terminal, "Back to its default");
    until_row(&mut terminal, "gyro_lpf1_static_hz", &["250"]);
    // A second press on the value begins to type.
    let at = place(&mut terminal, "gyro_lpf1_static_hz  ");
    click(&mut terminal, 0, at);
    click(&mut terminal, 0, (at.0 + 28, at.1));
    terminal.until_shown("Enter sets it");
    terminal.send("270\r");
    until_row(&mut terminal, "gyro_lpf1_static_hz", &["270"]);
    // The wheel goes through the list.
    for _ in 0..12 {
        terminal.send(&format!("\x1b[<65;{};{}M", at.0 + 1, at.1 + 1));
    }
    terminal.until("further down", |terminal| row(terminal, "gyro_lpf1_static_hz").is_empty());
    terminal.send("q");
    terminal.until_shown("has edits that no file holds");
    terminal.send("d");
    assert_eq!(terminal.end(), 0);
}
