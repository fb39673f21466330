//! Asks before a real remote craft is changed.

use super::flight;
use crate::session::Command;
use crate::ui::acts::{setting_changes, setting_reading};
use crate::ui::app_state::AppState;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::popup::Popup;

/// The reason for missing settings after the user declined.
const NOT_READ: &str = "The settings were not read: reading them would have opened the command line.";

/// Returns the effects that may be carried out. Effects that would change a real craft are held, and the user is asked.
pub(in crate::ui) fn hold(state: &mut AppState, effects: Vec<Effect>) -> Vec<Effect> {
    if state.shared.real_craft().is_none() {
        return effects;
    }
    let held_before = state.permission.held.len();
    let free = state.permission.hold(&state.shared.view, effects);
    if state.permission.held.len() > held_before {
        ask(state);
    }
    free
}

/// Asks the user to permit changes of the craft.
pub(super) fn ask(state: &mut AppState) {
    if !state.popups.contains(&Popup::Permission) {
        state.popups.push(Popup::Permission);
    }
}

/// Permits changes and releases the held effects.
pub(super) fn permit(state: &mut AppState) -> Vec<Effect> {
    close(state);
    let Some(remote) = state.shared.real_craft() else { return Vec::new() };
    let connection = remote.connection;
    let mut effects = vec![Effect::Send(Command::PermitChanges(connection))];
    effects.append(&mut state.permission.held);
    state.permission.permitted = Some(connection);
    effects
}

/// Declines changes and drops the held effects.
pub(super) fn decline(state: &mut AppState) {
    close(state);
    let held = std::mem::take(&mut state.permission.held);
    if held.iter().any(|effect| matches!(effect, Effect::Cli(_))) {
        state.panels.cli.console.not_run("not run: changes were not permitted");
    }
    if held.iter().any(|effect| matches!(effect, Effect::Set(_))) {
        setting_changes::take_back(&mut state.shared);
    }
    if held.iter().any(|effect| matches!(effect, Effect::ReadSettings)) {
        setting_reading::take(&mut state.shared, Err(NOT_READ.to_owned()));
    }
    for effect in &held {
        if let Effect::Upload { id, .. } = effect {
            flight::forget_upload(&mut state.shared, *id);
        }
    }
    state.shared.notify(Severity::Info, "Nothing was changed.");
}

/// Drops the held effects if the question is gone: it was closed in another way, or its connection ended.
pub(super) fn follow(state: &mut AppState, connection_before: Option<u32>) {
    let connection = state.shared.real_craft().map(|remote| remote.connection);
    let is_asked = state.popups.contains(&Popup::Permission);
    if is_asked && connection != connection_before || !is_asked && !state.permission.held.is_empty() {
        decline(state);
    }
}

fn close(state: &mut AppState) {
    state.popups.retain(|popup| *popup != Popup::Permission);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;

    #[test]
    fn a_declined_upload_is_not_remembered_as_on_the_craft() {
        let mut state = AppState::bare((80, 24), SessionView::default());
        let id = state.shared.editor.plan().id();
        state.shared.editor.fly_after_upload = Some(id);
        let effect = flight::upload_now(&mut state.shared);
        assert_eq!(state.shared.editor.uploaded_last(), Some(id));
        state.permission.held.push(effect);
        decline(&mut state);
        assert_eq!(state.shared.editor.uploaded_last(), None);
        assert_eq!(state.shared.editor.fly_after_upload, None, "and no later upload flies");
    }
}
