//! `docs/scenarios.md` and `docs/campaigns.md` against the code: every signal, flag, event, input, unit and metric has
//! its row.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may stop at a surprise and print what the page should say"
)]

use betadeck_core::scenario::flag::Flag;
use betadeck_core::scenario::happening::EVENTS;
use betadeck_core::scenario::{FORMS, Metric};
use betadeck_core::telemetry::quantity::UNITS;
use betadeck_core::telemetry::signal::{SIGNALS, SignalInfo};
use strum::IntoEnumIterator as _;

/// Returns the tables of the reference, each with its page and the name of the marks around it.
fn tables() -> Vec<(&'static str, &'static str, String)> {
    let page = "docs/scenarios.md";
    vec![
        (page, "INPUTS", inputs()),
        (page, "EVENTS", events()),
        (page, "FLAGS", flags()),
        (page, "SIGNALS", signals()),
        (page, "UNITS", units()),
        ("docs/campaigns.md", "METRICS", metrics()),
    ]
}

fn metrics() -> String {
    let row = |metric: Metric| {
        let unit = metric.dimension().unit().map_or("", |unit| unit.name);
        let unit = if metric.is_share() { "%" } else { unit };
        format!("| `{metric}` | {unit} | {} |", metric.help())
    };
    rows("| metric | unit | is |", Metric::iter().map(row))
}

fn rows(head: &str, rows: impl Iterator<Item = String>) -> String {
    let columns = head.matches('|').count() - 1;
    format!("{head}\n|{}\n{}", " --- |".repeat(columns), rows.map(|row| row + "\n").collect::<String>())
}

fn inputs() -> String {
    rows("| `do` | does |", FORMS.iter().map(|(form, help)| format!("| `{form}` | {help} |")))
}

fn events() -> String {
    let row = |info: &betadeck_core::scenario::happening::EventInfo| {
        let words = info.event.words();
        let words = if words.len() > 12 {
            format!("`{}` … `{}`", words[..10].join("` `"), words[words.len() - 2..].join("` `"))
        } else if words.is_empty() {
            String::new()
        } else {
            format!("`{}`", words.join("` `"))
        };
        let fields: Vec<String> = info
            .fields
            .iter()
            .map(|field| {
                let (name, dimension, help) = field.info();
                let unit = dimension.unit().map_or(String::new(), |unit| format!(", {}", unit.name));
                format!("`{name}` ({help}{unit})")
            })
            .collect();
        format!(
            "| `{}` | {} | {words} | {} | {} |",
            info.name,
            info.help,
            fields.join(", "),
            info.event.insight()
        )
    };
    rows("| event | when | words behind it | numbers for `with` | needs |", EVENTS.iter().map(row))
}

fn flags() -> String {
    rows(
        "| flag | says | needs |",
        Flag::iter().map(|flag| format!("| `{flag}` | {} | {} |", flag.help(), flag.insight())),
    )
}

fn signals() -> String {
    let row = |info: &SignalInfo| {
        let unit = info.dimension.unit().map_or("", |unit| unit.name);
        format!("| `{}` | {unit} | {} | {} |", info.name, info.help, info.signal.insight())
    };
    rows("| signal | unit | is | needs |", SIGNALS.iter().map(row))
}

fn units() -> String {
    rows("| unit | is |", UNITS.iter().map(|unit| format!("| `{}` | {} |", unit.name, unit.help)))
}

#[test]
fn the_reference_has_a_row_for_everything_that_can_be_written() {
    let mut missing = Vec::new();
    for (page, name, table) in tables() {
        let page = test_support::text(page);
        println!("=={name}==\n{table}");
        let marked = format!("<!-- {name} -->\n{table}<!-- end -->");
        if !page.contains(&marked) {
            missing.push(name);
        }
    }
    assert!(missing.is_empty(), "replace these tables of the pages by those printed above: {missing:?}");
}
