//! Creates the output files of the options, but never over a file that the program reads or stores.

mod own;
mod whole;

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use super::flight_library;
use crate::process::error::AppError;
use crate::storage;
pub(crate) use own::{Writer, may_replace, named_outputs, remove_results};
pub(crate) use whole::{FinalOutput, StreamedOutput, replace};

/// Files of a state directory other than the stored configuration.
const HISTORIES: [&str; 3] = ["commands.history", "cli.history", "palette.history"];
/// The folder for the journals of edits, and their file extension.
const JOURNALS: (&str, &str) = ("plans", "journal");
/// The folder in which a remote firmware keeps its configuration.
const FIRMWARE: &str = "firmware";
/// The folders of the program, with the words for their files.
const FOLDERS: [(&str, &str); 3] = [
    (JOURNALS.0, "a journal of edits"),
    (FIRMWARE, "the configuration of a firmware"),
    (flight_library::FOLDER, "a recorded flight"),
];

/// The files that no output may replace, under any name or link.
#[derive(Debug, Default)]
pub(crate) struct KeptFiles {
    files: Vec<(&'static str, PathBuf)>,
    stores: Vec<PathBuf>,
    states: Vec<PathBuf>,
}

impl KeptFiles {
    /// Protects a file, called `what` in messages.
    pub(crate) fn keep(&mut self, what: &'static str, path: &Path) {
        self.files.push((what, path.to_owned()));
    }

    /// Protects the stored configuration in a directory.
    pub(crate) fn keep_store(&mut self, directory: &Path) {
        self.stores.push(directory.to_owned());
    }

    /// Protects all that the program stores in a state directory.
    pub(crate) fn keep_state(&mut self, directory: &Path) {
        self.keep_store(directory);
        self.states.push(directory.to_owned());
    }

    /// Checks that the output of `option` may be written to a path, and then protects the path from the next output.
    ///
    /// # Errors
    /// Returns a sentence that names the file that it would replace.
    pub(crate) fn claim(&mut self, option: &'static str, path: &Path) -> Result<(), AppError> {
        self.check(option, path)?;
        self.keep(option, path);
        Ok(())
    }

    /// Checks that the output of `option` may be written to a path.
    ///
    /// # Errors
    /// Returns a sentence that names the file that it would replace.
    pub(crate) fn check(&self, option: &'static str, path: &Path) -> Result<(), AppError> {
        let stored = self.stores.iter().flat_map(|directory| storage::files_in(directory));
        let stored = stored.map(|file| ("the stored configuration", file));
        let states = self.states.iter().flat_map(|directory| state_files(directory));
        let kept = self.files.iter().cloned().chain(stored).chain(states);
        let clash = kept.filter(|(_, kept)| is_same(path, kept)).map(|(what, _)| what).next();
        match clash.or_else(|| self.states.iter().find_map(|directory| state_folder(directory, path))) {
            None => Ok(()),
            Some(kept) => Err(AppError::input(format!(
                "{option} {} would overwrite {kept}: name another file",
                path.display()
            ))),
        }
    }
}

/// Returns the files of a state directory other than the stored configuration, even if they do not exist.
fn state_files(directory: &Path) -> Vec<(&'static str, PathBuf)> {
    let mut files: Vec<_> =
        HISTORIES.map(|name| ("the history of entered lines", directory.join(name))).into();
    files.extend(storage::logs_in(directory).map(|path| ("a blackbox log", path)));
    for (folder, what) in FOLDERS {
        let entries = std::fs::read_dir(directory.join(folder)).into_iter().flatten().flatten();
        let paths = entries.map(|entry| entry.path());
        files.extend(paths.filter(|path| is_stored_in(folder, path)).map(|path| (what, path)));
    }
    files
}

/// Returns the kind of file that this path would create in a folder of a state directory.
fn state_folder(directory: &Path, path: &Path) -> Option<&'static str> {
    let (place, name) = place(path)?;
    let lies_in = |folder: &str| {
        directory.join(folder).canonicalize().is_ok_and(|folder| folder == place)
            && is_stored_in(folder, Path::new(&name))
    };
    FOLDERS.iter().find(|(folder, _)| lies_in(folder)).map(|(_, what)| *what)
}

/// Returns `true` if a file with this name in this folder belongs to the program. A folder of plans may be the user's
/// own.
fn is_stored_in(folder: &str, path: &Path) -> bool {
    folder != JOURNALS.0
        || path.extension().is_some_and(|extension| extension == JOURNALS.1 || extension == "bad")
}

/// Creates a file after a successful claim.
pub(crate) fn create(path: &Path) -> Result<File, AppError> {
    File::create(path).map_err(|error| cannot_write(path, &error))
}

/// Returns the error for a file that cannot be written.
pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> AppError {
    AppError::environment(format!("cannot write {}: {error}", path.display()))
}

/// The error of an output file, with its name.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", path.display())]
struct FileError {
    path: PathBuf,
    source: io::Error,
}

/// Returns the error of an output. That of a [`StreamedOutput`] names its file.
#[expect(clippy::needless_pass_by_value, reason = "a map_err argument")]
pub(crate) fn write_failed(error: io::Error) -> AppError {
    let is_named = error.get_ref().and_then(|inner| inner.downcast_ref::<FileError>()).is_some();
    AppError::environment(if is_named {
        error.to_string()
    } else {
        format!("cannot write the output: {error}")
    })
}

/// Returns the directory of a path.
fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns `true` if two paths lead to the same file. Follows links, and compares the places of files that do not
/// exist yet.
fn is_same(a: &Path, b: &Path) -> bool {
    match (a.metadata(), b.metadata()) {
        // Devices and pipes have no contents to lose.
        (Ok(a), Ok(b)) => a.is_file() && (a.dev(), a.ino()) == (b.dev(), b.ino()),
        (Err(_), Err(_)) => place(a).is_some_and(|a| place(b) == Some(a)),
        _ => false,
    }
}

/// Returns the place where a file would be created: its real directory and its name, after all links.
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
            assert!(error.to_string().contains("would overwrite the plan: name another file"), "{error}");
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
        assert!(error.to_string().contains("would overwrite --json"), "{error}");
    }
}
