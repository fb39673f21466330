//! The blackbox logs of a state directory: `LOG00001.BFL` and so on, as the real simulator names them.

use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

/// The greatest number of a log.
const MOST: u32 = 99_999;

/// A directory that gets a file for each log. Files that exist are never replaced.
#[derive(Debug)]
pub struct LogFolder {
    directory: PathBuf,
    /// The log under way, with its path.
    file: Option<(BufWriter<File>, PathBuf)>,
}

impl LogFolder {
    pub fn new(directory: PathBuf) -> Self {
        Self { directory, file: None }
    }

    /// Ends the log under way, and begins one with the number after the greatest. Returns its file.
    ///
    /// # Errors
    /// Returns the error of the directory or the file.
    pub fn begin(&mut self) -> io::Result<PathBuf> {
        self.file = None;
        let mut number = logs_in(&self.directory).filter_map(|path| number(&path)).max().unwrap_or(0);
        loop {
            number += 1;
            if number > MOST {
                return Err(io::Error::other(format!("all numbers up to LOG{MOST}.BFL are used")));
            }
            let path = self.directory.join(format!("LOG{number:05}.BFL"));
            match File::create_new(&path) {
                Ok(file) => {
                    self.file = Some((BufWriter::new(file), path.clone()));
                    return Ok(path);
                }
                // Another process began it meanwhile.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// Returns `true` while a log is written.
    pub fn is_open(&self) -> bool {
        self.file.is_some()
    }

    /// Adds to the log under way. After an error it has ended.
    ///
    /// # Errors
    /// Returns the error of the file.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.with_file(|file| file.write_all(bytes))
    }

    /// Passes all that was written on to the system. After an error the log has ended.
    ///
    /// # Errors
    /// Returns the error of the file.
    pub fn flush(&mut self) -> io::Result<()> {
        self.with_file(BufWriter::flush)
    }

    /// Ends the log under way.
    ///
    /// # Errors
    /// Returns the error of the file.
    pub fn end(&mut self) -> io::Result<()> {
        let flushed = self.flush();
        self.file = None;
        flushed
    }

    fn with_file(&mut self, act: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
        let done = self.file.as_mut().map_or(Ok(()), |(file, _)| act(file));
        if done.is_err()
            && let Some((file, path)) = self.file.take()
        {
            // A second attempt to write what is left would fail, too.
            let _unwritten = file.into_parts();
            // A full disk takes the name of a file, but not its first byte.
            if path.metadata().is_ok_and(|there| there.len() == 0) {
                std::fs::remove_file(path).ok();
            }
        }
        done
    }
}

/// Returns the logs in a directory.
pub fn logs_in(directory: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| number(path).is_some())
}

/// Returns the number in the name of a log.
fn number(path: &Path) -> Option<u32> {
    let digits = path.file_name()?.to_str()?.strip_prefix("LOG")?.strip_suffix(".BFL")?;
    let is_number = digits.len() == 5 && digits.bytes().all(|digit| digit.is_ascii_digit());
    digits.parse().ok().filter(|_| is_number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let mut names: Vec<_> = logs_in(directory)
            .map(|path| path.file_name().expect("a name").to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn each_log_has_the_number_after_the_greatest() {
        let directory = tempfile::tempdir().expect("a directory");
        let mut folder = LogFolder::new(directory.path().to_owned());
        for name in ["LOG00007.BFL", "LOG1.BFL", "LOG000999.BFL", "LOG+9999.BFL", "log00009.bfl"] {
            std::fs::write(directory.path().join(name), "kept").expect("written");
        }
        assert_eq!(folder.begin().expect("created"), directory.path().join("LOG00008.BFL"));
        folder.write(b"one").expect("written");
        folder.begin().expect("created");
        folder.write(b"two").expect("written");
        folder.end().expect("ended");
        assert!(!folder.is_open());
        assert_eq!(names(directory.path()), ["LOG00007.BFL", "LOG00008.BFL", "LOG00009.BFL"]);
        let read = |name: &str| std::fs::read_to_string(directory.path().join(name)).expect("text");
        assert_eq!((read("LOG00007.BFL"), read("LOG00008.BFL")), ("kept".to_owned(), "one".to_owned()));
        assert_eq!(read("LOG00009.BFL"), "two");
    }

    #[test]
    fn a_flushed_log_can_be_read_while_it_grows() {
        let directory = tempfile::tempdir().expect("a directory");
        let mut folder = LogFolder::new(directory.path().to_owned());
        let path = folder.begin().expect("created");
        folder.write(b"frames").expect("written");
        assert_eq!(std::fs::read(&path).expect("there"), b"");
        folder.flush().expect("written");
        assert_eq!(std::fs::read(&path).expect("there"), b"frames");
    }

    #[test]
    fn a_directory_without_a_free_number_or_without_a_place_is_an_error() {
        let directory = tempfile::tempdir().expect("a directory");
        std::fs::write(directory.path().join("LOG99999.BFL"), "").expect("written");
        let error = LogFolder::new(directory.path().to_owned()).begin().expect_err("no number");
        assert!(error.to_string().contains("LOG99999.BFL"), "{error}");
        let missing = directory.path().join("none");
        assert_eq!(LogFolder::new(missing).begin().expect_err("refused").kind(), ErrorKind::NotFound);
    }
}
