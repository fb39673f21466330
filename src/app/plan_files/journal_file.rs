//! A journal as a file that one program has locked.

use std::fs::{File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::plan::edit::{Journal, JournalLine};
use crate::storage::state_file::{self, Access};

/// Ending of journals.
const ENDING: &str = "journal";
/// Largest journal that is read, bytes: some hundred thousand edits.
const LARGEST: u64 = 64 << 20;
/// More journals of one plan than programs have it open.
const MOST: u32 = 1000;

/// A journal that is being written.
#[derive(Debug)]
pub(super) struct JournalFile {
    path: PathBuf,
    /// Locked as long as it is open.
    file: File,
}

impl JournalFile {
    /// Begins a journal.
    pub(super) fn create(directory: &Path, journal: &Journal) -> io::Result<Self> {
        std::fs::create_dir_all(directory)?;
        let stem = stem(journal.file.as_deref().unwrap_or("unnamed"));
        for number in 0..MOST {
            let path = directory.join(format!("{stem}-{number}.{ENDING}"));
            match OpenOptions::new().append(true).create_new(true).open(&path) {
                Ok(file) => {
                    let mut created = Self { path, file };
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

    /// Opens a journal that nobody has locked.
    fn open(path: PathBuf) -> Option<(Self, Journal)> {
        let file = state_file::open(&path, Access::Append).ok()?;
        lock(&file).ok()?;
        let text = state_file::read(&path, LARGEST).ok()??;
        let journal = Journal::read(&String::from_utf8_lossy(&text))?;
        Some((Self { path, file }, journal))
    }

    /// Writes the whole journal anew; what is there stays until the new one is complete.
    pub(super) fn rewrite(&mut self, journal: &Journal) -> io::Result<()> {
        let text: String = journal.lines().iter().map(JournalLine::to_text).collect();
        let there = state_file::read(&self.path, LARGEST);
        // A hard link would let later lines appear in another file.
        if there.is_ok_and(|there| there.as_deref() == Some(text.as_bytes()))
            && !state_file::has_other_names(&self.file)
        {
            return Ok(());
        }
        self.file = state_file::replace(&self.path, text.as_bytes())?;
        Ok(())
    }

    /// Appends a line; a part of one does not stay.
    pub(super) fn append(&mut self, line: &JournalLine) -> io::Result<()> {
        let length = self.file.metadata()?.len();
        self.file.write_all(line.to_text().as_bytes()).inspect_err(|_| {
            self.file.set_len(length).ok();
        })
    }

    /// Deletes it.
    pub(super) fn remove(self) {
        std::fs::remove_file(&self.path).ok();
    }
}

fn lock(file: &File) -> io::Result<()> {
    match file.try_lock() {
        Err(std::fs::TryLockError::Error(error)) if error.kind() != io::ErrorKind::Unsupported => Err(error),
        Err(std::fs::TryLockError::WouldBlock) => Err(io::ErrorKind::WouldBlock.into()),
        _ => Ok(()),
    }
}

/// The journal of a plan that nobody has locked.
pub(super) fn find(directory: &Path, name: &str) -> Option<(JournalFile, Journal)> {
    // All of them are looked at: a plan that was saved under another name kept its journal.
    paths(directory)
        .into_iter()
        .filter_map(JournalFile::open)
        .find(|(_, journal)| journal.file.as_deref() == Some(name))
}

/// The journals with edits that were never saved, which nobody has locked.
pub(super) fn left_behind(directory: &Path) -> Vec<(JournalFile, Journal)> {
    state_file::sweep(directory);
    let left = paths(directory).into_iter().filter_map(JournalFile::open);
    left.filter(|(_, journal)| !journal.history.is_saved() && !journal.history.is_empty()).collect()
}

fn paths(directory: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(directory) else { return Vec::new() };
    let is_journal = |path: &PathBuf| {
        // Only what this program wrote: a FIFO would make it wait, a huge file fill the memory.
        let is_sound = path.symlink_metadata().is_ok_and(|there| there.is_file() && there.len() <= LARGEST);
        is_sound && path.extension().is_some_and(|ending| ending == ENDING)
    };
    let mut paths: Vec<PathBuf> =
        entries.filter_map(Result::ok).map(|entry| entry.path()).filter(is_journal).collect();
    paths.sort();
    paths
}

/// The name of a plan's journals: the file's own name, and a checksum of its whole path (FNV-1a).
fn stem(name: &str) -> String {
    let sum = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |sum, byte| {
        (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    let own = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let own: String = own.chars().filter(char::is_ascii_alphanumeric).take(24).collect();
    format!("{own}-{sum:016x}")
}
