//! Commands of other builds. They are kept without effect in a batch or a file, and unknown at the prompt.

use super::super::config::KeptLine;
use super::session::Session;

const NAMES: &[&str] = &[
    "beacon",
    "beeper",
    "bind_rx",
    "bind_rx_spi",
    "color",
    "displayport",
    "dma",
    "escprog",
    "gyroregisters",
    "led",
    "mode_color",
    "resource",
    "sd_info",
    "servo",
    "smix",
    "timer",
    "vcd",
];

/// The prefixes of families of names.
const FAMILIES: &[&str] = &["flash_", "dshot", "vtx"];

/// Returns `true` if another build has this command.
pub(super) fn is_foreign_command(word: &str) -> bool {
    let word = word.to_ascii_lowercase();
    NAMES.contains(&word.as_str()) || FAMILIES.iter().any(|family| word.starts_with(family))
}

/// Keeps a whole command line.
pub(super) fn keep_command(session: &mut Session<'_>, word: &str, line: &str) {
    keep(session, word, String::new(), line);
}

/// Keeps a foreign setting.
pub(super) fn keep_setting(session: &mut Session<'_>, name: &'static str, value: &str) {
    keep(session, name, name.to_owned(), value);
}

fn keep(session: &mut Session<'_>, what: &str, name: String, text: &str) {
    let (scope, instance) = session.interpreter.section;
    let kept = session.configuration.kept.keep(KeptLine { scope, instance, name, text: text.to_owned() });
    if kept {
        session.line(format_args!("# {what}: not used by this vehicle, kept"));
    } else {
        session.error(format_args!("NO ROOM TO KEEP {what}"));
    }
}
