//! The user's side of the firmware's command line: input, history, scrollback, pasted lines.

use std::collections::VecDeque;

use crate::fc::Impact;
use crate::plan::format::SettingCheck;
use crate::session::command::CliOutput;
use crate::ui::completion::common_prefix;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::history::History;
use crate::ui::text_field::TextField;

/// The number of scrollback lines kept.
const MAX_SCROLLBACK: usize = 5000;

/// Completion and help, provided by the code that knows the firmware.
#[derive(Debug, Clone, Copy)]
pub struct CliHelp {
    /// Returns the possible completions of the input.
    pub complete: fn(&str) -> Vec<String>,
    /// Returns a hint about the input: usage of the command, range of the setting.
    pub hint: fn(&str) -> Option<String>,
    /// Checks that the firmware accepts a setting.
    pub check_setting: SettingCheck,
}

impl Default for CliHelp {
    fn default() -> Self {
        Self { complete: |_| Vec::new(), hint: |_| None, check_setting: |_, _| Ok(()) }
    }
}

/// The origin of a scrollback line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CliLineKind {
    /// Entered by the user.
    Entered,
    /// Answered by the firmware.
    Output,
    /// Answered by the firmware as an error.
    Error,
    /// Written by the user interface.
    Note,
}

/// A line that waits for the firmware.
#[derive(Debug)]
struct Queued {
    line: String,
    reports: bool,
}

/// The state of the CLI panel.
#[derive(Debug, Default)]
pub struct CliState {
    /// The line being typed.
    pub input: TextField,
    pub lines: VecDeque<(CliLineKind, String)>,
    /// The number of lines scrolled up from the newest.
    pub scroll: usize,
    /// Candidates of the last completion.
    pub candidates: Vec<String>,
    /// `true` while a line is being run.
    pub waiting: bool,
    queue: VecDeque<Queued>,
    /// `true` if the running line may change the craft.
    changes_craft: bool,
    /// `true` if the answer of the running line is also shown as a notice.
    reports: bool,
    history: History,
}

impl CliState {
    /// Returns a command line with the history of earlier runs.
    pub(in crate::ui) fn with_history(lines: &[String]) -> Self {
        Self { history: History::of(lines), ..Self::default() }
    }

    /// Queues the input as a line to run. Returns the line if it is new in the history.
    pub fn enter(&mut self) -> Option<String> {
        let line = self.input.take();
        self.candidates.clear();
        self.scroll = 0;
        let new = self.history.remember(&line).then(|| line.clone());
        self.queue(line, false);
        new
    }

    /// Queues a line. With `reports`, the answer is also shown as a notice.
    pub fn queue(&mut self, line: String, reports: bool) {
        self.queue.push_back(Queued { line, reports });
    }

    /// Returns the next line to run, if the firmware is free.
    pub fn next_to_run(&mut self) -> Option<String> {
        if self.waiting {
            return None;
        }
        let Queued { line, reports } = self.queue.pop_front()?;
        self.reports = reports;
        self.waiting = true;
        self.changes_craft = Impact::from_line(&line) > Impact::Reads;
        self.push(CliLineKind::Entered, line.clone());
        Some(line)
    }

    /// Returns the effect that runs the next line, if the firmware is free.
    pub(in crate::ui) fn next_effect(&mut self) -> Option<Effect> {
        self.next_to_run().map(Effect::Cli)
    }

    /// Returns the number of lines not run yet.
    pub fn queued(&self) -> usize {
        self.queue.len()
    }

    /// Returns `true` if the line that was run last may change the craft.
    pub(in crate::ui) fn changes_craft(&self) -> bool {
        self.changes_craft
    }

    /// Keeps a line that another part of the screen ran, and its answer.
    pub(in crate::ui) fn record(&mut self, line: String, output: Option<&CliOutput>) {
        self.push(CliLineKind::Entered, line);
        self.keep_answer(output);
    }

    /// Processes the answer of the line that was run. Returns the text of the notice if the answer is shown as one.
    pub fn answer(&mut self, output: Option<&CliOutput>) -> Option<(Severity, String)> {
        self.waiting = false;
        if output.is_none() {
            self.queue.clear();
        }
        let said = self.keep_answer(output);
        said.filter(|_| std::mem::take(&mut self.reports))
    }

    /// Appends an answer. Returns its text in a line.
    fn keep_answer(&mut self, output: Option<&CliOutput>) -> Option<(Severity, String)> {
        let Some(output) = output else {
            self.push(CliLineKind::Note, "no answer: the firmware went away".to_owned());
            return None;
        };
        let mut severity = Severity::Good;
        let mut said = Vec::new();
        for line in output.text.trim_end().lines() {
            let clean: String = line.trim_end().chars().filter(|c| !c.is_control()).collect();
            let is_error = clean.starts_with("###ERROR");
            if is_error {
                severity = Severity::Fault;
            }
            if !clean.is_empty() {
                said.push(clean.clone());
            }
            self.push(if is_error { CliLineKind::Error } else { CliLineKind::Output }, clean);
        }
        if let Some(advice) = &output.advice {
            said.push(advice.clone());
            self.push(CliLineKind::Note, advice.clone());
        }
        if output.restarted {
            self.push(CliLineKind::Note, "the firmware restarted".to_owned());
        }
        Some((severity, said.join(" ")))
    }

    /// Drops the line to run and all lines after it, and notes the reason.
    pub fn not_run(&mut self, why: &str) {
        self.waiting = false;
        self.reports = false;
        self.queue.clear();
        self.push(CliLineKind::Note, why.to_owned());
    }

    fn push(&mut self, kind: CliLineKind, text: String) {
        if self.lines.len() == MAX_SCROLLBACK {
            self.lines.pop_front();
        }
        self.lines.push_back((kind, text));
    }

    /// Inserts pasted text: every complete line is queued, the rest stays in the input.
    pub fn paste(&mut self, text: &str) {
        let text = text.replace("\r\n", "\n").replace('\r', "\n");
        let mut parts = text.split('\n').peekable();
        while let Some(part) = parts.next() {
            self.input.insert(part);
            if parts.peek().is_some() {
                self.enter();
            }
        }
    }

    /// Discards the input and all queued lines. Returns `true` if there was anything.
    pub fn cancel(&mut self) -> bool {
        let any = !self.input.is_empty() || !self.queue.is_empty();
        self.queue.clear();
        self.input = TextField::default();
        self.candidates.clear();
        self.history.forget_place();
        any
    }

    /// Recalls an older line.
    pub fn older(&mut self) {
        if let Some(line) = self.history.older(self.input.value()) {
            self.input = TextField::new(line);
        }
    }

    /// Recalls a newer line; after the newest, the line being typed.
    pub fn newer(&mut self) {
        if let Some(line) = self.history.newer() {
            self.input = TextField::new(line);
        }
    }

    /// Extends the input as far as all completions agree, and lists them when they do not.
    pub fn complete(&mut self, help: CliHelp) {
        let candidates = (help.complete)(self.input.value());
        let common = common_prefix(candidates.iter().map(String::as_str));
        if !candidates.is_empty() && common.len() >= self.input.value().len() {
            self.input = TextField::new(common);
        }
        self.candidates = if candidates.len() > 1 { candidates } else { Vec::new() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(cli: &mut CliState, text: &str) {
        cli.paste(text);
    }

    #[test]
    fn pasted_lines_run_one_after_the_other() {
        let mut cli = CliState::default();
        typed(&mut cli, "set a = 1\r\nset b = 2\nsa");
        assert_eq!(cli.input.value(), "sa");
        assert_eq!(cli.next_to_run().as_deref(), Some("set a = 1"));
        assert_eq!(cli.next_to_run(), None, "one line at a time");
        cli.answer(Some(&CliOutput { text: "a set to 1\r\n".to_owned(), ..CliOutput::default() }));
        assert_eq!(cli.next_to_run().as_deref(), Some("set b = 2"));
        assert!(cli.lines.contains(&(CliLineKind::Output, "a set to 1".to_owned())));
    }

    #[test]
    fn history_goes_back_and_forth_and_returns_the_draft() {
        let mut cli = CliState::default();
        for line in ["one", "two"] {
            typed(&mut cli, line);
            cli.enter();
        }
        typed(&mut cli, "dra");
        cli.older();
        cli.older();
        cli.older();
        assert_eq!(cli.input.value(), "one");
        cli.newer();
        assert_eq!(cli.input.value(), "two");
        cli.newer();
        assert_eq!(cli.input.value(), "dra");
    }

    #[test]
    fn completion_extends_to_what_all_candidates_share() {
        let help = CliHelp {
            complete: |_| vec!["set ap_position_p".to_owned(), "set ap_position_i".to_owned()],
            ..CliHelp::default()
        };
        let mut cli = CliState::default();
        typed(&mut cli, "set ap_po");
        cli.complete(help);
        assert_eq!(cli.input.value(), "set ap_position_");
        assert_eq!(cli.candidates.len(), 2);
    }

    #[test]
    fn errors_are_marked_and_cancel_empties_the_queue() {
        let mut cli = CliState::default();
        typed(&mut cli, "set x = 1\nset y = 2\n");
        cli.next_to_run();
        cli.answer(Some(&CliOutput {
            text: "###ERROR: INVALID NAME###".to_owned(),
            advice: Some("Did you mean b?".to_owned()),
            restarted: true,
        }));
        assert_eq!(cli.lines[1].0, CliLineKind::Error);
        assert_eq!(cli.lines[2].0, CliLineKind::Note);
        assert!(cli.cancel());
        assert_eq!(cli.next_to_run(), None);
    }
}
