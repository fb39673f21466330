//! Problems of a file with their places, collected so that all of them are reported at once.

use std::fmt;
use std::ops::Range;

use crate::text::source_snippet::{SourceSnippet, shortened, source_snippet};

/// The most problems of a file that are listed; the others are counted.
const MAX_LISTED: usize = 100;

/// The size of a block of the text whose line ends are counted together.
const BLOCK: usize = 4096;

/// A problem of a file. `Display` is the whole report: `FILE:LINE:COLUMN: MESSAGE`, the line, and carets under the
/// place with the allowed values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanError {
    /// The file name as the user gave it.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The number of wrong characters that `source` shows, at least 1.
    pub width: usize,
    /// The problem, as a sentence without its full stop.
    pub message: String,
    /// The allowed values or a suggestion; may be empty.
    pub hint: String,
    /// The line, or the part of it around the place.
    pub source: SourceSnippet,
    /// The number of problems after this one that are not listed.
    pub unlisted: usize,
}

impl PlanError {
    /// Returns the message with its place in one line, without the source line.
    pub fn headline(&self) -> String {
        format!("{}:{}:{}: {}", self.file, self.line, self.column, self.message)
    }
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.line.to_string();
        let gutter = " ".repeat(number.len());
        let indent = " ".repeat(self.source.column.saturating_sub(1));
        let carets = "^".repeat(self.width);
        let hint = if self.hint.is_empty() { String::new() } else { format!(" {}", self.hint) };
        writeln!(f, "{}", self.headline())?;
        writeln!(f, "{gutter} |")?;
        writeln!(f, "{number} | {}", self.source.text)?;
        write!(f, "{gutter} | {indent}{carets}{hint}")
    }
}

impl std::error::Error for PlanError {}

/// Returns all problems as one text, with their number at the end if there are several.
pub fn report(errors: &[PlanError]) -> String {
    let mut text = errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    if errors.len() > 1 {
        let file = errors.first().map_or("", |error| error.file.as_str());
        let all = errors.iter().map(|error| 1 + error.unlisted).sum::<usize>();
        let listed =
            if all > errors.len() { format!(" ({} are shown)", errors.len()) } else { String::new() };
        text.push_str(&format!("\n{file}: {all} problems{listed}; nothing was changed"));
    }
    text
}

/// Collects the problems of one file.
#[derive(Debug)]
pub struct Problems<'a> {
    file: &'a str,
    text: &'a str,
    /// The number of line ends before each block of the text. A list of all lines could take more memory than the text.
    line_ends: Vec<u32>,
    errors: Vec<(usize, PlanError)>,
    unlisted: usize,
}

impl<'a> Problems<'a> {
    /// Creates a collection without problems; all spans refer to `text`.
    pub fn new(file: &'a str, text: &'a str) -> Self {
        let counts = text.as_bytes().chunks(BLOCK).scan(0, |count, block| {
            let before = *count;
            *count += line_ends(block) as u32;
            Some(before)
        });
        Self { file, text, line_ends: counts.collect(), errors: Vec::new(), unlisted: 0 }
    }

    /// Returns the line of a byte of the text, from 1.
    pub fn line_at(&self, at: usize) -> usize {
        let at = at.min(self.text.len());
        let block = (at / BLOCK).min(self.line_ends.len().saturating_sub(1));
        let before = self.line_ends.get(block).map_or(0, |&count| count as usize);
        before + line_ends(&self.text.as_bytes()[block * BLOCK..at]) + 1
    }

    /// Returns the first byte of a line, from 1, or the end of the text.
    fn line_start(&self, line: usize) -> usize {
        let ends = line.saturating_sub(1);
        if ends == 0 {
            return 0;
        }
        let block = self.line_ends.partition_point(|&count| (count as usize) < ends).saturating_sub(1);
        let before = self.line_ends.get(block).map_or(0, |&count| count as usize);
        let from = block * BLOCK;
        let mut found = self.text.as_bytes()[from..].iter().enumerate().filter(|&(_, &byte)| byte == b'\n');
        found.nth(ends - before - 1).map_or(self.text.len(), |(at, _)| from + at + 1)
    }

    /// Adds a problem at a byte range of the text. A range that is not on character boundaries is widened.
    pub fn add(&mut self, span: Range<usize>, message: impl Into<String>, hint: impl Into<String>) {
        if self.errors.len() == MAX_LISTED {
            self.unlisted += 1;
            return;
        }
        let start = floor_boundary(self.text, span.start);
        let line = self.line_at(start);
        let line_start = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = self.text[start..].find('\n').map_or(self.text.len(), |at| start + at);
        let end = floor_boundary(self.text, span.end.min(line_end)).max(start);
        let column = self.text[line_start..start].chars().count() + 1;
        let source = source_snippet(self.text[line_start..line_end].trim_end_matches('\r'), column);
        let shown = (source.text.chars().count() + 1).saturating_sub(source.column);
        let error = PlanError {
            file: self.file.to_owned(),
            line,
            column,
            width: self.text[start..end].trim_end().chars().count().min(shown).max(1),
            // Values of a file may have line ends; a message is one line.
            message: shortened(message.into().replace(['\n', '\r'], " ")),
            hint: hint.into(),
            source,
            unlisted: 0,
        };
        self.errors.push((start, error));
    }

    /// Adds a problem at a part of a line, counted from 1: the last occurrence of `part` before a `#` comment, or
    /// else the whole line.
    pub fn add_line_part(
        &mut self,
        line: usize,
        part: impl AsRef<str>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        let (start, end) = (self.line_start(line), self.line_start(line + 1));
        let (text, part) = (&self.text[start..end], part.as_ref());
        let code = text.split('#').next().unwrap_or(text);
        let span = code.rfind(part).map_or_else(
            || text.len() - text.trim_start().len()..text.len(),
            |found| found..found + part.len(),
        );
        self.add(start + span.start..start + span.end, message, hint);
    }

    /// Returns the number of problems so far.
    pub fn len(&self) -> usize {
        self.errors.len() + self.unlisted
    }

    /// Returns `true` if further problems are only counted.
    pub fn is_full(&self) -> bool {
        self.errors.len() == MAX_LISTED
    }

    /// Returns `true` if there is no problem so far.
    pub fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// Returns the problems in the order of their places.
    pub fn into_errors(mut self) -> Vec<PlanError> {
        self.errors.sort_by_key(|&(start, _)| start);
        if let Some((_, last)) = self.errors.last_mut() {
            last.unlisted = self.unlisted;
        }
        self.errors.into_iter().map(|(_, error)| error).collect()
    }
}

fn line_ends(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&byte| byte == b'\n').count()
}

fn floor_boundary(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_shows_line_and_caret() {
        let text = "# one\n\twaypoint insert 0 4O.46\r\nlast";
        let mut problems = Problems::new("plan.txt", text);
        let start = text.find("4O").unwrap();
        problems.add(start..start + 5, "latitude 4O.46 is not a number", "allowed: -90 to 90");
        let errors = problems.into_errors();
        assert_eq!(
            errors[0].to_string(),
            "plan.txt:2:20: latitude 4O.46 is not a number\n  |\n2 |  waypoint insert 0 4O.46\n  \
             |                    ^^^^^ allowed: -90 to 90"
        );
    }

    #[test]
    fn parts_of_lines_are_found_else_the_line_is_marked() {
        let mut problems = Problems::new("f", "one\n  two = 2 # 2\nthree");
        problems.add_line_part(2, "four", "a", "");
        problems.add_line_part(2, "2", "b", "");
        problems.add_line_part(3, "three", "c", "");
        problems.add_line_part(9, "x", "d", "");
        let errors = problems.into_errors();
        let places: Vec<_> = errors.iter().map(|e| (e.line, e.column, e.width)).collect();
        assert_eq!(places, [(2, 3, 11), (2, 9, 1), (3, 1, 5), (3, 6, 1)]);
    }

    #[test]
    fn lines_are_found_in_every_block() {
        let text: String = (0..5000).map(|at| format!("{at}\n")).collect();
        let problems = Problems::new("f", &text);
        for line in [1, 2, 700, 1200, 1201, 4999, 5000] {
            let start = problems.line_start(line);
            assert!(text[start..].starts_with(&format!("{}\n", line - 1)), "{line}");
            assert_eq!(problems.line_at(start), line);
        }
        assert_eq!((problems.line_start(5001), problems.line_start(9999)), (text.len(), text.len()));
        assert_eq!(problems.line_at(text.len() + 5), 5001);
    }

    #[test]
    fn spans_outside_the_text_do_not_panic() {
        let mut problems = Problems::new("f", "é\n");
        problems.add(1..99, "a", "");
        problems.add(50..60, "b", "");
        let errors = problems.into_errors();
        assert_eq!((errors[0].line, errors[0].column, errors[0].width), (1, 1, 1));
        assert_eq!((errors[1].line, errors[1].column), (2, 1));
        assert!(report(&errors).ends_with("f: 2 problems; nothing was changed"));
    }

    #[test]
    fn a_million_problems_in_one_long_line_are_counted_and_some_are_shown() {
        let text = "x".repeat(1_000_000);
        let mut problems = Problems::new("f", &text);
        for at in 0..text.len() {
            problems.add(at..text.len(), "a", "");
        }
        assert_eq!(problems.len(), text.len());
        let errors = problems.into_errors();
        assert_eq!(errors.len(), MAX_LISTED);
        let report = report(&errors);
        assert!(report.ends_with("f: 1000000 problems (100 are shown); nothing was changed"));
        assert!(report.len() < 100_000, "{} bytes", report.len());
    }
}
