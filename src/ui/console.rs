//! The command line of the firmware, seen from the user's side: input, history, scrollback, pasted lines.

use std::collections::VecDeque;

use super::history::History;
use super::text_field::TextField;
use crate::session::command::CliOutput;

/// Lines of scrollback kept.
const MAX_SCROLLBACK: usize = 5000;

/// Completion and help, given by who knows the firmware.
#[derive(Debug, Clone, Copy)]
pub struct CliHelp {
    /// The lines that the given input may become.
    pub complete: fn(&str) -> Vec<String>,
    /// A word about the input: usage of the command, range of the setting.
    pub hint: fn(&str) -> Option<String>,
}

impl Default for CliHelp {
    /// Knows nothing.
    fn default() -> Self {
        Self { complete: |_| Vec::new(), hint: |_| None }
    }
}

/// What a line of the scrollback is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CliLineKind {
    /// What the user entered.
    Entered,
    /// What the firmware answered.
    Output,
    /// An error the firmware answered.
    Error,
    /// Said by the user interface.
    Note,
}

/// The state of the CLI panel.
#[derive(Debug, Default)]
pub struct CliState {
    /// The line being typed.
    pub input: TextField,
    /// Everything above it.
    pub lines: VecDeque<(CliLineKind, String)>,
    /// Lines scrolled up from the newest.
    pub scroll: usize,
    /// Candidates of the last completion.
    pub candidates: Vec<String>,
    /// A line is being run.
    pub waiting: bool,
    queue: VecDeque<String>,
    history: History,
}

impl CliState {
    /// Takes the input as a line to run.
    pub fn enter(&mut self) {
        let line = self.input.take();
        self.candidates.clear();
        self.scroll = 0;
        self.history.remember(&line);
        self.queue.push_back(line);
    }

    /// The next line to run, if the firmware is free.
    pub fn next_to_run(&mut self) -> Option<String> {
        if self.waiting {
            return None;
        }
        let line = self.queue.pop_front()?;
        self.waiting = true;
        self.push(CliLineKind::Entered, line.clone());
        Some(line)
    }

    /// Lines not run yet.
    #[must_use]
    pub fn queued(&self) -> usize {
        self.queue.len()
    }

    /// Takes the answer of the line that was run.
    pub fn answer(&mut self, output: Option<&CliOutput>) {
        self.waiting = false;
        let Some(output) = output else {
            self.push(CliLineKind::Note, "no answer: the firmware went away".to_owned());
            self.queue.clear();
            return;
        };
        for line in output.text.trim_end().lines() {
            let clean: String = line.trim_end().chars().filter(|c| !c.is_control()).collect();
            let kind = if clean.starts_with("###ERROR") { CliLineKind::Error } else { CliLineKind::Output };
            self.push(kind, clean);
        }
        if let Some(advice) = &output.advice {
            self.push(CliLineKind::Note, advice.clone());
        }
        if output.restarted {
            self.push(CliLineKind::Note, "the firmware restarted".to_owned());
        }
    }

    fn push(&mut self, kind: CliLineKind, text: String) {
        if self.lines.len() == MAX_SCROLLBACK {
            self.lines.pop_front();
        }
        self.lines.push_back((kind, text));
    }

    /// Takes pasted text: every complete line is queued, the rest stays in the input.
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

    /// Throws the input and all queued lines away; whether there was anything.
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

    /// Recalls a newer line, in the end the one being typed.
    pub fn newer(&mut self) {
        if let Some(line) = self.history.newer() {
            self.input = TextField::new(line);
        }
    }

    /// Extends the input as far as all completions agree, and lists them when they do not.
    pub fn complete(&mut self, help: CliHelp) {
        let candidates = (help.complete)(self.input.value());
        let Some(first) = candidates.first() else {
            self.candidates.clear();
            return;
        };
        let mut common = first.as_str();
        for candidate in &candidates {
            let shared = common
                .char_indices()
                .zip(candidate.chars())
                .find(|((_, a), b)| !a.eq_ignore_ascii_case(b))
                .map_or(common.len().min(candidate.len()), |((at, _), _)| at);
            common = common.get(..shared).unwrap_or(common);
        }
        if common.len() >= self.input.value().len() {
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
            hint: |_| None,
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
