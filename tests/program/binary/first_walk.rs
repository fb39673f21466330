//! The first half hour of a new user, by keys: the tutorial, a new plan, its flight, a rewind, a scenario of
//! it.

use crate::binary::pty::Terminal;
use crate::binary::terminal::state;

/// The keys for a faster flight: four steps up, from 1× to 16×.
const FASTER: &str = "]]]]";

fn has_landed(terminal: &Terminal) -> bool {
    state(terminal) == "COMPLETE" && terminal.row(0).contains("DISARMED")
}

/// Returns the minutes of the clock in the second row.
fn minutes(terminal: &Terminal) -> Option<u32> {
    let row = terminal.row(1);
    let clock = row.split_whitespace().rev().find_map(|word| word.split_once(':'))?;
    clock.0.parse().ok()
}

fn tutorial(terminal: &mut Terminal) {
    terminal.send(":tutorial\r");
    terminal.until_shown("▸ 1/5");
    terminal.until_shown("GPS fix");
    terminal.send("F");
    terminal.until_shown("▸ 2/5");
    terminal.send("]");
    terminal.until_shown("That is 2×");
    terminal.send("]");
    terminal.until_shown("▸ 3/5");
    terminal.send("2");
    terminal.until_shown("Arrows choose");
    terminal.send("lll+");
    terminal.until_shown("▸ 4/5");
    terminal.send("U");
    terminal.until_shown("▸ 5/5");
    terminal.send(",");
    terminal.until_shown("Every panel shows that instant");
    terminal.send("e");
    terminal.until_shown("That was the tutorial");
    terminal.send(FASTER);
    terminal.until("a landing", has_landed);
}

/// Makes a plan of two legs and a landing. One altitude is mistyped and then corrected.
fn plan_from_nothing(terminal: &mut Terminal) {
    terminal.send("2n");
    terminal.until_shown("A new plan");
    terminal.send("ii");
    terminal.until_shown("[20.0]");
    terminal.send("\r2035\r");
    terminal.until_shown("2035 m above home");
    terminal.send("\r35\r");
    terminal.until_shown("[35.0]");
    terminal.until("no finding", |terminal| !terminal.screen().contains("above home"));
    terminal.send("i");
    terminal.until_shown("● 2");
    terminal.send("hhh+++");
    terminal.until_shown("[LAND]");
    terminal.send("U");
    terminal.until_shown("✓ on the craft");
}

/// Presses a key that goes back in time until `is_there` accepts the screen.
fn back(terminal: &mut Terminal, key: &str, is_there: impl Fn(&Terminal) -> bool) {
    while !is_there(terminal) {
        let before = terminal.row(1);
        terminal.send(key);
        terminal.until("an earlier instant", |terminal| terminal.row(1) != before);
    }
}

fn a_new_user_flies_a_plan_from_nothing_and_makes_a_scenario_of_it(columns: u16, rows: u16) {
    let program = crate::binary::support::PROGRAM;
    let written = "new-flight-1.toml";
    let script = format!("{program} --fresh --no-ports && {program} check {written}");
    let mut terminal = Terminal::start(columns, rows, "/bin/sh", &["-c", &script]);
    terminal.until_shown("DISARMED");
    tutorial(&mut terminal);
    plan_from_nothing(&mut terminal);
    terminal.send("F");
    terminal.until("the mission", |terminal| state(terminal) == "APPROACHING");
    terminal.send(FASTER);
    terminal.until("a landing", has_landed);
    terminal.until("real time again", |terminal| terminal.row(1).trim_end().ends_with(" 1×"));
    let landed = minutes(&terminal).expect("a clock");
    terminal.send(FASTER);
    terminal
        .until("two minutes of waiting", |terminal| minutes(terminal).is_some_and(|now| now > landed + 2));
    terminal.send(" {");
    terminal.until_shown("REWOUND −");
    back(&mut terminal, "{", |terminal| terminal.row(1).contains("APPROACHING WP0"));
    back(&mut terminal, ",", |terminal| {
        terminal.row(0).contains("● ARMED") && !terminal.row(0).contains("AUTOPILOT")
    });
    terminal.send("T");
    terminal.until_shown(written);
    terminal.send("q");
    // The craft has landed, whatever instant is shown.
    terminal.until_shown("square has edits that no file holds");
    // The plan from nothing has edits, too.
    terminal.send("dd");
    assert_eq!(terminal.end(), 0, "{}", terminal.screen());
    let seen = terminal.screen();
    let judged = seen.split("1 of 1 flight passed; ").nth(1).unwrap_or_else(|| panic!("{seen}"));
    let flown_s: f64 =
        judged.split(" s flown").next().and_then(|text| text.trim().parse().ok()).expect("a time");
    // The scenario has the complete flight and the wait after it, not only the climb that was shown.
    assert!(flown_s > 60.0 * f64::from(landed), "{seen}");
    terminal.assert_given_back();
}

#[test]
#[ignore = "search: minutes of real time"]
fn a_new_user_walks_through_a_small_terminal() {
    a_new_user_flies_a_plan_from_nothing_and_makes_a_scenario_of_it(80, 24);
}

#[test]
#[ignore = "search: minutes of real time"]
fn a_new_user_walks_through_a_large_terminal() {
    a_new_user_flies_a_plan_from_nothing_and_makes_a_scenario_of_it(200, 60);
}
