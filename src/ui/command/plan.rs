//! Commands that write or open files. Without a name they do the same as their keys.

use crate::ui::action::{Action, EditAction};
use crate::ui::app_state::AppState;
use crate::ui::editor::FileRequest;
use crate::ui::message::Effect;
use crate::ui::update;

pub(super) fn open(state: &mut AppState, _: &str, file: &str) -> Result<Vec<Effect>, String> {
    if file.is_empty() {
        return Ok(update::perform(state, Action::Edit(EditAction::Open)));
    }
    Ok(vec![Effect::Files(FileRequest::Open(file.into()))])
}

pub(super) fn save(state: &mut AppState, _: &str, file: &str) -> Result<Vec<Effect>, String> {
    if file.is_empty() {
        return Ok(update::perform(state, Action::Edit(EditAction::Save)));
    }
    let path = std::path::absolute(file).map_err(|error| format!("{file}: {error}."))?;
    Ok(vec![update::write_plan(state, path)])
}

pub(super) fn scenario(state: &mut AppState, _: &str, file: &str) -> Result<Vec<Effect>, String> {
    let path = if file.is_empty() {
        None
    } else {
        Some(std::path::absolute(file).map_err(|error| format!("{file}: {error}."))?)
    };
    Ok(update::write_scenario(state, path))
}

/// Returns nothing: file names are not completed here. `:open` alone lists the files.
pub(super) fn complete(_: &AppState, _: &str, _: &str) -> Vec<String> {
    Vec::new()
}
