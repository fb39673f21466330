//! Commands that change the display.

use super::did_you_mean_end;
use crate::ui::message::Request;
use crate::ui::shared::Shared;
use crate::ui::theme::{Charset, Palette};
use crate::ui::units::Units;

/// Runs `theme light`.
pub(super) fn theme(state: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    if state.theme.no_colour {
        return Err("The environment variable NO_COLOR asks for no colours: start without it.".to_owned());
    }
    let palette = Palette::NAMES.into_iter().find(|(name, _)| *name == argument);
    match palette {
        Some((_, palette)) => {
            state.theme.palette = palette;
            Ok(Vec::new())
        }
        None => Err(unknown("theme", argument, &Palette::NAMES.map(|(name, _)| name))),
    }
}

pub(super) fn complete_theme(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    starting(typed, &Palette::NAMES.map(|(name, _)| name))
}

/// Runs `charset ascii`.
pub(super) fn charset(state: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    state.theme.charset = match argument {
        "unicode" => Charset::Unicode,
        "ascii" => Charset::Ascii,
        _ => return Err(unknown("character set", argument, &["unicode", "ascii"])),
    };
    Ok(Vec::new())
}

/// Returns the matching names of character sets.
pub(super) fn complete_charset(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    starting(typed, &["unicode", "ascii"])
}

/// Runs `units imperial`.
pub(super) fn units(state: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    state.units = match argument {
        "metric" => Units::Metric,
        "imperial" => Units::Imperial,
        _ => return Err(unknown("system of units", argument, &["metric", "imperial"])),
    };
    Ok(Vec::new())
}

/// Returns the matching names of systems of units.
pub(super) fn complete_units(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    starting(typed, &["metric", "imperial"])
}

fn unknown(what: &str, argument: &str, names: &[&'static str]) -> String {
    let all = names.join(", ");
    if argument.is_empty() {
        return format!("Which {what}? There are {all}.");
    }
    match did_you_mean_end(argument, names.iter().copied()) {
        guess if guess.ends_with('?') => format!("There is no {what} {argument}{guess}"),
        _ => format!("There is no {what} {argument}; there are {all}."),
    }
}

fn starting(typed: &str, names: &[&str]) -> Vec<String> {
    names.iter().filter(|name| name.starts_with(typed)).map(|name| (*name).to_owned()).collect()
}
