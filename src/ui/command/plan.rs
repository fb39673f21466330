//! Commands that write or open files. Without a name they do the same as their keys.

use crate::ui::action::{Action, EditAction};
use crate::ui::editor::FileRequest;
use crate::ui::message::{Effect, Request};
use crate::ui::shared::Shared;

pub(super) fn open(_: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    if file.is_empty() {
        return Ok(vec![Request::Act(Action::Edit(EditAction::Open))]);
    }
    Ok(vec![Effect::Files(FileRequest::Open { path: file.into(), accepted: false }).into()])
}

pub(super) fn save(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    if file.is_empty() {
        return Ok(vec![Request::Act(Action::Edit(EditAction::Save))]);
    }
    let path = std::path::absolute(file).map_err(|error| format!("{file}: {error}."))?;
    Ok(vec![state.editor.write(state.editor.plan().id(), path, false, false).into()])
}

pub(super) fn scenario(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    let path = if file.is_empty() {
        None
    } else {
        Some(std::path::absolute(file).map_err(|error| format!("{file}: {error}."))?)
    };
    Ok(vec![state.write_scenario(path).into()])
}

/// Returns nothing: file names are not completed here. `:open` alone lists the files.
pub(super) fn complete(_: &Shared, _: &str, _: &str) -> Vec<String> {
    Vec::new()
}
