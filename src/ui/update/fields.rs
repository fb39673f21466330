//! The text fields inside panels: while one is open in the focused panel, letters are text there.

use crossterm::event::KeyEvent;

use crate::ui::app_state::AppState;
use crate::ui::message::Effect;
use crate::ui::panel::Panel;
use crate::ui::text_field::TextField;

/// Returns the field that takes letters, if there is one.
pub(super) fn open(state: &mut AppState) -> Option<&mut TextField> {
    match state.shared.focus {
        Panel::Log if state.log_view.typing => Some(&mut state.log_view.search),
        Panel::World => state.knobs.field.as_mut(),
        _ => None,
    }
}

/// Handles a key while a field is open.
pub(super) fn key(state: &mut AppState, event: KeyEvent) -> Vec<Effect> {
    match state.shared.focus {
        Panel::Log => {
            state.log_view.search_key(&state.shared, event);
            Vec::new()
        }
        Panel::World => state.knobs.field_key(&mut state.shared, event),
        _ => Vec::new(),
    }
}

/// Closes the open field. Returns `true` if there was one.
pub(super) fn close(state: &mut AppState) -> bool {
    let was_open = open(state).is_some();
    if was_open {
        state.log_view.end_search();
        state.knobs.field = None;
    }
    was_open
}
