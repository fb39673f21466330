//! Reads the text files of the options.
//!
//! Only regular files are read by name, because a FIFO would make the program wait and a device could be endless. A
//! pipe from the shell (`-`, `/dev/stdin`, `/dev/fd/N`) is read up to the size limit of a plan.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use rustix::fs::{Mode, OFlags};

use crate::args::is_descriptor;
use crate::plan::format::decode_text;
use crate::process::error::AppError;

/// The name of standard input in messages.
const STDIN: &str = "standard input";
/// A plan or settings.
const TEXT: Kind =
    Kind { most: 4 << 20, too_large: "neither a plan nor settings", or_stdin: ", or - for standard input" };
const TILE: Kind = Kind { most: 64 << 20, too_large: "no elevation tile", or_stdin: "" };
/// A blackbox log, which is read in parts.
const LOG: Kind = Kind { most: u64::MAX, too_large: "no log", or_stdin: "" };
const MAP: Kind = Kind { most: 64 << 20, too_large: "too much for a map", or_stdin: "" };
/// A recording. Its reader has bounds of its own.
const RECORDING: Kind = Kind { most: 1 << 30, too_large: "no recording of a flight", or_stdin: "" };
/// A file for a syntax tree. The tree takes a hundred times as much memory.
const TREE: Kind = Kind { most: 512 << 10, ..TEXT };

/// A kind of file.
#[derive(Clone, Copy)]
struct Kind {
    /// The size of the largest one, bytes.
    most: u64,
    /// The end of the sentence about a larger one.
    too_large: &'static str,
    /// The words for standard input in place of a file, if it can be that.
    or_stdin: &'static str,
}

/// Reads a plan file.
pub(crate) fn read_plan(path: &Path) -> Result<Vec<u8>, AppError> {
    let name = path.display().to_string();
    read_bytes(open(path, &name, TEXT)?, &name, TEXT)
}

/// Reads an elevation tile.
pub(crate) fn read_tile(path: &Path) -> Result<Vec<u8>, AppError> {
    let name = path.display().to_string();
    read_bytes(open(path, &name, TILE)?, &name, TILE)
}

/// Opens a recorded flight. Returns it with its size, bytes.
pub(crate) fn open_log(path: &Path) -> Result<(File, u64), AppError> {
    let name = path.display().to_string();
    if is_descriptor(path) {
        return Err(AppError::input(format!(
            "{name} is no file: a replay reads a file again and again, so name one"
        )));
    }
    let file = open(path, &name, LOG)?;
    let size =
        file.metadata().map_err(|error| AppError::environment(format!("cannot read {name}: {error}")))?.len();
    Ok((file, size))
}

/// Reads a map for a backdrop.
pub(crate) fn read_map(path: &Path) -> Result<Vec<u8>, AppError> {
    let name = path.display().to_string();
    read_bytes(open(path, &name, MAP)?, &name, MAP)
}

/// Opens a recording of a flight.
pub(crate) fn open_recording(path: &Path) -> Result<File, AppError> {
    open(path, &path.display().to_string(), RECORDING)
}

/// Reads a text file of reasonable size.
pub(crate) fn read(path: &Path) -> Result<String, AppError> {
    read_at_most(path, TEXT)
}

/// Reads a file for a syntax tree.
pub(crate) fn read_small(path: &Path) -> Result<String, AppError> {
    read_at_most(path, TREE)
}

fn read_at_most(path: &Path, kind: Kind) -> Result<String, AppError> {
    let name = path.display().to_string();
    let file = open(path, &name, kind)?;
    read_text(file, &name, kind)
}

/// Reads a text file, which may be missing.
pub(crate) fn read_if_there(path: &Path) -> Result<Option<String>, AppError> {
    match path.symlink_metadata() {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        _ => read_small(path).map(Some),
    }
}

pub(crate) fn read_stdin() -> Result<Vec<u8>, AppError> {
    read_bytes(std::io::stdin().lock(), STDIN, TEXT)
}

pub(crate) fn read_stdin_text() -> Result<String, AppError> {
    read_text(std::io::stdin().lock(), STDIN, TEXT)
}

fn open(path: &Path, name: &str, kind: Kind) -> Result<File, AppError> {
    let cannot_open = |error: std::io::Error| AppError::environment(format!("cannot open {name}: {error}"));
    if is_descriptor(path) {
        return File::open(path).map_err(cannot_open);
    }
    // This does not wait for the writer of a FIFO.
    let flags = OFlags::RDONLY | OFlags::NONBLOCK | OFlags::CLOEXEC | OFlags::NOCTTY;
    let file =
        File::from(rustix::fs::open(path, flags, Mode::empty()).map_err(|error| cannot_open(error.into()))?);
    let metadata = file.metadata().map_err(cannot_open)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "a directory" } else { "a device or a pipe" };
        return Err(AppError::input(format!("{name} is {what}, not a file: name a file{}", kind.or_stdin)));
    }
    if is_of_system(&file) {
        return Err(AppError::input(format!(
            "{name} is a system file, which describes this machine: name a file of your own{}",
            kind.or_stdin
        )));
    }
    if metadata.len() > kind.most {
        return Err(too_large(name, kind));
    }
    Ok(file)
}

/// Returns `true` if the system generates the contents of a file, such as the environment of a process.
#[cfg(target_os = "linux")]
fn is_of_system(file: &File) -> bool {
    // proc, sysfs, debugfs, tracefs, securityfs, configfs, cgroup, cgroup2, efivarfs.
    const KINDS: [u32; 9] = [
        0x9fa0,
        0x6265_6572,
        0x6462_6720,
        0x7472_6163,
        0x7363_6673,
        0x6265_6570,
        0x0027_e0eb,
        0x6367_7270,
        0xde5e_81e4,
    ];
    rustix::fs::fstatfs(file).is_ok_and(|system| KINDS.contains(&(system.f_type as u32)))
}

#[cfg(not(target_os = "linux"))]
fn is_of_system(_: &File) -> bool {
    false
}

fn read_text(source: impl Read, name: &str, kind: Kind) -> Result<String, AppError> {
    let bytes = read_bytes(source, name, kind)?;
    match decode_text(&bytes) {
        Ok(text) => Ok(text.into_owned()),
        Err(reason) => Err(AppError::input(format!("{name} is not a text file: {reason}"))),
    }
}

fn read_bytes(source: impl Read, name: &str, kind: Kind) -> Result<Vec<u8>, AppError> {
    let mut bytes = Vec::new();
    source
        .take(kind.most + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| AppError::environment(format!("cannot read {name}: {error}")))?;
    if bytes.len() as u64 > kind.most {
        return Err(too_large(name, kind));
    }
    Ok(bytes)
}

fn too_large(name: &str, kind: Kind) -> AppError {
    let Kind { most, too_large, .. } = kind;
    let most = if most < 1 << 20 { format!("{} KiB", most >> 10) } else { format!("{} MiB", most >> 20) };
    AppError::input(format!("{name} is larger than {most}: that is {too_large}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_are_read_by_name() {
        let directory = tempfile::tempdir().expect("a directory");
        let fifo = directory.path().join("fifo");
        rustix::fs::mknodat(rustix::fs::CWD, &fifo, rustix::fs::FileType::Fifo, Mode::RWXU, 0)
            .expect("a FIFO");
        let link = directory.path().join("link");
        std::os::unix::fs::symlink(&fifo, &link).expect("a link");
        for path in [fifo.as_path(), &link, directory.path(), Path::new("/dev/zero"), Path::new("/dev/null")]
        {
            let error = read(path).expect_err("not a file");
            assert!(
                error.to_string().contains("not a file: name a file, or - for standard input"),
                "{error}"
            );
        }
    }

    #[test]
    fn a_huge_file_is_refused_by_its_size() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("huge.txt");
        File::create(&path).and_then(|file| file.set_len(20 << 30)).expect("a sparse file");
        let error = read(&path).expect_err("too large");
        assert!(
            error.to_string().ends_with("larger than 4 MiB: that is neither a plan nor settings"),
            "{error}"
        );
        let error = read_small(&path).expect_err("too large");
        assert!(
            error.to_string().ends_with("larger than 512 KiB: that is neither a plan nor settings"),
            "{error}"
        );
        let error = read_tile(&path).expect_err("too large");
        assert!(error.to_string().ends_with("larger than 64 MiB: that is no elevation tile"), "{error}");
        let error = read_map(&path).expect_err("too large");
        assert!(error.to_string().ends_with("larger than 64 MiB: that is too much for a map"), "{error}");
    }

    #[test]
    fn a_file_that_is_no_text_is_refused_with_the_reason() {
        let say = |bytes: &[u8]| read_text(bytes, "a.toml", TEXT).expect_err("no text").to_string();
        assert_eq!(say(b"abc\xff"), "a.toml is not a text file: byte 3 is not UTF-8 text");
        assert_eq!(
            say(b"\xff\xfea\0b"),
            "a.toml is not a text file: the UTF-16 text ends in the middle of a character"
        );
    }

    #[test]
    fn a_missing_file_is_none_only_where_it_may_be_missing() {
        let missing = Path::new("/nonexistent/file");
        assert_eq!(read_if_there(missing).expect("missing"), None);
        assert!(read(missing).is_err());
    }
}
