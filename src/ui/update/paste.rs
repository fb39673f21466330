//! Pasted text.

use crate::ui::acts::plan_edits as plan;
use crate::ui::app_state::AppState;
use crate::ui::model::action::Action;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::Popup;
use crate::ui::search::Search;
use crate::ui::text_field::TextField;

/// Inserts pasted text into the field with the focus; a field of a single line gets the first line.
pub(super) fn paste(state: &mut AppState, text: &str) -> Vec<Effect> {
    let field = match state.popups.last_mut() {
        Some(Popup::CommandLine) => Some(&mut state.command_line.field),
        Some(Popup::Palette(palette)) => Some(&mut palette.query),
        Some(Popup::Signals(list)) => Some(&mut list.query),
        Some(Popup::Flights(list)) => list.deleting.is_none().then_some(&mut list.query),
        Some(Popup::Help(help)) => typed(&mut help.search),
        Some(Popup::Diff(view)) => typed(&mut view.search),
        Some(
            Popup::GoTo(_)
            | Popup::MapMenu(_)
            | Popup::Plots { .. }
            | Popup::WhatIf { .. }
            | Popup::Guards { .. }
            | Popup::Actions(_)
            | Popup::ResetSettings
            | Popup::Layout
            | Popup::Permission
            | Popup::Quit,
        ) => None,
        None => state.panels.of_mut(state.shared.focus).field(),
    };
    if let Some(field) = field {
        field.insert(text.lines().next().unwrap_or_default());
        return Vec::new();
    }
    let first_line = text.lines().next().unwrap_or_default();
    if state.popups.is_empty()
        && state.shared.editor.popup.as_mut().is_some_and(|popup| popup.paste(first_line))
    {
        return Vec::new();
    }
    let is_covered = !state.popups.is_empty() || state.shared.editor.popup.is_some();
    if matches!(state.shared.focus, Panel::Plan | Panel::Map) && !is_covered {
        return plan::paste_text(&mut state.shared, text);
    }
    if state.shared.focus != Panel::Cli || is_covered {
        let [cli, plan] = [Panel::Cli, Panel::Plan].map(|panel| state.shared.key(Action::Show(panel)));
        let text = format!("Pasted text goes to the CLI ({cli}) or, as waypoints, to the plan ({plan}).");
        state.shared.notify(Severity::Info, text);
        return Vec::new();
    }
    state.panels.cli.console.paste(text);
    state.panels.cli.console.next_effect().into_iter().collect()
}

/// Returns the field of a search while its words are typed.
fn typed(search: &mut Search) -> Option<&mut TextField> {
    search.is_typing.then_some(&mut search.field)
}
