//! A journal file that is locked by one program.

use std::fs::{File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::files::set_aside;
use crate::files::set_aside::SetAside;
use crate::plan::edit::{Journal, JournalLine, Losses};
use crate::storage::state_file::{self, Access};

const EXTENSION: &str = "journal";
/// The largest journal that is read, bytes: some hundred thousand edits.
const LARGEST: u64 = 64 << 20;
/// The length above which a journal is compacted, bytes: its older edits become one.
const LONGEST: usize = 16 << 20;
/// A number of journals that is larger than the number of programs with the same plan.
const MOST: u32 = 1000;

/// A journal in use.
#[derive(Debug)]
pub(super) struct JournalFile {
    path: PathBuf,
    /// Locked while it is open.
    file: File,
    /// The length above which it is compacted, bytes.
    longest: usize,
    /// The new number of every revision in a compacted file, and the number of revisions there.
    numbers: Option<(Vec<Option<usize>>, usize)>,
}

/// An unlocked journal that was read.
#[derive(Debug)]
pub(super) struct Found {
    pub(super) file: JournalFile,
    pub(super) journal: Journal,
    pub(super) losses: Losses,
}

impl Found {
    /// Returns notes about a journal that lost at most its last edit.
    pub(super) fn notes(&self) -> Vec<String> {
        let is_cut_short = self.losses.is_cut_short && self.losses.line.is_none();
        let note = "The newest edit was cut off when the program ended, and is lost.";
        is_cut_short.then(|| note.to_owned()).into_iter().collect()
    }
}

/// The contents of a directory of journals.
#[derive(Debug, Default)]
pub(super) struct Journals {
    /// The journals that could be read, at least their beginning.
    pub(super) found: Vec<Found>,
    /// The journals that could not be read at all.
    pub(super) set_aside: Vec<SetAside>,
}

impl JournalFile {
    pub(super) fn create(directory: &Path, journal: &Journal) -> io::Result<Self> {
        std::fs::create_dir_all(directory)?;
        let stem = stem(journal.file.as_deref().unwrap_or("unnamed"));
        for number in 0..MOST {
            let path = directory.join(format!("{stem}-{number}.{EXTENSION}"));
            match OpenOptions::new().append(true).create_new(true).open(&path) {
                Ok(file) => {
                    let mut created = Self::new(path, file);
                    return match lock(&created.file).and_then(|()| created.rewrite(journal)) {
                        Ok(()) => Ok(created),
                        Err(error) => {
                            created.remove();
                            Err(error)
                        }
                    };
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other("too many journals of this plan"))
    }

    fn new(path: PathBuf, file: File) -> Self {
        Self { path, file, longest: LONGEST, numbers: None }
    }

    /// Opens a journal; `None` if another program has locked it, if it cannot be read now, or if it is empty because its
    /// program was killed before its first line was written.
    fn open(path: PathBuf) -> Option<Result<Found, SetAside>> {
        let file = state_file::open(&path, Access::Append).ok()?;
        lock(&file).ok()?;
        let file = Self::new(path, file);
        let length = file.file.metadata().ok()?.len();
        if length == 0 {
            return None;
        }
        if length > LARGEST {
            let why = format!("it is larger than {} MiB", LARGEST >> 20);
            return Some(Err(set_aside::away(&file.path, why)));
        }
        let text = state_file::read(&file.path, LARGEST).ok()??;
        Some(match Journal::read_whole_part(&String::from_utf8_lossy(&text)) {
            Some((journal, losses)) => Ok(Found { file, journal, losses }),
            None => {
                let why = "its first line is damaged, or written by a later version";
                Err(set_aside::away(&file.path, why.to_owned()))
            }
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Keeps a copy of the file under another name.
    ///
    /// # Errors
    /// Returns the reason why there is no copy. The file must then stay unchanged.
    pub(super) fn set_copy_aside(&self) -> io::Result<PathBuf> {
        set_aside::copy(&self.path)
    }

    /// Rewrites the whole journal. If it is too long, its older edits become one. The old file stays until the new
    /// one is complete.
    pub(super) fn rewrite(&mut self, journal: &Journal) -> io::Result<()> {
        let text_of =
            |journal: &Journal| journal.lines().iter().map(JournalLine::to_text).collect::<String>();
        let mut text = text_of(journal);
        let mut numbers = None;
        if text.len() > self.longest {
            let (newest, found) = journal.newest(self.longest / 2);
            text = text_of(&newest);
            numbers = Some((found, newest.history.len()));
        }
        self.numbers = numbers;
        let there = state_file::read(&self.path, LARGEST);
        // With a hard link, later lines would appear in another file.
        if there.is_ok_and(|there| there.as_deref() == Some(text.as_bytes()))
            && !state_file::has_other_names(&self.file)
        {
            return Ok(());
        }
        self.file = state_file::replace(&self.path, text.as_bytes())?;
        Ok(())
    }

    /// Appends a line that was applied to `journal`. A partly written line is removed.
    pub(super) fn append(&mut self, line: &JournalLine, journal: &Journal) -> io::Result<()> {
        let length = self.file.metadata()?.len();
        let Some(text) = self.numbered(line, journal).map(|line| line.to_text()) else {
            return self.rewrite(journal);
        };
        if length.saturating_add(text.len() as u64) > self.longest as u64 {
            return self.rewrite(journal);
        }
        self.file.write_all(text.as_bytes()).inspect_err(|_| {
            self.file.set_len(length).ok();
        })
    }

    /// Returns a line with the number of the revision in the file; `None` if the file does not have that revision.
    fn numbered(&mut self, line: &JournalLine, journal: &Journal) -> Option<JournalLine> {
        let Some((numbers, count)) = &mut self.numbers else { return Some(line.clone()) };
        match line {
            JournalLine::Moved(revision) => numbers.get(*revision).copied()?.map(JournalLine::Moved),
            JournalLine::Edited { .. } => {
                *count += 1;
                numbers.resize(journal.history.len(), None);
                numbers.push(Some(*count));
                Some(line.clone())
            }
            JournalLine::Opened { .. } | JournalLine::Saved(_) | JournalLine::Unsaved => Some(line.clone()),
        }
    }

    pub(super) fn remove(self) {
        std::fs::remove_file(&self.path).ok();
    }
}

impl Drop for JournalFile {
    /// Unlocks the journal at once. To close it is not enough, because a starting child process also has its
    /// descriptor and would keep the lock until it runs.
    fn drop(&mut self) {
        self.file.unlock().ok();
    }
}

fn lock(file: &File) -> io::Result<()> {
    match file.try_lock() {
        Err(std::fs::TryLockError::Error(error)) if error.kind() != io::ErrorKind::Unsupported => Err(error),
        Err(std::fs::TryLockError::WouldBlock) => Err(io::ErrorKind::WouldBlock.into()),
        _ => Ok(()),
    }
}

/// Returns the unlocked journal of a plan.
pub(super) fn find(directory: &Path, name: &str) -> Journals {
    // All journals are read, because a plan that was saved under another name kept its journal.
    let mut journals = Journals::default();
    for opened in paths(directory).into_iter().filter_map(JournalFile::open) {
        match opened {
            Ok(found) if found.journal.file.as_deref() == Some(name) => {
                journals.found.push(found);
                break;
            }
            Ok(_) => {}
            Err(set_aside) => journals.set_aside.push(set_aside),
        }
    }
    journals
}

/// Returns the unlocked journals that are damaged or have unsaved edits.
pub(super) fn left_behind(directory: &Path) -> Journals {
    state_file::sweep(directory);
    let mut journals = Journals::default();
    for opened in paths(directory).into_iter().filter_map(JournalFile::open) {
        match opened {
            Ok(found) => {
                let history = &found.journal.history;
                if found.losses.line.is_some() || !history.is_saved() && !history.is_empty() {
                    journals.found.push(found);
                }
            }
            Err(set_aside) => journals.set_aside.push(set_aside),
        }
    }
    journals
}

fn paths(directory: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(directory) else { return Vec::new() };
    let is_journal = |path: &PathBuf| {
        // Only files written by this program are opened: a FIFO would make it wait.
        let is_sound = path.symlink_metadata().is_ok_and(|there| there.is_file());
        is_sound && path.extension().is_some_and(|extension| extension == EXTENSION)
    };
    let mut paths: Vec<PathBuf> =
        entries.filter_map(Result::ok).map(|entry| entry.path()).filter(is_journal).collect();
    paths.sort();
    paths
}

/// Returns the name of a plan's journals: the file's own name, and a checksum of its whole path (FNV-1a).
fn stem(name: &str) -> String {
    let sum = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |sum, byte| {
        (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    let own = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let own: String = own.chars().filter(char::is_ascii_alphanumeric).take(24).collect();
    format!("{own}-{sum:016x}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::edit::{History, PlanDocument};

    #[test]
    fn a_journal_is_free_when_its_program_ends_though_a_child_still_has_its_descriptor() {
        let directory = tempfile::tempdir().unwrap();
        let journal =
            Journal { file: Some("a.toml".to_owned()), history: History::new(PlanDocument::default(), true) };
        let file = JournalFile::create(directory.path(), &journal).unwrap();
        assert!(find(directory.path(), "a.toml").found.is_empty(), "it is locked");
        // A child process has the descriptors of the program until it becomes another program.
        let inherited = file.file.try_clone().unwrap();
        drop(file);
        assert_eq!(find(directory.path(), "a.toml").found.len(), 1);
        drop(inherited);
    }

    #[test]
    fn a_kill_while_a_journal_is_made_is_no_damage() {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("plan-0.journal"), "").unwrap();
        for journals in [left_behind(directory.path()), find(directory.path(), "plan")] {
            assert!(journals.found.is_empty() && journals.set_aside.is_empty(), "{journals:?}");
        }
    }

    fn named(name: usize) -> PlanDocument {
        PlanDocument { name: name.to_string(), ..PlanDocument::default() }
    }

    #[test]
    fn a_journal_stays_short_however_long_a_plan_is_edited_and_undo_goes_on_from_its_file() {
        let directory = tempfile::tempdir().unwrap();
        let mut journal = Journal { file: Some("a.toml".to_owned()), history: History::new(named(0), true) };
        let mut file = JournalFile::create(directory.path(), &journal).unwrap();
        file.longest = 4096;
        let path = file.path.clone();
        let read = || Journal::read_whole_part(&std::fs::read_to_string(&path).unwrap()).unwrap().0;
        let mut take = |journal: &mut Journal, line: JournalLine| {
            assert!(journal.take(line.clone()));
            file.append(&line, journal).unwrap();
            assert!(file.file.metadata().unwrap().len() <= 4096);
            let kept = read();
            assert_eq!(kept.history.document(), journal.history.document());
            assert_eq!(kept.history.saved_document(), journal.history.saved_document());
        };
        for edit in 1..=300 {
            let mut history = journal.history.clone();
            let revision = history.commit("edit", named(edit)).unwrap();
            let (label, change) = ("edit".to_owned(), Box::new(revision.change().clone()));
            take(&mut journal, JournalLine::Edited { label, change });
            if edit == 100 {
                take(&mut journal, JournalLine::Saved("a.toml".to_owned()));
            }
            if edit % 7 == 0 {
                take(&mut journal, JournalLine::Moved(edit - 3));
                take(&mut journal, JournalLine::Moved(edit));
            }
        }
        // Undoes further back than the file goes, and edits from there.
        take(&mut journal, JournalLine::Moved(40));
        let mut history = journal.history.clone();
        let revision = history.commit("edit", named(1000)).unwrap();
        let (label, change) = ("edit".to_owned(), Box::new(revision.change().clone()));
        take(&mut journal, JournalLine::Edited { label, change });
        take(&mut journal, JournalLine::Moved(299));
    }
}
