//! Reads, writes and watches plan files for the editor, on a thread of its own, in the order of asking.
//!
//! Every edit is appended to a journal in the state directory before the next request is looked at, so that a program
//! that is killed loses at most the edit of the last key. A journal belongs to the program that has locked it.
#![allow(clippy::disallowed_methods, reason = "the shell of the editor lives on wall-clock time")]

mod journal_file;
mod on_disk;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

use tokio::sync::mpsc::UnboundedSender;
use tokio::sync::watch;

use super::line_history::LineHistory;
use crate::plan::edit::{History, Journal, JournalLine, PlanDocument};
use crate::ui::editor::{FileReply, FileRequest, Opened, PlanId};
use journal_file::JournalFile;
use on_disk::Stamp;

/// How often files are looked at, whether somebody else changed them.
const WATCH: Duration = Duration::from_millis(500);

/// The plan files of a running editor.
#[derive(Debug)]
pub(super) struct PlanFiles {
    /// Where journals are kept; `None` keeps none.
    journals: Option<PathBuf>,
    open: BTreeMap<PlanId, OpenFile>,
    next: u32,
    /// Where plans were opened or saved last.
    directory: PathBuf,
    /// A journal could not be written, and that was told.
    told: bool,
    lines: LineHistory,
}

#[derive(Debug)]
struct OpenFile {
    path: Option<PathBuf>,
    /// What was on disk when it was read or written last.
    stamp: Option<Stamp>,
    /// The change was told.
    told: bool,
    /// The document with its history: what the journal's file holds, or is to hold as soon as there is something to keep.
    kept: Journal,
    journal: Option<JournalFile>,
    /// A line could not be written: the file is written anew before the next one counts.
    is_behind: bool,
}

impl PlanFiles {
    /// Keeps journals in this directory of the state.
    pub(super) fn new(state: Option<&Path>) -> Self {
        let journals = state.map(|state| state.join("plans"));
        let directory = std::env::current_dir().unwrap_or_else(|_| PathBuf::from("/"));
        Self {
            journals,
            open: BTreeMap::new(),
            next: 1,
            directory,
            told: false,
            lines: LineHistory::new(state),
        }
    }

    /// Takes in the plan that the program starts with, with the history that its journal has.
    pub(super) fn start_with(&mut self, path: Option<&Path>, document: PlanDocument) -> Opened {
        let path = path.and_then(|path| std::path::absolute(path).ok());
        if let Some(parent) = path.as_deref().and_then(Path::parent) {
            self.directory = parent.to_owned();
        }
        let stamp = path.as_deref().and_then(Stamp::of);
        self.take_in(path, stamp, document, Vec::new())
    }

    /// The plans with edits that were never saved, whose program is gone.
    pub(super) fn recovered(&mut self) -> Vec<Opened> {
        let Some(directory) = &self.journals else { return Vec::new() };
        let left = journal_file::left_behind(directory);
        left.into_iter()
            .map(|(file, journal)| {
                let path = journal.file.as_ref().map(PathBuf::from);
                let history = journal.history;
                let saved = history.saved_document();
                let is_known = path.as_deref().zip(saved).is_some_and(|(path, saved)| {
                    on_disk::holds(path, &saved) || on_disk::read(path).is_ok_and(|(there, _)| there == saved)
                });
                let stamp = path.as_deref().filter(|_| is_known).and_then(Stamp::of);
                let opened = self.keep(path, stamp, history, Some(file), Vec::new());
                Opened { recovered: true, ..opened }
            })
            .collect()
    }

    /// Carries requests out until nobody asks any more, and counts in `done` how many.
    pub(super) fn run(
        mut self,
        requests: &Receiver<FileRequest>,
        replies: &UnboundedSender<FileReply>,
        done: &watch::Sender<u64>,
    ) {
        loop {
            match requests.recv_timeout(WATCH) {
                Ok(request) => {
                    for reply in self.carry_out(request) {
                        replies.send(reply).ok();
                    }
                    done.send_modify(|done| *done += 1);
                }
                Err(RecvTimeoutError::Timeout) => {
                    for id in self.changed() {
                        replies.send(FileReply::Changed(id)).ok();
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    fn carry_out(&mut self, request: FileRequest) -> Vec<FileReply> {
        match request {
            FileRequest::Open(path) => vec![self.open(&path)],
            FileRequest::Save { id, path, document, revision, replace } => {
                self.save(id, path, *document, revision, replace)
            }
            FileRequest::List(directory) => vec![self.list(directory)],
            FileRequest::Journal(id, line) => self.append(id, &line).into_iter().collect(),
            FileRequest::KeepLine(field, line) => {
                self.lines.append(field, &line);
                Vec::new()
            }
            FileRequest::Begin(id, document) => {
                let kept = Journal { file: None, history: History::new(*document, false) };
                let (path, stamp, journal) = (None, None, None);
                let file = OpenFile { path, stamp, told: false, kept, journal, is_behind: false };
                self.open.insert(id, file);
                Vec::new()
            }
            FileRequest::Close { id, discard } => {
                let journal = self.open.remove(&id).and_then(|file| file.journal);
                if let Some(journal) = journal.filter(|_| discard) {
                    journal.remove();
                }
                Vec::new()
            }
        }
    }

    fn open(&mut self, path: &Path) -> FileReply {
        let path = match std::path::absolute(path) {
            Ok(path) => path,
            Err(error) => return FileReply::Failed(format!("Cannot open {}: {error}.", path.display())),
        };
        let stamp = Stamp::of(&path);
        let (document, notes) = match on_disk::read(&path) {
            Ok(read) => read,
            Err(sentence) => return FileReply::Failed(sentence),
        };
        if let Some(parent) = path.parent() {
            self.directory = parent.to_owned();
        }
        let known = self.open.iter().find(|(_, file)| file.path.as_deref() == Some(&path)).map(|(&id, _)| id);
        let opened = match known {
            Some(id) => self.read_again(id, path, stamp, document, notes),
            None => self.take_in(Some(path), stamp, document, notes),
        };
        FileReply::Opened(Box::new(opened))
    }

    /// What another program wrote takes the place of what is open, as an edit.
    fn read_again(
        &mut self,
        id: PlanId,
        path: PathBuf,
        stamp: Option<Stamp>,
        document: PlanDocument,
        mut notes: Vec<String>,
    ) -> Opened {
        let open = self.open.get(&id).map(|file| (file.kept.history.clone(), file.stamp));
        let (mut history, seen) = open.unwrap_or_else(|| (History::new(document.clone(), true), None));
        if stamp == seen {
            return Opened { id, file: Some(path), history, notes, recovered: false };
        }
        let is_held = *history.document() == document || on_disk::holds(&path, history.document());
        let label = "read again";
        let edited = if is_held { None } else { history.commit(label, document) };
        let edited = edited.map(|revision| Box::new(revision.change().clone()));
        let edited = edited.map(|change| JournalLine::Edited { label: label.to_owned(), change });
        if edited.is_some() {
            notes.push("Read again: `u` shows what you had.".to_owned());
        }
        history.mark_saved();
        for line in edited.into_iter().chain([JournalLine::Saved(path.display().to_string())]) {
            if let Some(FileReply::NotKept(sentence)) = self.append(id, &line) {
                notes.push(sentence);
            }
        }
        if let Some(file) = self.open.get_mut(&id) {
            file.stamp = stamp;
            file.told = false;
        }
        Opened { id, file: Some(path), history, notes, recovered: false }
    }

    /// Takes in a document that was read from `path`, with the history that its journal has.
    fn take_in(
        &mut self,
        path: Option<PathBuf>,
        mut stamp: Option<Stamp>,
        document: PlanDocument,
        mut notes: Vec<String>,
    ) -> Opened {
        let name = path.as_ref().map(|path| path.display().to_string());
        let found = match (&self.journals, &name) {
            (Some(directory), Some(name)) => journal_file::find(directory, name),
            _ => None,
        };
        let Some((file, journal)) = found else {
            return self.keep(path, stamp, History::new(document, true), None, notes);
        };
        let mut history = journal.history;
        let mut recovered = false;
        // A format that cannot carry everything reads as another document than was written.
        let is_held = |held: &PlanDocument| {
            *held == document || path.as_deref().is_some_and(|path| on_disk::holds(path, held))
        };
        let (holds_newest, saved) = (is_held(history.document()), history.saved_document());
        let is_unchanged = saved.as_ref().is_some_and(is_held);
        if holds_newest {
            history.mark_saved();
        } else if history.is_saved() || saved.is_none() {
            history.commit("changed on disk", document);
            history.mark_saved();
            notes.push("It was changed by another program: `u` shows what you had.".to_owned());
        } else {
            recovered = true;
            if !is_unchanged {
                // So that saving asks first.
                stamp = None;
                notes.push("Another program changed the file meanwhile, too.".to_owned());
            }
        }
        let opened = self.keep(path, stamp, history, Some(file), notes);
        Opened { recovered, ..opened }
    }

    fn keep(
        &mut self,
        path: Option<PathBuf>,
        stamp: Option<Stamp>,
        history: History,
        journal: Option<JournalFile>,
        notes: Vec<String>,
    ) -> Opened {
        let id = PlanId(self.next);
        self.next += 1;
        let name = path.as_ref().map(|path| path.display().to_string());
        let kept = Journal { file: name, history: history.clone() };
        // Written anew without what was cut short.
        let mut journal = journal;
        let is_behind = journal.as_mut().is_some_and(|journal| journal.rewrite(&kept).is_err());
        let file = OpenFile { path: path.clone(), stamp, told: false, kept, journal, is_behind };
        self.open.insert(id, file);
        Opened { id, file: path, history, notes, recovered: false }
    }

    fn save(
        &mut self,
        id: PlanId,
        path: PathBuf,
        document: PlanDocument,
        revision: usize,
        replace: bool,
    ) -> Vec<FileReply> {
        let Some(file) = self.open.get_mut(&id) else {
            return vec![FileReply::Failed("This plan is not open any more.".to_owned())];
        };
        let is_own = file.path.as_deref() == Some(path.as_path());
        let there = Stamp::of(&path);
        let is_known = is_own && there == file.stamp;
        if there.is_some() && !is_known && !replace {
            return vec![FileReply::Occupied { id, path, changed: is_own }];
        }
        let lost = match on_disk::write(&path, document) {
            Ok(lost) => lost,
            Err(sentence) => return vec![FileReply::Failed(sentence)],
        };
        file.stamp = Stamp::of(&path);
        file.told = false;
        file.path = Some(path.clone());
        if let Some(parent) = path.parent() {
            self.directory = parent.to_owned();
        }
        let kept = self.append(id, &JournalLine::Saved(path.display().to_string()));
        [FileReply::Saved { id, path, revision, lost }].into_iter().chain(kept).collect()
    }

    /// Appends a line to the journal of a plan; the first failure is told, and its end.
    fn append(&mut self, id: PlanId, line: &JournalLine) -> Option<FileReply> {
        let file = self.open.get_mut(&id)?;
        file.kept.take(line.clone());
        let directory = self.journals.as_deref()?;
        let written = match &mut file.journal {
            None => JournalFile::create(directory, &file.kept).map(|journal| file.journal = Some(journal)),
            Some(journal) if file.is_behind => journal.rewrite(&file.kept),
            Some(journal) => journal.append(line),
        };
        file.is_behind = written.is_err();
        let Err(error) = written else {
            let again = self.told && !self.open.values().any(|file| file.is_behind);
            self.told &= !again;
            return again.then_some(FileReply::KeptAgain);
        };
        let first = !std::mem::replace(&mut self.told, true);
        first.then(|| {
            FileReply::NotKept(format!(
                "Edits cannot be kept in {}: {error}. Save often.",
                directory.display()
            ))
        })
    }

    fn list(&self, directory: Option<PathBuf>) -> FileReply {
        on_disk::list(&directory.unwrap_or_else(|| self.directory.clone()))
            .map_or_else(FileReply::Failed, FileReply::Listed)
    }

    /// The plans whose file somebody else changed since this was told last.
    fn changed(&mut self) -> Vec<PlanId> {
        let mut changed = Vec::new();
        for (&id, file) in &mut self.open {
            let Some(path) = &file.path else { continue };
            let is_other = Stamp::of(path) != file.stamp;
            if is_other && !file.told {
                changed.push(id);
            }
            file.told = is_other;
        }
        changed
    }
}

#[cfg(test)]
mod tests;
