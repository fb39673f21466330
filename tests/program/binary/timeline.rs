//! The recorded flight in a pseudo-terminal: rewind, a scenario of it, and the timeline after a long wait.

use crate::binary::pty::Terminal;
use crate::binary::terminal::{started, state};

#[test]
fn the_flight_is_rewound_and_flown_on_by_keys() {
    for (columns, rows) in [(80, 24), (120, 40)] {
        let mut terminal = started(columns, rows, &["--fresh"]);
        terminal.send("F]]]]]");
        terminal.until("the mission", |terminal| state(terminal) == "APPROACHING");
        terminal.send(",");
        terminal.until_shown("REWOUND −");
        // Goes back before the engagement, which is a state and an event.
        terminal.send(",");
        terminal.until("before the mission", |terminal| state(terminal) == "IDLE");
        let timeline = terminal.row(usize::from(rows) - 2);
        assert!(timeline.starts_with(" 00:00.0 I") && timeline.contains("━┃─"), "{timeline}");
        terminal.send("a");
        terminal.until_shown("An earlier instant is shown");
        terminal.send("eq");
        // At the end of the recording the craft is armed.
        terminal.until_shown("Quit?");
        terminal.send("n,b");
        terminal.until_shown("Flying on from here");
        terminal.until("the flight", |terminal| !terminal.screen().contains("REWOUND"));
        terminal.send("qy");
        assert_eq!(terminal.end(), 0);
        terminal.assert_given_back();
    }
}

#[test]
fn the_first_flight_of_a_session_becomes_a_scenario_that_passes() {
    for (columns, rows) in [(80, 24), (200, 60)] {
        // Runs the screen, then the check of the file that `T` wrote, in one directory.
        let program = crate::binary::support::PROGRAM;
        let written = "square-flight-1.toml";
        let script = format!(
            "{program} --fresh --no-ports && {program} check {written} && grep 'ARRIVED 2 of stored' {written}"
        );
        let mut terminal = Terminal::start(columns, rows, "/bin/sh", &["-c", &script]);
        terminal.until_shown("DISARMED");
        terminal.send("F]]]]]]");
        terminal.until_shown("GPS fix");
        // A wind that rises during the flight is part of the scenario.
        terminal.until("the mission", |terminal| state(terminal) == "APPROACHING");
        terminal.send(":wind 3@270\r");
        terminal.until("a landing", |terminal| {
            state(terminal) == "COMPLETE" && terminal.row(0).contains("DISARMED")
        });
        terminal.send("T");
        terminal.until("the scenario", |terminal| {
            let screen = terminal.screen();
            assert!(!screen.contains("No scenario was written"), "{screen}");
            screen.contains(written)
        });
        terminal.send("q");
        assert_eq!(terminal.end(), 0, "{}", terminal.screen());
        assert!(terminal.screen().contains("ARRIVED 2 of stored"), "{}", terminal.screen());
    }
}

#[test]
fn the_speed_falls_back_after_the_landing_and_a_long_wait_leaves_the_flight_on_the_timeline() {
    let mut terminal = started(120, 40, &["--fresh"]);
    terminal.send("F]]]]]]]");
    terminal
        .until("a landing", |terminal| state(terminal) == "COMPLETE" && terminal.row(0).contains("DISARMED"));
    terminal.until_shown("time runs at 1× again");
    // A speed that is chosen now is kept: more than an hour passes on the ground.
    terminal.send(":speed 1000\r");
    let minutes = |terminal: &Terminal| {
        let row = terminal.row(38);
        let head = row.split_whitespace().next_back().and_then(|head| head.split_once(':'));
        head.and_then(|(minutes, _)| minutes.parse::<u32>().ok()).unwrap_or(0)
    };
    terminal.until("more than an hour", |terminal| minutes(terminal) > 70);
    terminal.send(" ");
    let timeline = terminal.row(38);
    assert!(timeline.starts_with(" 00:00.0 "), "{timeline}");
    let flight =
        timeline.find('●').zip(timeline.find('C')).map(|(from, to)| timeline[from..to].chars().count());
    assert!(flight.is_some_and(|columns| columns > 70), "{timeline}");
    assert!(timeline.contains('≈'), "{timeline}");
    terminal.send("{{");
    terminal.until("the landing again", |terminal| state(terminal) == "LANDING");
    terminal.until_shown("REWOUND −");
    // The craft is now disarmed, so quitting asks no question.
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}
