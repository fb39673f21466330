//! Creates the files that the options name for output, but never over what is read or stored.

mod whole;

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use super::AppError;
use crate::storage;
pub(super) use whole::{FinalOutput, replace};

/// The files that no output may replace, under whatever name or link.
#[derive(Debug, Default)]
pub(super) struct KeptFiles {
    files: Vec<(&'static str, PathBuf)>,
    stores: Vec<PathBuf>,
}

impl KeptFiles {
    /// Keeps a file, called `what` in messages.
    pub(super) fn keep(&mut self, what: &'static str, path: &Path) {
        self.files.push((what, path.to_owned()));
    }

    /// Keeps the stored configuration of a directory.
    pub(super) fn keep_store(&mut self, directory: &Path) {
        self.stores.push(directory.to_owned());
    }

    /// Whether the output of `option` may be written there; it is kept from the next one.
    ///
    /// # Errors
    /// The sentence that names what it would replace.
    pub(super) fn claim(&mut self, option: &'static str, path: &Path) -> Result<(), AppError> {
        let stored = self.stores.iter().flat_map(|directory| storage::files_in(directory));
        let stored = stored.map(|file| ("the stored configuration", file));
        let clash = self.files.iter().cloned().chain(stored).find(|(_, kept)| is_same(path, kept));
        match clash {
            None => {
                self.keep(option, path);
                Ok(())
            }
            Some((kept, _)) => Err(AppError::input(format!(
                "{option} {} would write over {kept}: name another file",
                path.display()
            ))),
        }
    }
}

/// Creates a file that was claimed.
pub(super) fn create(path: &Path) -> Result<File, AppError> {
    File::create(path).map_err(|error| cannot_write(path, &error))
}

fn cannot_write(path: &Path, error: &io::Error) -> AppError {
    AppError::environment(format!("cannot write {}: {error}", path.display()))
}

/// The directory that a path's name stands in.
fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Whether two paths lead to one file; links count, and of files that are not there yet the place.
fn is_same(a: &Path, b: &Path) -> bool {
    match (a.metadata(), b.metadata()) {
        // Devices and pipes hold nothing that could be lost.
        (Ok(a), Ok(b)) => a.is_file() && (a.dev(), a.ino()) == (b.dev(), b.ino()),
        (Err(_), Err(_)) => place(a).is_some_and(|a| place(b) == Some(a)),
        _ => false,
    }
}

/// Where a file would be created: its real directory and name, links followed.
fn place(path: &Path) -> Option<(PathBuf, OsString)> {
    let path = storage::link_target(path);
    Some((directory_of(&path).canonicalize().ok()?, path.file_name()?.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_output_replaces_an_input_under_any_name() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        std::fs::write(at("plan.txt"), "").expect("written");
        std::fs::hard_link(at("plan.txt"), at("hard.txt")).expect("a link");
        std::os::unix::fs::symlink(at("plan.txt"), at("soft.txt")).expect("a link");
        let mut kept = KeptFiles::default();
        kept.keep("the plan", &at("plan.txt"));
        for name in ["plan.txt", "hard.txt", "soft.txt", "../plan.txt"] {
            let path = if let Some(name) = name.strip_prefix("../") {
                directory.path().join("..").join(directory.path().file_name().expect("a name")).join(name)
            } else {
                at(name)
            };
            let error = kept.claim("--json", &path).expect_err("refused");
            assert!(error.to_string().contains("would write over the plan: name another file"), "{error}");
        }
        assert!(kept.claim("--json", &at("other.txt")).is_ok());
        assert!(kept.claim("--json", Path::new("/dev/null")).is_ok());
    }

    #[test]
    fn no_output_replaces_the_store_nor_another_output() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        let mut kept = KeptFiles::default();
        kept.keep_store(directory.path());
        let error = kept.claim("--json", &at("eeprom.bin")).expect_err("not stored yet, but soon");
        assert!(error.to_string().contains("the stored configuration"), "{error}");
        std::fs::write(at("eeprom.bin.bak"), "").expect("written");
        std::fs::hard_link(at("eeprom.bin.bak"), at("track.gpx")).expect("a link");
        assert!(kept.claim("--gpx", &at("track.gpx")).is_err());
        kept.claim("--json", &at("lines")).expect("free");
        std::os::unix::fs::symlink(at("lines"), at("dangling")).expect("a link");
        assert!(kept.claim("--gpx", &at("dangling")).is_err());
        let error = kept.claim("--gpx", &at("lines")).expect_err("refused");
        assert!(error.to_string().contains("would write over --json"), "{error}");
    }
}
