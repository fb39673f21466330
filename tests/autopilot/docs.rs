//! Compares `docs/autopilot.md` with the code: the transition table, and one row for each parameter.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and say what it measured"
)]

use std::path::Path;

use betadeck::autopilot::Params;
use betadeck::autopilot::machine::transition_table;
use betadeck::autopilot::params::Field;

fn page() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/autopilot.md")).unwrap()
}

#[test]
fn the_transition_table_is_the_one_of_the_code() {
    let table = transition_table();
    println!("{table}");
    assert!(page().contains(&table), "replace the table in docs/autopilot.md by the one printed above");
}

fn value(field: &Field, code: i64) -> String {
    let words = field.words;
    let word = usize::try_from(code).ok().and_then(|index| words.get(index).copied());
    word.map_or_else(|| code.to_string(), str::to_owned)
}

#[test]
fn every_parameter_has_its_row_with_range_and_default() {
    let page = page();
    let defaults = Params::default();
    let missing: Vec<String> = Params::FIELDS
        .iter()
        .filter(|field| field.name.starts_with("ap_"))
        .map(|field| {
            let words = field.words;
            let range =
                if words.is_empty() { format!("{}–{}", field.min, field.max) } else { words.join(" ") };
            format!("| `{}` | {range} | {} |", field.name, value(field, (field.get)(&defaults)))
        })
        .filter(|row| !page.contains(row))
        .collect();
    assert!(missing.is_empty(), "missing in docs/autopilot.md:\n{}", missing.join("\n"));
}
