//! The lines that a reader skipped, for the report.

use std::fmt;

/// Skipped lines of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// The kind of the lines.
    pub kind: NoteKind,
    /// The number of lines.
    pub count: usize,
    /// The number of the first line, from 1.
    pub first_line: usize,
}

/// Kinds of skipped lines.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoteKind {
    /// A comment.
    Comment,
    /// `set …` lines: a text plan carries waypoints only.
    Setting,
    /// Other CLI commands, by name.
    Command(String),
    /// Lines with further commands, if there are many different ones.
    Others,
    /// The file has no waypoint line at all.
    NoWaypoints,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = if self.count == 1 { "line" } else { "lines" };
        let Self { count, first_line, .. } = self;
        match &self.kind {
            NoteKind::Comment => write!(f, "Skipped {count} comment {lines}"),
            NoteKind::Setting => write!(
                f,
                "Skipped {count} `set` {lines} (first: line {first_line}); a plan's text carries waypoints only: \
                 pass the file with --settings to apply them"
            ),
            NoteKind::Command(name) => {
                write!(f, "Skipped {count} `{name}` {lines} (first: line {first_line})")
            }
            NoteKind::Others => write!(f, "Skipped {count} other {lines} (first: line {first_line})"),
            NoteKind::NoWaypoints => write!(f, "The file has no `waypoint insert` line: the plan is empty"),
        }
    }
}
