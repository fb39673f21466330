//! Suggestions for the line being typed, and a hint about it.

use super::{all, short_name, split};
use crate::ui::acts::availability;
use crate::ui::model::action;
use crate::ui::model::action::ACTIONS;
use crate::ui::shared::Shared;

/// The longest argument form shown beside the help.
const SHORT: usize = 24;

/// A possible completion of the typed line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Suggestion {
    pub line: String,
    /// The part that is shown: the word being typed.
    pub word: String,
    pub help: &'static str,
    pub keys: String,
}

/// Returns the possible completions of `typed`, the commands of the `:` line first.
pub fn suggestions(state: &Shared, typed: &str) -> Vec<Suggestion> {
    let typed = typed.trim_start().trim_start_matches(':').trim_start();
    if typed.contains([' ', '=']) {
        let (word, argument) = split(typed);
        let Some(command) = all().find(|command| command.name == word) else { return Vec::new() };
        let argument = argument.trim_start_matches('=').trim_start();
        let whole = |argument: String| Suggestion {
            line: format!("{word} {argument}"),
            word: argument,
            help: "",
            keys: String::new(),
        };
        return (command.complete)(state, word, argument).into_iter().map(whole).collect();
    }
    let commands = all().filter(|command| command.name.starts_with(typed)).map(|command| Suggestion {
        line: format!("{} ", command.name),
        word: command.name.to_owned(),
        help: command.help,
        // The hint shows a long form once the word is typed.
        keys: if command.argument.len() > SHORT { String::new() } else { command.argument.to_owned() },
    });
    let by_name = |name: &str| name.starts_with(typed);
    let full = ACTIONS.iter().any(|spec| by_name(spec.name));
    // A user who types only the part after the dot is offered the whole name.
    let actions = ACTIONS.iter().filter(|spec| by_name(if full { spec.name } else { short_name(spec) }));
    let actions = actions.map(|spec| Suggestion {
        line: spec.name.to_owned(),
        word: spec.name.to_owned(),
        help: spec.help,
        keys: state.keymap.shown_keys(spec.action).join(" "),
    });
    commands.chain(actions).collect()
}

/// Returns a hint about the line: the usage of the command, or the effect of the action and the reason if it is refused
/// now.
pub fn hint(state: &Shared, typed: &str) -> Option<String> {
    let (word, argument) = split(typed);
    if word == "set" {
        let setting = (state.cli_help.hint)(&format!("set {argument}"));
        if let Some(hint) = setting.filter(|_| !argument.is_empty()) {
            return Some(hint);
        }
    }
    if let Some(command) = all().find(|command| command.name == word) {
        return Some(format!("{word} {} — {}", command.argument, command.help));
    }
    let action = super::action_named(word, state.focus).ok()?;
    let spec = action::spec_of(action)?;
    Some(match availability::enabled(state, action) {
        Ok(()) => format!("{} — {}", spec.name, spec.help),
        Err(reason) => format!("{} — {reason}", spec.name),
    })
}
