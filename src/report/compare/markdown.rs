//! The comparison as a table in Markdown for a pull request: before and after, or measured and simulated.

use super::Comparison;
use super::cells::{flights, incomplete, notes, rows};
use crate::report::markdown::{cell, code, line};

/// Returns the table. The first firmware is the one before the change.
pub(super) fn markdown(comparison: &Comparison, command: Option<&str>) -> String {
    let [before, after] = &comparison.sides;
    let mark = if comparison.is_complete() { "✅" } else { "❌" };
    let mut text = format!("<!-- betadeck comparison -->\n### {mark} {}\n\n", line(&comparison.title()));
    for (letter, side) in ["A", "B"].iter().zip(&comparison.sides) {
        text.push_str(&format!("- {letter}: {}, {}\n", line(&side.name), flights(side)));
    }
    let [first, second] = if comparison.has_log() { ["measured", "simulated"] } else { ["before", "after"] };
    text.push_str(&format!(
        "\n| measure | {first} (A: {}) | {second} (B: {}) | B − A |\n| --- | ---: | ---: | ---: |\n",
        cell(&before.name),
        cell(&after.name)
    ));
    for row in rows(comparison) {
        let is_marked = row.is_marked();
        let unit = if row.unit.is_empty() { String::new() } else { format!(", {}", row.unit) };
        let difference = if is_marked { format!("**{}** \\*", row.difference) } else { row.difference };
        text.push_str(&format!(
            "| {}{unit} | {} | {} | {difference} |\n",
            row.title,
            cell(&row.a),
            cell(&row.b)
        ));
    }
    text.push('\n');
    let incomplete = incomplete(comparison);
    for sentence in &incomplete {
        text.push_str(&format!("- {}\n", line(sentence)));
    }
    if !incomplete.is_empty() {
        text.push('\n');
    }
    for note in notes(comparison) {
        text.push_str(&format!("{}\n", line(&note)));
    }
    text.extend(command.map(|command| format!("\n{}\n", code(command))));
    text
}
