//! Completion and hints for the word being typed.

use strum::IntoEnumIterator;

use super::super::config::{Feature, MixerKind};
use super::super::settings::{Kind, PORT_NAMES, Role, SETTINGS, Setting, Settings, find, needs_restart};
use super::command_table::{COMMANDS, by_name};
use crate::plan::{HoldPattern, WaypointType};

/// The possible completions of the word at the end of a line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Completion {
    /// The byte offset at which that word starts.
    pub start: usize,
    /// The candidates, in table order.
    pub candidates: Vec<&'static str>,
    /// The longest prefix common to all candidates.
    pub common: String,
}

impl Completion {
    /// Returns the text that is certain to follow the line.
    pub fn tail(&self, line: &str) -> &str {
        let typed = line.len().saturating_sub(self.start);
        self.common.get(typed..).unwrap_or("")
    }

    /// Returns the completed lines, one for each candidate.
    pub fn lines(&self, line: &str) -> Vec<String> {
        let head = line.get(..self.start).unwrap_or(line);
        self.candidates.iter().map(|word| format!("{head}{word}")).collect()
    }
}

/// Completes the last word of a line.
pub fn complete(line: &str) -> Completion {
    let trimmed = line.trim_start();
    let indent = line.len() - trimmed.len();
    let Some((word, rest)) = trimmed.split_once(' ') else {
        return among(COMMANDS.iter().map(|command| command.name), trimmed, indent);
    };
    let start = indent + word.len() + 1;
    let name = by_name(word).map_or("", |command| command.name);
    match name {
        "get" => setting_name(rest, start),
        "set" => match rest.split_once('=') {
            Some((name, value)) => setting_value(name.trim(), value, start + name.len() + 1),
            None => setting_name(rest, start),
        },
        "waypoint" => waypoint(rest, start),
        "feature" => {
            let name = rest.trim_start().trim_start_matches('-');
            among(Feature::iter().map(Into::into), name, line.len() - name.len())
        }
        "help" => last_word(COMMANDS.iter().map(|command| command.name), rest, start),
        "mixer" => last_word(MixerKind::iter().map(Into::into).chain(["list"]), rest, start),
        "dump" | "diff" => {
            last_word(["master", "profile", "rates", "hardware", "all", "defaults", "bare"], rest, start)
        }
        "save" | "exit" => last_word(["noreboot"], rest, start),
        "defaults" => last_word(["nosave"], rest, start),
        "batch" => last_word(["start", "end"], rest, start),
        _ => Completion { start: line.len(), ..Completion::default() },
    }
}

/// Returns the candidates that start with the typed text, in any case.
fn among(words: impl IntoIterator<Item = &'static str>, typed: &str, start: usize) -> Completion {
    let starts = |word: &&str| word.get(..typed.len()).is_some_and(|head| head.eq_ignore_ascii_case(typed));
    let candidates: Vec<&'static str> = words.into_iter().filter(starts).collect();
    let common = candidates.split_first().map_or_else(String::new, |(first, others)| {
        let shared = others.iter().fold(first.len(), |shared, other| {
            first.bytes().zip(other.bytes()).take(shared).take_while(|(a, b)| a == b).count()
        });
        first.get(..shared).unwrap_or(first).to_owned()
    });
    Completion { start, candidates, common }
}

fn last_word(words: impl IntoIterator<Item = &'static str>, rest: &str, start: usize) -> Completion {
    let at = rest.rfind(' ').map_or(0, |at| at + 1);
    among(words, rest.get(at..).unwrap_or(""), start + at)
}

fn setting_name(rest: &str, start: usize) -> Completion {
    let typed = rest.trim_start();
    among(SETTINGS.iter().map(|setting| setting.name), typed, start + rest.len() - typed.len())
}

fn setting_value(name: &str, value: &str, start: usize) -> Completion {
    let typed = value.trim_start();
    let words: &'static [&'static str] = match find(name).map(|setting| setting.kind) {
        Some(Kind::Choice { words, .. }) => words,
        Some(Kind::Port { .. }) => &PORT_NAMES,
        _ => &[],
    };
    among(words.iter().copied(), typed, start + value.len() - typed.len())
}

/// The position of the type among the words after `waypoint`.
const TYPE_AT: usize = 6;
const PATTERN_AT: usize = 8;

fn waypoint(rest: &str, start: usize) -> Completion {
    let words: Vec<&str> = rest.split(' ').collect();
    let edits = words
        .first()
        .is_some_and(|word| ["insert", "update"].iter().any(|edit| word.eq_ignore_ascii_case(edit)));
    match words.len() - 1 {
        0 => last_word(["list", "status", "insert", "update", "remove", "clear"], rest, start),
        TYPE_AT if edits => last_word(WaypointType::iter().map(Into::into), rest, start),
        PATTERN_AT if edits => last_word(HoldPattern::iter().map(Into::into), rest, start),
        _ => Completion { start: start + rest.len(), ..Completion::default() },
    }
}

/// Returns the hint to show beside a line while it is typed: the setting's range, meaning and present value, if known,
/// or the command's arguments.
pub fn hint(line: &str, settings: Option<&Settings>) -> Option<String> {
    let trimmed = line.trim_start();
    let (word, rest) = trimmed.split_once(' ').unwrap_or((trimmed, ""));
    let command = by_name(word)?;
    if let "get" | "set" = command.name {
        let name = rest.split('=').next().unwrap_or("").trim();
        if let Some(setting) = find(name) {
            return Some(setting_hint(setting, settings));
        }
    }
    let description = command.description.unwrap_or("");
    Some(format!("{} {}: {description}", command.name, command.arguments.join(" or ")).replace(" :", ":"))
}

fn setting_hint(setting: &Setting, settings: Option<&Settings>) -> String {
    let setting = &settings.map_or(*setting, |settings| settings.resolved(setting));
    let value = settings.and_then(|settings| settings.active_value(setting));
    let now = value.map_or_else(String::new, |value| format!(" = {}", setting.display(value)));
    let default = setting.display(&setting.default_value());
    let range = match setting.kind {
        Kind::Number { min, max, .. } => format!("{min}…{max}"),
        Kind::Choice { words, .. } => words.join(" "),
        Kind::Array { default } => format!("{} numbers", default.len()),
        Kind::Text { max } => format!("up to {max} characters"),
        Kind::Port { .. } => PORT_NAMES.join(" "),
    };
    let effect = match setting.role {
        Role::Carry => " No effect here.",
        Role::Only(_) => " No effect in the other profile.",
        Role::Live if needs_restart(setting.name) => " Works after save.",
        Role::Live => "",
    };
    format!("{}{now} (default {default}; {range}): {}{effect}", setting.name, setting.help)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(line: &str) -> (usize, Vec<&'static str>, String) {
        let completion = complete(line);
        (completion.start, completion.candidates, completion.common)
    }

    #[test]
    fn commands_settings_values_and_waypoint_words_are_completed() {
        assert_eq!(found("wa"), (0, vec!["waypoint"], "waypoint".to_owned()));
        assert_eq!(found("  rx").1, ["rxfail", "rxrange"]);
        assert_eq!(found("get ap_yaw_").1, ["ap_yaw_mode", "ap_yaw_p", "ap_yaw_d"]);
        assert_eq!(found("set AP_L1_M").2, "ap_l1_m");
        assert_eq!(found("set ap_yaw_mode = f"), (18, vec!["FIXED"], "FIXED".to_owned()));
        assert_eq!(found("set ap_l1_enable=").1, ["OFF", "ON"]);
        assert_eq!(found("set msp_uart_2 = uart8").1, ["UART8"]);
        assert_eq!(found("waypoint i"), (9, vec!["insert"], "insert".to_owned()));
        assert_eq!(found("waypoint insert 0 1 2 3 4 FLY").1, ["FLYOVER", "FLYBY"]);
        assert_eq!(found("waypoint update 0 1 2 3 4 HOLD 5 o").1, ["ORBIT"]);
        assert_eq!(found("feature -g").1, ["GPS"]);
        assert_eq!(found("dump all d").1, ["defaults"]);
        assert_eq!(found("set nonsense = ").1, Vec::<&str>::new());
        assert_eq!(found("nonsense x").1, Vec::<&str>::new());
        assert_eq!(
            complete("set ap_yaw_mode = v").lines("set ap_yaw_mode = v"),
            ["set ap_yaw_mode = VELOCITY"]
        );
    }

    #[test]
    fn hints_tell_value_range_and_meaning() {
        let settings = Settings::default();
        let text = hint("set ap_max_angle = 2", Some(&settings)).expect("a hint");
        assert!(text.starts_with("ap_max_angle = 50 (default 50; 10…70): Maximum tilt"), "{text}");
        assert!(hint("rxf", None).is_none());
        let text = hint("get msp_uart_2", None).expect("a hint");
        assert!(text.starts_with("msp_uart_2 (default NONE; NONE UART1"), "{text}");
        let text = hint("save", None).expect("a hint");
        assert_eq!(text, "save [noreboot]: store the configuration and restart");
    }
}
