//! The files of a store and the steps of a save.

use std::fs::{File, TryLockError};
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use rustix::fs::{Mode, OFlags};

use super::FILE_NAME;
use crate::firmware::storage::MAX_IMAGE;

/// The file names of a store.
#[derive(Debug, Clone)]
pub(super) struct Files {
    pub(super) directory: PathBuf,
    pub(super) image: PathBuf,
    pub(super) backup: PathBuf,
    temporary: PathBuf,
    temporary_backup: PathBuf,
    /// `true` if the image is reached through a symbolic link.
    pub(super) is_linked: bool,
}

/// One step of a save. After each step the directory holds a good image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    WriteTemporary,
    LinkPrevious,
    RenamePrevious,
    RenameTemporary,
    FlushDirectory,
}

impl Step {
    /// All steps in order.
    pub(super) const ALL: [Self; 5] = [
        Self::WriteTemporary,
        Self::LinkPrevious,
        Self::RenamePrevious,
        Self::RenameTemporary,
        Self::FlushDirectory,
    ];
}

impl Files {
    /// Returns the names in `directory`. If the image there is a symbolic link, returns the names beside its
    /// target: a save keeps the link.
    pub(super) fn new(directory: &Path) -> Self {
        let named_image = directory.join(FILE_NAME);
        let image = link_target(&named_image);
        let is_linked = image != named_image;
        let directory = match image.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        let name = image.file_name().unwrap_or(FILE_NAME.as_ref()).to_owned();
        let named = |suffix: &str| {
            let mut name = name.clone();
            name.push(suffix);
            directory.join(name)
        };
        Self {
            image: named(""),
            backup: named(".bak"),
            temporary: named(".tmp"),
            temporary_backup: named(".bak.tmp"),
            directory,
            is_linked,
        }
    }

    /// Returns the existing files of the store, and those that it will use.
    pub(super) fn all(&self) -> Vec<PathBuf> {
        let name = self.image.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let listed = std::fs::read_dir(&self.directory).into_iter().flatten().flatten();
        let is_ours =
            |path: &PathBuf| path.file_name().is_some_and(|file| file.to_string_lossy().starts_with(&name));
        let mut files: Vec<PathBuf> = listed.map(|entry| entry.path()).filter(is_ours).collect();
        let used = [&self.image, &self.backup, &self.temporary, &self.temporary_backup];
        files.extend(used.into_iter().cloned());
        files
    }

    /// Locks the directory. Returns `None` if another process has the lock.
    pub(super) fn lock(&self) -> std::io::Result<Option<File>> {
        let directory = File::open(&self.directory)?;
        match directory.try_lock() {
            Ok(()) => Ok(Some(directory)),
            Err(TryLockError::WouldBlock) => Ok(None),
            // Some file systems do not support locks. The user must then keep other processes away from the
            // store.
            Err(TryLockError::Error(error)) if error.kind() == std::io::ErrorKind::Unsupported => {
                Ok(Some(directory))
            }
            Err(TryLockError::Error(error)) => Err(error),
        }
    }

    /// Returns `true` if the stored image is exactly this one.
    pub(super) fn holds(&self, image: &[u8]) -> bool {
        read_image(&self.image).ok().flatten().is_some_and(|stored| stored == image)
    }

    /// Replaces the image, and keeps the previous one as the backup if `keep_previous`.
    pub(super) fn replace(&self, image: &[u8], keep_previous: bool) -> std::io::Result<()> {
        Step::ALL.into_iter().try_for_each(|step| self.perform(step, image, keep_previous))
    }

    pub(super) fn perform(&self, step: Step, image: &[u8], keep_previous: bool) -> std::io::Result<()> {
        match step {
            Step::WriteTemporary => {
                // Removes the rest of an interrupted save. A link in its place is not followed.
                remove_if_there(&self.temporary)?;
                let mut file = File::create_new(&self.temporary)?;
                file.write_all(image).and_then(|()| file.sync_all()).inspect_err(|_| {
                    // It is an incomplete image, perhaps in a full directory.
                    std::fs::remove_file(&self.temporary).ok();
                })
            }
            Step::LinkPrevious if keep_previous => self.link_previous(),
            Step::RenamePrevious if keep_previous => std::fs::rename(&self.temporary_backup, &self.backup),
            Step::LinkPrevious | Step::RenamePrevious => Ok(()),
            Step::RenameTemporary => std::fs::rename(&self.temporary, &self.image),
            Step::FlushDirectory => File::open(&self.directory)?.sync_all(),
        }
    }

    /// Gives the current image a second name. File systems without hard links get a copy.
    fn link_previous(&self) -> std::io::Result<()> {
        remove_if_there(&self.temporary_backup)?;
        if std::fs::hard_link(&self.image, &self.temporary_backup).is_ok() {
            return Ok(());
        }
        // Creates the file itself: a link that appeared meanwhile is not followed.
        let mut copy = File::create_new(&self.temporary_backup)?;
        std::io::copy(&mut File::open(&self.image)?, &mut copy)?;
        copy.sync_all()
    }

    /// Renames the image to the first free name for damaged files.
    pub(super) fn set_aside(&self) -> std::io::Result<PathBuf> {
        const MOST: usize = 100;
        let names = (1..MOST).map(|at| if at == 1 { String::new() } else { format!(".{at}") });
        let mut free = names
            .map(|number| {
                let mut name = self.image.clone().into_os_string();
                name.push(format!(".bad{number}"));
                PathBuf::from(name)
            })
            .filter(|path| path.symlink_metadata().is_err());
        let kept =
            free.next().ok_or_else(|| std::io::Error::other("there are too many damaged files already"))?;
        std::fs::rename(&self.image, &kept)?;
        Ok(kept)
    }
}

/// Returns the target of a symbolic link, even if it does not exist, or the path itself if it is no link.
pub fn link_target(path: &Path) -> PathBuf {
    const MAX_LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(target) = std::fs::read_link(&path) else { break };
        // An absolute target replaces the whole path.
        path = path.parent().map_or_else(|| target.clone(), |parent| parent.join(&target));
    }
    path
}

fn remove_if_there(path: &Path) -> std::io::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Reads a regular file if it exists, at most a little more than the largest image.
pub(super) fn read_image(path: &Path) -> std::io::Result<Option<Vec<u8>>> {
    // Opens without waiting for the writer of a FIFO.
    let flags = OFlags::RDONLY | OFlags::NONBLOCK | OFlags::CLOEXEC | OFlags::NOCTTY;
    let file = match rustix::fs::open(path, flags, Mode::empty()) {
        Err(rustix::io::Errno::NOENT) => return Ok(None),
        other => File::from(other?),
    };
    if !file.metadata()?.is_file() {
        return Err(std::io::Error::other("it is not a regular file"));
    }
    let mut image = Vec::new();
    file.take(MAX_IMAGE as u64 + 1).read_to_end(&mut image)?;
    Ok(Some(image))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::config::Configuration;
    use crate::firmware::storage::encode;
    use crate::storage::Store;

    fn named(name: &str) -> Configuration {
        let mut configuration = Configuration::default();
        configuration.settings.set_text("craft_name", name).expect("a short name");
        configuration
    }

    fn name_in(directory: &Path) -> String {
        let loaded = Store::open(directory, false).expect("a directory").load();
        loaded.configuration.settings.text("craft_name").to_owned()
    }

    /// Returns a directory in which `old` was saved after `older`.
    fn directory_with_two_saves() -> tempfile::TempDir {
        let directory = tempfile::tempdir().expect("a directory");
        let mut store = Store::open(directory.path(), false).expect("a store");
        store.save(&named("older")).expect("saved");
        store.save(&named("old")).expect("saved");
        directory
    }

    #[test]
    fn a_save_interrupted_after_any_step_leaves_old_or_new() {
        let new = encode(&named("new"));
        for done in 0..=Step::ALL.len() {
            let directory = directory_with_two_saves();
            let files = Files::new(directory.path());
            for step in &Step::ALL[..done] {
                files.perform(*step, &new, true).expect("a step");
            }
            let replaced = Step::ALL[..done].contains(&Step::RenameTemporary);
            assert_eq!(name_in(directory.path()), if replaced { "new" } else { "old" }, "after {done} steps");
        }
    }

    #[test]
    fn a_save_interrupted_while_writing_leaves_the_old_image() {
        let new = encode(&named("new"));
        for length in [0, 1, 11, 12, new.len() / 2, new.len() - 1] {
            let directory = directory_with_two_saves();
            std::fs::write(Files::new(directory.path()).temporary, &new[..length]).expect("written");
            assert_eq!(name_in(directory.path()), "old");
        }
    }

    #[test]
    fn a_linked_image_keeps_its_link() {
        let directory = tempfile::tempdir().expect("a directory");
        let (here, there) = (directory.path().join("here"), directory.path().join("there"));
        for folder in [&here, &there] {
            std::fs::create_dir(folder).expect("a directory");
        }
        std::os::unix::fs::symlink("../there/craft.bin", here.join(FILE_NAME)).expect("a link");
        for name in ["first", "second"] {
            Store::open(&here, false).expect("a store").save(&named(name)).expect("saved");
            assert_eq!(name_in(&here), name);
        }
        assert!(here.join(FILE_NAME).symlink_metadata().expect("there").is_symlink());
        assert_eq!(std::fs::read(there.join("craft.bin")).expect("there"), encode(&named("second")));
        let backup = read_image(&there.join("craft.bin.bak")).expect("readable").expect("there");
        assert_eq!(backup, encode(&named("first")));
    }

    #[test]
    fn a_link_to_somebody_elses_file_is_left_alone() {
        let directory = tempfile::tempdir().expect("a directory");
        let thesis = directory.path().join("thesis.txt");
        std::fs::write(&thesis, "precious").expect("written");
        std::os::unix::fs::symlink(&thesis, directory.path().join(FILE_NAME)).expect("a link");
        let mut store = Store::open(directory.path(), false).expect("a store");
        let findings = store.load().findings;
        assert!(findings[0].contains("is not used: a link leads to it"), "{findings:?}");
        assert!(store.save(&named("new")).is_err());
        assert_eq!(std::fs::read(&thesis).expect("there"), b"precious");
    }

    #[test]
    fn a_link_in_the_place_of_the_temporary_file_is_not_followed() {
        let directory = directory_with_two_saves();
        let victim = directory.path().join("victim");
        std::fs::write(&victim, "precious").expect("written");
        let files = Files::new(directory.path());
        for name in [&files.temporary, &files.temporary_backup] {
            std::os::unix::fs::symlink(&victim, name).expect("a link");
        }
        Store::open(directory.path(), false).expect("a store").save(&named("new")).expect("saved");
        assert_eq!(std::fs::read(&victim).expect("there"), b"precious");
        assert_eq!(name_in(directory.path()), "new");
    }

    #[test]
    fn a_pipe_in_the_place_of_the_image_is_refused_at_once() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join(FILE_NAME);
        rustix::fs::mknodat(rustix::fs::CWD, &path, rustix::fs::FileType::Fifo, Mode::RWXU, 0)
            .expect("a FIFO");
        let mut store = Store::open(directory.path(), false).expect("a store");
        let findings = store.load().findings;
        assert!(findings[0].contains("it is not a regular file"), "{findings:?}");
        assert!(store.save(&named("new")).is_err());
        assert!(path.exists());
    }

    #[test]
    fn a_save_after_an_interrupted_one_works() {
        let directory = directory_with_two_saves();
        let files = Files::new(directory.path());
        let new = encode(&named("new"));
        for step in [Step::WriteTemporary, Step::LinkPrevious] {
            files.perform(step, &new, true).expect("a step");
        }
        Store::open(directory.path(), false).expect("a store").save(&named("newer")).expect("saved");
        assert_eq!(name_in(directory.path()), "newer");
        let backup = read_image(&files.backup).expect("readable").expect("there");
        assert_eq!(backup, encode(&named("old")));
    }
}
