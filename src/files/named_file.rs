//! New files that are named after a plan, or by the user. An existing file is never replaced.

use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

/// The most files with numbers after the plan's name.
const MOST: u32 = 999;

/// A kind of file: its extension, and the command that writes it to a file with a name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kind {
    pub(crate) extension: &'static str,
    pub(crate) command: &'static str,
}

impl Kind {
    /// Writes a new file: the one of the user, or one that is named after the plan. Returns its path.
    ///
    /// # Errors
    /// Returns a sentence with the reason.
    pub(crate) fn write(self, file: Option<PathBuf>, plan: &str, contents: &[u8]) -> Result<PathBuf, String> {
        match file {
            Some(path) => self.create(&path, contents).map(|()| path),
            None => self.create_numbered(&stem(plan), contents),
        }
    }

    fn create_numbered(self, stem: &str, contents: &[u8]) -> Result<PathBuf, String> {
        let Self { extension, command } = self;
        for number in 1..=MOST {
            let path = PathBuf::from(format!("{stem}-flight-{number}.{extension}"));
            if !path.exists() {
                return self.create(&path, contents).map(|()| path);
            }
        }
        Err(format!(
            "{stem}-flight-1.{extension} to {stem}-flight-{MOST}.{extension} exist already: name a file, `:{command} FILE`."
        ))
    }

    fn create(self, path: &Path, contents: &[u8]) -> Result<(), String> {
        let written = File::create_new(path).and_then(|mut file| file.write_all(contents));
        written.map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => {
                format!("{} exists already: name another file, `:{} FILE`.", path.display(), self.command)
            }
            _ => format!("{} cannot be written: {error}.", path.display()),
        })
    }
}

/// Returns the start of a file's name, with only those characters that need no quotes in a shell.
pub(crate) fn stem(plan: &str) -> String {
    let kept: String =
        plan.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(40).collect();
    let kept = kept.trim_matches('-');
    if kept.is_empty() { "flight".to_owned() } else { kept.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_name_has_nothing_that_a_shell_minds() {
        assert_eq!(stem("square"), "square");
        assert_eq!(stem("../my plan; rm -rf"), "my-plan--rm--rf");
        assert_eq!(stem("…"), "flight");
    }

    #[test]
    fn a_file_that_is_there_is_never_replaced() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("mine.toml");
        let kind = Kind { extension: "toml", command: "scenario" };
        assert_eq!(kind.write(Some(path.clone()), "plan", b"one"), Ok(path.clone()));
        let error = kind.write(Some(path.clone()), "plan", b"two").expect_err("there already");
        assert!(error.contains("exists already") && error.contains("`:scenario FILE`"), "{error}");
        assert_eq!(std::fs::read_to_string(&path).expect("readable"), "one");
    }
}
