//! Texts from files and links, before a template escapes them.

use crate::text::printable::{self, is_printable};

/// The most characters of a command.
const MAX_COMMAND: usize = 8_000;

/// Returns a line of printable text.
pub(super) fn line(text: &str) -> String {
    printable::line(text).into_owned()
}

/// Returns a command that can be pasted into a shell; `None` if it is too long, or would not be the same.
pub(super) fn command(command: &str) -> Option<&str> {
    let is_whole = command.chars().all(is_printable) && command.chars().count() <= MAX_COMMAND;
    is_whole.then_some(command)
}
