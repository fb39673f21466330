//! The selected setting below the list: its description, range and origin, and what another value changes.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::SettingsPanel;
use super::editing::Purpose;
use crate::fc::{Allowed, CraftSetting};
use crate::ui::acts::setting_list::planned;
use crate::ui::area::row;
use crate::ui::model::action::{Action, EditAction, PanelAction};
use crate::ui::model::forecast::difference;
use crate::ui::shared::Shared;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::Role;

/// Returns the number of rows of the details in a panel of this size.
pub(super) fn rows(area: Rect) -> u16 {
    (area.height / 4 + 1).clamp(4, 9).min(area.height.saturating_sub(2))
}

pub(super) fn draw(panel: &SettingsPanel, state: &Shared, area: Rect, buffer: &mut Buffer) {
    let count = rows(area);
    let place = Rect { y: area.bottom() - count, height: count, ..area };
    let Some(setting) = panel.setting(state) else { return };
    let width = usize::from(area.width);
    let mut lines: Vec<(Role, String)> = Vec::new();
    let mut say = |role: Role, text: &str| {
        lines.extend(wrapped(text, width).into_iter().map(|line| (role, line)));
    };
    if let Some(edit) = &panel.edit {
        let verb = match edit.purpose {
            Purpose::Set => "sets it",
            Purpose::Try => "flies ahead with it and without it",
        };
        say(
            Role::Title,
            &format!("Enter {verb}, ↑ ↓ change it, Esc leaves it. Allowed: {}.", setting.allowed),
        );
        if let Some(problem) = &edit.problem {
            say(Role::Warn, &format!("✗ {problem}"));
        }
    } else if let Some((value, flown)) = state.forecast.tried(&setting.name) {
        let text = match flown {
            None => format!("with {value}: flying ahead …"),
            Some(flown) => {
                let end = flown.line(|metres| state.units.length_text(metres, 0));
                let difference = difference(flown, state.units).unwrap_or_default();
                let enter = state.key(Action::Panel(PanelAction::SettingEdit));
                format!("with {value}: {end}; {difference}. The map shows both tracks; {enter} sets it.")
            }
        };
        say(Role::Title, &text);
    }
    let help = if setting.help.is_empty() { "No description is known." } else { setting.help };
    say(Role::Text, help);
    say(Role::Dim, &facts(state, setting));
    if let Some(why) = state.settings.refusal() {
        say(Role::Warn, why);
    }
    let profile = if setting.profile.is_empty() { String::new() } else { format!(", {}", setting.profile) };
    let rule = format!("─ {}{profile} {}", setting.name, "─".repeat(width));
    let rule: String = rule.chars().take(width).collect();
    row(buffer, place, 0, &state.theme, Role::Dim, &rule);
    for (at, (role, text)) in (1..count).zip(&lines) {
        row(buffer, place, at, &state.theme, *role, text);
    }
}

/// Returns range, default, origin and effect in a line.
fn facts(state: &Shared, setting: &CraftSetting) -> String {
    let unit = if setting.unit.is_empty() { String::new() } else { format!(" × {}", setting.unit) };
    let unit =
        if setting.unit.starts_with(|c: char| c.is_ascii_digit()) { unit } else { unit.replace(" × ", " ") };
    let mut facts = Vec::new();
    if setting.needs_restart {
        facts.push("↻ works after save and restart, on the ground".to_owned());
    }
    if setting.is_carried {
        facts.push("no effect here".to_owned());
    }
    if let Some(default) = &setting.default {
        facts.push(format!("default {default}"));
    }
    if let Some(value) = planned(state, &setting.name) {
        facts.push(format!("the plan sets {value}"));
    }
    if let Some(source) = state.settings.given_by(&setting.name) {
        facts.push(format!("set by {source}"));
    }
    if setting.is_unsaved() {
        let save = state.key(Action::Edit(EditAction::SaveToFlash));
        let saved = setting.saved.as_deref().unwrap_or_default();
        facts.push(if state.view.remote.is_some() {
            format!("{saved} when it was read first")
        } else {
            format!("{saved} in flash: {save} saves")
        });
    }
    // A list of words may take the rest of the room.
    let allowed = format!("{}{unit}", setting.allowed);
    let at = if matches!(setting.allowed, Allowed::Words(_)) { facts.len() } else { 0 };
    facts.insert(at, allowed);
    facts.join(" · ")
}
