//! The file of the state directory with the layouts that the user saved. A line is appended for each change, so that
//! programs that run at the same time lose no layout.
#![allow(clippy::disallowed_methods, reason = "the shell of the user interface reads and writes files")]

use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::storage::state_file::{self, Access};
use crate::ui::SavedLayouts;

/// The name of the file.
const NAME: &str = "layouts.jsonl";
/// The largest file that is read, bytes: some thousand changes.
const LARGEST: u64 = 1 << 20;
/// The most lines that a sentence names.
const NAMED_LINES: usize = 5;

/// The file, if there is a state directory.
#[derive(Debug, Clone)]
pub(crate) struct LayoutFile(Option<PathBuf>);

impl LayoutFile {
    pub(crate) fn new(state: Option<&Path>) -> Self {
        Self(state.map(|state| state.join(NAME)))
    }

    /// Reads the layouts. A file that cannot be read, or only in part, is a sentence for `notices`.
    pub(crate) fn read(&self, notices: &mut Vec<String>) -> SavedLayouts {
        let Some(path) = &self.0 else { return SavedLayouts::default() };
        match state_file::read(path, LARGEST) {
            Ok(contents) => {
                let text = String::from_utf8_lossy(contents.as_deref().unwrap_or_default());
                let (layouts, left_out) = SavedLayouts::from_lines(&text);
                notices.extend(in_part(path, &left_out));
                layouts
            }
            Err(error) => {
                notices
                    .push(format!("Saved layouts are unknown: {} cannot be read: {error}.", path.display()));
                SavedLayouts::default()
            }
        }
    }

    /// Appends a line. The error is a sentence.
    pub(crate) fn append(&self, line: &str) -> Result<(), String> {
        let Some(path) = &self.0 else {
            return Err("The layout is kept for this run only: there is no state directory.".to_owned());
        };
        let opened = state_file::open(path, Access::AppendOrCreate);
        // A single write is not mixed with the lines of another program. The line break before it ends a torn line.
        let written = opened.and_then(|mut file| file.write_all(format!("\n{line}\n").as_bytes()));
        written.map_err(|error| {
            format!("The layout is kept for this run only: {} cannot be written: {error}.", path.display())
        })
    }
}

/// Returns the sentence about the lines that are left out; `None` if there are none.
fn in_part(path: &Path, left_out: &[usize]) -> Option<String> {
    let named: Vec<String> = left_out.iter().take(NAMED_LINES).map(ToString::to_string).collect();
    let more = left_out.len() - named.len();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let lines = match left_out {
        [] => return None,
        [_] => format!("Line {} of {} is", named.concat(), path.display()),
        _ => format!("Lines {}{more} of {} are", named.join(", "), path.display()),
    };
    Some(format!(
        "{lines} no layout that can be read. All other layouts are there, and the file stays as it is."
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_appended_even_after_a_torn_one_and_read_again() {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join(NAME), "{\"name\": \"torn").unwrap();
        let file = LayoutFile::new(Some(directory.path()));
        file.append(r#"{"name": "mine", "layout": {}}"#).unwrap();
        file.append(r#"{"name": "wide", "layout": {}}"#).unwrap();
        let mut notices = Vec::new();
        let layouts = file.read(&mut notices);
        let lines = "{\"name\":\"mine\",\"layout\":{}}\n{\"name\":\"wide\",\"layout\":{}}";
        assert_eq!((layouts, Vec::new()), SavedLayouts::from_lines(lines));
        let path = directory.path().join(NAME).display().to_string();
        let stays = "All other layouts are there, and the file stays as it is.";
        assert_eq!(notices, [format!("Line 1 of {path} is no layout that can be read. {stays}")]);
    }

    #[test]
    fn a_file_of_damaged_lines_is_one_sentence_with_the_first_numbers() {
        let directory = tempfile::tempdir().unwrap();
        let file = LayoutFile::new(Some(directory.path()));
        let mut notices = Vec::new();
        file.read(&mut notices);
        file.append(r#"{"name": "mine", "layout": {}}"#).unwrap();
        file.read(&mut notices);
        assert_eq!(notices, [""; 0], "neither a missing file nor an empty line is a fault");
        std::fs::write(directory.path().join(NAME), "{\n".repeat(900)).unwrap();
        file.read(&mut notices);
        assert!(notices[0].starts_with("Lines 1, 2, 3, 4, 5 and 895 more of "), "{notices:?}");
        assert!(notices[0].contains(" are no layout"), "{notices:?}");
    }

    #[test]
    fn a_file_that_cannot_be_used_is_reported_and_stays() {
        let directory = tempfile::tempdir().unwrap();
        std::fs::create_dir(directory.path().join(NAME)).unwrap();
        let file = LayoutFile::new(Some(directory.path()));
        let mut notices = Vec::new();
        assert_eq!(file.read(&mut notices), SavedLayouts::default());
        assert!(notices[0].contains("cannot be read"), "{notices:?}");
        assert!(file.append("{}").unwrap_err().contains("for this run only"));
        assert!(LayoutFile::new(None).append("{}").unwrap_err().contains("no state directory"));
    }
}
