//! Reads the shown part of the shown series.

use crate::replay::{Curve, CurvesRequest};
use crate::ui::acts::screen_layout;
use crate::ui::model::effect::Effect;
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;

/// Requests the curves that are missing, while the graphs are on the screen.
pub(super) fn follow(state: &mut Shared) -> Option<Effect> {
    let is_read = state.view.replay.as_ref().is_some_and(|replay| replay.reading.is_none());
    if !is_read || screen_layout::screen(state)?.panel(Panel::Graphs).is_none() {
        return None;
    }
    let window = state.graphs.window(state.graphs.cursor_s(&state.view));
    let request = state.graphs.wanted_curves(state.series(), window)?;
    state.graphs.request_curves(request.clone());
    Some(Effect::Curves(request))
}

/// Takes the answer to a request. If the file cannot be read, the session reports it, and the curves before stay.
pub(super) fn take(state: &mut Shared, request: CurvesRequest, result: Result<Vec<Curve>, String>) {
    if let Ok(curves) = result {
        state.graphs.take_curves(request, curves);
    }
}
