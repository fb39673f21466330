//! Saving, leaving, resetting and batches.

use super::CliAction;
use super::session::Session;
use super::state::{Batch, CliMode};
use crate::firmware::config::correct;
use crate::firmware::settings::Scope;

const REVIEW: &str = "ERRORS WERE DETECTED - PLEASE REVIEW BEFORE CONTINUING";

/// Returns `true` if the command's single optional word was given. Refuses any other word and returns `None`.
fn flag(session: &mut Session<'_>, rest: &str, word: &str) -> Option<bool> {
    if rest.is_empty() || rest.eq_ignore_ascii_case(word) {
        return Some(!rest.is_empty());
    }
    session.not_understood();
    None
}

/// Ends the session with a restart, as far as the link allows it.
fn restart(session: &mut Session<'_>) {
    match session.interpreter.mode {
        CliMode::Interactive | CliMode::File => {
            session.raw("\r\nRebooting");
            session.act(CliAction::Restart { close_links: true });
        }
        CliMode::Framed => session.act(CliAction::Restart { close_links: false }),
        CliMode::Message => {}
    }
}

/// Requests that the configuration is stored. Refuses and returns `false` if it cannot be stored.
fn store(session: &mut Session<'_>) -> bool {
    if let Some(refusal) = session.facts.storage.save_refusal.clone() {
        session.error(refusal);
        return false;
    }
    correct(session.configuration);
    session.act(CliAction::Save);
    true
}

/// `save [noreboot]`.
pub(super) fn save(session: &mut Session<'_>, rest: &str) {
    if session.refused_while_armed() {
        return;
    }
    let Some(noreboot) = flag(session, rest, "noreboot") else { return };
    if std::mem::take(&mut session.interpreter.batch) == Batch::Failed {
        session.error(REVIEW);
        session.error("PLEASE FIX ERRORS THEN 'SAVE'");
        return;
    }
    if !store(session) {
        return;
    }
    session.heading("saving");
    if !noreboot {
        restart(session);
    }
}

/// `exit [noreboot]`.
pub(super) fn exit(session: &mut Session<'_>, rest: &str) {
    if session.refused_while_armed() {
        return;
    }
    let Some(noreboot) = flag(session, rest, "noreboot") else { return };
    if matches!(session.interpreter.mode, CliMode::Framed | CliMode::Message) {
        return;
    }
    session.interpreter.batch = Batch::Closed;
    if noreboot {
        session.heading("leaving CLI mode, no reboot");
        session.act(CliAction::Leave);
    } else {
        session.heading("leaving CLI mode, unsaved changes lost");
        restart(session);
    }
}

/// `reboot`: restarts; unsaved changes are lost.
pub(super) fn reboot(session: &mut Session<'_>, _rest: &str) {
    if !session.refused_while_armed() {
        restart(session);
    }
}

/// `bl [rom]`: restarts, because there is no boot loader to enter.
pub(super) fn bl(session: &mut Session<'_>, rest: &str) {
    if session.refused_while_armed() || flag(session, rest, "rom").is_none() {
        return;
    }
    session.heading("restarting in ROM bootloader mode");
    restart(session);
}

/// `defaults [nosave]`.
pub(super) fn defaults(session: &mut Session<'_>, rest: &str) {
    if session.refused_while_armed() {
        return;
    }
    if rest.split_ascii_whitespace().next().is_some_and(|word| word.eq_ignore_ascii_case("group_id")) {
        session.error("GROUPS HAVE NO NUMBERS HERE, USE 'defaults nosave'");
        return;
    }
    let Some(nosave) = flag(session, rest, "nosave") else { return };
    if !nosave && session.facts.storage.save_refusal.is_some() {
        store(session);
        return;
    }
    session.configuration.reset();
    session.interpreter.section = (Scope::Master, 0);
    session.heading("resetting to defaults");
    if nosave {
        if session.interpreter.batch == Batch::Failed {
            session.interpreter.batch = Batch::Open;
        }
    } else if store(session) {
        restart(session);
    }
}

/// `batch start | end`.
pub(super) fn batch(session: &mut Session<'_>, word: &str) {
    if word.eq_ignore_ascii_case("start") {
        session.interpreter.batch = Batch::Open;
        session.interpreter.section = (Scope::Master, 0);
        session.line("Command batch started");
    } else if word.eq_ignore_ascii_case("end") {
        if std::mem::take(&mut session.interpreter.batch) == Batch::Failed {
            session.error(REVIEW);
        } else {
            session.line("Command batch ended");
        }
    } else {
        session.error("Invalid option");
    }
}
