//! Compares `docs/modes.md` with the code: the boxes, the arming flags, the failsafe responses.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may stop and say what it expects")]

use betadeck_core::telemetry::{ArmingFlag, BoxLevel, DisarmReason, ModeBox};
use strum::IntoEnumIterator as _;

fn page() -> String {
    test_support::text("docs/modes.md")
}

#[track_caller]
fn assert_on_page(table: &str) {
    println!("{table}");
    assert!(page().contains(table), "replace the table in docs/modes.md by the one printed above");
}

#[test]
fn boxes_are_those_of_the_code() {
    let mut table = String::from("| id | box | here |\n| --- | --- | --- |\n");
    for entry in ModeBox::iter() {
        let level = match entry.level() {
            BoxLevel::Full => "works",
            BoxLevel::Flag => "is reported",
            BoxLevel::Name => "is accepted",
        };
        table += &format!("| {} | {} | {level} |\n", entry as u8, entry);
    }
    assert_on_page(&table);
}

#[test]
fn arming_flags_are_those_of_the_code() {
    let mut table = String::from("| bit | flag | set by | what to do |\n| --- | --- | --- | --- |\n");
    for flag in ArmingFlag::iter() {
        let cause = flag.cause();
        let hint = if cause.starts_with("never") { "" } else { flag.hint() };
        table += &format!("| {} | {flag} | {cause} | {hint} |\n", flag as u8);
    }
    assert_on_page(&table);
}

#[test]
fn disarm_reasons_are_those_of_the_code() {
    let names: Vec<_> = DisarmReason::iter().map(|reason| format!("{} {reason}", reason as u8)).collect();
    let line = names.join(", ");
    println!("{line}");
    assert!(page().replace('\n', " ").contains(&line));
}
