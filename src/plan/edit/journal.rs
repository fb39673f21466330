//! A history as lines of JSON, one an action: what is appended to a file survives the program.

use serde::{Deserialize, Serialize};

use super::{Change, History, PlanDocument};
use crate::plan::format::{self, Format, PlanFile};

/// One line of a journal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum JournalLine {
    /// The document as it was opened: the first line.
    Opened {
        /// Its file, if it has one.
        file: Option<String>,
        /// The document as TOML.
        text: String,
        /// The file holds it.
        saved: bool,
    },
    /// An edit.
    Edited {
        /// What was done.
        label: String,
        /// What changed.
        change: Box<Change>,
    },
    /// Undo, redo or a jump, to this revision.
    Moved(usize),
    /// The document of now was written to this file.
    Saved(String),
    /// The file of the document no longer holds it.
    Unsaved,
}

impl JournalLine {
    /// The first line of a document.
    #[must_use]
    pub fn opened(document: &PlanDocument, file: Option<String>, saved: bool) -> Self {
        let text = format::write(&PlanFile::from(document.clone()), Format::Toml).text;
        Self::Opened { file, text, saved }
    }

    /// The line, with its line end.
    #[must_use]
    pub fn to_text(&self) -> String {
        // Plain data with text keys always has a JSON form.
        serde_json::to_string(self).map(|line| line + "\n").unwrap_or_default()
    }
}

/// What a journal holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Journal {
    /// The file of the document, if it has one.
    pub file: Option<String>,
    /// The document and its history.
    pub history: History,
}

impl Journal {
    /// The lines that read as this journal.
    #[must_use]
    pub fn lines(&self) -> Vec<JournalLine> {
        let Self { file, history } = self;
        let mut lines = vec![JournalLine::opened(history.base(), file.clone(), history.saved() == Some(0))];
        let mut at = 0;
        for (number, revision) in (1..).zip(history.revisions()) {
            if revision.parent() != at {
                lines.push(JournalLine::Moved(revision.parent()));
            }
            let (label, change) = (revision.label().to_owned(), Box::new(revision.change().clone()));
            lines.push(JournalLine::Edited { label, change });
            if history.saved() == Some(number) {
                lines.push(JournalLine::Saved(file.clone().unwrap_or_default()));
            }
            at = number;
        }
        if history.saved().is_none() {
            lines.push(JournalLine::Unsaved);
        }
        if history.at() != at {
            lines.push(JournalLine::Moved(history.at()));
        }
        lines
    }

    /// Reads a journal. A line that was cut short, and whatever follows, is left out; `None` when not even the first
    /// line makes sense.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let mut lines = text.lines().map_while(|line| serde_json::from_str(line).ok());
        let JournalLine::Opened { file, text, saved } = lines.next()? else { return None };
        let document = format::parse("", &text, Format::Toml).ok()?.into();
        let mut journal = Self { file, history: History::new(document, saved) };
        // The rest counts from a document that is not this one.
        while lines.next().is_some_and(|line| journal.take(line)) {}
        Some(journal)
    }

    /// Takes a line in; whether it fits.
    pub fn take(&mut self, line: JournalLine) -> bool {
        match line {
            JournalLine::Opened { .. } => return false,
            JournalLine::Edited { label, change } => {
                return self.history.commit_change(label, &change).is_some();
            }
            JournalLine::Moved(revision) => return self.history.go_to(revision),
            JournalLine::Saved(file) => {
                self.file = Some(file);
                self.history.mark_saved();
            }
            JournalLine::Unsaved => self.history.mark_unsaved(),
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Waypoint;
    use proptest::prelude::*;

    fn document(alts: &[i32]) -> PlanDocument {
        let mut document = PlanDocument { name: "test".to_owned(), ..PlanDocument::default() };
        document.plan.waypoints =
            alts.iter().map(|&alt_cm| Waypoint { alt_cm, ..Waypoint::default() }).collect();
        document
    }

    proptest! {
        #[test]
        fn a_journal_cut_anywhere_gives_the_history_up_to_there(
            steps in prop::collection::vec((0_u8..4, prop::collection::vec(0_i32..5, 0..5)), 0..12),
            cut in 0.0..1.0_f64,
        ) {
            let mut history = History::new(document(&[1]), true);
            let mut text = JournalLine::opened(history.document(), Some("a.toml".to_owned()), true).to_text();
            let mut known = vec![(text.len(), history.clone())];
            for (kind, alts) in steps {
                let line = match kind {
                    0 => history.undo().is_some().then(|| JournalLine::Moved(history.at())),
                    1 => {
                        history.mark_saved();
                        Some(JournalLine::Saved("a.toml".to_owned()))
                    }
                    _ => history.commit("edit", document(&alts)).map(|revision| JournalLine::Edited {
                        label: revision.label().to_owned(),
                        change: Box::new(revision.change().clone()),
                    }),
                };
                text.extend(line.iter().map(JournalLine::to_text));
                known.push((text.len(), history.clone()));
            }
            let cut = (cut * text.len() as f64) as usize;
            let expected = known.iter().rev().find(|(end, _)| *end <= cut + 1);
            match (Journal::read(&text[..cut]), expected) {
                (Some(journal), Some((_, history))) => {
                    prop_assert_eq!(journal.history.document(), history.document());
                    prop_assert_eq!(journal.history.is_saved(), history.is_saved());
                }
                (read, expected) => prop_assert!(read.is_none() && expected.is_none()),
            }
        }
    }

    #[test]
    fn a_journal_is_written_as_it_was_read() {
        let mut history = History::new(document(&[1]), true);
        history.commit("a", document(&[1, 2]));
        history.mark_saved();
        history.undo();
        history.commit("b", document(&[3]));
        history.undo();
        for history in [history, History::new(document(&[]), false)] {
            let journal = Journal { file: Some("a.toml".to_owned()), history };
            let text: String = journal.lines().iter().map(JournalLine::to_text).collect();
            let read = Journal::read(&text).unwrap();
            assert_eq!(read.lines(), journal.lines());
            assert_eq!(read.history.document(), journal.history.document());
        }
    }

    #[test]
    fn what_is_no_journal_is_none() {
        for text in ["", "{}", "name = \"x\"", "{\"moved\":3}\n"] {
            assert_eq!(Journal::read(text), None, "{text}");
        }
    }
}
