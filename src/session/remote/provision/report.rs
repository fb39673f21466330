//! What came of setting a flight controller.

use crate::session::landing_gains::landing_gains_told;

/// What came of it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct ProvisionReport {
    /// Nothing was ever changed in its configuration, so that it was set as a fresh one is.
    pub(super) was_bare: bool,
    /// Lines that were written and taken.
    pub(super) written: usize,
    /// Settings that this firmware does not have.
    pub(super) unknown: Vec<String>,
    /// Lines that it refused.
    pub(super) refused: Vec<RefusedLine>,
    /// Where it holds something else than is wanted.
    pub(super) differences: Vec<Difference>,
    /// Settings that it gets instead of the guide's, so that it lands.
    pub(super) landing_gains: Vec<String>,
    /// Something differs and nothing was written, because nobody allowed it.
    pub(super) may_not_write: bool,
}

/// A line that was refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct RefusedLine {
    /// The line.
    pub(super) line: String,
    /// What the flight controller says.
    pub(super) reason: String,
}

impl RefusedLine {
    pub(super) fn new(line: &str, output: &str) -> Self {
        let reason = output.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default();
        Self { line: line.to_owned(), reason: reason.trim_matches('#').to_owned() }
    }
}

/// Something that is held and not wanted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Difference {
    /// The line that says what is wanted.
    pub(super) line: String,
    /// What is held.
    pub(super) held: String,
}

impl ProvisionReport {
    /// Whether everything that this firmware knows is as wanted.
    #[must_use]
    pub(super) fn is_as_wanted(&self) -> bool {
        self.refused.is_empty() && self.differences.is_empty()
    }

    /// What there is to tell, as sentences; none when nothing had to be done.
    #[must_use]
    pub(super) fn sentences(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        if self.was_bare {
            sentences.push(
                "Nothing was ever changed in the firmware's configuration: it is set as a fresh one is."
                    .to_owned(),
            );
        }
        sentences.extend(landing_gains_told(&self.landing_gains).filter(|_| !self.may_not_write));
        if self.written > 0 && self.is_as_wanted() {
            sentences
                .push(format!("The firmware took {} lines of settings, read back as written.", self.written));
        } else if self.written > 0 {
            sentences.push(format!("The firmware took {} lines of settings.", self.written));
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
            let held = if held.is_empty() { "nothing" } else { held };
            format!("`{line}` is wanted, it holds {held}")
        });
        let differ: Vec<String> = differ.collect();
        if self.may_not_write {
            sentences.push(format!(
                "The firmware has a configuration, which is not changed unasked (--yes permits it): {}.",
                if differ.is_empty() { "its settings may differ".to_owned() } else { differ.join("; ") }
            ));
        } else if !differ.is_empty() {
            sentences.push(format!("Read back it differs: {}.", differ.join("; ")));
        }
        sentences
    }
}
