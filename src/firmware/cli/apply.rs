//! Running the lines of a file, a paste or a list of options, with a report of those that failed.
//!
//! Lines that save, leave or restart are not run: the caller decides what happens to the configuration. `defaults`
//! resets without saving.

use super::super::config::correct;
use super::interpreter::code_of;
use super::{CliContext, CliReply, Interpreter};

/// One line that was refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FailedLine {
    /// The line number, from 1.
    pub number: usize,
    /// The line without its comment, cut to the longest line.
    pub line: String,
    /// The first line of the refusal.
    pub reason: String,
}

/// The results of running the lines.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ApplyReport {
    /// Lines that held a command.
    pub commands: usize,
    /// Lines that were refused.
    pub failed: Vec<FailedLine>,
    /// `true` if a line was refused between `batch start` and `batch end`.
    pub batch_failed: bool,
}

/// The request of one line in a file.
enum Wish<'l> {
    Nothing,
    /// The line leaves or restarts.
    Leave,
    Save,
    Run(&'l str),
}

fn wish(line: &str) -> Wish<'_> {
    let code = code_of(line);
    match code.split_ascii_whitespace().next().unwrap_or("").to_ascii_lowercase().as_str() {
        "" => Wish::Nothing,
        "save" => Wish::Save,
        "exit" | "bl" | "msc" | "reboot" => Wish::Leave,
        "defaults" => Wish::Run("defaults nosave"),
        _ => Wish::Run(code),
    }
}

impl ApplyReport {
    fn run(
        &mut self,
        number: usize,
        line: &str,
        interpreter: &mut Interpreter,
        context: &mut CliContext<'_>,
    ) -> CliReply {
        self.commands += 1;
        let reply = interpreter.run(line, context);
        if reply.failed {
            let reason = reply.text.lines().find(|line| !line.is_empty()).unwrap_or("").to_owned();
            self.failed.push(FailedLine { number, line: line.to_owned(), reason });
        }
        let ends_batch =
            line.split_ascii_whitespace().next().is_some_and(|word| word.eq_ignore_ascii_case("batch"));
        self.batch_failed |= ends_batch && reply.failed;
        reply
    }
}

/// Runs the lines in order. Passes each line that is run to `shown` with its reply.
#[doc(hidden)]
pub fn apply_lines<'l>(
    lines: impl IntoIterator<Item = &'l str>,
    interpreter: &mut Interpreter,
    context: &mut CliContext<'_>,
    mut shown: impl FnMut(&str, &CliReply),
) -> ApplyReport {
    let mut report = ApplyReport::default();
    for (at, line) in lines.into_iter().enumerate() {
        if let Wish::Run(line) = wish(line) {
            let reply = report.run(at + 1, line, interpreter, context);
            shown(line, &reply);
        }
    }
    report.batch_failed |= interpreter.batch_failed();
    report
}

/// Runs a provisioning file up to its `save` or its end, and passes the text of the session to `shown`. The
/// configuration is then ready to be stored, unless a line in a batch was refused.
#[doc(hidden)]
pub fn provision(
    file: &str,
    interpreter: &mut Interpreter,
    context: &mut CliContext<'_>,
    mut shown: impl FnMut(&str),
) -> ApplyReport {
    let mut report = ApplyReport::default();
    for (at, line) in file.lines().enumerate() {
        match wish(line) {
            Wish::Nothing | Wish::Leave => {}
            Wish::Save => break,
            Wish::Run(line) => {
                let reply = report.run(at + 1, line, interpreter, context);
                shown(&format!("{line}\r\n{}\r\n# ", reply.text));
            }
        }
    }
    report.batch_failed |= interpreter.batch_failed();
    if !report.batch_failed {
        correct(context.configuration);
    }
    report
}
