//! Files of the state directory that cannot be read, or only in part, kept under another name that is never replaced.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The extension of these files.
const EXTENSION: &str = "bad";
/// The most files with the same name.
const MOST: u32 = 1000;

/// A journal that could not be read at all.
#[derive(Debug)]
pub(crate) struct SetAside {
    journal: PathBuf,
    /// The current place of the journal.
    kept: io::Result<PathBuf>,
    why: String,
}

impl SetAside {
    /// Returns the event as a sentence.
    pub(crate) fn sentence(&self) -> String {
        let Self { journal, kept, why } = self;
        let now = place(kept, journal);
        format!("Edits are lost: the journal {} was not read, {why}. {now}.", journal.display())
    }
}

/// Returns the current place of a file as the second half of a message.
pub(crate) fn place(kept: &io::Result<PathBuf>, file: &Path) -> String {
    match kept {
        Ok(kept) => format!("It is kept as {}", kept.display()),
        Err(error) => format!("It stays as {}, because it cannot be copied: {error}", file.display()),
    }
}

/// Renames a journal that cannot be read at all.
pub(crate) fn away(journal: &Path, why: String) -> SetAside {
    let kept = copy(journal).and_then(|kept| std::fs::remove_file(journal).map(|()| kept));
    SetAside { journal: journal.to_owned(), kept, why }
}

/// Copies a file to a free name and returns that name.
pub(crate) fn copy(file: &Path) -> io::Result<PathBuf> {
    for number in 1..=MOST {
        let extension = if number == 1 { EXTENSION.to_owned() } else { format!("{number}.{EXTENSION}") };
        let kept = file.with_extension(extension);
        // A second name takes no space on a full disk. Some file systems allow only one name for a file.
        let copied = match std::fs::hard_link(file, &kept) {
            Err(error) if error.kind() != ErrorKind::AlreadyExists => copy_bytes(file, &kept),
            linked => linked,
        };
        match copied {
            Ok(()) => return Ok(kept),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::other("too many files are set aside already"))
}

fn copy_bytes(file: &Path, kept: &Path) -> io::Result<()> {
    let mut to = OpenOptions::new().write(true).create_new(true).open(kept)?;
    let copied = File::open(file).and_then(|mut from| io::copy(&mut from, &mut to));
    if copied.is_err() {
        std::fs::remove_file(kept).ok();
    }
    copied.map(drop)
}
