//! Compares `docs/autopilot.md` with the code: one row for each parameter.
#![allow(clippy::unwrap_used, reason = "a test may stop at a surprise")]

use betadeck_core::autopilot::Params;
use betadeck_core::autopilot::params::Field;

fn page() -> String {
    test_support::text("docs/autopilot.md")
}

fn value(field: &Field, code: i64) -> String {
    let words = field.words;
    let word = usize::try_from(code).ok().and_then(|index| words.get(index).copied());
    word.map_or_else(|| code.to_string(), str::to_owned)
}

#[test]
fn every_parameter_has_its_row_with_range_and_default() {
    let page = page();
    let missing: Vec<String> = Params::FIELDS
        .iter()
        .filter(|field| field.name.starts_with("ap_"))
        .map(|field| {
            let words = field.words;
            let range =
                if words.is_empty() { format!("{}–{}", field.min, field.max) } else { words.join(" ") };
            format!("| `{}` | {range} | {} |", field.name, value(field, field.default))
        })
        .filter(|row| !page.contains(row))
        .collect();
    assert!(missing.is_empty(), "missing in docs/autopilot.md:\n{}", missing.join("\n"));
}
