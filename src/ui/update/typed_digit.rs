//! A digit on a value that was just chosen begins to type it, in place of showing a panel.

use crossterm::event::{KeyCode, KeyEvent};

use super::{act, key};
use crate::ui::app_state::AppState;
use crate::ui::model::action::{Action, EditAction, PanelAction};
use crate::ui::model::effect::Effect;

/// Begins to type the chosen value with a digit. Returns `None` if the key is something else here.
pub(super) fn take(state: &mut AppState, event: KeyEvent, found: Option<Action>) -> Option<Vec<Effect>> {
    let is_digit = matches!(event.code, KeyCode::Char('0'..='9')) && event.modifiers.is_empty();
    // The user may have given the digit to another action.
    let shows = found.is_none_or(|action| matches!(action, Action::Show(_)));
    if !is_digit || !shows || !state.has_chosen {
        return None;
    }
    let action = state.panels.of(state.shared.focus).typing(&state.shared)?;
    let mut effects = act(state, action);
    if state.panels.of_mut(state.shared.focus).field().is_some() || state.shared.editor.field().is_some() {
        effects.extend(key(state, event));
    }
    Some(effects)
}

/// Notes whether an action of the focused panel chooses a value. While it is edited it stays chosen.
pub(super) fn follow(state: &mut AppState, action: Action) {
    let chooses = matches!(
        action,
        Action::ScrollUp
            | Action::ScrollDown
            | Action::PageUp
            | Action::PageDown
            | Action::Top
            | Action::Bottom
            | Action::Edit(EditAction::Left | EditAction::Right)
            | Action::Panel(
                PanelAction::KnobUp
                    | PanelAction::KnobDown
                    | PanelAction::NextGroup
                    | PanelAction::PreviousGroup
                    | PanelAction::NextSetting
                    | PanelAction::PreviousSetting
            )
    );
    let edits = matches!(
        action,
        Action::Edit(
            EditAction::Cell
                | EditAction::Raise
                | EditAction::Lower
                | EditAction::RaiseMuch
                | EditAction::LowerMuch
        ) | Action::Panel(
            PanelAction::KnobLess
                | PanelAction::KnobMore
                | PanelAction::KnobEnter
                | PanelAction::KnobEdit
                | PanelAction::SettingEdit
                | PanelAction::SettingType
                | PanelAction::SettingMore
                | PanelAction::SettingLess
                | PanelAction::SettingMoreMuch
                | PanelAction::SettingLessMuch
        )
    );
    state.has_chosen = chooses || edits && state.has_chosen;
}
