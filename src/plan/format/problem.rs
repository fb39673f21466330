//! What is wrong with a file, and where: collected, so that all problems are reported at once.

use std::fmt;
use std::ops::Range;

/// One problem of a file. `Display` is the whole report: `FILE:LINE:COLUMN: MESSAGE`, the line, and carets under the
/// place with what is allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanError {
    /// The file as the user named it.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Characters that are wrong, at least 1.
    pub width: usize,
    /// What is wrong.
    pub message: String,
    /// What is allowed or what to do; may be empty.
    pub hint: String,
    /// The text of the line, tabs replaced by spaces.
    pub source_line: String,
}

impl PlanError {
    /// The message with its place in one line, without the source line.
    #[must_use]
    pub fn headline(&self) -> String {
        format!("{}:{}:{}: {}", self.file, self.line, self.column, self.message)
    }
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.line.to_string();
        let gutter = " ".repeat(number.len());
        let indent = " ".repeat(self.column.saturating_sub(1));
        let carets = "^".repeat(self.width);
        let hint = if self.hint.is_empty() { String::new() } else { format!(" {}", self.hint) };
        writeln!(f, "{}", self.headline())?;
        writeln!(f, "{gutter} |")?;
        writeln!(f, "{number} | {}", self.source_line)?;
        write!(f, "{gutter} | {indent}{carets}{hint}")
    }
}

impl std::error::Error for PlanError {}

/// All problems as one text, with their number at the end when there are several.
#[must_use]
pub fn report(errors: &[PlanError]) -> String {
    let mut text = errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    if errors.len() > 1 {
        let file = errors.first().map_or("", |error| error.file.as_str());
        text.push_str(&format!("\n{file}: {} problems; nothing was changed", errors.len()));
    }
    text
}

/// Collects the problems of one file.
#[derive(Debug)]
pub struct Problems<'a> {
    file: &'a str,
    text: &'a str,
    errors: Vec<(usize, PlanError)>,
}

impl<'a> Problems<'a> {
    /// No problems yet; `text` is what all spans refer to.
    #[must_use]
    pub fn new(file: &'a str, text: &'a str) -> Self {
        Self { file, text, errors: Vec::new() }
    }

    /// Records a problem at a byte range of the text; ranges that are not on character boundaries are widened.
    pub fn add(&mut self, span: Range<usize>, message: impl Into<String>, hint: impl Into<String>) {
        let start = floor_boundary(self.text, span.start);
        let line_start = self.text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = self.text[start..].find('\n').map_or(self.text.len(), |i| start + i);
        let end = floor_boundary(self.text, span.end.min(line_end)).max(start);
        let shown = self.text[line_start..line_end].trim_end_matches('\r');
        let error = PlanError {
            file: self.file.to_owned(),
            line: self.text[..start].matches('\n').count() + 1,
            column: self.text[line_start..start].chars().count() + 1,
            width: self.text[start..end].trim_end().chars().count().max(1),
            message: message.into(),
            hint: hint.into(),
            source_line: shown.replace(|c: char| c.is_control(), " "),
        };
        self.errors.push((start, error));
    }

    /// How many problems there are so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.errors.len()
    }

    /// Whether no problem was found so far.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// The problems in the order of their places.
    #[must_use]
    pub fn into_errors(mut self) -> Vec<PlanError> {
        self.errors.sort_by_key(|&(start, _)| start);
        self.errors.into_iter().map(|(_, error)| error).collect()
    }
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
    fn spans_outside_the_text_do_not_panic() {
        let mut problems = Problems::new("f", "é\n");
        problems.add(1..99, "a", "");
        problems.add(50..60, "b", "");
        let errors = problems.into_errors();
        assert_eq!((errors[0].line, errors[0].column, errors[0].width), (1, 1, 1));
        assert_eq!((errors[1].line, errors[1].column), (2, 1));
        assert!(report(&errors).ends_with("f: 2 problems; nothing was changed"));
    }
}
