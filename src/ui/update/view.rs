//! The view: focus, window of the map, scrolling.

use crate::ui::app_state::AppState;
use crate::ui::knobs;
use crate::ui::layout;
use crate::ui::map_point;
use crate::ui::map_state::MapMode;
use crate::ui::message::Effect;
use crate::ui::panel;
use crate::ui::panel::Panel;
use crate::ui::shared::Shared;
use crate::ui::viewport::Viewport;

/// The factor of a zoom step of the map.
pub(super) const ZOOM_STEP: f64 = 1.5;

/// Gives a panel the focus.
pub(super) fn focus(state: &mut Shared, panel: Panel) -> Vec<Effect> {
    state.focus = panel;
    state.slots.visit(panel);
    Vec::new()
}

/// Gives the focus to the panel before or after the focused one in the order of numbers.
pub(super) fn focus_neighbour(state: &mut Shared, step: isize) -> Vec<Effect> {
    let count = Panel::ALL.len();
    let at = Panel::ALL.iter().position(|&panel| panel == state.focus).unwrap_or(0);
    focus(state, Panel::ALL[(at + count).wrapping_add_signed(step) % count])
}

/// Returns the current window of the map.
pub(super) fn viewport(state: &Shared) -> Option<Viewport> {
    let area = layout::screen(state)?.panel(Panel::Map)?;
    Some(Viewport::of(state, layout::inner(area)))
}

/// Keeps the craft in the middle of the map, at the current scale.
pub(super) fn follow(state: &mut Shared) -> Vec<Effect> {
    if let Some(view) = viewport(state) {
        state.map.mode = MapMode::Follow(view.scale);
    }
    Vec::new()
}

/// Moves the map by an eighth of its size.
pub(super) fn pan(state: &mut Shared, columns: f64, rows: f64) -> Vec<Effect> {
    if let Some(view) = viewport(state) {
        let (width, height) = (f64::from(view.area.width), f64::from(view.area.height));
        state.map.mode = view.panned(columns * (width / 8.0).ceil(), rows * (height / 8.0).ceil());
    }
    Vec::new()
}

/// Zooms around the edit cursor, else around the craft if it is in the window, else around the middle.
pub(super) fn zoom_map(state: &mut Shared, factor: f64) -> Vec<Effect> {
    if let Some(view) = viewport(state) {
        state.map.mode = match state.map.mode {
            MapMode::Follow(scale) => MapMode::Follow(scale * factor),
            MapMode::Fit | MapMode::Free { .. } => {
                let cursor = state.map.edit.map(|cursor| cursor.place);
                let place = cursor.or_else(|| map_point::craft(&state.view));
                let place = place.filter(|&place| view.screen_cell(place).is_some());
                view.zoomed(factor, place.unwrap_or(view.centre))
            }
        };
    }
    Vec::new()
}

pub(super) fn scroll(state: &mut AppState, by: isize) -> Vec<Effect> {
    scroll_panel(state, state.shared.focus, by);
    Vec::new()
}

/// Scrolls a panel by lines, within its content.
pub(super) fn scroll_panel(state: &mut AppState, panel: Panel, by: isize) {
    let Some(area) = layout::screen(&state.shared).and_then(|screen| screen.panel(panel)).map(layout::inner)
    else {
        return;
    };
    let (at, by, last) = match panel {
        Panel::State => {
            let last = state.transitions.len().saturating_sub(1);
            (&mut state.transitions.scroll, by, last)
        }
        Panel::Log => {
            let last = panel::log::last_scroll(&state.log_view, &state.shared, area);
            (&mut state.log_view.scroll, by, last)
        }
        Panel::Plan => {
            state.shared.editor.move_cursor(by, 0);
            return;
        }
        // The newest line of the CLI is at the bottom, so scrolling up increases its position.
        Panel::Cli => {
            let last = panel::cli::last_scroll(&state.cli, &state.shared, area);
            (&mut state.cli.scroll, by.saturating_neg(), last)
        }
        // The knob whose value is typed stays selected.
        Panel::World if state.knobs.field.is_some() => return,
        Panel::World => {
            let last = knobs::knobs(&state.shared).len().saturating_sub(1);
            (&mut state.knobs.selected, by, last)
        }
        Panel::Map | Panel::Rc | Panel::Graphs => return,
    };
    *at = (*at).min(last).saturating_add_signed(by).min(last);
}
