//! Strict access to TOML tables with the places of keys and values. An unknown key is a problem.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::Problems;
use crate::text::did_you_mean;

/// A value with its place.
pub type Value<'i> = Spanned<DeValue<'i>>;

/// A table with its place.
#[derive(Debug)]
pub struct TomlTable<'t, 'i> {
    /// The name for messages: `waypoint 3`.
    what: String,
    entries: &'t DeTable<'i>,
    span: Range<usize>,
}

impl<'t, 'i> TomlTable<'t, 'i> {
    /// Returns the table of a whole file.
    pub fn from_document(what: &str, entries: &'t DeTable<'i>, span: Range<usize>) -> Self {
        Self { what: what.to_owned(), entries, span }
    }

    /// Returns the name for messages.
    pub fn what(&self) -> &str {
        &self.what
    }

    /// Returns the byte range of the table in the text.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Returns the keys with their places, in alphabetical order.
    pub fn keys(&self) -> impl Iterator<Item = (&'t str, Range<usize>, &'t Value<'i>)> {
        self.entries.iter().map(|(key, value)| (key.get_ref().as_ref(), key.span(), value))
    }

    /// Returns the value as a table, or adds a problem.
    pub fn new(what: String, value: &'t Value<'i>, problems: &mut Problems<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::Table(entries) => Some(Self { what, entries, span: value.span() }),
            other => {
                problems.add(value.span(), format!("{what} is a {}, not a table", other.type_str()), "");
                None
            }
        }
    }

    /// Returns a key and its value.
    fn entry(&self, key: &str) -> Option<(&'t Spanned<DeString<'i>>, &'t Value<'i>)> {
        self.entries.iter().find(|(name, _)| name.get_ref() == key)
    }

    /// Returns the value of a key.
    pub fn get(&self, key: &str) -> Option<&'t Value<'i>> {
        self.entry(key).map(|(_, value)| value)
    }

    /// Returns the value of a required key.
    pub fn required(&self, key: &str, problems: &mut Problems<'_>) -> Option<&'t Value<'i>> {
        let value = self.get(key);
        if value.is_none() {
            problems.add(
                self.span.clone(),
                format!("{key} is missing in {}", self.what),
                format!("add {key} = …"),
            );
        }
        value
    }

    /// Returns the text of a key.
    pub fn string(&self, key: &str, problems: &mut Problems<'_>) -> Option<String> {
        let value = self.get(key)?;
        let text = value.get_ref().as_str();
        if text.is_none() {
            problems.add(value.span(), format!("{key} is not a text"), format!("write {key} = \"…\""));
        }
        text.map(str::to_owned)
    }

    /// Adds a problem for each key that is not in `known`.
    pub fn refuse_unknown(&self, known: &'static [&'static str], problems: &mut Problems<'_>) {
        for (key, _) in self.entries.iter() {
            let name = key.get_ref();
            if !known.contains(&name.as_ref()) {
                problems.add(
                    key.span(),
                    format!("{name} is not a key of {}", self.what),
                    did_you_mean::hint(name, known.iter().copied()),
                );
            }
        }
    }
}
