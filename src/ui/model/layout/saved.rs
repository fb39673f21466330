//! The layouts that the user saved, as lines of a file. Programs that run at the same time append to it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::ui::model::layout::named::{MAX_LAYOUTS, NamedLayout, is_name};

/// The layouts that the user saved, in the order of their names.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SavedLayouts(BTreeMap<String, NamedLayout>);

/// A line of the file.
#[derive(Debug, Serialize, Deserialize)]
struct Line {
    name: String,
    /// `None` if the layout was deleted.
    layout: Option<NamedLayout>,
}

impl SavedLayouts {
    /// Reads the lines of the file. Returns the layouts, and the numbers of the lines that are left out because they are
    /// damaged or of a later version. Lines are counted from 1.
    pub fn from_lines(text: &str) -> (Self, Vec<usize>) {
        let mut layouts = Self::default();
        let mut left_out = Vec::new();
        for (number, line) in (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty()) {
            match serde_json::from_str(line) {
                Ok(Line { name, layout: None }) => drop(layouts.0.remove(&name)),
                Ok(Line { name, layout: Some(layout) }) if layouts.has_room(&name) && is_name(&name) => {
                    layouts.0.insert(name, layout);
                }
                _ => left_out.push(number),
            }
        }
        (layouts, left_out)
    }

    /// Returns `true` if a layout with this name can be saved.
    pub(in crate::ui) fn has_room(&self, name: &str) -> bool {
        self.0.len() < MAX_LAYOUTS || self.0.contains_key(name)
    }

    /// Returns the layout with this name.
    pub(in crate::ui) fn get(&self, name: &str) -> Option<&NamedLayout> {
        self.0.get(name)
    }

    /// Returns the names.
    pub(in crate::ui) fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// Saves a layout. Returns the line for the file.
    pub(in crate::ui) fn insert(&mut self, name: &str, layout: NamedLayout) -> Option<String> {
        let line = Line { name: name.to_owned(), layout: Some(layout.clone()) };
        self.0.insert(name.to_owned(), layout);
        serde_json::to_string(&line).ok()
    }

    /// Removes a layout. Returns the line for the file; `None` if there is no such layout.
    pub(in crate::ui) fn remove(&mut self, name: &str) -> Option<String> {
        self.0.remove(name)?;
        serde_json::to_string(&Line { name: name.to_owned(), layout: None }).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn saved_layouts_come_back_from_their_lines_and_deleted_ones_do_not() {
        let mut layouts = SavedLayouts::default();
        let lines = [
            layouts.insert("mine", NamedLayout::default()),
            layouts.insert("wide", NamedLayout::default()),
            layouts.remove("mine"),
        ];
        let text: String = lines.map(|line| line.expect("a line") + "\n").concat();
        assert_eq!(SavedLayouts::from_lines(&text), (layouts.clone(), Vec::new()));
        assert_eq!(layouts.names().collect::<Vec<_>>(), ["wide"]);
        assert_eq!(layouts.remove("mine"), None);
    }

    #[test]
    fn damaged_lines_and_impossible_names_are_counted_and_lose_no_other_layout() {
        let mut layouts = SavedLayouts::default();
        let line = layouts.insert("mine", NamedLayout::default()).expect("a line");
        let text = format!(
            "{}\n\u{fffd}\n{line}\n{{\"name\": \"two words\", \"layout\": {{}}}}\n{{\"name\": 3}}\n{{\"name\": \"x",
            &line[..line.len() / 2]
        );
        assert_eq!(SavedLayouts::from_lines(&text), (layouts, vec![1, 2, 4, 5, 6]));
        let many: String = (0..100).map(|n| format!("{{\"name\": \"n{n}\", \"layout\": {{}}}}\n")).collect();
        let (layouts, left_out) = SavedLayouts::from_lines(&many);
        assert_eq!((layouts.names().count(), left_out.len()), (MAX_LAYOUTS, 100 - MAX_LAYOUTS));
    }
}
