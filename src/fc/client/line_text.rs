//! The text of command lines and of their output.

use super::Answer;

/// The last word in the output of a flight controller that restarts.
const REBOOTING: &str = "Rebooting";
/// Lines that restart the flight controller or start its boot loader.
const RESTARTING: [&str; 7] = ["save", "exit", "defaults", "reboot", "bl", "dfu", "msc"];
/// The start of an error at the prompt, and the answer to an unknown word between STX and ETX.
const ERRORS: [&str; 2] = ["###ERROR", "ERR_CMD_NA"];

/// Returns a line as it is sent. Control characters and characters outside ASCII are removed: they would be
/// dropped or mean something else.
pub fn printable(line: &str) -> String {
    let printable: String = line.chars().filter(|letter| matches!(letter, ' '..='~')).collect();
    printable.trim().to_owned()
}

/// Returns `true` if a line is empty or only a comment.
pub(super) fn is_empty(line: &str) -> bool {
    let line = printable(line);
    line.is_empty() || line.starts_with('#')
}

/// Returns `true` if a line is meant to end in a restart.
pub(super) fn restarts(line: &str) -> bool {
    let mut words = line.split_ascii_whitespace();
    let restarting =
        words.next().is_some_and(|first| RESTARTING.iter().any(|word| first.eq_ignore_ascii_case(word)));
    restarting
        && !words.any(|word| word.eq_ignore_ascii_case("noreboot") || word.eq_ignore_ascii_case("nosave"))
}

/// Returns `true` if an output ends in the announcement of a restart.
pub(super) fn announces_restart(text: &str) -> bool {
    text.trim_end().ends_with(REBOOTING)
}

/// Returns `true` if an output reports an error.
pub(super) fn tells_of_error(text: &str) -> bool {
    ERRORS.iter().any(|error| text.contains(error))
}

/// Turns an output into an answer.
pub(super) fn answer(text: String, restarted: bool) -> Answer {
    let failed = tells_of_error(&text);
    Answer::Line { text, failed, restarted }
}
