//! The problems of an airframe file, line by line.

use std::fmt;

use crate::text::source_snippet::SourceSnippet;

/// One problem of an airframe file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AirframeProblem {
    /// Line, starting at 1.
    pub line: usize,
    /// Column in characters, starting at 1.
    pub column: usize,
    /// The line, or the part of it around the problem.
    pub source: SourceSnippet,
    /// The problem, as a sentence without its full stop.
    pub text: String,
}

impl fmt::Display for AirframeProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}:{}: {}", self.line, self.column, self.text)?;
        writeln!(f, "  {}", self.source.text)?;
        write!(f, "  {:>width$}", "^", width = self.source.column)
    }
}

/// All problems of an airframe file. `Display` gives them as `LINE:COLUMN: …`, each with its line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AirframeFileError {
    /// At least one problem, in the order of the keys.
    pub problems: Vec<AirframeProblem>,
    /// Number of problems that are not listed.
    pub unlisted: usize,
}

impl AirframeFileError {
    /// Returns the problems as `FILE:LINE:COLUMN: …`, each with its line.
    pub fn in_file(&self, file: &str) -> String {
        self.lines(|problem| format!("{file}:{problem}"))
    }

    fn lines(&self, line: impl Fn(&AirframeProblem) -> String) -> String {
        let mut lines: Vec<String> = self.problems.iter().map(line).collect();
        if self.unlisted > 0 {
            let problems = if self.unlisted == 1 { "problem" } else { "problems" };
            lines.push(format!("and {} more {problems}", self.unlisted));
        }
        lines.join("\n")
    }
}

impl fmt::Display for AirframeFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.lines(ToString::to_string))
    }
}

impl std::error::Error for AirframeFileError {}
