//! The comparison of two versions: opens it, and requests what must be read.

use crate::ui::acts::diff::Against;
use crate::ui::acts::{diff, findings, setting_reading};
use crate::ui::app_state::AppState;
use crate::ui::model::editor::{Column, EditorPopup, Question};
use crate::ui::model::effect::Effect;
use crate::ui::model::files::FileRequest;
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::diff_view::DiffKey;
use crate::ui::popup::{DiffView, Popup};
use crate::ui::shared::Shared;

use super::view::focus;

/// Opens the most useful comparison of the open plan.
pub(super) fn open(state: &mut AppState) -> Vec<Effect> {
    let against = diff::most_useful(&state.shared);
    begin(state, against)
}

/// Opens the comparison with the file if the editor asks about a file that was changed on disk.
pub(super) fn instead_of_question(state: &mut AppState) -> Option<Vec<Effect>> {
    let Some(EditorPopup::Question(Question::Replace { changed: true, .. })) = state.shared.editor.popup
    else {
        return None;
    };
    state.shared.editor.popup = None;
    Some(begin(state, Against::File))
}

/// Shows another comparison in the open popup.
pub(in crate::ui) fn compare(state: &mut AppState, against: Against) -> Vec<Effect> {
    if let Some(Popup::Diff(view)) = state.popups.last_mut() {
        view.show(against);
    }
    read(&mut state.shared, against)
}

/// Carries out the result of a key or of the mouse.
pub(super) fn take(state: &mut AppState, result: DiffKey) -> Vec<Effect> {
    match result {
        DiffKey::Open => Vec::new(),
        DiffKey::Left => {
            state.popups.pop();
            Vec::new()
        }
        DiffKey::Other(against) => read(&mut state.shared, against),
        DiffKey::Waypoint(index) => {
            state.popups.pop();
            state.shared.editor.go_to_cell(index, Column::Type);
            focus(state, Panel::Plan)
        }
    }
}

fn begin(state: &mut AppState, against: Against) -> Vec<Effect> {
    state.popups.push(Popup::Diff(DiffView::new(against)));
    read(&mut state.shared, against)
}

/// Requests the values of a comparison that may be outdated or unknown.
fn read(state: &mut Shared, against: Against) -> Vec<Effect> {
    match against {
        Against::File => read_file(state).into_iter().collect(),
        // The craft has settings of the plan, too.
        Against::Settings(_) | Against::Craft => setting_reading::refresh(state).into_iter().collect(),
        Against::Revision(_) => Vec::new(),
    }
}

/// Returns the request to read the file of the open plan for a comparison.
pub(super) fn read_file(state: &Shared) -> Option<Effect> {
    let plan = state.editor.plan();
    let (id, path) = (plan.id(), plan.file()?.to_owned());
    Some(Effect::Files(FileRequest::ReadDisk { id, path, home: findings::home_above_sea(state) }))
}
