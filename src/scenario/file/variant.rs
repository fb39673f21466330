//! A combination of the values of `[vary]`.

use toml::de::DeValue;

use crate::plan::format::Value;

/// The varied keys with their values.
#[derive(Debug, Default)]
pub(super) struct Variant<'l, 't> {
    pub(super) values: Vec<(&'l str, &'l Value<'t>)>,
}

impl<'l, 't> Variant<'l, 't> {
    /// Returns the varied value of this key.
    pub(super) fn get(&self, key: &str) -> Option<&'l Value<'t>> {
        self.values.iter().find(|(name, _)| *name == key).map(|&(_, value)| value)
    }

    /// Returns the keys with their values for people.
    pub(super) fn shown(&self) -> impl Iterator<Item = (&'l str, String)> {
        self.values.iter().map(|&(key, value)| (key, scalar(value)))
    }

    /// Returns the name of a case with this combination.
    pub(super) fn name_of(&self, base: &str) -> String {
        let parts =
            self.shown().map(|(key, shown)| if key == "settings" { shown } else { format!("{key} {shown}") });
        std::iter::once(base.to_owned())
            .filter(|base| !base.is_empty())
            .chain(parts)
            .collect::<Vec<_>>()
            .join(", ")
    }
}

/// Returns a text, a number or a truth value as it is written.
pub(super) fn scalar(value: &Value<'_>) -> String {
    match value.get_ref() {
        DeValue::String(text) => text.to_string(),
        DeValue::Integer(integer) => integer.as_str().to_owned(),
        DeValue::Float(float) => float.as_str().to_owned(),
        DeValue::Boolean(true) => "on".to_owned(),
        DeValue::Boolean(false) => "off".to_owned(),
        _ => String::new(),
    }
}
