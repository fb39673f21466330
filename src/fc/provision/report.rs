//! The report on the configuration of a flight controller.

use crate::flight::setup::replaced_reported;

/// The result of the configuration.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(in crate::fc) struct ProvisionReport {
    /// `true` if nothing was ever changed in its configuration, so that it was configured like a fresh one.
    pub(super) was_bare: bool,
    /// The number of lines that were written and accepted.
    pub(super) written: usize,
    /// Settings that this firmware does not have.
    pub(super) unknown: Vec<String>,
    /// Lines that it refused.
    pub(super) refused: Vec<RefusedLine>,
    /// The differences from the wanted settings.
    pub(super) differences: Vec<Difference>,
    /// The settings that replace the guide's, so that the craft lands safely.
    pub(super) replaced: Vec<String>,
    /// `true` if there are differences and writing was not allowed.
    pub(super) may_not_write: bool,
}

/// The settings that were not applied as requested.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unset {
    /// Nothing was written, with the reason as a sentence.
    Everything(String),
    /// These lines are not in force.
    Lines(Vec<UnsetLine>),
}

/// A line that is not in force.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnsetLine {
    /// The line. For a setting that this firmware does not have, the line has no value.
    pub line: String,
    /// The firmware's refusal or current value, as part of a sentence.
    pub why: String,
}

/// A line that was refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct RefusedLine {
    pub(super) line: String,
    /// The flight controller's reason.
    pub(super) reason: String,
}

impl RefusedLine {
    pub(super) fn new(line: &str, output: &str) -> Self {
        let reason = output.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default();
        Self { line: line.to_owned(), reason: reason.trim_matches('#').to_owned() }
    }
}

/// A setting that differs from the wanted one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Difference {
    /// The line with the wanted value.
    pub(super) line: String,
    pub(super) held: String,
}

impl ProvisionReport {
    /// Returns `true` if all wishes that this firmware supports are fulfilled.
    pub(in crate::fc) fn is_as_wanted(&self) -> bool {
        self.refused.is_empty() && self.differences.is_empty()
    }

    /// Returns the wishes that are not fulfilled; `None` if there are none.
    pub(in crate::fc) fn unset(&self) -> Option<Unset> {
        if self.may_not_write {
            return Some(Unset::Everything(self.sentences().join(" ")));
        }
        let unknown = self.unknown.iter().map(|name| UnsetLine {
            line: format!("set {name}"),
            why: "this version of the firmware does not know it".to_owned(),
        });
        let refused = self.refused.iter().map(|RefusedLine { line, reason }| UnsetLine {
            line: line.clone(),
            why: format!("the firmware refused it: {reason}"),
        });
        let is_refused = |line: &String| self.refused.iter().any(|refused| refused.line == *line);
        let differ = self.differences.iter().filter(|difference| !is_refused(&difference.line));
        let differ = differ.map(|Difference { line, held }| UnsetLine {
            line: line.clone(),
            why: format!("the firmware holds {}", held_text(held)),
        });
        let lines: Vec<UnsetLine> = unknown.chain(refused).chain(differ).collect();
        (!lines.is_empty()).then_some(Unset::Lines(lines))
    }

    /// Returns the notices as sentences. There are none if nothing had to be done.
    pub(in crate::fc) fn sentences(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        if self.was_bare {
            sentences.push(
                "The firmware's configuration was never changed: it is set up like a fresh one.".to_owned(),
            );
        }
        sentences.extend(replaced_reported(&self.replaced).filter(|_| !self.may_not_write));
        if self.written > 0 && self.is_as_wanted() {
            sentences.push(format!(
                "The firmware accepted {} lines of settings, and they read back as written.",
                self.written
            ));
        } else if self.written > 0 {
            sentences.push(format!("The firmware accepted {} lines of settings.", self.written));
        }
        if !self.unknown.is_empty() {
            sentences
                .push(format!("This version of the firmware does not know {}.", self.unknown.join(", ")));
        }
        for RefusedLine { line, reason } in &self.refused {
            sentences.push(format!("The firmware refused `{line}`: {reason}."));
        }
        let differ = self.differences.iter().map(|difference| {
            let Difference { line, held } = difference;
            format!("`{line}` is required, it holds {}", held_text(held))
        });
        let differ: Vec<String> = differ.collect();
        if self.may_not_write {
            sentences.push(format!(
                "The firmware has a configuration, which is not changed without permission (--yes gives it): {}.",
                if differ.is_empty() { "its settings may differ".to_owned() } else { differ.join("; ") }
            ));
        } else if !differ.is_empty() {
            sentences.push(format!("It differs when read back: {}.", differ.join("; ")));
        }
        sentences
    }
}

fn held_text(held: &str) -> &str {
    if held.is_empty() { "nothing" } else { held }
}
