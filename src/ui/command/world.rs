//! Commands that change the simulated world: wind, noise, faults. The session parses and checks the values.

use super::did_you_mean_end;
use crate::sim::{COMMAND_WORDS, FAULTS, FaultInfo, SWITCHES};
use crate::ui::model::effect::Effect;
use crate::ui::model::message::Request;
use crate::ui::shared::Shared;

/// Runs `wind 5@270`, `fault gps-loss,6` and the like.
pub(super) fn change(_: &mut Shared, name: &str, argument: &str) -> Result<Vec<Request>, String> {
    match COMMAND_WORDS.iter().find(|word| word.name == name) {
        Some(word) if argument.is_empty() => Err(format!("Write :{name} {}.", word.value)),
        _ => Ok(vec![
            Effect::World(format!("{name}={}", argument.trim_start_matches('=').trim_start())).into(),
        ]),
    }
}

/// Returns the matching values that are words.
pub(super) fn complete(_: &Shared, name: &str, typed: &str) -> Vec<String> {
    let starting = |words: Vec<&str>| -> Vec<String> {
        words.into_iter().filter(|word| word.starts_with(typed)).map(str::to_owned).collect()
    };
    match name {
        "fault" => starting(FAULTS.iter().map(FaultInfo::name).collect()),
        "end" => starting(FAULTS.iter().map(FaultInfo::name).chain(["all"]).collect()),
        _ => match COMMAND_WORDS.iter().find(|word| word.name == name) {
            Some(word) => starting(words_of(word.value)),
            None => Vec::new(),
        },
    }
}

/// Runs `world battery_sag=on`.
pub(super) fn switch(_: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    let usage = "Write :world NAME=VALUE, such as :world battery_sag=on.";
    let (name, value) = argument.split_once(['=', ' ']).ok_or(usage)?;
    let (name, value) = (name.trim(), value.trim());
    let names = || SWITCHES.iter().map(|switch| switch.name);
    if !names().any(|known| known == name) {
        return Err(format!("There is no switch {name}{}", did_you_mean_end(name, names())));
    }
    Ok(vec![Effect::World(format!("{name}={value}")).into()])
}

/// Returns the matching names of switches, then their values.
pub(super) fn complete_switch(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    let lines = SWITCHES.iter().flat_map(|switch| match typed.split_once('=') {
        Some((name, _)) if name == switch.name => {
            words_of(switch.values).into_iter().map(|value| format!("{name}={value}")).collect()
        }
        Some(_) => Vec::new(),
        None => vec![format!("{}=", switch.name)],
    });
    lines.filter(|line| line.starts_with(typed)).collect()
}

/// Returns the words of a description of values such as `real, none`. Parts of a form to be filled in are left out.
fn words_of(values: &str) -> Vec<&str> {
    let parts: Vec<&str> = values.split([',', ' ']).map(str::trim).filter(|part| !part.is_empty()).collect();
    let is_word = |part: &&str| part.chars().all(|c| c.is_ascii_lowercase() || c == '-');
    parts.into_iter().filter(|part| is_word(part) && *part != "or" && *part != "to").collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;

    #[test]
    fn values_that_are_words_are_completed() {
        let state = Shared::bare((80, 24), SessionView::default());
        assert_eq!(complete(&state, "turbulence", "se"), ["severe"]);
        assert_eq!(complete(&state, "noise", ""), ["real", "none"]);
        assert_eq!(complete(&state, "wind", ""), ["calm"]);
        assert!(complete(&state, "gps-rate", "").is_empty());
        assert_eq!(complete(&state, "fault", "gps-l"), ["gps-loss"]);
        assert_eq!(complete_switch(&state, "world", "battery_sag="), ["battery_sag=on", "battery_sag=off"]);
    }
}
