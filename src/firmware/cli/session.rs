//! What a command handler works with: the interpreter's state, the vehicle, and the reply it is writing.

use std::fmt::{Display, Write as _};

use super::super::config::Configuration;
use super::{CliAction, CliFacts, CliReply, Interpreter};

/// One command being run.
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

    /// Writes text as it is.
    pub(super) fn raw(&mut self, text: impl Display) {
        // Writing to a string cannot fail.
        let _infallible = write!(self.reply.text, "{text}");
    }

    /// Writes a heading, which stands below an empty line.
    pub(super) fn heading(&mut self, title: impl Display) {
        self.line(format_args!("\r\n# {title}"));
    }

    pub(super) fn error(&mut self, text: impl Display) {
        let command = self.command;
        self.line(format_args!("###ERROR IN {command}: {text}###"));
        self.fail();
    }

    /// Notes that the line was refused, which an open batch remembers.
    pub(super) fn fail(&mut self) {
        self.reply.failed = true;
        self.interpreter.note_failure();
    }

    /// Refuses the command for its number of arguments.
    pub(super) fn wrong_count(&mut self) {
        self.error("INVALID ARGUMENT COUNT");
    }

    /// Refuses the command for an argument that was not understood.
    pub(super) fn not_understood(&mut self) {
        self.error("PARSING FAILED");
    }

    /// Refuses the command while the craft is armed; the caller returns when this says `true`.
    pub(super) fn refused_while_armed(&mut self) -> bool {
        if self.facts.armed {
            self.error("NOT WHILE ARMED");
        }
        self.facts.armed
    }

    /// Asks the owner of the firmware for something.
    pub(super) fn act(&mut self, action: CliAction) {
        self.reply.actions.push(action);
    }

    /// Reads an integer argument within bounds, or refuses the command with `<what> NOT BETWEEN <min> AND <max>`.
    pub(super) fn bounded(&mut self, word: &str, what: &str, min: i64, max: i64) -> Option<i64> {
        match integer(word) {
            None => self.not_understood(),
            Some(number) if (min..=max).contains(&number) => return Some(number),
            Some(_) => self.error(format_args!("{what} NOT BETWEEN {min} AND {max}")),
        }
        None
    }
}

/// An optional sign and digits, nothing else; numbers beyond the type saturate.
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
