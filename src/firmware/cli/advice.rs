//! Advice after a line was run: the way out of a refusal, or the step that is still missing. It is for people at the
//! console panel; serial links never carry it.

use super::super::settings::{SETTINGS, find, needs_restart};
use super::CliReply;
use super::command_table::{COMMANDS, by_name};
use crate::text::did_you_mean;

/// Returns the advice to show after `line` was answered with `reply`, if any.
pub fn advice(line: &str, reply: &CliReply) -> Option<String> {
    let line = line.trim();
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    let name = rest.split('=').next().unwrap_or("").trim();
    if !reply.failed {
        let restart = word.eq_ignore_ascii_case("set") && rest.contains('=');
        let setting = find(name).filter(|setting| restart && needs_restart(setting.name))?;
        return Some(format!("{} works after save, which restarts the firmware.", setting.name));
    }
    if by_name(word).is_none() {
        let command = did_you_mean::closest(word, COMMANDS.iter().map(|command| command.name))?;
        return Some(format!("Did you mean {command}?"));
    }
    if reply.text.contains("NOT WHILE ARMED") {
        return Some("Land and disarm first.".to_owned());
    }
    if reply.text.contains("PLEASE FIX ERRORS") {
        return Some("Nothing was saved: run the corrected lines, then save.".to_owned());
    }
    if reply.text.contains("INVALID NAME") && matches!(word.to_ascii_lowercase().as_str(), "set" | "get") {
        if find(name).is_none()
            && let Some(setting) = name.split(' ').next().and_then(find)
        {
            return Some(format!("To change it: set {} = VALUE", setting.name));
        }
        let setting = did_you_mean::closest(name, SETTINGS.iter().map(|setting| setting.name))?;
        return Some(format!("Did you mean {setting}?"));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::super::super::config::Configuration;
    use super::super::{CliContext, CliFacts, Interpreter};
    use super::*;

    fn after(line: &str, armed: bool) -> Option<String> {
        let facts = CliFacts { armed, ..CliFacts::default() };
        let mut configuration = Configuration::default();
        let reply = Interpreter::default()
            .run(line, &mut CliContext { configuration: &mut configuration, facts: &facts });
        advice(line, &reply)
    }

    #[test]
    fn refusals_come_with_the_way_out() {
        for (line, expected) in [
            ("set ap_max_angel = 20", "Did you mean ap_max_angle?"),
            ("get ap_yaw_mdoe", "Did you mean ap_yaw_mode?"),
            ("set ap_max_angle 40", "To change it: set ap_max_angle = VALUE"),
            ("waypont list", "Did you mean waypoint?"),
            ("set max_aux_channels = 8", "max_aux_channels works after save, which restarts the firmware."),
        ] {
            assert_eq!(after(line, false).as_deref(), Some(expected), "{line}");
        }
        assert_eq!(after("save", true).as_deref(), Some("Land and disarm first."));
        for line in [
            "set ap_max_angle = 20",
            "set ap_max_angle = 999",
            "get ap_yaw_mode",
            "get max_aux_channels",
            "xyzzy",
        ] {
            assert_eq!(after(line, false), None, "{line}");
        }
    }
}
