//! A history as lines of JSON, one for each action. Lines that are appended to a file survive the program.

use serde::{Deserialize, Serialize};

use super::history::Revision;
use super::{Change, History, PlanDocument};
use crate::plan::format::{self, Format, PlanFile};

/// One line of a journal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum JournalLine {
    /// The opened document: the first line.
    Opened {
        /// The file of the document, if there is one.
        file: Option<String>,
        /// The document as TOML.
        text: String,
        /// `true` if the file has the document.
        saved: bool,
    },
    /// An edit of the plan.
    Edited {
        /// The edit, for people.
        label: String,
        /// The change.
        change: Box<Change>,
    },
    /// An undo, a redo or a jump to this revision.
    Moved(usize),
    /// The current document was written to this file.
    Saved(String),
    /// The file no longer has the document.
    Unsaved,
}

impl JournalLine {
    /// Returns the first line for a document.
    pub fn opened(document: &PlanDocument, file: Option<String>, saved: bool) -> Self {
        let text = format::write(&PlanFile::from(document.clone()), Format::Toml).text().into_owned();
        Self::Opened { file, text, saved }
    }

    /// Returns the line with its line end.
    pub fn to_text(&self) -> String {
        // Plain data with text keys always has a JSON form.
        serde_json::to_string(self).map(|line| line + "\n").unwrap_or_default()
    }
}

/// The unreadable part of a journal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Losses {
    /// The first line that is invalid, or does not fit the lines before it, counted from 1.
    pub line: Option<usize>,
    /// The number of edits from that line on; an invalid line counts as one.
    pub edits: usize,
    /// `true` if the plan was saved after that line. Its file is then newer than the part that was read.
    pub has_saved: bool,
    /// `true` if the last line was cut short, for example by a kill during the write.
    pub is_cut_short: bool,
}

/// The contents of a journal.
#[derive(Debug, Clone, PartialEq)]
pub struct Journal {
    /// The file of the document, if there is one.
    pub file: Option<String>,
    /// The document and its history.
    pub history: History,
}

impl Journal {
    /// Returns the lines of this journal.
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

    /// Reads a journal up to the first invalid line, and reports the losses from that line on. Returns `None` if even
    /// the first line is invalid.
    pub fn read_whole_part(text: &str) -> Option<(Self, Losses)> {
        let parse = |line: &str| serde_json::from_str::<JournalLine>(line).ok();
        let mut lines = (1..).zip(text.split_inclusive('\n'));
        let (_, first) = lines.next()?;
        let JournalLine::Opened { file, text, saved } = parse(first)? else { return None };
        let document = format::parse("", &text, Format::Toml).ok()?.into();
        let mut journal = Self { file, history: History::new(document, saved) };
        let mut losses = Losses::default();
        for (number, line) in lines {
            let parsed = parse(line);
            // The other lines are based on a document that was not read.
            if losses.line.is_none() {
                match parsed {
                    Some(parsed) if journal.take(parsed.clone()) => continue,
                    None if !line.ends_with('\n') => {
                        losses.is_cut_short = true;
                        continue;
                    }
                    _ => losses.line = Some(number),
                }
            }
            match parsed {
                Some(JournalLine::Saved(_)) => losses.has_saved = true,
                Some(JournalLine::Edited { .. }) | None => losses.edits += 1,
                Some(_) => {}
            }
        }
        Some((journal, losses))
    }

    /// Returns a journal with only the newest edits, whose lines take at most `room` bytes, and the new number of every
    /// revision. The edits before them become one.
    pub fn newest(&self, room: usize) -> (Self, Vec<Option<usize>>) {
        let size = |revision: &Revision| {
            let (label, change) = (revision.label().to_owned(), Box::new(revision.change().clone()));
            JournalLine::Edited { label, change }.to_text().len()
        };
        let (history, numbers) = self.history.newest(room, size);
        (Self { file: self.file.clone(), history }, numbers)
    }

    /// Applies a line. Returns `true` if it fits.
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
    use crate::plan::record::WaypointRecord;
    use proptest::prelude::*;

    fn document(alts: &[i32]) -> PlanDocument {
        let mut document = PlanDocument { name: "test".to_owned(), ..PlanDocument::default() };
        document.plan.waypoints = alts
            .iter()
            .map(|&alt_cm| Waypoint::from(WaypointRecord { alt_cm, ..Default::default() }))
            .collect();
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
            match (Journal::read_whole_part(&text[..cut]).map(|(journal, _)| journal), expected) {
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
            let read = Journal::read_whole_part(&text).unwrap().0;
            assert_eq!(read.lines(), journal.lines());
            assert_eq!(read.history.document(), journal.history.document());
        }
    }

    #[test]
    fn a_line_that_makes_no_sense_is_reported_with_the_edits_after_it() {
        let mut history = History::new(document(&[1]), true);
        let mut lines = vec![JournalLine::opened(history.document(), None, true).to_text()];
        for alt_cm in 2..=5 {
            let revision = history.commit("edit", document(&[alt_cm])).unwrap();
            let (label, change) = ("edit".to_owned(), Box::new(revision.change().clone()));
            lines.push(JournalLine::Edited { label, change }.to_text());
        }
        lines.push(JournalLine::Saved("a.toml".to_owned()).to_text());
        let read = |lines: &[String]| Journal::read_whole_part(&lines.concat()).unwrap();
        assert_eq!(read(&lines).1, Losses::default());
        for noise in ["noise\n", "\n", "{\"later\":1}\n", "{\"moved\":77}\n"] {
            let mut damaged = lines.clone();
            damaged[3] = noise.to_owned();
            let (journal, losses) = read(&damaged);
            assert_eq!(journal.history.document(), &document(&[3]));
            // A line that was read as a jump is not an edit.
            let edits = if noise.contains("moved") { 1 } else { 2 };
            assert_eq!(losses, Losses { line: Some(4), edits, has_saved: true, is_cut_short: false });
        }
        // With one edit missing, the next one does not fit.
        lines.remove(2);
        assert_eq!(read(&lines).1, Losses { line: Some(3), edits: 2, has_saved: true, is_cut_short: false });
        lines.truncate(2);
        lines[1].truncate(10);
        assert_eq!(read(&lines).1, Losses { is_cut_short: true, ..Losses::default() });
    }

    #[test]
    fn a_text_that_is_no_journal_gives_none() {
        for text in ["", "{}", "name = \"x\"", "{\"moved\":3}\n"] {
            assert_eq!(Journal::read_whole_part(text).map(|(journal, _)| journal), None, "{text}");
        }
    }
}
