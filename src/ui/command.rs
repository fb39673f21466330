//! The language of the `:` line and of `--plain`: every action by its name, and commands that take an argument.
//!
//! A line is a word and, after a blank or `=`, the argument: `flight.arm`, `arm`, `speed 4`, `wind=5@270`. The word is
//! the name of a [`Command`], the full name of an action, or the part of that name after the dot if it is unique.

mod display;
pub(super) mod flight;
mod plan;
mod suggestion;
mod table;
mod time;
mod vehicle;
mod world;

pub use suggestion::{Suggestion, hint, suggestions};
pub use table::{Command, all};

use super::shared::Shared;
use crate::text::did_you_mean;
use crate::ui::acts::availability;
use crate::ui::model::action;
use crate::ui::model::action::{ACTIONS, Action, Context, Spec};
use crate::ui::model::keymap::KeyPress;
use crate::ui::model::message::Request;
use crate::ui::model::panel_table::Panel;

/// Returns the requests of a line.
///
/// # Errors
/// Returns the reason for a refusal, in a sentence.
pub fn run(state: &mut Shared, line: &str) -> Result<Vec<Request>, String> {
    let (word, argument) = split(line);
    if word.is_empty() {
        return Ok(Vec::new());
    }
    if let Some(command) = all().find(|command| command.name == word) {
        return (command.run)(state, command.name, argument);
    }
    let action =
        action_named(word, state.focus).map_err(|unknown| named_by_key(state, word).unwrap_or(unknown))?;
    if !argument.is_empty() {
        return Err(format!("{word} takes no argument."));
    }
    availability::enabled(state, action)?;
    Ok(vec![Request::Act(action)])
}

/// Returns the action that a line names, if it is not a command with an argument.
pub(super) fn named(state: &Shared, line: &str) -> Option<Action> {
    let (word, argument) = split(line);
    let is_command = all().any(|command| command.name == word);
    let action = action_named(word, state.focus).ok()?;
    (!is_command && argument.is_empty()).then_some(action)
}

/// Returns `true` if a line arranges the panels of the screen.
pub(super) fn arranges(line: &str) -> bool {
    matches!(split(line).0, "layout" | "view.layout")
}

/// Splits a line into its word and its argument.
fn split(line: &str) -> (&str, &str) {
    let line = line.trim().trim_start_matches(':').trim_start();
    let (word, argument) = line.split_once([' ', '=']).unwrap_or((line, ""));
    (word, argument.trim())
}

/// Returns the part of an action's name after the dot.
pub(super) fn short_name(spec: &Spec) -> &'static str {
    spec.name.rsplit_once('.').map_or(spec.name, |(_, short)| short)
}

/// Returns the action that a word names while `focus` has the focus.
fn action_named(word: &str, focus: Panel) -> Result<Action, String> {
    if let Some(spec) = ACTIONS.iter().find(|spec| spec.name == word) {
        return Ok(spec.action);
    }
    let named: Vec<&Spec> = ACTIONS.iter().filter(|spec| short_name(spec) == word).collect();
    let is_here = |spec: &Spec| {
        matches!(spec.context, Context::Global | Context::Always) || spec.context.applies(focus)
    };
    match named[..] {
        [only] => Ok(only.action),
        [] => {
            let words = all().map(|command| command.name);
            let words = words.chain(ACTIONS.iter().flat_map(|spec| [spec.name, short_name(spec)]));
            Err(format!("There is no command {word}{}", did_you_mean_end(word, words)))
        }
        _ => {
            let mut here = named.iter().filter(|spec| is_here(spec));
            match (here.next(), here.next()) {
                (Some(spec), None) => Ok(spec.action),
                _ => {
                    let names: Vec<&str> = named.iter().map(|spec| spec.name).collect();
                    Err(format!("{word} is more than one command: {}.", names.join(", ")))
                }
            }
        }
    }
}

/// Returns the sentence about a key that was typed as a command.
fn named_by_key(state: &Shared, word: &str) -> Option<String> {
    let action = state.keymap.action(KeyPress::parse(word)?, state.focus)?;
    let name = action::spec_of(action)?.name;
    Some(format!("{word} is a key of the screen; its command is {name}."))
}

/// Returns the command whose name is the first word of a line.
pub(super) fn with_value(line: &str) -> Option<Command> {
    let word = split(line).0;
    all().find(|command| command.name == word)
}

/// Returns the line for the firmware's command line if its panel has the focus and the line is not rather a command.
pub(super) fn for_firmware<'a>(state: &Shared, line: &'a str) -> Option<&'a str> {
    let line = line.trim();
    let word = line.split([' ', '=']).next().filter(|word| !word.is_empty() && !word.starts_with(':'))?;
    if !state.focus.takes_text() {
        return None;
    }
    let knows = |word: &str| (state.cli_help.complete)(word).iter().any(|known| known.trim_end() == word);
    let is_ours = with_value(line).is_some() || action_named(word, state.focus).is_ok();
    (knows(word) || !is_ours).then_some(line)
}

/// Returns the end of a sentence about an unknown word.
fn did_you_mean_end<'a>(word: &str, words: impl IntoIterator<Item = &'a str>) -> String {
    match did_you_mean::closest(word, words) {
        Some(close) => format!("; did you mean {close}?"),
        None => "; `Ctrl-P` lists all.".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::{Command as SessionCommand, SessionView};
    use crate::ui::app_state::AppState;
    use crate::ui::model::action::PanelAction;
    use crate::ui::model::effect::Effect;
    use crate::ui::update::run_line;

    fn bare() -> AppState {
        AppState::bare((80, 24), SessionView::default())
    }

    #[test]
    fn every_action_is_reached_by_its_name() {
        for spec in ACTIONS {
            assert_eq!(action_named(spec.name, Panel::Log), Ok(spec.action), "{}", spec.name);
            assert!(all().all(|command| command.name != spec.name), "{}", spec.name);
        }
    }

    #[test]
    fn a_short_name_means_the_action_of_the_focused_panel() {
        assert_eq!(action_named("arm", Panel::Cli), Ok(Action::Arm));
        assert_eq!(action_named("up", Panel::Map), Ok(Action::Panel(PanelAction::PanUp)));
        assert_eq!(action_named("up", Panel::Log), Ok(Action::ScrollUp));
        let many = action_named("up", Panel::Cli).expect_err("three actions have this name");
        assert!(many.contains("map.up, rc.up, "), "{many}");
    }

    #[test]
    fn wrong_words_say_what_was_meant() {
        let mut state = bare();
        for (line, part) in [
            ("wnd 5@270", "did you mean wind?"),
            ("flight.amr", "did you mean flight.arm?"),
            ("pause now", "pause takes no argument."),
            ("qwertyuiop", "`Ctrl-P` lists all."),
            ("speed fast", "a factor"),
            ("speed 5000", "0.05 to 1000"),
            ("theme blue", "dark, light"),
            ("set", "NAME=VALUE"),
            ("home", "disarmed"),
        ] {
            if line == "home" {
                std::sync::Arc::make_mut(&mut state.shared.view.vehicle).craft.armed = Some(false);
            }
            let error = run_line(&mut state, line).expect_err(line);
            assert!(error.contains(part), "{line}: {error}");
        }
        assert!(run_line(&mut state, "  : ").is_ok_and(|effects| effects.is_empty()));
    }

    #[test]
    fn arguments_follow_a_blank_or_an_equals_sign() {
        let mut state = bare();
        for line in ["wind 5@270", ":wind=5@270", " wind = 5@270"] {
            let effects = run_line(&mut state, line).expect(line);
            assert!(matches!(&effects[..], [Effect::World(line)] if line == "wind=5@270"), "{effects:?}");
        }
        let effects = run_line(&mut state, "speed max").expect("a speed");
        assert!(matches!(effects[..], [Effect::Send(SessionCommand::Speed(speed))] if speed.is_infinite()));
        let effects = run_line(&mut state, "set ap_max_angle=25").expect("a setting");
        assert!(matches!(&effects[..], [Effect::Cli(line)] if line == "set ap_max_angle = 25"));
    }

    proptest::proptest! {
        #[test]
        fn any_line_is_carried_out_or_refused(line in ".{0,40}", word in 0usize..20) {
            let mut state = bare();
            let _ = run_line(&mut state, &line);
            if let Some(command) = all().nth(word) {
                let _ = run_line(&mut state, &format!("{} {line}", command.name));
                let _ = suggestions(&state.shared, &format!("{} {line}", command.name));
            }
            let _ = (suggestions(&state.shared, &line), hint(&state.shared, &line));
        }
    }
}
