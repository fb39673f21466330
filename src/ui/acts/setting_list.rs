//! The list of settings: what is compared, what is searched, and the order of the rows.

use std::collections::BTreeSet;

use crate::fc::{CraftSetting, same_value};
use crate::ui::model::settings::comparison::Comparison;
use crate::ui::model::settings::{SettingsState, name_of};
use crate::ui::shared::Shared;

impl Comparison {
    /// Returns the name of the other values, for the title and the head of their column.
    pub(in crate::ui) fn name(self, state: &Shared) -> &'static str {
        match self {
            Self::All | Self::Defaults => "default",
            Self::Plan => "plan",
            Self::Saved if state.view.remote.is_some() => "first read",
            Self::Saved => "saved",
        }
    }

    /// Returns the value to compare with.
    pub(in crate::ui) fn other(self, state: &Shared, setting: &CraftSetting) -> Option<String> {
        match self {
            Self::All | Self::Defaults => setting.default.clone(),
            Self::Plan => planned(state, &setting.name).map(str::to_owned),
            Self::Saved => setting.saved.clone(),
        }
    }
}

/// A row of the list.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) enum Row<'a> {
    /// The heading of a group.
    Heading(&'static str),
    Setting(&'a CraftSetting),
}

/// The heading of the changed settings.
pub(in crate::ui) const CHANGED: &str = "Changed";

/// The choice of rows.
#[derive(Debug, Clone, Default)]
pub(in crate::ui) struct Choice {
    pub(in crate::ui) comparison: Comparison,
    /// The words that name or description must have.
    pub(in crate::ui) query: String,
    /// The settings that stay at the top while the list is used, so that a row keeps its place; `None` for those that
    /// are changed now.
    pub(in crate::ui) on_top: Option<BTreeSet<String>>,
}

impl Choice {
    /// Keeps the settings at the top that are there now.
    pub(in crate::ui) fn freeze(&mut self, settings: &SettingsState) {
        self.on_top.get_or_insert_with(|| changed(settings));
    }
}

/// Returns the value that the open plan sets at its upload.
pub(in crate::ui) fn planned<'a>(state: &'a Shared, name: &str) -> Option<&'a str> {
    let lines = &state.editor.document().settings;
    let line = lines.iter().rev().find(|line| name_of(line).eq_ignore_ascii_case(name))?;
    Some(line.split_once('=').map_or("", |(_, value)| value).trim())
}

/// Returns the names of the settings that differ from a fresh craft.
fn changed(settings: &SettingsState) -> BTreeSet<String> {
    let all = settings.craft().into_iter().flat_map(|craft| &craft.all);
    all.filter(|setting| setting.is_changed()).map(|setting| setting.name.clone()).collect()
}

/// Returns the rows: the changed settings first, then the groups.
pub(in crate::ui) fn rows<'a>(state: &'a Shared, choice: &Choice) -> Vec<Row<'a>> {
    let words: Vec<String> = choice.query.split_whitespace().map(str::to_lowercase).collect();
    let all = state.settings.craft().into_iter().flat_map(|craft| &craft.all);
    let on_top = choice.on_top.clone().unwrap_or_else(|| changed(&state.settings));
    let is_chosen = |setting: &&CraftSetting| {
        is_found(setting, &words) && is_compared(state, choice.comparison, setting, &on_top)
    };
    let (top, rest): (Vec<_>, Vec<_>) =
        all.filter(is_chosen).partition(|setting| on_top.contains(&setting.name));
    let mut rows = Vec::new();
    let mut heading = "";
    for setting in top {
        if heading.is_empty() {
            heading = CHANGED;
            rows.push(Row::Heading(heading));
        }
        rows.push(Row::Setting(setting));
    }
    for setting in rest {
        if heading != setting.group {
            heading = setting.group;
            rows.push(Row::Heading(heading));
        }
        rows.push(Row::Setting(setting));
    }
    rows
}

/// Returns `true` if each word occurs in the name or in the description.
fn is_found(setting: &CraftSetting, words: &[String]) -> bool {
    if words.is_empty() {
        return true;
    }
    let (name, help) = (setting.name.to_lowercase(), setting.help.to_lowercase());
    words.iter().all(|word| name.contains(word.as_str()) || help.contains(word.as_str()))
}

fn is_compared(
    state: &Shared,
    comparison: Comparison,
    setting: &CraftSetting,
    on_top: &BTreeSet<String>,
) -> bool {
    if comparison == Comparison::All {
        return true;
    }
    let other = comparison.other(state, setting);
    // A row whose value was just made equal stays while the list is used.
    let differs = other.as_ref().is_some_and(|other| !same_value(other, &setting.value));
    differs || comparison == Comparison::Defaults && on_top.contains(&setting.name)
}
