//! A walk through the screen at 200x60 in a pseudo-terminal, by the mouse alone.

use crate::binary::pty::Terminal;
use crate::binary::settings::{click, place};

const LEFT: u8 = 0;
const WHEEL_DOWN: u8 = 65;

/// Clicks on a text.
#[track_caller]
fn click_on(terminal: &mut Terminal, text: &str) {
    let at = place(terminal, text);
    click(terminal, LEFT, at);
}

#[test]
fn a_flight_is_started_rewound_searched_and_left_by_the_mouse() {
    let mut terminal = Terminal::betadeck(200, 60, &["--no-ports", "--fresh"]);
    terminal.until_shown("DISARMED");
    // The hints, the help, and a place outside of it.
    click_on(&mut terminal, "? help");
    terminal.until_shown("Keys");
    click(&mut terminal, LEFT, (1, 57));
    terminal.until("the help is closed", |terminal| !terminal.screen().contains("Keys — "));
    // The status lines open the palette, the wheel scrolls it, and a click outside closes it.
    click_on(&mut terminal, "DISARMED");
    terminal.until_shown("Commands — Enter runs");
    let first = place(&mut terminal, "flight.fly ");
    (0..40).for_each(|_| terminal.send(&format!("\x1b[<{WHEEL_DOWN};{};{}M", first.0 + 1, first.1 + 1)));
    terminal.until("later commands", |terminal| !terminal.screen().contains("flight.fly "));
    click(&mut terminal, LEFT, (1, 57));
    terminal.until("no palette", |terminal| !terminal.screen().contains("Commands — Enter runs"));
    // Panels by the bar, and a waypoint by its cell.
    click_on(&mut terminal, "6 Graphs");
    terminal.until_shown("▸6 Graphs");
    click_on(&mut terminal, "-79.5190000");
    terminal.until_shown("[-79.5190000]");
    terminal.until_shown("▸2 Plan");
    // The pilot flies, and the timeline goes back and to the end again.
    click_on(&mut terminal, "DISARMED");
    click_on(&mut terminal, "flight.fly ");
    terminal.until_shown("ARMED ANGLE");
    let time = place(&mut terminal, "00:00.0 I");
    click(&mut terminal, LEFT, (time.0 + 30, time.1));
    terminal.until_shown("REWOUND");
    click_on(&mut terminal, "e end  ,");
    terminal.until("the present", |terminal| !terminal.screen().contains("REWOUND"));
    // The question of the end, answered by its key on the screen.
    click_on(&mut terminal, "q quit");
    terminal.until_shown("Quit?");
    click_on(&mut terminal, "y quit");
    assert_eq!(terminal.end(), 0);
}
