//! The files of a store and the steps of a save.

use std::fs::{File, TryLockError};
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use super::FILE_NAME;
use crate::firmware::storage::MAX_IMAGE;

/// The names in one directory.
#[derive(Debug, Clone)]
pub(super) struct Files {
    pub(super) directory: PathBuf,
    pub(super) image: PathBuf,
    pub(super) backup: PathBuf,
    temporary: PathBuf,
    temporary_backup: PathBuf,
}

/// One step of a save; after each of them the directory holds a good image.
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
    pub(super) fn new(directory: &Path) -> Self {
        let named = |suffix: &str| directory.join(format!("{FILE_NAME}{suffix}"));
        Self {
            directory: directory.to_owned(),
            image: named(""),
            backup: named(".bak"),
            temporary: named(".tmp"),
            temporary_backup: named(".bak.tmp"),
        }
    }

    /// Locks the directory; `None` when another process has it.
    pub(super) fn lock(&self) -> std::io::Result<Option<File>> {
        let directory = File::open(&self.directory)?;
        match directory.try_lock() {
            Ok(()) => Ok(Some(directory)),
            Err(TryLockError::WouldBlock) => Ok(None),
            // Some file systems know no locks; a store there is only as safe as its user.
            Err(TryLockError::Error(error)) if error.kind() == std::io::ErrorKind::Unsupported => {
                Ok(Some(directory))
            }
            Err(TryLockError::Error(error)) => Err(error),
        }
    }

    /// Whether the stored image is exactly this one.
    pub(super) fn holds(&self, image: &[u8]) -> bool {
        read_image(&self.image).ok().flatten().is_some_and(|stored| stored == image)
    }

    /// Replaces the image, keeping the previous one as the backup if it is worth keeping.
    pub(super) fn replace(&self, image: &[u8], keep_previous: bool) -> std::io::Result<()> {
        Step::ALL.into_iter().try_for_each(|step| self.perform(step, image, keep_previous))
    }

    pub(super) fn perform(&self, step: Step, image: &[u8], keep_previous: bool) -> std::io::Result<()> {
        match step {
            Step::WriteTemporary => {
                let mut file = File::create(&self.temporary)?;
                file.write_all(image)?;
                file.sync_all()
            }
            Step::LinkPrevious if keep_previous => self.link_previous(),
            Step::RenamePrevious if keep_previous => std::fs::rename(&self.temporary_backup, &self.backup),
            Step::LinkPrevious | Step::RenamePrevious => Ok(()),
            Step::RenameTemporary => std::fs::rename(&self.temporary, &self.image),
            Step::FlushDirectory => File::open(&self.directory)?.sync_all(),
        }
    }

    /// Gives the present image a second name; file systems without links get a copy.
    fn link_previous(&self) -> std::io::Result<()> {
        match std::fs::remove_file(&self.temporary_backup) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        if std::fs::hard_link(&self.image, &self.temporary_backup).is_ok() {
            return Ok(());
        }
        std::fs::copy(&self.image, &self.temporary_backup)?;
        File::open(&self.temporary_backup)?.sync_all()
    }

    /// Renames the image to the first free name for damaged files.
    pub(super) fn set_aside(&self) -> std::io::Result<PathBuf> {
        const MOST: usize = 100;
        let names = (1..MOST).map(|at| if at == 1 { String::new() } else { format!(".{at}") });
        let mut free = names
            .map(|number| self.directory.join(format!("{FILE_NAME}.bad{number}")))
            .filter(|path| !path.exists());
        let kept =
            free.next().ok_or_else(|| std::io::Error::other("there are too many damaged files already"))?;
        std::fs::rename(&self.image, &kept)?;
        Ok(kept)
    }
}

/// Reads a file if it exists, at most a little more than the largest image.
pub(super) fn read_image(path: &Path) -> std::io::Result<Option<Vec<u8>>> {
    let file = match File::open(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        other => other?,
    };
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

    /// A directory in which `old` is stored over `older`.
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
