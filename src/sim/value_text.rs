//! The common parts of the parsers of the world's command-line values: the error and the reading of numbers.

/// A value that cannot be read: its meaning, the text, and the problem.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} {text:?}: {problem}")]
pub struct ParseError {
    what: &'static str,
    text: String,
    problem: String,
}

impl ParseError {
    pub(super) fn new(what: &'static str, text: &str, problem: impl Into<String>) -> Self {
        Self { what, text: text.to_owned(), problem: problem.into() }
    }

    /// Returns the problem, for a message that already shows the text.
    pub fn problem(&self) -> &str {
        &self.problem
    }
}

/// Reads a finite number. The error describes the problem.
pub(super) fn number(name: &str, text: &str) -> Result<f64, String> {
    let text = text.trim();
    if text.is_empty() {
        return Err(format!("the {name} is missing"));
    }
    text.parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(|| format!("{name} {text} is not a number"))
}

/// Reads a finite number within limits. The error describes the problem.
pub(super) fn number_in(name: &str, text: &str, min: f64, max: f64) -> Result<f64, String> {
    let value = number(name, text)?;
    if (min..=max).contains(&value) {
        Ok(value)
    } else {
        Err(format!("{name} {value} is out of range; allowed are {min} to {max}"))
    }
}

/// Reads `on` or `off`.
pub(super) fn on_off(text: &str) -> Result<bool, String> {
    match text.trim() {
        "on" => Ok(true),
        "off" => Ok(false),
        other => Err(format!("{other} is neither on nor off")),
    }
}
