//! An open plan: its document with the history, and the file it came from.

use std::path::{Path, PathBuf};

use crate::plan::edit::{History, JournalLine, PlanDocument};
use crate::ui::model::backdrop::BackdropLayer;
use crate::ui::model::plan_id::PlanId;

/// An open plan.
#[derive(Debug, Clone)]
pub struct OpenPlan {
    id: PlanId,
    file: Option<PathBuf>,
    history: History,
    /// `true` if the file has other content than was last read or written.
    changed_on_disk: bool,
    opened_with: Vec<String>,
    /// The files under the plan on the map.
    backdrop: Vec<BackdropLayer>,
}

impl OpenPlan {
    /// Returns a plan with its history, as the files provided it.
    pub fn new(id: PlanId, file: Option<PathBuf>, history: History) -> Self {
        let opened_with = history.document().settings.clone();
        Self { id, file, history, changed_on_disk: false, opened_with, backdrop: Vec::new() }
    }

    pub fn id(&self) -> PlanId {
        self.id
    }

    /// Returns the current document.
    pub fn document(&self) -> &PlanDocument {
        self.history.document()
    }

    pub fn history(&self) -> &History {
        &self.history
    }

    /// Returns the settings that the plan had when it was opened.
    pub(in crate::ui) fn settings_at_opening(&self) -> &[String] {
        &self.opened_with
    }

    /// Returns the files under the plan on the map.
    pub fn backdrop(&self) -> &[BackdropLayer] {
        &self.backdrop
    }

    pub(super) fn backdrop_mut(&mut self) -> &mut Vec<BackdropLayer> {
        &mut self.backdrop
    }

    /// Returns its file, if it has one.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Returns the name of the file, else of the plan.
    pub fn title(&self) -> String {
        let file =
            self.file.as_deref().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        let name = &self.document().name;
        file.unwrap_or_else(|| if name.is_empty() { "unnamed".to_owned() } else { name.clone() })
    }

    /// Returns `true` if closing the plan loses an edit that no file holds.
    pub fn is_unsaved(&self) -> bool {
        !self.history.is_saved() && (self.file.is_some() || !self.history.is_empty())
    }

    /// Returns `true` if somebody else has changed the file since.
    pub fn is_changed_on_disk(&self) -> bool {
        self.changed_on_disk
    }

    pub(super) fn set_changed_on_disk(&mut self, changed: bool) {
        self.changed_on_disk = changed;
    }

    /// Makes an edit. Returns the line for the journal.
    pub(super) fn commit(&mut self, label: &str, after: PlanDocument) -> Option<JournalLine> {
        let revision = self.history.commit(label, after)?;
        Some(JournalLine::Edited { label: label.to_owned(), change: Box::new(revision.change().clone()) })
    }

    /// Undoes the last edit. Returns its label and the line for the journal.
    pub(super) fn undo(&mut self) -> Option<(String, JournalLine)> {
        let label = self.history.undo()?.to_owned();
        Some((label, JournalLine::Moved(self.history.at())))
    }

    /// Redoes the edit that was undone last.
    pub(super) fn redo(&mut self) -> Option<(String, JournalLine)> {
        let label = self.history.redo()?.to_owned();
        Some((label, JournalLine::Moved(self.history.at())))
    }

    /// Goes to the revision made before this one, or after it, in any branch. Returns the line for the journal.
    pub(super) fn go_in_time(&mut self, later: bool) -> Option<JournalLine> {
        let at = self.history.at();
        let to = if later { at.checked_add(1)? } else { at.checked_sub(1)? };
        self.history.go_to(to).then_some(JournalLine::Moved(to))
    }

    /// Records that this revision was written to a file.
    pub(super) fn saved(&mut self, file: PathBuf, revision: usize) {
        self.changed_on_disk = false;
        self.file = Some(file);
        if self.history.at() == revision {
            self.history.mark_saved();
        } else {
            self.history.mark_unsaved();
        }
    }
}
