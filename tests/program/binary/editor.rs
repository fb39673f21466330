//! The plan editor in a pseudo-terminal: a new plan flown to its landing, and edits that survive a kill.

use betadeck::plan::edit::Journal;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;

/// The number of times the program is killed.
const KILLS: u64 = 100;

/// A plan of two waypoints, 10 m high.
const PLAN: &str = "waypoint insert 0 40.4640000 -79.5175000 1000 0 FLYOVER 0 NONE\nwaypoint insert 1 40.4636 -79.5182 1000 0 LAND 0 NONE\n";

/// Returns the altitude of the first waypoint on the screen, m.
fn shown_altitude(terminal: &Terminal) -> Option<i64> {
    let screen = terminal.screen();
    let row = screen.lines().find(|line| line.contains(" 0  FLYOVER"))?;
    let (value, _) = row.split_once('[')?.1.split_once(']')?;
    // The column before it has more decimals.
    value.strip_suffix(".0")?.parse().ok()
}

/// Returns the altitude of the first waypoint in the journals of a state directory, m.
fn kept_altitude(sandbox: &Sandbox) -> Option<i64> {
    let entries = std::fs::read_dir(sandbox.path("state/plans")).ok()?;
    let mut journals = entries.filter_map(|entry| {
        // A kill can leave a temporary file with an edit that no journal has.
        let path = entry.ok()?.path();
        let text =
            std::fs::read(path.extension().is_some_and(|end| end == "journal").then_some(path)?).ok()?;
        Some(Journal::read_whole_part(&String::from_utf8_lossy(&text))?.0)
    });
    let journal = journals.next()?;
    assert!(journals.next().is_none(), "one journal, for one plan");
    Some(i64::from(journal.history.document().plan.records().first()?.alt_cm) / 100)
}

#[test]
fn a_kill_at_any_instant_of_editing_loses_at_most_the_last_keys_edit() {
    let sandbox = Sandbox::new();
    sandbox.write("plan.txt", PLAN);
    let (plan, state) = (sandbox.path("plan.txt"), sandbox.path("state"));
    let (plan, state) = (plan.display().to_string(), state.display().to_string());
    let arguments = [plan.as_str(), "--no-ports", "--state-dir", &state];
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let mut kept = 10;
    for round in 0..KILLS {
        let mut terminal = Terminal::betadeck(80, 24, &arguments);
        // Moves the cursor to the altitude.
        terminal.send("2\x1b[C\x1b[C\x1b[C");
        terminal.until("the altitude", |terminal| shown_altitude(terminal).is_some());
        assert_eq!(shown_altitude(&terminal), Some(kept), "round {round}: what was kept is back");
        let edits = rng.random_range(1..12);
        // Waits for only some of the keys, so that the kill meets the program at any stage of its work.
        let waited = rng.random_range(0..=edits);
        terminal.send(&"+".repeat(edits));
        terminal.until("some edits", |terminal| shown_altitude(terminal) >= Some(kept + waited as i64));
        terminal.signal("KILL");
        terminal.end();
        let seen = shown_altitude(&terminal).expect("an altitude");
        let now = kept_altitude(&sandbox).unwrap_or(kept);
        assert!(now >= seen - 1, "round {round}: {seen} m was seen, {now} m was kept");
        assert!(now <= kept + edits as i64, "round {round}");
        kept = now;
    }
    assert!(kept > 10 + KILLS as i64, "{kept}");
    assert_eq!(sandbox.read("plan.txt"), PLAN, "nobody saved");

    // Undo reaches back to edits before the kills.
    let mut terminal = Terminal::betadeck(80, 24, &arguments);
    terminal.send("2\x1b[C\x1b[C\x1b[Cu");
    terminal.until("undone", |terminal| shown_altitude(terminal) == Some(kept - 1));
    terminal.send("s");
    terminal.until_shown("Saved plan.txt.");
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
    assert!(sandbox.read("plan.txt").contains(&format!(" {} 0 FLYOVER", (kept - 1) * 100)));
}

/// Makes, saves, uploads and flies a new plan and changes it in flight, with keys only.
fn from_nothing_to_the_ground(columns: u16, rows: u16) {
    let sandbox = Sandbox::new();
    let state = sandbox.path("state").display().to_string();
    let file = sandbox.path("made.toml").display().to_string();
    let mut terminal = Terminal::betadeck(columns, rows, &["--no-ports", "--state-dir", &state]);
    terminal.until_shown("DISARMED");
    terminal.send("2n");
    terminal.until_shown("No waypoints.");
    // Three waypoints, the last one a LAND.
    terminal.send("iii+++");
    terminal.until_shown("LAND");
    terminal.send("s");
    terminal.until_shown("Save as");
    // Control-U deletes the offered name.
    terminal.send(&format!("\x15{file}\r"));
    terminal.until_shown("Saved made.toml.");
    terminal.send("U");
    terminal.until_shown("Uploaded made.toml: 3 waypoints");
    terminal.send("F]]]]]");
    terminal.until("in the air", |terminal| terminal.row(1).contains("APPROACHING WP1"));
    // In flight, the last waypoint is raised and the plan is uploaded again.
    terminal.send("2\x1b[F\x1b[C\x1b[C\x1b[C+++++");
    terminal.until_shown("[25.0]");
    terminal.send("U");
    terminal.until_shown("Uploaded made.toml: 3 waypoints");
    terminal.until("landed", |terminal| {
        terminal.row(1).contains("COMPLETE") && terminal.row(0).contains("DISARMED")
    });
    terminal.send("q");
    terminal.until_shown("has edits that no file holds");
    terminal.send("s");
    assert_eq!(terminal.end(), 0);
    assert!(sandbox.read("made.toml").contains("alt_m = 25"));
}

#[test]
fn a_plan_from_nothing_to_the_ground_at_80x24() {
    from_nothing_to_the_ground(80, 24);
}

#[test]
fn a_plan_from_nothing_to_the_ground_at_120x40() {
    from_nothing_to_the_ground(120, 40);
}

#[test]
fn a_plan_is_compared_with_the_craft_its_changed_file_and_its_revisions() {
    let sandbox = Sandbox::new();
    sandbox.write("mine.txt", PLAN);
    let plan = sandbox.path("mine.txt").display().to_string();
    let state = sandbox.path("state").display().to_string();
    let mut terminal = Terminal::betadeck(80, 24, &[&plan, "--no-ports", "--state-dir", &state]);
    terminal.until_shown("DISARMED");
    terminal.send("2V");
    terminal.until_shown("+ WP0 FLYOVER");
    terminal.send("V\x1b[C\x1b[C\x1b[C+");
    terminal.until_shown("[11.0]");
    sandbox.write("mine.txt", &PLAN.replace("1000 0 FLYOVER", "2000 0 FLYOVER"));
    terminal.until_shown("changed on disk: `V` compares");
    terminal.send("V");
    terminal.until("the altitude in the file beside the edited one", |terminal| {
        let screen = terminal.screen();
        let row = screen.lines().find(|line| line.contains("≠   altitude")).unwrap_or_default();
        screen.contains("▸file") && row.contains("20 m") && row.contains("11 m")
    });
    terminal.send("\tm");
    terminal.until_shown("╌╌ this plan ··· ○ revision 0");
    terminal.send("\t");
    terminal.until("the settings of the craft", |terminal| {
        terminal.screen().contains("▸settings") && terminal.screen().contains("= gyro_lpf1_type")
    });
    terminal.send("V:quit\r");
    terminal.until_shown("has edits that no file holds");
    terminal.send("d");
    assert_eq!(terminal.end(), 0);
}
