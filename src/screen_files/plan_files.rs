//! Reads, writes and watches plan files for the editor. This runs on a thread of its own, in the order of the requests.
//!
//! Every edit is appended to a journal in the state directory before the next request, so that a killed program loses
//! at most the edit of the last key. A journal belongs to the program that has locked it.
#![allow(clippy::disallowed_methods, reason = "the shell of the editor lives on wall-clock time")]

mod backdrop_requests;
mod backdrops;
mod journal_file;
mod kept_plans;
mod on_disk;
mod settings_file;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

use tokio::sync::mpsc::UnboundedSender;
use tokio::sync::watch;

use crate::files::set_aside;
use crate::files::terrain::TerrainFiles;
use crate::plan::edit::{History, Journal, JournalLine, PlanDocument};
use crate::plan::format::HomePosition;
use crate::screen_files::layout_file::LayoutFile;
use crate::screen_files::line_history::LineHistory;
use crate::screen_files::screen_file::ScreenFile;
use crate::terrain::Tiles;
use crate::ui::PlanId;
use crate::ui::files::{Conversion, ConversionLosses, FileReply, FileRequest, Opened};
use backdrops::Backdrops;
use journal_file::{Found, JournalFile};
use on_disk::Content;

/// The interval between two checks for changes by other programs.
const WATCH: Duration = Duration::from_millis(500);

/// The edit from the readable part of a damaged journal to the plan that was saved after the damage.
const SAVED_LATER: &str = "saved later";

/// The plan files of a running editor.
#[derive(Debug)]
pub(crate) struct PlanFiles {
    /// The directory of the journals; `None` keeps no journals.
    journals: Option<PathBuf>,
    open: BTreeMap<PlanId, OpenFile>,
    next: u32,
    /// The directory in which a plan was last opened or saved.
    directory: PathBuf,
    /// `true` if it was reported that a journal could not be written.
    reported: bool,
    /// The losses of journals, as sentences that were not reported yet.
    lost: Vec<String>,
    lines: LineHistory,
    screen: ScreenFile,
    layouts: LayoutFile,
    ground: TerrainFiles,
    tiles: Arc<Tiles>,
    backdrops: Backdrops,
}

#[derive(Debug)]
struct OpenFile {
    path: Option<PathBuf>,
    /// The contents of the file when it was last read or written.
    seen: Content,
    /// `true` if the change was reported.
    reported: bool,
    /// The document with its history, as in the journal's file, or as it will be there once there is an edit to keep.
    kept: Journal,
    journal: Option<JournalFile>,
    /// `true` if a line could not be written. The file must then be rewritten before the next line counts.
    is_behind: bool,
    /// The differences that the user accepted at the last save.
    accepted: Vec<String>,
    /// The files under the plan on the map, and the number of their vertices.
    backdrop: Vec<(PathBuf, usize)>,
}

/// The consent of the user to a save.
#[derive(Debug, Clone, Copy)]
struct Consent {
    /// Replaces other contents of the file.
    replace: bool,
    /// Writes a file that differs from the plan.
    losses: bool,
}

impl OpenFile {
    fn new(
        (path, seen): (Option<PathBuf>, Content),
        (kept, journal): (Journal, Option<JournalFile>),
        is_behind: bool,
    ) -> Self {
        let (accepted, backdrop) = (Vec::new(), Vec::new());
        Self { path, seen, reported: false, kept, journal, is_behind, accepted, backdrop }
    }
}

impl PlanFiles {
    /// Keeps journals in this state directory.
    pub(crate) fn new(state: Option<&Path>) -> Self {
        let journals = state.map(|state| state.join("plans"));
        let directory = std::env::current_dir().unwrap_or_else(|_| PathBuf::from("/"));
        Self {
            journals,
            open: BTreeMap::new(),
            next: 1,
            directory,
            reported: false,
            lost: Vec::new(),
            lines: LineHistory::new(state),
            screen: ScreenFile::default(),
            layouts: LayoutFile::new(state),
            ground: TerrainFiles::default(),
            tiles: Arc::default(),
            backdrops: Backdrops::new(state),
        }
    }

    /// Reads elevation tiles from these directories; `tiles` were read before.
    pub(crate) fn read_ground(&mut self, ground: TerrainFiles, tiles: Arc<Tiles>) {
        (self.ground, self.tiles) = (ground, tiles);
    }

    /// Adds the plan with which the program starts, with the history in its journal.
    pub(crate) fn start_with(&mut self, path: Option<&Path>, document: PlanDocument) -> Opened {
        let path = path.and_then(|path| std::path::absolute(path).ok());
        if let Some(parent) = path.as_deref().and_then(Path::parent) {
            self.directory = parent.to_owned();
        }
        let mut seen = path.as_deref().map_or(Content::Missing, Content::of);
        let is_other = path.as_deref().is_some_and(|path| !seen.is_document(path, &document));
        if is_other && matches!(seen, Content::Bytes(_)) {
            // Another program changed the file after the document was read.
            seen = Content::Missing;
        }
        self.take_in(path, seen, document, Vec::new())
    }

    /// Returns one sentence for each journal that was found damaged or unreadable since the last call.
    pub(crate) fn take_losses(&mut self) -> Vec<String> {
        std::mem::take(&mut self.lost)
    }

    /// Returns the plans with unsaved edits whose program has ended.
    pub(crate) fn recovered(&mut self) -> Vec<Opened> {
        let Some(directory) = &self.journals else { return Vec::new() };
        let left = journal_file::left_behind(directory);
        self.lost.extend(left.set_aside.iter().map(set_aside::SetAside::sentence));
        left.found.into_iter().map(|found| self.recover(found)).collect()
    }

    fn recover(&mut self, found: Found) -> Opened {
        let path = found.journal.file.as_ref().map(PathBuf::from);
        let notes = found.notes();
        let has_saved = found.losses.has_saved;
        let (journal, mut history) = self.whole_part(found);
        let mut seen = path.as_deref().map_or(Content::Missing, Content::of);
        let newer = path.as_deref().filter(|_| has_saved).and_then(|path| on_disk::read(path, None).ok());
        if let Some(on_disk::Read { document, content, .. }) = newer {
            history.commit(SAVED_LATER, document);
            history.mark_saved();
            seen = content;
        } else {
            let saved = history.saved_document();
            let is_known =
                path.as_deref().zip(saved).is_some_and(|(path, saved)| seen.is_document(path, &saved));
            if !is_known {
                seen = Content::Missing;
            }
        }
        let recovered = !history.is_saved();
        let opened = self.keep(path, seen, history, journal, notes);
        Opened { recovered, ..opened }
    }

    /// Returns the readable part of a journal. A damaged file is first set aside. If that is not possible, it stays,
    /// and the journal continues in another file.
    fn whole_part(&mut self, found: Found) -> (Option<JournalFile>, History) {
        let Found { file, journal, losses } = found;
        let Some(line) = losses.line else { return (Some(file), journal.history) };
        let name = journal.file.as_deref().unwrap_or("an unnamed plan");
        let count = match losses.edits {
            1 => "1 edit".to_owned(),
            edits => format!("{edits} edits"),
        };
        let kept = file.set_copy_aside();
        let now = set_aside::place(&kept, file.path());
        self.lost.push(format!(
            "{count} of {name} could not be read: line {line} of the journal is damaged, or written by a later version. \
             {now}."
        ));
        (kept.is_ok().then_some(file), journal.history)
    }

    /// Carries out requests until there are no more senders, and counts them in `done`.
    pub(crate) fn run(
        mut self,
        requests: &Receiver<FileRequest>,
        replies: &UnboundedSender<FileReply>,
        done: &watch::Sender<u64>,
    ) {
        loop {
            match requests.recv_timeout(WATCH) {
                Ok(request) => {
                    self.carry_out(request).into_iter().for_each(|reply| drop(replies.send(reply)));
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
            FileRequest::Open { path, home, accepted } => {
                let opened = self.open(&path, home, accepted);
                let backdrop = match &opened {
                    FileReply::Opened(opened) => self.remembered_backdrop(opened.id),
                    _ => Vec::new(),
                };
                let lost = self.take_losses().into_iter().map(FileReply::EditsLost);
                std::iter::once(opened).chain(backdrop).chain(lost).collect()
            }
            FileRequest::Save { id, path, document, revision, replace, accepted } => {
                self.save(id, path, (*document, revision), Consent { replace, losses: accepted })
            }
            FileRequest::Backdrop(id, path) => vec![self.read_backdrop(id, &path, true)],
            FileRequest::NoBackdrop(id) => {
                self.forget_backdrop(id);
                Vec::new()
            }
            FileRequest::List(directory) => vec![self.list(directory)],
            FileRequest::Journal(id, line) => self.append(id, &line).into_iter().collect(),
            FileRequest::KeepLine(field, line) => {
                self.lines.append(field, &line);
                Vec::new()
            }
            FileRequest::ReadDisk { id, path, home } => vec![on_disk::compared(id, &path, home)],
            FileRequest::SaveSettings { path, text, count } => vec![settings_file::save(path, &text, count)],
            FileRequest::KeepLayout(line) => {
                self.layouts.append(&line).err().map(FileReply::Failed).into_iter().collect()
            }
            FileRequest::KeepScreen(texts) => {
                self.screen.write(&texts);
                Vec::new()
            }
            FileRequest::Ground { home, plan } => {
                let mut problems = Vec::new();
                let more = self.ground.read_more(&self.tiles, home, &plan, &mut problems);
                let tiles = more.map(Arc::new);
                if let Some(tiles) = &tiles {
                    self.tiles = Arc::clone(tiles);
                }
                vec![FileReply::Ground { tiles, problems }]
            }
            FileRequest::Begin(id, document) => {
                let kept = Journal { file: None, history: History::new(*document, false) };
                let file = OpenFile::new((None, Content::Missing), (kept, None), false);
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

    fn open(&mut self, path: &Path, home: Option<HomePosition>, accepted: bool) -> FileReply {
        let path = match std::path::absolute(path) {
            Ok(path) => path,
            Err(error) => return FileReply::Failed(format!("Cannot open {}: {error}.", path.display())),
        };
        let on_disk::Read { document, mut notes, losses, content: seen } = match on_disk::read(&path, home) {
            Ok(read) => read,
            Err(sentence) => return FileReply::Failed(sentence),
        };
        if !losses.is_lossless() && !accepted {
            return FileReply::Losses(Box::new(ConversionLosses::of(Conversion::Open(path), &losses)));
        }
        notes.extend(losses.findings.iter().map(ToString::to_string));
        if let Some(parent) = path.parent() {
            self.directory = parent.to_owned();
        }
        let known = self.open.iter().find(|(_, file)| file.path.as_deref() == Some(&path)).map(|(&id, _)| id);
        let opened = match known {
            Some(id) => self.read_again(id, path, seen, document, notes),
            None => self.take_in(Some(path), seen, document, notes),
        };
        FileReply::Opened(Box::new(opened))
    }

    /// Replaces the open plan by the file of another program, as an edit.
    fn read_again(
        &mut self,
        id: PlanId,
        path: PathBuf,
        content: Content,
        document: PlanDocument,
        mut notes: Vec<String>,
    ) -> Opened {
        let open = self.open.get(&id).map(|file| (file.kept.history.clone(), file.seen.clone()));
        let (mut history, seen) =
            open.unwrap_or_else(|| (History::new(document.clone(), true), Content::Missing));
        if content == seen {
            return Opened { id, file: Some(path), history, notes, recovered: false };
        }
        let is_held = *history.document() == document || content.is_written(&path, history.document());
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
            file.seen = content;
            file.reported = false;
        }
        Opened { id, file: Some(path), history, notes, recovered: false }
    }

    /// Adds a document that was read from `path`, with the history in its journal.
    fn take_in(
        &mut self,
        path: Option<PathBuf>,
        mut seen: Content,
        document: PlanDocument,
        mut notes: Vec<String>,
    ) -> Opened {
        let name = path.as_ref().map(|path| path.display().to_string());
        let journals = match (&self.journals, &name) {
            (Some(directory), Some(name)) => journal_file::find(directory, name),
            _ => journal_file::Journals::default(),
        };
        self.lost.extend(journals.set_aside.iter().map(set_aside::SetAside::sentence));
        let Some(found) = journals.found.into_iter().next() else {
            return self.keep(path, seen, History::new(document, true), None, notes);
        };
        notes.extend(found.notes());
        let has_saved = found.losses.has_saved;
        let (file, mut history) = self.whole_part(found);
        let mut recovered = false;
        // A format that cannot hold everything gives another document when it is read again.
        let is_held = |held: &PlanDocument| {
            *held == document || path.as_deref().is_some_and(|path| seen.is_written(path, held))
        };
        let (holds_newest, saved) = (is_held(history.document()), history.saved_document());
        let is_unchanged = saved.as_ref().is_some_and(is_held);
        if holds_newest {
            history.mark_saved();
        } else if has_saved {
            history.commit(SAVED_LATER, document);
            history.mark_saved();
        } else if history.is_saved() || saved.is_none() {
            history.commit("changed on disk", document);
            history.mark_saved();
            notes.push("It was changed by another program: `u` shows what you had.".to_owned());
        } else {
            recovered = true;
            if !is_unchanged {
                // This makes the next save ask first.
                seen = Content::Missing;
                notes.push("Another program has changed the file, too.".to_owned());
            }
        }
        let opened = self.keep(path, seen, history, file, notes);
        Opened { recovered, ..opened }
    }

    fn keep(
        &mut self,
        path: Option<PathBuf>,
        seen: Content,
        history: History,
        journal: Option<JournalFile>,
        notes: Vec<String>,
    ) -> Opened {
        let id = PlanId(self.next);
        self.next += 1;
        let name = path.as_ref().map(|path| path.display().to_string());
        let kept = Journal { file: name, history: history.clone() };
        // The journal is rewritten without the part that was cut short.
        let mut journal = journal;
        let is_behind = journal.as_mut().is_some_and(|journal| journal.rewrite(&kept).is_err());
        let file = OpenFile::new((path.clone(), seen), (kept, journal), is_behind);
        self.open.insert(id, file);
        Opened { id, file: path, history, notes, recovered: false }
    }

    fn save(
        &mut self,
        id: PlanId,
        path: PathBuf,
        (document, revision): (PlanDocument, usize),
        consent: Consent,
    ) -> Vec<FileReply> {
        let Some(file) = self.open.get_mut(&id) else {
            return vec![FileReply::Failed("This plan is no longer open.".to_owned())];
        };
        let is_own = file.path.as_deref() == Some(path.as_path());
        // The file is read again just before it is replaced.
        let there = Content::of(&path);
        let is_known = is_own && there.is_known_as(&file.seen);
        if there.is_there() && !is_known && !consent.replace {
            return vec![FileReply::Occupied { id, path, changed: is_own }];
        }
        let written = match on_disk::converted(&path, document) {
            Ok(written) => written,
            Err(sentence) => return vec![FileReply::Failed(sentence)],
        };
        let lost: Vec<String> = written.losses.findings.iter().map(ToString::to_string).collect();
        if !written.losses.is_lossless() && !consent.losses && file.accepted != lost {
            let replace = consent.replace;
            let asked = Conversion::Save { id, path, replace };
            return vec![FileReply::Losses(Box::new(ConversionLosses::of(asked, &written.losses)))];
        }
        if let Err(sentence) = on_disk::write(&path, &written.contents) {
            return vec![FileReply::Failed(sentence)];
        }
        file.accepted.clone_from(&lost);
        let seen = Content::Bytes(written.contents);
        file.seen = seen;
        file.reported = false;
        file.path = Some(path.clone());
        if let Some(parent) = path.parent() {
            self.directory = parent.to_owned();
        }
        if !is_own {
            self.keep_backdrop(id);
        }
        let kept = self.append(id, &JournalLine::Saved(path.display().to_string()));
        [FileReply::Saved { id, path, revision, lost }].into_iter().chain(kept).collect()
    }

    /// Appends a line to the journal of a plan. Reports the first failure, and the end of the failures.
    fn append(&mut self, id: PlanId, line: &JournalLine) -> Option<FileReply> {
        let file = self.open.get_mut(&id)?;
        file.kept.take(line.clone());
        let directory = self.journals.as_deref()?;
        let written = match &mut file.journal {
            None => JournalFile::create(directory, &file.kept).map(|journal| file.journal = Some(journal)),
            Some(journal) if file.is_behind => journal.rewrite(&file.kept),
            Some(journal) => journal.append(line, &file.kept),
        };
        file.is_behind = written.is_err();
        let Err(error) = written else {
            let again = self.reported && !self.open.values().any(|file| file.is_behind);
            self.reported &= !again;
            return again.then_some(FileReply::KeptAgain);
        };
        let first = !std::mem::replace(&mut self.reported, true);
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

    /// Returns the plans whose file another program changed since the last report.
    fn changed(&mut self) -> Vec<PlanId> {
        let mut changed = Vec::new();
        for (&id, file) in &mut self.open {
            let Some(path) = &file.path else { continue };
            let reported = std::mem::replace(&mut file.reported, Content::of(path) != file.seen);
            if file.reported && !reported {
                changed.push(id);
            }
        }
        changed
    }
}

#[cfg(test)]
mod tests;
