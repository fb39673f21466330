//! Opens and replaces the files of the state directory.
//!
//! Nothing is read or written through a symbolic link, and a pipe or a device does not block the program. A
//! replacement is first written under a fresh name, which no other program can have taken beforehand.

use std::ffi::OsStr;
use std::fs::{File, Permissions, TryLockError};
use std::io::{self, Read as _, Write as _};
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::path::Path;

use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use tempfile::NamedTempFile;

/// The start and the end of the names of temporary files.
const TEMPORARY: (&str, &str) = (".betadeck-", ".tmp");

/// The access with which a file is opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    Read,
    /// Reading and appending.
    Append,
    /// Reading and appending. A missing file is created.
    AppendOrCreate,
}

/// Opens a regular file, without following a link in its last component.
///
/// # Errors
/// Returns an error if the system refuses, or if the name is that of a link, a pipe or a device.
pub fn open(path: &Path, access: Access) -> io::Result<File> {
    let usual = OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC | OFlags::NOCTTY;
    let flags = match access {
        Access::Read => OFlags::RDONLY,
        Access::Append => OFlags::RDWR | OFlags::APPEND,
        Access::AppendOrCreate => OFlags::RDWR | OFlags::APPEND | OFlags::CREATE,
    };
    let file = match rustix::fs::open(path, usual | flags, Mode::RUSR | Mode::WUSR) {
        Err(Errno::LOOP | Errno::MLINK) => return Err(io::Error::other("it is a symbolic link")),
        Err(Errno::ISDIR) => return Err(io::Error::other("it is a directory")),
        opened => File::from(opened?),
    };
    if file.metadata()?.is_file() { Ok(file) } else { Err(io::Error::other("it is not a regular file")) }
}

/// Reads a regular file if it exists.
///
/// # Errors
/// Returns the errors of [`open`], and an error if the file has more than `most` bytes.
pub fn read(path: &Path, most: u64) -> io::Result<Option<Vec<u8>>> {
    let file = match open(path, Access::Read) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        opened => opened?,
    };
    let mut contents = Vec::new();
    file.take(most + 1).read_to_end(&mut contents)?;
    if contents.len() as u64 > most {
        return Err(io::Error::other(format!("it has more than {most} bytes")));
    }
    Ok(Some(contents))
}

/// Returns `true` if a file has other names, under which everything written to it also appears.
pub fn has_other_names(file: &File) -> bool {
    file.metadata().is_ok_and(|metadata| metadata.nlink() > 1)
}

/// Creates a temporary file in a directory. It is locked while it is open, and deleted when it is dropped.
///
/// # Errors
/// Returns an error if the system refuses.
pub fn temporary_in(directory: &Path, mode: u32) -> io::Result<NamedTempFile> {
    let file = tempfile::Builder::new()
        .prefix(TEMPORARY.0)
        .suffix(TEMPORARY.1)
        .append(true)
        .permissions(Permissions::from_mode(mode))
        .tempfile_in(directory)?;
    // Some file systems do not support locks.
    file.as_file().try_lock().ok();
    Ok(file)
}

/// Replaces a file as a whole, or creates it. A link in its place is replaced, not followed. Returns the new
/// file, locked and open for appending.
///
/// # Errors
/// Returns an error if the system refuses. The file is then unchanged.
pub fn replace(path: &Path, contents: &[u8]) -> io::Result<File> {
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut temporary = temporary_in(directory, 0o600)?;
    temporary.write_all(contents)?;
    temporary.persist(path).map_err(|error| error.error)
}

/// Deletes the temporary files of this user that a killed program left in a directory.
pub fn sweep(directory: &Path) {
    let Ok(entries) = std::fs::read_dir(directory) else { return };
    let user = rustix::process::geteuid().as_raw();
    for entry in entries.flatten() {
        if !is_temporary(&entry.file_name()) {
            continue;
        }
        let Ok(file) = open(&entry.path(), Access::Read) else { continue };
        // An empty file may belong to a program that has not locked it yet.
        let is_left = file.metadata().is_ok_and(|there| there.uid() == user && there.len() > 0)
            && !matches!(file.try_lock(), Err(TryLockError::WouldBlock));
        if is_left {
            std::fs::remove_file(entry.path()).ok();
        }
    }
}

/// Returns `true` for the name of a temporary file of this program.
pub fn is_temporary(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with(TEMPORARY.0) && name.ends_with(TEMPORARY.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_pipes_and_directories_are_not_opened() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        std::fs::write(at("precious"), "precious").expect("written");
        std::os::unix::fs::symlink(at("precious"), at("link")).expect("a link");
        std::os::unix::fs::symlink(at("nothing"), at("dangling")).expect("a link");
        rustix::fs::mknodat(rustix::fs::CWD, at("fifo"), rustix::fs::FileType::Fifo, Mode::RWXU, 0)
            .expect("a FIFO");
        for access in [Access::Read, Access::Append, Access::AppendOrCreate] {
            for name in ["link", "dangling", "fifo", "."] {
                open(&at(name), access).expect_err(name);
            }
        }
        assert!(!at("nothing").exists());
        assert!(open(&at("link"), Access::Read).expect_err("refused").to_string().contains("symbolic link"));
        assert_eq!(read(&at("missing"), 10).expect("nothing"), None);
        assert!(read(&at("precious"), 7).is_err());
        assert_eq!(read(&at("precious"), 8).expect("read"), Some(b"precious".to_vec()));
    }

    #[test]
    fn a_link_is_replaced_and_what_it_leads_to_stays() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        std::fs::write(at("precious"), "precious").expect("written");
        std::os::unix::fs::symlink(at("precious"), at("soft")).expect("a link");
        std::fs::hard_link(at("precious"), at("hard")).expect("a link");
        for name in ["soft", "hard", "new"] {
            let mut file = replace(&at(name), b"one").expect("replaced");
            file.write_all(b" two").expect("appended");
            assert_eq!(std::fs::read_to_string(at(name)).expect("there"), "one two");
            assert!(at(name).symlink_metadata().expect("there").is_file());
        }
        assert_eq!(std::fs::read_to_string(at("precious")).expect("there"), "precious");
        assert_eq!(std::fs::read_dir(directory.path()).expect("readable").count(), 4);
    }

    #[test]
    fn only_temporary_files_that_nobody_writes_are_swept() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        for name in [".betadeck-dead.tmp", "betadeck-other.tmp", ".betadeck-journal"] {
            std::fs::write(at(name), "text").expect("written");
        }
        std::os::unix::fs::symlink(at("betadeck-other.tmp"), at(".betadeck-link.tmp")).expect("a link");
        let mut alive = temporary_in(directory.path(), 0o600).expect("created");
        alive.write_all(b"text").expect("written");
        sweep(directory.path());
        assert!(!at(".betadeck-dead.tmp").exists());
        assert!(alive.path().exists());
        assert_eq!(std::fs::read_dir(directory.path()).expect("readable").count(), 4);
    }
}
