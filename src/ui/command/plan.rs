//! Commands that write or open files. Without a name they do the same as their keys.

use std::path::PathBuf;

use crate::ui::acts::findings;
use crate::ui::model::action::{Action, EditAction, PanelAction};
use crate::ui::model::effect::{Effect, FlightForm};
use crate::ui::model::files::FileRequest;
use crate::ui::model::message::{Change, Request};
use crate::ui::shared::Shared;

/// The argument that removes the backdrop.
const OFF: &str = "off";

pub(super) fn open(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    if file.is_empty() {
        return Ok(vec![Request::Act(Action::Edit(EditAction::Open))]);
    }
    Ok(vec![
        Effect::Files(FileRequest::Open {
            path: file.into(),
            home: findings::home_above_sea(state),
            accepted: false,
        })
        .into(),
    ])
}

pub(super) fn save(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    if file.is_empty() {
        return Ok(vec![Request::Act(Action::Edit(EditAction::Save))]);
    }
    let path = std::path::absolute(file).map_err(|error| format!("{file}: {error}."))?;
    Ok(vec![state.editor.write(state.editor.plan().id(), path, false, false).into()])
}

pub(super) fn scenario(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    Ok(vec![state.write_flight(FlightForm::Scenario, named(file)?).into()])
}

pub(super) fn log(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    Ok(vec![state.write_flight(FlightForm::Log, named(file)?).into()])
}

pub(super) fn record(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    Ok(vec![state.write_recording(named(file)?).into()])
}

/// Returns the path of a file if it has a name.
fn named(file: &str) -> Result<Option<PathBuf>, String> {
    let absolute = |file| std::path::absolute(file).map_err(|error| format!("{file}: {error}."));
    Some(file).filter(|file| !file.is_empty()).map(absolute).transpose()
}

/// Runs `backdrop FILE` and `backdrop off`.
pub(super) fn backdrop(state: &mut Shared, _: &str, file: &str) -> Result<Vec<Request>, String> {
    if file.is_empty() {
        return Ok(vec![Request::Act(Action::Panel(PanelAction::Backdrop))]);
    }
    if file == OFF {
        return Ok(vec![Change::NoBackdrop.into()]);
    }
    let path = std::path::absolute(file).map_err(|error| format!("{file}: {error}."))?;
    Ok(vec![Effect::Files(FileRequest::Backdrop(state.editor.plan().id(), path)).into()])
}

pub(super) fn complete_backdrop(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    if OFF.starts_with(typed) { vec![OFF.to_owned()] } else { Vec::new() }
}

/// Returns nothing: file names are not completed here. `:open` alone lists the files.
pub(super) fn complete(_: &Shared, _: &str, _: &str) -> Vec<String> {
    Vec::new()
}
