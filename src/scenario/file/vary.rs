//! `[vary]`: every combination of the listed values becomes a case of its own.

use toml::de::DeValue;

use super::keys::VARY_KEYS;
use super::reader::Reader;
use super::variant::Variant;
use crate::plan::format::TomlTable;

const MAX_VARIANTS: usize = 1000;

/// Returns all combinations; one empty combination if nothing is varied.
pub(super) fn read<'l, 't>(top: &TomlTable<'l, 't>, reader: &mut Reader<'_, '_>) -> Vec<Variant<'l, 't>> {
    let mut variants = vec![Variant::default()];
    let Some(table) = top.get("vary").and_then(|value| reader.table("vary", value)) else { return variants };
    reader.refuse_unknown(&table, VARY_KEYS);
    for (key, span, value) in table.keys().filter(|(key, ..)| VARY_KEYS.contains(key)) {
        let DeValue::Array(values) = value.get_ref() else {
            reader.problem(
                value.span(),
                format!("{key} is not a list"),
                format!("write {key} = [\"…\", \"…\"]"),
            );
            continue;
        };
        if values.is_empty() || variants.len() * values.len() > MAX_VARIANTS {
            let message = format!("{} values cannot be combined", values.len());
            reader.problem(span, message, format!("allowed: 1 to {MAX_VARIANTS} combinations in all"));
            continue;
        }
        variants = variants
            .iter()
            .flat_map(|variant| {
                values.iter().map(move |value| {
                    let mut values = variant.values.clone();
                    values.push((key, value));
                    Variant { values }
                })
            })
            .collect();
    }
    variants
}
