//! The configuration on disk when its process is killed in the middle of a save.
//!
//! It is alone in its program, because a child that is being started holds the locks of other tests for a moment.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use betadeck::firmware::config::Configuration;
use betadeck::storage::Store;

/// The name of the variable that gives a child process the directory to save in.
const CHILD_DIRECTORY: &str = "BETADECK_TEST_SAVE_DIRECTORY";

fn named(name: &str) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.settings.set_text("craft_name", name).expect("a short name");
    configuration
}

fn name_of(configuration: &Configuration) -> &str {
    configuration.settings.text("craft_name")
}

fn open(directory: &Path) -> Store {
    Store::open(directory, false).expect("a store")
}

/// Not a test of its own: the process that the next test kills.
#[test]
#[ignore = "runs only as a child of `killed_savers_leave_old_or_new`"]
fn child_saves_for_ever() {
    let Some(directory) = std::env::var_os(CHILD_DIRECTORY) else { return };
    let mut store = open(Path::new(&directory));
    for round in 0_u64.. {
        store.save(&named(if round % 2 == 0 { "even" } else { "odd" })).expect("saved");
        println!("saved {round}");
    }
}

#[test]
fn killed_savers_leave_old_or_new() {
    let directory = tempfile::tempdir().expect("a directory");
    open(directory.path()).save(&named("even")).expect("saved");
    let program = std::env::current_exe().expect("this program");
    for round in 0..200_usize {
        let mut child = Command::new(&program)
            .args(["--exact", "files::killed::child_saves_for_ever", "--ignored", "--nocapture"])
            .env(CHILD_DIRECTORY, directory.path())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a child");
        let mut lines = BufReader::new(child.stdout.take().expect("its output")).lines();
        // Kill at different places: after a different number of saves, and a different while later.
        let saves = round % 5 + 1;
        let seen =
            lines.by_ref().filter(|line| line.as_ref().is_ok_and(|line| line.contains("saved"))).take(saves);
        assert_eq!(seen.count(), saves, "round {round}: the child cannot save");
        for turn in 0..round * 300 {
            std::hint::black_box(turn);
        }
        child.kill().expect("killed");
        child.wait().expect("ended");
        let loaded = open(directory.path()).load();
        assert!(loaded.findings.is_empty(), "round {round}: {:?}", loaded.findings);
        assert!(["even", "odd"].contains(&name_of(&loaded.configuration)), "round {round}");
    }
}
