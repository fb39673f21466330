//! Handles keys for the editor's popups, and replies of the files.

use crate::ui::acts::{findings, ground_under, plan_edits as plan, screen_layout};
use std::path::{Path, PathBuf};

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::layout::Rect;

use super::{diff, flight};
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::editor::{
    Browser, BrowserKey, EditorPopup, Form, FormKey, LossList, Purpose, Question,
};
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::files::{Conversion, FileReply, FileRequest};
use crate::ui::model::plan_id::PlanId;
use crate::ui::panel::editor_popup;
use crate::ui::shared::Shared;

/// The lines of differences that a page key scrolls.
const PAGE: usize = 8;

/// Handles a key while a popup of the editor is open.
pub(super) fn key(state: &mut Shared, event: KeyEvent) -> Vec<Effect> {
    match state.editor.popup.take() {
        Some(EditorPopup::Form(form)) => form_key(state, form, event),
        Some(EditorPopup::Browser(browser)) => browser_key(state, browser, event),
        Some(EditorPopup::Question(question)) => question_key(state, question, event),
        Some(EditorPopup::Losses(list)) => losses_key(state, list, event),
        None => Vec::new(),
    }
}

/// Handles a click on a row of a form or of the browser. Returns `None` if there is no such row at the cell.
pub(super) fn click(state: &mut Shared, cell: (u16, u16)) -> Option<Vec<Effect>> {
    let area = Rect::new(0, 0, state.size.0, state.size.1);
    match &state.editor.popup {
        Some(EditorPopup::Form(form)) => {
            let beside = screen_layout::screen(state).and_then(|screen| screen.form);
            let click = editor_popup::field_at(state, form, area, beside, cell)?;
            if let Some(EditorPopup::Form(form)) = &mut state.editor.popup {
                form.click(click);
            }
            Some(Vec::new())
        }
        Some(EditorPopup::Browser(browser)) => {
            let place = editor_popup::place_at(browser, area, cell)?;
            let Some(EditorPopup::Browser(mut browser)) = state.editor.popup.take() else { return None };
            let result = browser.click(place);
            Some(take_browser(state, browser, result))
        }
        Some(EditorPopup::Question(_) | EditorPopup::Losses(_)) | None => None,
    }
}

fn form_key(state: &mut Shared, mut form: Form, event: KeyEvent) -> Vec<Effect> {
    match form.key(event) {
        FormKey::Cancel => return Vec::new(),
        FormKey::Edited => {}
        FormKey::Accept => {
            match state.editor.take_form(&form, findings::home(state), state.cli_help.check_setting) {
                Ok((effects, reported)) => {
                    state.notify(Severity::Good, reported);
                    return effects;
                }
                Err(problem) => form.problem = Some(problem),
            }
        }
    }
    state.editor.popup = Some(EditorPopup::Form(form));
    Vec::new()
}

fn browser_key(state: &mut Shared, mut browser: Browser, event: KeyEvent) -> Vec<Effect> {
    let key = browser.key(event);
    take_browser(state, browser, key)
}

/// Carries out the result of a key or a click in the browser, which stays open unless it chose a file or was left.
fn take_browser(state: &mut Shared, browser: Browser, key: BrowserKey) -> Vec<Effect> {
    match key {
        BrowserKey::Cancel => {
            state.editor.quitting = false;
            return Vec::new();
        }
        BrowserKey::Chosen(path) => {
            return match browser.purpose {
                Purpose::Open => vec![open(state, path, false)],
                Purpose::Save(id) => vec![state.editor.write(id, path, false, false)],
                Purpose::Backdrop(id) => vec![Effect::Files(FileRequest::Backdrop(id, path))],
            };
        }
        BrowserKey::NothingChosen => {
            state.say(Severity::Info, "No file is chosen: type a name, or select one with ↓.");
        }
        BrowserKey::Edited | BrowserKey::List(_) => {}
    }
    state.editor.popup = Some(EditorPopup::Browser(browser));
    match key {
        BrowserKey::List(directory) => vec![Effect::Files(FileRequest::List(Some(directory)))],
        _ => Vec::new(),
    }
}

fn question_key(state: &mut Shared, question: Question, event: KeyEvent) -> Vec<Effect> {
    let answer = match event.code {
        KeyCode::Esc => 'n',
        KeyCode::Char(c) => c.to_ascii_lowercase(),
        _ => ' ',
    };
    match (question, answer) {
        (_, 'n') => {
            state.editor.quitting = false;
            Vec::new()
        }
        (Question::Replace { id, path, .. }, 'y') => vec![state.editor.write(id, path, true, false)],
        (Question::Replace { path, changed: true, .. }, 'r') => {
            vec![open(state, path, false)]
        }
        (Question::Replace { .. }, 'o') => plan::save_as(state),
        (Question::MovesTarget { id, .. }, 'y') => {
            state.editor.show_plan(id);
            vec![flight::upload_now(state)]
        }
        (Question::FliesWhich { id, .. }, 'y') => {
            state.editor.show_plan(id);
            flight::upload_and_fly(state)
        }
        (Question::FliesWhich { .. }, 'c') => flight::fly_stored(state),
        (Question::Unsaved { id, quits }, 's') => {
            state.editor.quitting = quits;
            save_plan(state, id)
        }
        (Question::Unsaved { id, quits }, 'd') => {
            let mut effects = state.editor.close(id);
            if quits {
                effects.extend(quit(state));
            }
            effects
        }
        (Question::Unsaved { quits: true, .. }, 'y') if !state.editor.loses_edits() => vec![Effect::Quit],
        (question, answer) => {
            if matches!((&question, answer), (Question::Unsaved { quits: true, .. }, 'y')) {
                let text = "Edits are not kept: `s` saves this plan, `d` discards its edits.";
                state.notify(Severity::Fault, text);
            }
            state.editor.popup = Some(EditorPopup::Question(question));
            Vec::new()
        }
    }
}

fn losses_key(state: &mut Shared, mut list: LossList, event: KeyEvent) -> Vec<Effect> {
    let last = list.losses.lines.len().saturating_sub(1);
    match event.code {
        KeyCode::Enter | KeyCode::Char('y' | 'Y') => {
            return vec![match list.losses.conversion {
                Conversion::Open(path) => open(state, path, true),
                Conversion::Save { id, path, replace } => state.editor.write(id, path, replace, true),
            }];
        }
        KeyCode::Esc | KeyCode::Char('n' | 'N') => {
            state.editor.quitting = false;
            return Vec::new();
        }
        KeyCode::Down | KeyCode::Char('j') => list.scroll = (list.scroll + 1).min(last),
        KeyCode::Up | KeyCode::Char('k') => list.scroll = list.scroll.saturating_sub(1),
        KeyCode::PageDown => list.scroll = (list.scroll + PAGE).min(last),
        KeyCode::PageUp => list.scroll = list.scroll.saturating_sub(PAGE),
        _ => {}
    }
    state.editor.popup = Some(EditorPopup::Losses(list));
    Vec::new()
}

/// Returns the request to open a file.
fn open(state: &Shared, path: PathBuf, accepted: bool) -> Effect {
    Effect::Files(FileRequest::Open { path, home: findings::home_above_sea(state), accepted })
}

fn save_plan(state: &mut Shared, id: PlanId) -> Vec<Effect> {
    state.editor.show_plan(id);
    plan::save(state)
}

/// Quits if all edits are saved; else asks about the first plan with an unsaved edit.
pub(super) fn quit(state: &mut Shared) -> Vec<Effect> {
    match state
        .editor
        .plans()
        .iter()
        .find(|plan| plan.is_unsaved())
        .map(crate::ui::model::editor::OpenPlan::id)
    {
        Some(id) => {
            state.editor.popup = Some(EditorPopup::Question(Question::Unsaved { id, quits: true }));
            Vec::new()
        }
        None => vec![Effect::Quit],
    }
}

/// Processes a reply of the files.
pub(super) fn answered(state: &mut Shared, reply: FileReply) -> Vec<Effect> {
    match reply {
        FileReply::Opened(opened) => {
            for note in &opened.notes {
                let note = state.keymap.in_force(note);
                state.notify(Severity::Info, note);
            }
            let of_plan = || format!("the plan {}", opened.history.document().name);
            let name = opened.file.as_ref().map_or_else(of_plan, |file| shown(file.as_path()));
            let reported = if opened.recovered {
                let [undo, save] =
                    [EditAction::Undo, EditAction::Save].map(|action| state.key(Action::Edit(action)));
                Some(format!(
                    "Unsaved edits of {name} were restored: `{undo}` undoes them, `{save}` saves them."
                ))
            } else {
                Some(format!("Opened {name}.")).filter(|_| opened.notes.is_empty())
            };
            state.editor.opened(*opened);
            if let Some(reported) = reported {
                state.notify(Severity::Good, reported);
            }
        }
        FileReply::Losses(losses) => {
            state.editor.popup = Some(EditorPopup::Losses(LossList { losses: *losses, scroll: 0 }));
        }
        FileReply::Saved { id, path, revision, lost } => {
            let name = shown(&path);
            state.editor.saved(id, path, revision);
            let differs = if lost.is_empty() { "" } else { " The log has its differences." };
            for line in lost {
                state.log_only(Severity::Warn, line);
            }
            state.notify(Severity::Good, format!("Saved {name}.{differs}"));
            if std::mem::take(&mut state.editor.quitting) {
                return quit(state);
            }
        }
        FileReply::OnDisk { id, document } => state.editor.on_disk = Some((id, document)),
        FileReply::SavedSettings { path, count } => {
            let name = shown(&path);
            state.notify(Severity::Good, format!("Saved {count} settings in {name}."));
        }
        FileReply::Occupied { id, path, changed } => {
            state.editor.popup = Some(EditorPopup::Question(Question::Replace { id, path, changed }));
        }
        FileReply::Changed(id) => {
            if let Some(title) = state.editor.changed_on_disk(id) {
                let [save, compare] =
                    [EditAction::Save, EditAction::Compare].map(|action| state.key(Action::Edit(action)));
                let text = format!(
                    "{title} changed on disk: `{compare}` compares, `{save}` asks before it replaces it."
                );
                state.notify(Severity::Warn, text);
            }
            // A comparison with the file goes on with its present contents.
            if state.editor.on_disk.as_ref().is_some_and(|(compared, _)| *compared == id) {
                return diff::read_file(state).into_iter().collect();
            }
        }
        FileReply::Backdrop { id, layer, is_new } => {
            let (name, vertices) = (shown(&layer.path), layer.vertices());
            if state.editor.add_backdrop(id, layer) && is_new {
                let noun = if vertices == 1 { "vertex" } else { "vertices" };
                state.notify(Severity::Good, format!("{name} is under the plan: {vertices} {noun}."));
            }
        }
        FileReply::Shown(id, row) => {
            state.editor.show_plan(id);
            state.editor.go_to_row(row);
        }
        FileReply::Listed(mut listing) => {
            if let Some(EditorPopup::Browser(browser)) = &mut state.editor.popup {
                let purpose = browser.purpose;
                listing.entries.retain(|entry| entry.is_directory || purpose.takes(&entry.name));
                browser.listing = listing;
                browser.at = None;
            }
        }
        FileReply::NotKept(sentence) => {
            state.editor.journal_fails = true;
            state.notify(Severity::Fault, sentence);
        }
        FileReply::KeepsNothing => state.editor.keeps_nothing = true,
        FileReply::NotRecorded(sentence) => state.notify(Severity::Warn, sentence),
        FileReply::KeptAgain => {
            state.editor.journal_fails = false;
            state.notify(Severity::Good, "Edits are kept again.");
        }
        FileReply::Ground { tiles, problems } => ground_under::read(state, tiles, problems),
        FileReply::EditsLost(text) => state.pin(text),
        FileReply::Failed(sentence) => {
            state.editor.quitting = false;
            state.notify(Severity::Fault, sentence);
        }
    }
    Vec::new()
}

fn shown(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
