//! Configures a remote flight controller with command lines: compares them with its state, writes the
//! differences, saves, and compares again.
//!
//! ```text
//! look ─▶ nothing differs ───────────────────────────────▶ done
//!      ─▶ it may not be written: report the differences ─▶ done
//!      ─▶ write ─▶ save ─▶ restart ─▶ look again ──────────▶ done
//! ```
//!
//! If it is unknown whether it was ever configured, its configuration is first checked for changes.

mod held;
mod lines;
mod report;
#[cfg(test)]
mod tests;
mod wish;

use std::collections::VecDeque;
use std::path::PathBuf;

use held::{Held, Question};
pub use lines::ProvisionLines;
use report::{ProvisionReport, RefusedLine};
pub use report::{Unset, UnsetLine};
use wish::Wish;

use crate::fc::client::{Answer, Ask, Unanswered};

/// The line that stores the written settings and restarts.
const SAVE: &str = "save";
/// The firmware's answer for a setting that it does not have.
const UNKNOWN_NAME: &str = "INVALID NAME";
/// The number of lost connections after which the procedure no longer starts again.
const MAX_LOST: usize = 3;

/// The configuration of one flight controller.
#[derive(Debug, Clone)]
pub struct Provision {
    lines: ProvisionLines,
    wishes: Vec<Wish>,
    may_write: bool,
    phase: Phase,
    /// The last question or line without an answer yet.
    asked: Option<Asked>,
    held: Held,
    report: ProvisionReport,
    restarted: bool,
    /// The settings that replace the guide's.
    replaced: Vec<String>,
    /// The lines for a flight controller whose configuration was never changed, until that is known.
    when_bare: Option<ProvisionLines>,
    was_bare: bool,
    /// A file to be written after success, with its contents.
    pub(super) note: Option<(PathBuf, String)>,
    /// The number of connections that were lost before it was written.
    lost: usize,
}

#[derive(Debug, Clone)]
enum Phase {
    /// Reading the remaining answers; `written` is `true` after the settings were written.
    Look {
        left: VecDeque<Question>,
        written: bool,
    },
    /// Writing the remaining wishes, by number.
    Write {
        left: VecDeque<usize>,
    },
    Restart,
    /// Finished, or given up for this reason.
    Done(Result<(), String>),
}

#[derive(Debug, Clone)]
enum Asked {
    Question(Question),
    Wish(usize),
    Save,
}

impl Provision {
    /// Applies these command lines. Without `may_write` they are only compared with the flight controller's
    /// state. Comments, `save` and batches are skipped.
    pub fn new(lines: ProvisionLines, may_write: bool) -> Self {
        let wishes = wish::wishes(lines.in_order());
        let left = held::questions(&wishes);
        Self {
            lines,
            wishes,
            may_write,
            phase: Phase::Look { left, written: false },
            asked: None,
            held: Held::default(),
            report: ProvisionReport::default(),
            restarted: false,
            replaced: Vec::new(),
            when_bare: None,
            was_bare: false,
            note: None,
            lost: 0,
        }
    }

    /// Applies these lines instead if nothing was ever changed in the configuration. They may be written. Use
    /// this if it is unknown whether the flight controller was configured before.
    pub fn or_when_bare(mut self, lines: ProvisionLines) -> Self {
        self.when_bare = Some(lines);
        self.begin();
        self
    }

    /// Has these words written to `file` after success.
    pub fn noted_in(mut self, file: PathBuf, words: String) -> Self {
        self.note = Some((file, words));
        self
    }

    /// Adapts the lines to a flight controller that falls in LAND with the guide's altitude gains.
    pub(super) fn replace_settings(&mut self) {
        let replaced = self.lines.replace_settings();
        if replaced.is_empty() {
            return;
        }
        self.wishes = wish::wishes(self.lines.in_order());
        let is_wished = |setting: &String| {
            self.wishes.iter().any(|wish| wish.line().strip_prefix("set ") == Some(setting.as_str()))
        };
        self.replaced = replaced.into_iter().filter(is_wished).collect();
    }

    /// Returns the next request; `None` while an answer or a restart is pending, and at the end.
    pub(super) fn next(&mut self) -> Option<Ask> {
        if self.asked.is_some() {
            return None;
        }
        loop {
            let asked = match &mut self.phase {
                Phase::Restart | Phase::Done(_) => return None,
                Phase::Look { left, .. } => left.pop_front().map(Asked::Question),
                Phase::Write { left } => Some(left.pop_front().map_or(Asked::Save, Asked::Wish)),
            };
            match asked {
                Some(asked) => {
                    let line = self.line_of(&asked);
                    self.asked = Some(asked);
                    return Some(Ask::Line(line));
                }
                None => self.conclude(),
            }
        }
    }

    /// Takes the answer to the last request.
    pub(super) fn take(&mut self, answer: &Answer) {
        let Some(asked) = self.asked.take() else { return };
        if let (Answer::NotAnswered(Unanswered::LinkLost), true) = (answer, self.lost < MAX_LOST) {
            self.lost += 1;
            return self.begin();
        }
        let Answer::Line { text, failed, restarted } = answer else {
            if let Asked::Question(Question::Changes) = asked {
                // The flight controller stays as it is.
                return;
            }
            let why = match answer {
                Answer::NotAnswered(why) => why.to_string(),
                _ => "the flight controller's answer does not belong to this line".to_owned(),
            };
            self.phase = Phase::Done(Err(format!("`{}` was not answered: {why}", self.line_of(&asked))));
            return;
        };
        match asked {
            Asked::Question(question) => self.held.learn(question, text, *failed),
            Asked::Wish(at) if *failed => self.refused(at, text),
            Asked::Wish(_) => self.report.written += 1,
            Asked::Save if *failed => {
                self.report.refused.push(RefusedLine::new(SAVE, text));
                self.phase = Phase::Done(Ok(()));
            }
            Asked::Save if *restarted => {
                self.restarted = true;
                self.phase = Phase::Restart;
            }
            Asked::Save => self.look_again(),
        }
    }

    /// Continues after the flight controller has restarted and answers again.
    pub(super) fn reconnected(&mut self) {
        if let Phase::Restart = self.phase {
            self.look_again();
        }
    }

    /// Returns the report at the end, or the reason for a failure as part of a sentence.
    pub(super) fn result(&self) -> Option<Result<&ProvisionReport, &str>> {
        match &self.phase {
            Phase::Done(Ok(())) => Some(Ok(&self.report)),
            Phase::Done(Err(why)) => Some(Err(why)),
            Phase::Look { .. } | Phase::Write { .. } | Phase::Restart => None,
        }
    }

    /// Returns `true` if something was written without a restart, so that the known settings are outdated.
    pub(super) fn is_changed_without_restart(&self) -> bool {
        self.report.written > 0 && !self.restarted
    }

    fn line_of(&self, asked: &Asked) -> String {
        match asked {
            Asked::Question(question) => question.line(),
            Asked::Wish(at) => self.wishes.get(*at).map_or_else(String::new, |wish| wish.line().to_owned()),
            Asked::Save => SAVE.to_owned(),
        }
    }

    fn refused(&mut self, at: usize, text: &str) {
        match &self.wishes[at] {
            Wish::Setting { name, .. } if text.contains(UNKNOWN_NAME) => self.held.is_unknown(name),
            wish => self.report.refused.push(RefusedLine::new(wish.line(), text)),
        }
    }

    /// Starts from the beginning. Lines that were written but not saved are lost.
    fn begin(&mut self) {
        self.report = ProvisionReport { was_bare: self.was_bare, ..ProvisionReport::default() };
        let left = match self.when_bare {
            Some(_) => VecDeque::from([Question::Changes]),
            None => held::questions(&self.wishes),
        };
        self.phase = Phase::Look { left, written: false };
    }

    fn look_again(&mut self) {
        self.phase = Phase::Look { left: held::questions(&self.wishes), written: true };
    }

    /// Evaluates the answers once all questions are answered.
    fn conclude(&mut self) {
        if let Some(lines) = self.when_bare.take() {
            if self.held.is_bare() {
                self.wishes = wish::wishes(lines.in_order());
                self.lines = lines;
                self.may_write = true;
                self.was_bare = true;
            }
            return self.begin();
        }
        self.report.unknown = self.held.unknown(&self.wishes);
        self.report.replaced.clone_from(&self.replaced);
        self.report.differences = self.held.differences(&self.wishes);
        let Phase::Look { written, .. } = self.phase else { return };
        let must_write = !self.report.differences.is_empty() || self.wishes.iter().any(Wish::cannot_be_read);
        self.phase = if written || !must_write || !self.may_write {
            Phase::Done(Ok(()))
        } else {
            let known = |at: &usize| !self.held.has_not(&self.wishes[*at]);
            Phase::Write { left: (0..self.wishes.len()).filter(known).collect() }
        };
        self.report.may_not_write = !written && must_write && !self.may_write;
    }
}
