//! The folder in which a firmware runs that keeps nothing: it is removed with the program, or at the next start when the
//! program was killed.

use std::fs::{File, TryLockError};
use std::io;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use rustix::fs::{Mode, OFlags};
use tempfile::TempDir;

/// Start of the names of these folders.
const PREFIX: &str = "betadeck-firmware-";
/// The folder in it in which the firmware runs: a drop-in locks the one in which it runs itself.
const WORK: &str = "work";
/// Folders that are tried when another program removes them as fast as they are made.
const ATTEMPTS: usize = 10;

/// A folder that is removed when it is dropped.
#[derive(Debug)]
pub(in crate::app) struct FirmwareFolder {
    /// Removed when it is dropped.
    _directory: TempDir,
    work: PathBuf,
    /// Locked as long as it is open: the system unlocks it when the program ends in whatever way.
    _lock: File,
}

impl FirmwareFolder {
    pub(super) fn make() -> io::Result<Self> {
        for _ in 0..ATTEMPTS {
            let directory = TempDir::with_prefix(PREFIX)?;
            // Another program that starts now may take it for a folder that was left, until it is locked.
            let Ok(lock) = open(directory.path()) else { continue };
            let work = directory.path().join(WORK);
            if is_locked_here(&lock) && std::fs::create_dir(&work).is_ok() {
                return Ok(Self { _directory: directory, work, _lock: lock });
            }
        }
        Err(io::Error::other("other programs remove it"))
    }

    /// The path of the folder in which the firmware runs.
    pub(super) fn path(&self) -> &Path {
        &self.work
    }
}

/// Removes the folders of this user that a killed program left among the temporary files.
pub(in crate::app) fn sweep() {
    let Ok(entries) = std::fs::read_dir(std::env::temp_dir()) else { return };
    let user = rustix::process::geteuid().as_raw();
    for entry in entries.flatten() {
        if !entry.file_name().to_string_lossy().starts_with(PREFIX) {
            continue;
        }
        let Ok(folder) = open(&entry.path()) else { continue };
        if folder.metadata().is_ok_and(|there| there.uid() == user) && is_locked_here(&folder) {
            // Follows no link, neither in the place of the folder nor in it.
            std::fs::remove_dir_all(entry.path()).ok();
        }
    }
}

/// Opens a directory that no link leads to.
fn open(path: &Path) -> io::Result<File> {
    let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
    Ok(File::from(rustix::fs::open(path, flags, Mode::empty())?))
}

/// Locks a folder; says whether no other program has. Some file systems know no locks.
fn is_locked_here(folder: &File) -> bool {
    !matches!(folder.try_lock(), Err(TryLockError::WouldBlock))
}
