//! The storage of the configuration: `eeprom.bin` in a directory, or memory. `log_folder` has the blackbox logs beside it.
//!
//! A save always leaves at least one good copy, even if it is interrupted:
//!
//! ```text
//! 1 write eeprom.bin.tmp and flush it      old image intact
//! 2 link eeprom.bin to eeprom.bin.bak      old image under two names
//! 3 rename eeprom.bin.tmp to eeprom.bin    new image in place, old one in .bak
//! 4 flush the directory
//! ```
//!
//! A damaged file is renamed to `eeprom.bin.bad` and never deleted. The file of another firmware is not
//! touched. The directory is locked: a second process in it runs but cannot save.

use std::fs::File;
use std::path::{Path, PathBuf};

use crate::firmware::cli::StorageFacts;
use crate::firmware::config::{Configuration, correct};
use crate::firmware::storage::{ImageError, decode, encode};

mod files;
mod firmware_folder;
mod log_folder;
pub mod state_file;

pub use files::link_target;
use files::{Files, read_image};
pub use firmware_folder::{FirmwareFolder, sweep};
pub use log_folder::{LogFolder, logs_in};

/// Returns the files that a store in this directory uses or leaves, including missing ones. If the image is a
/// link, they are beside its target.
pub fn files_in(directory: &Path) -> Vec<PathBuf> {
    Files::new(directory).all()
}

/// The name of the file.
pub const FILE_NAME: &str = "eeprom.bin";

/// The reason why the configuration cannot be saved or the directory cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StorageError {
    /// The directory cannot be used.
    #[error("cannot use the directory {}: {source}; choose another one", path.display())]
    Directory { path: PathBuf, source: std::io::Error },
    /// The file belongs to another firmware.
    #[error(
        "{} is not overwritten because {reason}: move it away, or use another directory",
        path.display()
    )]
    Protected {
        path: PathBuf,
        /// The kind of the file, or the reason why it cannot be read.
        reason: String,
    },
    /// The file cannot be read, or is no configuration.
    #[error("{} is left alone because {reason}: move it away, or use another directory", path.display())]
    Unusable { path: PathBuf, reason: String },
    /// Another process uses the directory.
    #[error("another betadeck uses {}: save there, or start this one with another directory", path.display())]
    Locked { path: PathBuf },
    #[error("cannot write {}: {source}; the stored configuration is unchanged", path.display())]
    Write { path: PathBuf, source: std::io::Error },
}

/// A configuration as loaded.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The configuration, made consistent.
    pub configuration: Configuration,
    /// Problems, as sentences for the user.
    pub findings: Vec<String>,
    /// `true` if nothing was stored before.
    pub first_boot: bool,
}

#[derive(Debug)]
pub struct Store {
    place: Place,
    used_bytes: usize,
    note: Option<String>,
}

#[derive(Debug)]
enum Place {
    Memory(Option<Vec<u8>>),
    Directory(Box<Directory>),
}

#[derive(Debug)]
struct Directory {
    files: Files,
    /// Holds the lock during the lifetime of the store; `None` if another process has it.
    lock: Option<File>,
    overwrite: bool,
    /// The stored image, if it is valid and from this firmware.
    current: Option<Vec<u8>>,
    /// The reason why the file must not be replaced, if there is one.
    protected: Option<Protection>,
}

/// The reason why a file is not replaced, with its words for the user.
#[derive(Debug, Clone)]
enum Protection {
    /// It belongs to another firmware.
    Foreign(String),
    /// It cannot be read, or a link leads to something other than a configuration.
    Unusable(String),
}

impl Store {
    /// Creates a store that lasts only as long as the process.
    pub fn in_memory() -> Self {
        Self { place: Place::Memory(None), used_bytes: 0, note: None }
    }

    /// Opens a store in a directory, which is created if it is missing. `overwrite` allows replacing the file
    /// of another firmware.
    pub fn open(directory: &Path, overwrite: bool) -> Result<Self, StorageError> {
        let unusable = |source| StorageError::Directory { path: directory.to_owned(), source };
        std::fs::create_dir_all(directory).map_err(unusable)?;
        let files = Files::new(directory);
        let lock = files.lock().map_err(unusable)?;
        let place = Directory { files, lock, overwrite, current: None, protected: None };
        Ok(Self { place: Place::Directory(Box::new(place)), used_bytes: 0, note: None })
    }

    /// Opens the store in an existing directory for reading only: nothing is written, moved or locked.
    pub fn read_only(directory: &Path) -> Self {
        let files = Files::new(directory);
        let place = Directory { files, lock: None, overwrite: false, current: None, protected: None };
        Self { place: Place::Directory(Box::new(place)), used_bytes: 0, note: None }
    }

    /// Reads the stored configuration. Unreadable parts are replaced as well as possible, and reported. On
    /// the first boot the defaults are stored.
    pub fn load(&mut self) -> Loaded {
        let (stored, mut findings) = match &mut self.place {
            Place::Memory(image) => (image.clone(), Vec::new()),
            Place::Directory(directory) => directory.load(),
        };
        self.note = findings.first().map(|_| match stored {
            Some(_) => "restored from the previous copy".to_owned(),
            None => "not loaded, defaults in use".to_owned(),
        });
        let decoded = stored.as_deref().and_then(|image| decode(image).ok());
        let first_boot = decoded.is_none() && findings.is_empty();
        let (mut configuration, unusable) = decoded.unwrap_or_default();
        findings.extend(unusable);
        correct(&mut configuration);
        self.used_bytes = stored.map_or_else(|| encode(&configuration).len(), |image| image.len());
        if first_boot
            && self.refusal().is_none()
            && let Err(error) = self.save(&configuration)
        {
            findings.push(format!("Not saved: {error}."));
        }
        Loaded { configuration, findings, first_boot }
    }

    /// Stores a configuration. An unchanged one is not written again.
    pub fn save(&mut self, configuration: &Configuration) -> Result<(), StorageError> {
        let image = encode(configuration);
        let length = image.len();
        let saved = match &mut self.place {
            Place::Memory(stored) => {
                *stored = Some(image);
                Ok(())
            }
            Place::Directory(directory) => directory.save(image),
        };
        if let Err(error) = saved {
            self.note = Some(format!("not saved: {error}"));
            return Err(error);
        }
        self.used_bytes = length;
        self.note = None;
        Ok(())
    }

    /// Returns the directory for logs, if the store has one.
    pub fn log_folder(&self) -> Option<LogFolder> {
        match &self.place {
            Place::Memory(_) => None,
            Place::Directory(directory) => Some(LogFolder::new(directory.files.directory.clone())),
        }
    }

    /// Returns the reason why [`Store::save`] cannot work, if it is known beforehand.
    pub fn refusal(&self) -> Option<StorageError> {
        match &self.place {
            Place::Memory(_) => None,
            Place::Directory(directory) => directory.refusal(),
        }
    }

    /// Returns the facts about the store for `status` and `save`.
    pub fn facts(&self) -> StorageFacts {
        let save_refusal = self.refusal().map(|error| error.to_string());
        let read_only = || save_refusal.as_ref().map(|why| format!("read-only: {why}"));
        StorageFacts {
            used_bytes: self.used_bytes,
            note: self.note.clone().or_else(read_only),
            save_refusal,
            ..StorageFacts::default()
        }
    }
}

impl Directory {
    fn refusal(&self) -> Option<StorageError> {
        if self.lock.is_none() {
            return Some(StorageError::Locked { path: self.files.directory.clone() });
        }
        let path = self.files.image.clone();
        Some(match self.protected.clone()? {
            Protection::Foreign(reason) => StorageError::Protected { path, reason },
            Protection::Unusable(reason) => StorageError::Unusable { path, reason },
        })
    }

    /// Returns the best available image, and the problems of the others.
    fn load(&mut self) -> (Option<Vec<u8>>, Vec<String>) {
        let mut findings = Vec::new();
        self.current = None;
        self.protected = None;
        let name = self.files.image.display().to_string();
        match read_image(&self.files.image) {
            Ok(Some(image)) => match decode(&image) {
                Ok(_) => {
                    self.current = Some(image.clone());
                    return (Some(image), findings);
                }
                Err(reason @ (ImageError::Foreign | ImageError::LaterFormat { .. })) => {
                    if !self.overwrite {
                        self.protected = Some(Protection::Foreign(reason.to_string()));
                    }
                    findings.push(format!("{name} is not used: {reason}"));
                    return (None, findings);
                }
                Err(ImageError::Damaged) if self.files.is_linked => {
                    let reason = "a link leads to it, and it is not a configuration";
                    findings.push(format!("{name} is not used: {reason}"));
                    self.protected = Some(Protection::Unusable(reason.to_owned()));
                    return (None, findings);
                }
                Err(ImageError::Damaged) => findings.push(self.set_aside(&name)),
            },
            Ok(None) => {}
            Err(error) => {
                findings.push(format!("{name} cannot be read: {error}"));
                self.protected = Some(Protection::Unusable(format!("it cannot be read: {error}")));
                return (None, findings);
            }
        }
        match read_image(&self.files.backup) {
            Ok(Some(image)) if decode(&image).is_ok() => {
                findings.push("The previous copy was loaded: the last save is lost.".to_owned());
                (Some(image), findings)
            }
            _ => {
                if !findings.is_empty() {
                    findings.push("There is no good copy: defaults are used.".to_owned());
                }
                (None, findings)
            }
        }
    }

    /// Keeps a damaged file under another name. Only the process that holds the lock may do that.
    fn set_aside(&self, name: &str) -> String {
        if self.lock.is_none() {
            return format!("{name} is damaged");
        }
        match self.files.set_aside() {
            Ok(kept) => format!("{name} is damaged and was kept as {}", kept.display()),
            Err(error) => format!("{name} is damaged and could not be renamed: {error}"),
        }
    }

    fn save(&mut self, image: Vec<u8>) -> Result<(), StorageError> {
        if let Some(refusal) = self.refusal() {
            return Err(refusal);
        }
        if self.current.as_ref() == Some(&image) && self.files.holds(&image) {
            return Ok(());
        }
        let keep_previous =
            read_image(&self.files.image).ok().flatten().is_some_and(|old| decode(&old).is_ok());
        self.files
            .replace(&image, keep_previous)
            .map_err(|source| StorageError::Write { path: self.files.image.clone(), source })?;
        self.current = Some(image);
        Ok(())
    }
}

impl Drop for Directory {
    /// Unlocks the directory at once. Closing it is not enough: a child process that is just starting has its
    /// descriptor, too, and would keep the lock until it runs.
    fn drop(&mut self) {
        if let Some(lock) = &self.lock {
            lock.unlock().ok();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_directory_is_free_when_its_store_ends_though_a_child_still_has_its_descriptor() {
        let directory = tempfile::tempdir().unwrap();
        let lock_of = |store: &Store| match &store.place {
            Place::Directory(place) => place.lock.as_ref().map(|lock| lock.try_clone().unwrap()),
            Place::Memory(_) => None,
        };
        let store = Store::open(directory.path(), false).unwrap();
        let inherited = lock_of(&store).expect("the lock");
        assert!(lock_of(&Store::open(directory.path(), false).unwrap()).is_none(), "it is locked");
        drop(store);
        assert!(lock_of(&Store::open(directory.path(), false).unwrap()).is_some());
        drop(inherited);
    }
}
