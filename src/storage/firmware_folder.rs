//! The folder of a firmware that keeps nothing. It is removed at the end of the program, or at the next start after a
//! kill.

use std::fs::{File, Permissions, TryLockError};
use std::io;
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use rustix::fs::{Mode, OFlags};
use tempfile::{Builder, TempDir};

/// The start of the names of these folders.
const PREFIX: &str = "betadeck-firmware-";
/// The subfolder in which the firmware runs. A drop-in locks its own working folder.
const WORK: &str = "work";
/// The number of attempts while another program removes the folders as fast as they are created.
const ATTEMPTS: usize = 10;

/// A folder that is removed on drop.
#[derive(Debug)]
pub struct FirmwareFolder {
    /// Removed on drop.
    _directory: TempDir,
    work: PathBuf,
    /// Locked while it is open. The system unlocks it when the program ends in any way.
    _lock: File,
}

impl FirmwareFolder {
    /// Makes a folder.
    ///
    /// # Errors
    /// Returns the system's error.
    pub fn make() -> io::Result<Self> {
        for _ in 0..ATTEMPTS {
            let for_owner = Permissions::from_mode(0o700);
            let directory = Builder::new().prefix(PREFIX).permissions(for_owner).tempdir()?;
            // Until it is locked, another program that starts now may treat the folder as abandoned.
            let Ok(lock) = open(directory.path()) else { continue };
            let work = directory.path().join(WORK);
            if is_locked_here(&lock) && std::fs::create_dir(&work).is_ok() {
                return Ok(Self { _directory: directory, work, _lock: lock });
            }
        }
        Err(io::Error::other("other programs remove it"))
    }

    /// Returns the path of the folder in which the firmware runs.
    pub fn path(&self) -> &Path {
        &self.work
    }
}

/// Removes the temporary folders of this user that a killed program left.
pub fn sweep() {
    let Ok(entries) = std::fs::read_dir(std::env::temp_dir()) else { return };
    let user = rustix::process::geteuid().as_raw();
    for entry in entries.flatten() {
        if !entry.file_name().to_string_lossy().starts_with(PREFIX) {
            continue;
        }
        let Ok(folder) = open(&entry.path()) else { continue };
        if folder.metadata().is_ok_and(|there| there.uid() == user) && is_locked_here(&folder) {
            // This follows no link, neither instead of the folder nor inside it.
            std::fs::remove_dir_all(entry.path()).ok();
        }
    }
}

/// Opens a directory, but not through a link.
fn open(path: &Path) -> io::Result<File> {
    let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
    Ok(File::from(rustix::fs::open(path, flags, Mode::empty())?))
}

/// Locks a folder. Returns `false` if another program has locked it. Some file systems have no locks.
fn is_locked_here(folder: &File) -> bool {
    !matches!(folder.try_lock(), Err(TryLockError::WouldBlock))
}
