//! The context of a command handler: the interpreter's state, the vehicle, and the reply.

use std::fmt::{Display, Write as _};

use super::super::config::Configuration;
use super::{CliAction, CliFacts, CliReply, Interpreter};

/// One command in progress.
#[derive(Debug)]
pub(super) struct Session<'a> {
    pub(super) interpreter: &'a mut Interpreter,
    pub(super) configuration: &'a mut Configuration,
    pub(super) facts: &'a CliFacts,
    pub(super) command: &'static str,
    pub(super) reply: CliReply,
}

impl Session<'_> {
    /// Writes one line of the reply.
    pub(super) fn line(&mut self, text: impl Display) {
        self.raw(text);
        self.raw("\r\n");
    }

    /// Writes text without adding a line end.
    pub(super) fn raw(&mut self, text: impl Display) {
        // Writing to a string cannot fail.
        let _infallible = write!(self.reply.text, "{text}");
    }

    /// Writes a heading after an empty line.
    pub(super) fn heading(&mut self, title: impl Display) {
        self.line(format_args!("\r\n# {title}"));
    }

    pub(super) fn error(&mut self, text: impl Display) {
        let command = self.command;
        self.line(format_args!("###ERROR IN {command}: {text}###"));
        self.fail();
    }

    /// Marks the line as refused. An open batch records this.
    pub(super) fn fail(&mut self) {
        self.reply.failed = true;
        self.interpreter.note_failure();
    }

    /// Refuses the command because of its number of arguments.
    pub(super) fn wrong_count(&mut self) {
        self.error("INVALID ARGUMENT COUNT");
    }

    /// Refuses the command because of an argument that cannot be parsed.
    pub(super) fn not_understood(&mut self) {
        self.error("PARSING FAILED");
    }

    /// Returns an argument, or refuses the command if it could not be parsed.
    pub(super) fn understood<T>(&mut self, argument: Option<T>) -> Option<T> {
        if argument.is_none() {
            self.not_understood();
        }
        argument
    }

    /// Refuses the command while the craft is armed. The caller returns if this is `true`.
    pub(super) fn refused_while_armed(&mut self) -> bool {
        if self.facts.armed {
            self.error("NOT WHILE ARMED");
        }
        self.facts.armed
    }

    /// Requests an action from the owner of the firmware.
    pub(super) fn act(&mut self, action: CliAction) {
        self.reply.actions.push(action);
    }

    /// Parses an integer argument within bounds, or refuses the command with `<what> NOT BETWEEN <min> AND <max>`.
    pub(super) fn bounded(&mut self, word: &str, what: &str, min: i64, max: i64) -> Option<i64> {
        match integer(word) {
            None => self.not_understood(),
            Some(number) if (min..=max).contains(&number) => return Some(number),
            Some(_) => self.error(format_args!("{what} NOT BETWEEN {min} AND {max}")),
        }
        None
    }
}

/// Parses an optional sign followed by digits only. Numbers beyond the type saturate.
pub(super) fn integer(word: &str) -> Option<i64> {
    let (negative, digits) = match word.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, word.strip_prefix('+').unwrap_or(word)),
    };
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let size = digits
        .bytes()
        .fold(0_i64, |sum, digit| sum.saturating_mul(10).saturating_add(i64::from(digit - b'0')));
    Some(if negative { -size } else { size })
}
