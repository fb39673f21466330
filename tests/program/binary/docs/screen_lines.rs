//! The lines of the pages that are entered at `:` on the screen.

use super::extract::{commands, is_screen, pages};
use super::filled_in;
use crate::binary::pty::Terminal;

/// The beginning of a line, and the words on the screen after it was carried out.
const CARRIED_OUT: [(&str, &str); 20] = [
    (":allow-changes", "changes need no permission"),
    (":arm", "● ARMED"),
    (":backdrop field.geojson", "is under the plan: 10 vertices"),
    (":backdrop off", "Nothing is under the plan."),
    (":fault gps-loss", "Fault gps-loss begins."),
    (":fault teleport", "Fault teleport 90,90,0 begins."),
    (":flight.home", "Nothing to bring home"),
    (":layout save ", "kept for this run only"),
    (":log ", "No log was written: the craft was not armed"),
    (":profile ", "ap_profile set to "),
    (":record ", "so far is recorded as"),
    (":scenario ", "The flight is written as"),
    (":set ap_l1_enable=OFF", "ap_l1_enable set to OFF"),
    (":set ap_rx_loss_policy=LAND", "ap_rx_loss_policy set to LAND"),
    (":set ap_", " set to "),
    (":speed 4", " 4×"),
    (":tutorial", "▸ 1/5"),
    (":where ", " at every second: "),
    (":what-if ", ", flown from home: "),
    (":wind 5@270", "wind=5@270"),
];

#[test]
fn every_line_of_the_pages_for_the_screen_is_carried_out() {
    let mut lines: Vec<String> = Vec::new();
    for shown in pages().iter().flat_map(|page| commands(page)).filter(|shown| is_screen(&shown.text)) {
        let line = filled_in(&shown).unwrap_or_else(|problem| panic!("{problem}"));
        let expected = CARRIED_OUT.iter().find(|(beginning, _)| line.starts_with(beginning));
        let (_, words) = expected.unwrap_or_else(|| panic!("{}: add its effect to CARRIED_OUT", shown.place));
        if lines.contains(&line) {
            continue;
        }
        let mut terminal = Terminal::betadeck(200, 60, &["--fresh", "--no-ports"]);
        terminal.until_shown("DISARMED");
        terminal.home().write("field.geojson", include_str!("../../../exchange/field.geojson"));
        if line == ":arm" {
            // This is what is missing once nothing blocks the arming any more.
            terminal.until_shown("The craft has no plan.");
        }
        assert!(!terminal.screen().contains(words), "{words} is always there");
        terminal.send(&format!("{line}\r"));
        terminal.until_shown(words);
        // It asks before it leaves an armed craft.
        terminal.send(if line == ":arm" { "qy" } else { "q" });
        assert_eq!(terminal.end(), 0, "{line}");
        lines.push(line);
    }
    assert!(lines.len() >= 10, "only {lines:?}");
}

#[test]
fn a_refused_line_of_the_screen_names_what_is_wrong_with_it() {
    let mut terminal = Terminal::betadeck(200, 60, &["--fresh", "--no-ports"]);
    terminal.until_shown("DISARMED");
    for (line, problem) in [
        (":nonsense", "There is no command nonsense"),
        (":wind 5@27x", "direction 27x is not a number"),
        (":set ap_l1_enabel=OFF", "Did you mean ap_l1_enable?"),
        (":fault teleport,90,90,0", "three numbers are needed"),
    ] {
        let before = terminal.screen();
        terminal.send(&format!("{line}\r"));
        terminal.until(problem, |terminal| {
            let screen = terminal.screen();
            screen != before && screen.contains(problem) && !screen.contains("World:")
        });
    }
}
