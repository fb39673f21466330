//! Files that are written as a whole at the end.

use std::fs::{File, OpenOptions, Permissions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use rustix::fs::{Access, access};
use tempfile::NamedTempFile;

use super::{FileError, cannot_write, directory_of, write_failed};
use crate::process::error::AppError;
use crate::storage::{self, state_file};

/// An output that is written as a whole at the end. Until then an existing file stays unchanged.
#[derive(Debug)]
pub(crate) struct FinalOutput {
    path: PathBuf,
    place: Place,
    /// The permissions of the existing file.
    permissions: Option<Permissions>,
}

/// The permissions of a new file, before the user's mask.
const USUAL_MODE: u32 = 0o666;

/// The place of an output.
#[derive(Debug)]
enum Place {
    /// A regular file, existing or not, after all links.
    Regular(PathBuf),
    /// A device, a pipe or an open descriptor.
    Stream(File),
}

impl FinalOutput {
    /// Prepares the output to a claimed path; writes nothing yet.
    ///
    /// # Errors
    /// Returns the reason why it cannot be written.
    pub(crate) fn prepare(path: &Path) -> Result<Self, AppError> {
        let place = Place::of(path).map_err(|error| cannot_write(path, &error))?;
        Ok(Self { path: path.to_owned(), place, permissions: None })
    }

    /// Does the same and removes an existing file, which has the results of an earlier run.
    ///
    /// # Errors
    /// Returns the reason why it cannot be written.
    pub(crate) fn begin(path: &Path) -> Result<Self, AppError> {
        let mut output = Self::prepare(path)?;
        if let Place::Regular(target) = &output.place {
            output.permissions = clear(target).map_err(|error| cannot_write(path, &error))?;
        }
        Ok(output)
    }

    pub(crate) fn write(self, contents: &[u8]) -> Result<(), AppError> {
        let written = match self.place {
            Place::Regular(target) => match replace_with(&target, contents, self.permissions) {
                Err(error) if is_of_directory(&error) => std::fs::write(&target, contents),
                written => written,
            },
            Place::Stream(mut file) => file.write_all(contents),
        };
        written.map_err(|error| cannot_write(&self.path, &error))
    }
}

/// An output that is written step by step under another name, and gets its own name at the end.
#[derive(Debug)]
pub(crate) struct StreamedOutput {
    path: PathBuf,
    writer: BufWriter<Stream>,
    /// The final place of the temporary file.
    target: Option<Target>,
}

/// A file to be created, with the permissions of the previous one.
type Target = (PathBuf, Option<Permissions>);

#[derive(Debug)]
enum Stream {
    Temporary(NamedTempFile),
    Direct(File),
}

impl StreamedOutput {
    /// Begins the output to a claimed path. Removes an existing file, which has the results of an earlier run.
    ///
    /// # Errors
    /// Returns the reason why it cannot be written.
    pub(crate) fn begin(path: &Path) -> Result<Self, AppError> {
        let begun = match Place::of(path) {
            Ok(Place::Stream(file)) => Ok((Stream::Direct(file), None)),
            Ok(Place::Regular(target)) => begin_at(target),
            Err(error) => Err(error),
        };
        let (stream, target) = begun.map_err(|error| cannot_write(path, &error))?;
        Ok(Self { path: path.to_owned(), writer: BufWriter::new(stream), target })
    }

    /// Does the same, and gives the file its name at once, with these bytes in it. After a kill it has what was flushed.
    ///
    /// # Errors
    /// Returns the reason why it cannot be written.
    pub(crate) fn begin_with(path: &Path, bytes: &[u8]) -> Result<Self, AppError> {
        let mut output = Self::begin(path)?;
        output.add(bytes)?;
        output.named()
    }

    /// Gives the file its name before its end. After a kill it has what was flushed.
    ///
    /// # Errors
    /// Returns the reason why it cannot be written.
    pub(crate) fn named(self) -> Result<Self, AppError> {
        let Self { path, writer, target } = self;
        let stream = writer.into_inner().map_err(io::IntoInnerError::into_error);
        let named = stream.and_then(|stream| match (stream, target) {
            (Stream::Temporary(file), Some((target, permissions))) => {
                name(file, &target, permissions).map(Stream::Direct)
            }
            (stream, _) => Ok(stream),
        });
        let stream = named.map_err(|error| cannot_write(&path, &error))?;
        Ok(Self { path, writer: BufWriter::new(stream), target: None })
    }

    /// Adds these bytes.
    ///
    /// # Errors
    /// Returns the reason why they cannot be written, with the name of the file.
    pub(crate) fn add(&mut self, bytes: &[u8]) -> Result<(), AppError> {
        self.write_all(bytes).map_err(write_failed)
    }

    /// Gives the file its name. Until then there is no file with that name.
    ///
    /// # Errors
    /// Returns the reason why it cannot be written.
    pub(crate) fn finish(self) -> Result<(), AppError> {
        self.named().map(drop)
    }
}

/// Each error names the file.
impl Write for StreamedOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes).map_err(|source| named_error(&self.path, source))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush().map_err(|source| named_error(&self.path, source))
    }
}

fn named_error(path: &Path, source: io::Error) -> io::Error {
    io::Error::new(source.kind(), FileError { path: path.to_owned(), source })
}

impl Write for Stream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Temporary(file) => file.write(bytes),
            Self::Direct(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn begin_at(target: PathBuf) -> io::Result<(Stream, Option<Target>)> {
    let directory = directory_of(&target);
    state_file::sweep(directory);
    match state_file::temporary_in(directory, USUAL_MODE) {
        Ok(file) => {
            let permissions = clear(&target)?;
            Ok((Stream::Temporary(file), Some((target, permissions))))
        }
        Err(error) if is_of_directory(&error) => Ok((Stream::Direct(File::create(&target)?), None)),
        Err(error) => Err(error),
    }
}

/// Removes the existing file, or empties it if it cannot be removed. Returns its permissions.
fn clear(target: &Path) -> io::Result<Option<Permissions>> {
    let Ok(there) = target.metadata() else { return Ok(None) };
    match std::fs::remove_file(target) {
        Err(error) if is_of_directory(&error) => File::create(target).map(drop)?,
        removed => removed?,
    }
    Ok(Some(there.permissions()))
}

/// Returns `true` if the error may come from the directory while the file itself can be written.
fn is_of_directory(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::PermissionDenied | ErrorKind::ResourceBusy | ErrorKind::ReadOnlyFilesystem
    )
}

impl Place {
    fn of(path: &Path) -> io::Result<Self> {
        let target = storage::link_target(path);
        match path.metadata() {
            Ok(there) if there.is_file() && !is_of_system(path) => {
                access(&target, Access::WRITE_OK)?;
                Ok(Self::Regular(target))
            }
            // Earlier output to a descriptor stays before this one.
            Ok(_) => Ok(Self::Stream(OpenOptions::new().append(true).open(path)?)),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                if target.as_os_str().as_encoded_bytes().ends_with(b"/") {
                    return Err(ErrorKind::IsADirectory.into());
                }
                access(directory_of(&target), Access::WRITE_OK | Access::EXEC_OK)?;
                Ok(Self::Regular(target))
            }
            Err(error) => Err(error),
        }
    }
}

/// Replaces or creates a file as a whole. It never exists in part.
pub(crate) fn replace(path: &Path, contents: &[u8]) -> io::Result<()> {
    replace_with(path, contents, None)
}

/// Does the same, with these permissions for a new file.
fn replace_with(path: &Path, contents: &[u8], permissions: Option<Permissions>) -> io::Result<()> {
    let mut file = state_file::temporary_in(directory_of(path), USUAL_MODE)?;
    file.write_all(contents)?;
    name(file, path, permissions).map(drop)
}

/// Gives a temporary file its name, with the permissions of an existing file. Returns the file.
fn name(file: NamedTempFile, path: &Path, permissions: Option<Permissions>) -> io::Result<File> {
    let there = path.metadata().ok().map(|there| there.permissions());
    if let Some(permissions) = there.or(permissions) {
        file.as_file().set_permissions(permissions)?;
    }
    file.as_file().sync_all()?;
    let named = file.persist(path).map_err(|error| error.error)?;
    File::open(directory_of(path))?.sync_all()?;
    Ok(named)
}

/// Returns `true` if a path goes through a directory of devices and open descriptors.
fn is_of_system(path: &Path) -> bool {
    const MAX_LINKS: usize = 40;
    let next = |path: &PathBuf| {
        let target = std::fs::read_link(path).ok()?;
        Some(directory_of(path).join(target))
    };
    let lies_there = |path: PathBuf| {
        let directory = directory_of(&path).canonicalize();
        directory.is_ok_and(|directory| directory.starts_with("/dev") || directory.starts_with("/proc"))
    };
    std::iter::successors(Some(path.to_owned()), next).take(MAX_LINKS).any(lies_there)
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};

    use super::*;

    #[test]
    fn a_file_stays_as_it_is_until_the_output_is_written_as_a_whole() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        std::fs::write(at("tracks.svg"), "before").expect("written");
        std::os::unix::fs::symlink("tracks.svg", at("link")).expect("a link");
        std::os::unix::fs::symlink("later", at("dangling")).expect("a link");
        let read = |name: &str| std::fs::read_to_string(at(name)).ok();
        for (name, target) in [("link", "tracks.svg"), ("new", "new"), ("dangling", "later")] {
            let before = read(target);
            let dropped = FinalOutput::prepare(&at(name)).expect("writable");
            drop(dropped);
            let output = FinalOutput::prepare(&at(name)).expect("writable");
            assert_eq!(read(target), before, "{name}");
            output.write(b"after").expect("written");
            assert_eq!(read(target).as_deref(), Some("after"), "{name}");
        }
        assert!(at("link").is_symlink() && at("dangling").is_symlink());
        let names = std::fs::read_dir(directory.path()).expect("readable").count();
        assert_eq!(names, 5, "nothing else is left");
    }

    #[test]
    fn where_nothing_can_be_written_is_reported_before() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        for path in [directory.path().to_owned(), at("none/x.svg"), at("x.svg/")] {
            let error = FinalOutput::prepare(&path).expect_err("refused");
            assert_eq!(error.code, 3, "{error}");
        }
        std::fs::write(at("kept"), "before").expect("written");
        let protected = std::fs::Permissions::from_mode(0o400);
        std::fs::set_permissions(at("kept"), protected).expect("permitted");
        // Root ignores the protection.
        if OpenOptions::new().write(true).open(at("kept")).is_err() {
            assert_eq!(FinalOutput::prepare(&at("kept")).expect_err("refused").code, 3);
        }
    }

    #[test]
    fn devices_pipes_and_descriptors_are_written_to_and_not_replaced() {
        let directory = tempfile::tempdir().expect("a directory");
        let fifo = directory.path().join("fifo");
        rustix::fs::mknodat(rustix::fs::CWD, &fifo, rustix::fs::FileType::Fifo, rustix::fs::Mode::RWXU, 0)
            .expect("a FIFO");
        let reader = std::thread::spawn({
            let fifo = fifo.clone();
            move || std::fs::read_to_string(fifo)
        });
        FinalOutput::prepare(&fifo).expect("writable").write(b"lines").expect("written");
        assert_eq!(reader.join().expect("read").expect("text"), "lines");
        FinalOutput::prepare(Path::new("/dev/null")).expect("writable").write(b"lines").expect("written");
        assert!(!fifo.metadata().expect("there").is_file());

        let file = File::create(directory.path().join("redirected")).expect("created");
        let inode = file.metadata().expect("there").ino();
        (&file).write_all(b"first ").expect("written");
        let descriptor = format!("/dev/fd/{}", std::os::fd::AsRawFd::as_raw_fd(&file));
        // This link belongs to the user; /dev/stdout is one of the system.
        let link = directory.path().join("stdout");
        std::os::unix::fs::symlink(&descriptor, &link).expect("a link");
        for path in [Path::new(&descriptor), &link] {
            FinalOutput::prepare(path).expect("writable").write(b"more ").expect("written");
        }
        let path = directory.path().join("redirected");
        assert_eq!(std::fs::read_to_string(&path).expect("text"), "first more more ");
        assert_eq!(path.metadata().expect("there").ino(), inode);
    }
}
