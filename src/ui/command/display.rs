//! Commands that change the display.

use super::did_you_mean_end;
use crate::ui::acts::named_layouts;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::files::FileRequest;
use crate::ui::model::layout::Arrangement;
use crate::ui::model::message::{Change, Request};
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

/// Runs `layout editing`, `layout default`, `layout save mine`, `layout delete mine`.
pub(super) fn layout(state: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    let keep = |line: Option<String>, text: String| {
        let kept = line.map(|line| Effect::Files(FileRequest::KeepLayout(line)).into());
        Ok(std::iter::once(Change::Say(Severity::Good, text).into()).chain(kept).collect())
    };
    match argument.split_once(' ').map_or((argument, ""), |(verb, name)| (verb, name.trim())) {
        ("default", "") => state.arrangement = Arrangement::default(),
        ("save", name) => {
            return keep(named_layouts::save(state, name)?, format!("`:layout {name}` shows this layout."));
        }
        ("delete", name) => {
            return keep(named_layouts::delete(state, name)?, format!("Layout {name} is deleted."));
        }
        _ => match named_layouts::find(state, argument) {
            Some(layout) => layout.show(state),
            None => {
                return Err(unknown("layout", argument, &named_layouts::names(state).collect::<Vec<_>>()));
            }
        },
    }
    Ok(Vec::new())
}

/// Returns the matching names of layouts.
pub(super) fn complete_layout(state: &Shared, _: &str, typed: &str) -> Vec<String> {
    let saved = || state.layouts.names().map(|name| format!("delete {name}"));
    let all =
        named_layouts::names(state).map(str::to_owned).chain(["default".to_owned(), "save ".to_owned()]);
    all.chain(saved()).filter(|name| name.starts_with(typed)).collect()
}

fn unknown(what: &str, argument: &str, names: &[&str]) -> String {
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
