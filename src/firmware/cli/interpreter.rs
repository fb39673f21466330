//! One line in, one reply out.

use super::command_table::by_name;
use super::foreign::{is_foreign_command, keep_command};
use super::session::Session;
use super::state::{Batch, CliMode, Interpreter};
use super::{CliContext, CliReply, MAX_LINE, waypoint};
use crate::plan::Records;

impl Interpreter {
    /// Runs one line. Drops comments and characters beyond [`MAX_LINE`].
    pub fn run(&mut self, line: &str, context: &mut CliContext<'_>) -> CliReply {
        let line = code_of(line);
        if line.is_empty() {
            return CliReply::default();
        }
        if self.mode == CliMode::Message && ends_the_link(line) {
            return CliReply { failed: true, ..CliReply::default() };
        }
        let (word, rest) = line.split_once([' ', '\t']).unwrap_or((line, ""));
        let rest = rest.trim();
        let command = by_name(word);
        let keeps_foreign = self.batch != Batch::Closed || self.mode == CliMode::File;
        let mut session = self.begin(command.map_or("input", |command| command.name), context);
        match command {
            Some(command) => (command.run)(&mut session, rest),
            None if keeps_foreign && is_foreign_command(word) => keep_command(&mut session, word, line),
            None => unknown(&mut session, line),
        }
        session.reply
    }

    /// Stores a plan as `waypoint clear` and `waypoint insert` lines do. The reply has one line for each of them, up to
    /// the first that is refused.
    pub fn store_plan(&mut self, records: &Records, context: &mut CliContext<'_>) -> CliReply {
        let mut session = self.begin("waypoint", context);
        waypoint::store(&mut session, records);
        session.reply
    }

    fn begin<'a>(&'a mut self, command: &'static str, context: &'a mut CliContext<'_>) -> Session<'a> {
        Session {
            command,
            interpreter: self,
            configuration: context.configuration,
            facts: context.facts,
            reply: CliReply::default(),
        }
    }
}

fn unknown(session: &mut Session<'_>, line: &str) {
    if matches!(session.interpreter.mode, CliMode::Framed | CliMode::Message) {
        session.line(format_args!("ERR_CMD_NA: {line}"));
    } else {
        // The only error without a line end.
        session.raw("###ERROR IN input: UNKNOWN COMMAND, TRY 'HELP'###");
    }
    session.fail();
}

/// Returns the part of a line before its comment, without surrounding blanks, cut to the longest line. As at a prompt,
/// blanks before the first word do not count.
pub(super) fn code_of(line: &str) -> &str {
    let line = line.trim_start();
    let end = line.char_indices().nth(MAX_LINE).map_or(line.len(), |(at, _)| at);
    let line = line.get(..end).unwrap_or(line);
    line.split_once('#').map_or(line, |(code, _)| code).trim()
}

/// Returns `true` for a line (without comment) that is refused in an MSP message because it would end the link.
fn ends_the_link(line: &str) -> bool {
    let line = line.to_ascii_lowercase();
    let mut words = line.split_ascii_whitespace();
    match words.next().unwrap_or("") {
        "bl" | "msc" | "serialpassthrough" => true,
        "defaults" => !words.any(|word| word == "nosave"),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::config::Configuration;
    use super::super::{CliAction, CliFacts, StorageFacts};
    use super::*;

    fn run(line: &str, facts: &CliFacts) -> CliReply {
        let mut configuration = Configuration::default();
        Interpreter::default().run(line, &mut CliContext { configuration: &mut configuration, facts })
    }

    #[test]
    fn what_would_change_a_flying_craft_is_refused() {
        let armed = CliFacts { armed: true, ..CliFacts::default() };
        for line in [
            "save",
            "save noreboot",
            "defaults",
            "defaults nosave",
            "exit",
            "bl",
            "reboot",
            "motor 0 1100",
            "feature -GPS",
            "mixer quadp",
            "mmix reset",
            "map TAER1234",
            "serial UART2 1 115200 57600 0 115200",
            "profile 1",
        ] {
            let reply = run(line, &armed);
            let word = line.split(' ').next().expect("a word");
            assert_eq!(reply.text, format!("###ERROR IN {word}: NOT WHILE ARMED###\r\n"), "{line}");
            assert!(reply.failed && reply.actions.is_empty(), "{line}");
            assert!(!run(line, &CliFacts::default()).failed, "{line}");
        }
        for line in [
            "feature",
            "feature list",
            "mixer",
            "mixer list",
            "mmix",
            "map",
            "serial",
            "profile",
            "status",
            "dump all",
            "get ap",
            "set ap_max_angle = 20",
            "set p_roll = 50",
            "waypoint clear",
            "waypoint insert 0 1 2 3 0 LAND 0 NONE",
        ] {
            assert!(!run(line, &armed).failed, "{line}");
        }
    }

    #[test]
    fn a_store_that_cannot_save_says_so_and_nothing_restarts() {
        let storage =
            StorageFacts { save_refusal: Some("the file is not ours".to_owned()), ..StorageFacts::default() };
        let facts = CliFacts { storage, ..CliFacts::default() };
        for line in ["save", "save noreboot", "defaults"] {
            let word = line.split(' ').next().expect("a word");
            let reply = run(line, &facts);
            assert_eq!(reply.text, format!("###ERROR IN {word}: the file is not ours###\r\n"));
            assert_eq!(reply.actions, []);
        }
        let restart = CliAction::Restart { close_links: true };
        assert_eq!(run("exit", &facts).actions, [restart]);
        assert_eq!(run("save", &CliFacts::default()).actions, [CliAction::Save, restart]);
    }

    #[test]
    fn lines_that_end_the_link_are_not_for_msp() {
        let run_message = |line: &str, armed: bool| {
            let facts = CliFacts { armed, ..CliFacts::default() };
            let mut configuration = Configuration::default();
            let mut context = CliContext { configuration: &mut configuration, facts: &facts };
            Interpreter::new(CliMode::Message).run(line, &mut context)
        };
        for line in ["bl", " BL rom", "defaults", "serialpassthrough 1", "msc # now"] {
            let refused = CliReply { failed: true, ..CliReply::default() };
            assert_eq!(run_message(line, false), refused, "{line}");
            assert_eq!(run_message(line, true), refused, "{line}");
        }
        for line in ["save", "defaults nosave"] {
            assert!(!run_message(line, false).failed && run_message(line, true).failed, "{line}");
        }
        assert!(!run_message("waypoint clear", true).failed);
        let mut configuration = Configuration::default();
        let mut context = CliContext { configuration: &mut configuration, facts: &CliFacts::default() };
        let mut message = Interpreter::new(CliMode::Message);
        assert_eq!(message.run("save", &mut context).actions, [CliAction::Save]);
        assert_eq!(message.run("exit", &mut context), CliReply::default());
    }
}
