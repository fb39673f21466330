//! Keys for the Settings panel that come before the settings of a remote craft, whose command line takes a while to tell them.

use crossterm::event::KeyEvent;

use super::key;
use crate::fc::CraftSettings;
use crate::ui::acts::setting_reading;
use crate::ui::app_state::AppState;
use crate::ui::model::action::{Action, Context, spec_of};
use crate::ui::model::effect::Effect;
use crate::ui::model::panel_table::Panel;

/// The most keys that wait.
const MOST: usize = 100;

/// Keeps a key that acts on settings which are still being read. Returns `true` if it waits.
pub(super) fn hold(state: &mut AppState, event: KeyEvent, found: Option<Action>) -> bool {
    let settings = &state.shared.settings;
    let is_read = settings.craft().is_some() || !settings.is_reading();
    let is_remote = state.shared.view.remote.is_some();
    if is_read || !is_remote || state.shared.focus != Panel::Settings || !state.popups.is_empty() {
        state.waiting_keys.clear();
        return false;
    }
    let context = found.and_then(spec_of).map(|spec| spec.context);
    match context {
        // Keys such as Esc act at once, and what was typed before them is over.
        Some(Context::Always) => {
            state.waiting_keys.clear();
            return false;
        }
        Some(Context::Global) | None if state.waiting_keys.is_empty() => return false,
        _ => {}
    }
    if state.waiting_keys.len() < MOST {
        state.waiting_keys.push(event);
    }
    true
}

/// Takes the settings of the craft, and carries out the keys that have waited for them. A mouse may have shown something
/// else in the meantime: the keys were not typed for that.
pub(super) fn take_settings(state: &mut AppState, reply: Result<Box<CraftSettings>, String>) -> Vec<Effect> {
    setting_reading::take(&mut state.shared, reply);
    let waiting = std::mem::take(&mut state.waiting_keys);
    let is_shown = state.shared.focus == Panel::Settings && state.popups.is_empty();
    if !is_shown || state.shared.settings.craft().is_none() {
        return Vec::new();
    }
    waiting.into_iter().flat_map(|event| key(state, event)).collect()
}
