//! The library of recorded flights: a folder of files, bounded in size.
//!
//! A recording is locked while it grows. Files are created under a fresh name, opened without following a link, and the
//! oldest are removed beyond the bound.

use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::io::{self, BufReader, ErrorKind, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::files::named_file::stem;
use crate::process::parallel;
use crate::recording::{Header, Listed, ReadError, Summary, TAIL, read_summary, seen_s};
use crate::runner::parallel::beside_a_flight;
use crate::storage::state_file::{self, Access};

/// The folder in the state directory.
pub(crate) const FOLDER: &str = "flights";
/// The extension of the files.
pub(crate) const EXTENSION: &str = "flight";
/// The most files that are listed.
const MAX_LISTED: usize = 10_000;
/// The most recordings of a second with the same name.
const MAX_NUMBERS: u32 = 100;

/// Returns the recordings in a state directory, the newest first.
///
/// # Errors
/// Returns the error of the system if the folder cannot be read. A missing folder is empty.
pub(crate) fn list(state: &Path) -> io::Result<Vec<Listed>> {
    Known::default().list(state)
}

/// The recordings of a library that were read before. They are read again only once they have changed.
#[derive(Debug, Default)]
pub(crate) struct Known(BTreeMap<PathBuf, (Fingerprint, Listed)>);

/// The size and the time of the last change of a file.
type Fingerprint = (u64, Option<SystemTime>);

impl Known {
    /// Returns the recordings in a state directory, the newest first.
    ///
    /// # Errors
    /// Returns the error of the system if the folder cannot be read. A missing folder is empty.
    pub(crate) fn list(&mut self, state: &Path) -> io::Result<Vec<Listed>> {
        let mut before = std::mem::take(&mut self.0);
        let mut changed = Vec::new();
        for path in files(&state.join(FOLDER))? {
            let fingerprint = path.symlink_metadata().ok().map(|there| (there.len(), there.modified().ok()));
            let Some(fingerprint) = fingerprint else { continue };
            let same =
                before.remove(&path).filter(|(then, listed)| *then == fingerprint && !listed.is_growing);
            match same {
                Some(same) => drop(self.0.insert(path, same)),
                None => changed.push((path, fingerprint)),
            }
        }
        let looked = look_at_all(&changed)?;
        let changed = changed.into_iter().zip(looked);
        self.0
            .extend(changed.filter_map(|((path, fingerprint), listed)| Some((path, (fingerprint, listed?)))));
        Ok(newest_first(self.0.values().map(|(_, listed)| listed.clone()).collect()))
    }
}

/// Deletes a recording from the library in a state directory, unless it is still being written.
///
/// # Errors
/// Returns the reason as the end of a sentence.
pub(crate) fn remove(state: &Path, path: &Path) -> Result<(), String> {
    if path.parent() != Some(&state.join(FOLDER)) || !is_recording(path) {
        return Err("it is not in the library".to_owned());
    }
    let file = state_file::open(path, Access::Read).map_err(|error| error.to_string())?;
    if matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)) {
        return Err("it is still being recorded".to_owned());
    }
    std::fs::remove_file(path).map_err(|error| error.to_string())
}

fn newest_first(mut listed: Vec<Listed>) -> Vec<Listed> {
    let date = |entry: &Listed| {
        entry.summary.as_ref().map_or_else(|_| String::new(), |summary| summary.header.date.clone())
    };
    listed.sort_by_cached_key(|entry| std::cmp::Reverse((date(entry), entry.file.clone())));
    listed
}

/// Returns the paths of the recordings in a folder, in the order of their names.
fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = match std::fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries?,
    };
    let paths = entries.flatten().map(|entry| entry.path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| is_recording(path)).take(MAX_LISTED).collect();
    paths.sort();
    Ok(paths)
}

fn is_recording(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == EXTENSION)
}

/// Returns what a list shows of files, in their order. A recording without an end is read whole, so several are read at
/// once.
fn look_at_all(files: &[(PathBuf, Fingerprint)]) -> io::Result<Vec<Option<Listed>>> {
    let paths: Vec<&Path> = files.iter().map(|(path, _)| path.as_path()).collect();
    let mut looked = Vec::with_capacity(paths.len());
    let look = |_, path: &Path| Some(look(path));
    // The screen lists them while it flies.
    let threads = beside_a_flight();
    let done = parallel::all(&paths, threads, &|| false, look, |listed, _| looked.push(listed));
    done.map_err(|error| io::Error::other(error.message))?;
    Ok(looked)
}

/// Returns what a list shows of a file; `None` if it is gone or no regular file.
fn look(path: &Path) -> Option<Listed> {
    let there = path.symlink_metadata().ok().filter(std::fs::Metadata::is_file)?;
    let mut file = match state_file::open(path, Access::Read) {
        Err(error) if error.kind() == ErrorKind::NotFound => return None,
        Err(error) => {
            let (bytes, summary) = (there.len(), Err(error.to_string()));
            return Some(Listed { file: path.to_owned(), bytes, is_growing: false, summary });
        }
        Ok(file) => file,
    };
    let bytes = file.metadata().ok()?.len();
    let is_growing = matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock));
    let summary = summary(&mut file, bytes).map_err(|error| error.to_string());
    Some(Listed { file: path.to_owned(), bytes, is_growing, summary })
}

fn summary(file: &mut File, bytes: u64) -> Result<Summary, ReadError> {
    let mut part = |from: u64| -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(from))?;
        file.take(TAIL as u64).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let head = part(0)?;
    let tail = part(bytes.saturating_sub(TAIL as u64))?;
    let mut summary = read_summary(&head, &tail)?;
    if summary.end.is_none() {
        file.seek(SeekFrom::Start(0))?;
        summary.seen_s = seen_s(BufReader::new(file))?;
    }
    Ok(summary)
}

/// The library while a program records its flights.
#[derive(Debug)]
pub(crate) struct Library {
    folder: PathBuf,
    /// The bound, bytes.
    most: u64,
    /// The recording under way.
    open: Option<Growing>,
}

#[derive(Debug)]
struct Growing {
    path: PathBuf,
    file: File,
    bytes: u64,
    /// The size of the others when they were last counted, bytes.
    others: u64,
}

impl Library {
    /// Returns the library in a state directory, bounded to `most` bytes.
    pub(crate) fn new(state: &Path, most: u64) -> Self {
        Self { folder: state.join(FOLDER), most, open: None }
    }

    /// Begins a recording.
    ///
    /// # Errors
    /// Returns the reason, the end of a sentence. There is no recording then.
    pub(crate) fn begin(&mut self, header: &Header, bytes: &[u8]) -> Result<(), String> {
        self.open = None;
        let begun = self.begin_at(header, bytes).map_err(|error| error.to_string());
        if let Err(problem) = begun.and_then(|()| self.make_room(0)) {
            self.discard();
            return Err(problem);
        }
        Ok(())
    }

    fn begin_at(&mut self, header: &Header, bytes: &[u8]) -> io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        state_file::sweep(&self.folder);
        let mut temporary = state_file::temporary_in(&self.folder, 0o600)?;
        temporary.write_all(bytes)?;
        let stem = format!("{}-{}", header.date.trim_end_matches('Z').replace(':', "-"), stem(&header.plan));
        for number in 1..=MAX_NUMBERS {
            let suffix = if number == 1 { String::new() } else { format!("-{number}") };
            let path = self.folder.join(format!("{stem}{suffix}.{EXTENSION}"));
            match temporary.persist_noclobber(&path) {
                Ok(file) => {
                    self.open = Some(Growing { path, file, bytes: bytes.len() as u64, others: 0 });
                    return Ok(());
                }
                Err(error) if error.error.kind() == ErrorKind::AlreadyExists => temporary = error.file,
                Err(error) => return Err(error.error),
            }
        }
        Err(io::Error::other("there are too many flights of this second"))
    }

    /// Adds to the recording under way, if there is one.
    ///
    /// # Errors
    /// Returns the reason, the end of a sentence. The recording then ends with what was written before.
    pub(crate) fn append(&mut self, bytes: &[u8]) -> Result<(), String> {
        let Some(open) = &self.open else { return Ok(()) };
        let more = bytes.len() as u64;
        let room = if open.bytes + open.others + more > self.most { self.make_room(more) } else { Ok(()) };
        let Some(open) = self.open.as_mut().filter(|_| room.is_ok()) else {
            self.open = None;
            return room;
        };
        open.bytes += more;
        let written = open.file.write_all(bytes);
        written.map_err(|error| {
            self.open = None;
            error.to_string()
        })
    }

    /// Ends the recording under way.
    ///
    /// # Errors
    /// Returns the reason, the end of a sentence.
    pub(crate) fn end(&mut self, bytes: &[u8]) -> Result<(), String> {
        self.append(bytes)?;
        let ended = self.open.take().map_or(Ok(()), |open| open.file.sync_all());
        ended.map_err(|error| error.to_string())
    }

    /// Deletes the recording under way.
    pub(crate) fn discard(&mut self) {
        if let Some(open) = self.open.take() {
            std::fs::remove_file(open.path).ok();
        }
    }

    /// Removes the oldest recordings until `more` bytes fit. Those that grow stay.
    fn make_room(&mut self, more: u64) -> Result<(), String> {
        let own = self.open.as_ref().map(|open| (open.path.clone(), open.bytes));
        let (own_path, own_bytes) = own.unwrap_or_default();
        let own_bytes = own_bytes + more;
        if own_bytes > self.most {
            let megabytes = self.most >> 20;
            return Err(format!("it takes more than --recordings-max-mb, {megabytes} MB"));
        }
        let others = files(&self.folder).map_err(|error| error.to_string())?;
        let others = others.into_iter().filter(|path| *path != own_path);
        let sizes: Vec<(PathBuf, u64)> =
            others.filter_map(|path| path.symlink_metadata().ok().map(|there| (path, there.len()))).collect();
        let mut sum: u64 = sizes.iter().map(|(_, bytes)| bytes).sum();
        for (path, bytes) in sizes {
            if sum + own_bytes > self.most && remove_unless_growing(&path) {
                sum -= bytes;
            }
        }
        if let Some(open) = &mut self.open {
            open.others = sum;
        }
        Ok(())
    }
}

/// Removes a recording that no program writes. Returns `true` if it is gone.
fn remove_unless_growing(path: &Path) -> bool {
    let Ok(file) = state_file::open(path, Access::Read) else { return false };
    !matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)) && std::fs::remove_file(path).is_ok()
}

#[cfg(test)]
mod tests;
