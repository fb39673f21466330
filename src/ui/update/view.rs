//! The view: focus and scrolling.

use super::carry_out;
use crate::ui::acts::{screen_layout, setting_reading};
use crate::ui::app_state::AppState;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::panel_table::Panel;

/// Draws the whole screen again, whatever another program has written on it.
pub(super) fn redraw(state: &mut AppState) -> Vec<Effect> {
    state.shared.notify(Severity::Info, "The screen is drawn again.");
    vec![Effect::Redraw]
}

/// Gives a panel the focus.
pub(super) fn focus(state: &mut AppState, panel: Panel) -> Vec<Effect> {
    let before = state.shared.focus;
    if before != panel {
        state.panels.of_mut(panel).visit();
        state.has_chosen = false;
        if !before.takes_text() {
            state.before_text = before;
        }
    }
    state.shared.focus = panel;
    // The place counts, which another panel may have swapped.
    let place = state.shared.arrangement.place_of(panel);
    state.shared.slots.visit(place);
    Vec::new()
}

/// Gives a panel the focus, and asks for the settings if it shows them and they may be outdated: keys typed ahead act on
/// the newest.
pub(super) fn show(state: &mut AppState, panel: Panel) -> Vec<Effect> {
    let mut effects = focus(state, panel);
    if panel == Panel::Settings {
        effects.extend(setting_reading::follow(&mut state.shared));
    }
    effects
}

/// Gives the focus to the panel before or after the focused one in the order of numbers.
pub(super) fn focus_neighbour(state: &mut AppState, step: isize) -> Vec<Effect> {
    let count = Panel::ALL.len();
    let at = Panel::ALL.iter().position(|&panel| panel == state.shared.focus).unwrap_or(0);
    focus(state, Panel::ALL[(at + count).wrapping_add_signed(step) % count])
}

/// Scrolls the focused panel by lines.
pub(super) fn scroll(state: &mut AppState, by: isize) -> Vec<Effect> {
    let panel = state.shared.focus;
    let area =
        screen_layout::screen(&state.shared).and_then(|screen| screen.panel(panel)).map(screen_layout::inner);
    let Some(area) = area else { return Vec::new() };
    let requests = state.panels.of_mut(panel).scroll(&state.shared, area, by);
    carry_out(state, requests)
}
