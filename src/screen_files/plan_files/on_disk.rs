//! Plan files and directories on disk.

use std::io::ErrorKind;
use std::path::Path;

use crate::files::{input_file, output_file};
use crate::flight::setup::check_setting;
use crate::plan::edit::PlanDocument;
use crate::plan::format::loss::LossReport;
use crate::plan::format::{self, Format, HomePosition, PlanFile, ReadOptions, Written};
use crate::storage::link_target;
use crate::ui::PlanId;
use crate::ui::files::{Entry, FileReply, Listing};

/// The contents of a file. They show a change by another program; time stamp and length do not show every change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Content {
    /// There is no file, or it was not read.
    Missing,
    Bytes(Vec<u8>),
    /// A file that cannot be read as a plan, with the reason.
    Unreadable(String),
}

impl Content {
    /// Reads the current contents.
    pub(super) fn of(path: &Path) -> Self {
        match path.metadata() {
            Err(error) if error.kind() == ErrorKind::NotFound => Self::Missing,
            Err(error) => Self::Unreadable(error.to_string()),
            // A pipe gives its contents only to the first reader.
            Ok(there) if !there.is_file() => Self::Unreadable("not a file".to_owned()),
            Ok(_) => match input_file::read_plan(path) {
                Ok(bytes) => Self::Bytes(bytes),
                Err(error) => Self::Unreadable(error.to_string()),
            },
        }
    }

    /// Returns `true` if the file exists.
    pub(super) fn is_there(&self) -> bool {
        *self != Self::Missing
    }

    /// Returns `true` if this is the same text as before.
    pub(super) fn is_known_as(&self, seen: &Self) -> bool {
        matches!(self, Self::Bytes(_)) && self == seen
    }

    /// Returns `true` if it is exactly the output of [`write`] for a document.
    pub(super) fn is_written(&self, path: &Path, document: &PlanDocument) -> bool {
        let Self::Bytes(bytes) = self else { return false };
        Format::from_file_name(&path.display().to_string())
            .is_some_and(|format| *bytes == format::write(&PlanFile::from(document.clone()), format).contents)
    }

    /// Returns `true` if it is this document, written here or by another program.
    pub(super) fn is_document(&self, path: &Path, document: &PlanDocument) -> bool {
        let Self::Bytes(bytes) = self else { return false };
        self.is_written(path, document)
            || parse(path, bytes, document.home).is_ok_and(|there| PlanDocument::from(there) == *document)
    }
}

/// A plan that was read from its file.
#[derive(Debug)]
pub(super) struct Read {
    pub(super) document: PlanDocument,
    /// Sentences about the skipped parts.
    pub(super) notes: Vec<String>,
    pub(super) losses: LossReport,
    pub(super) content: Content,
}

/// Reads a plan.
pub(super) fn read(path: &Path, home: Option<HomePosition>) -> Result<Read, String> {
    let contents = input_file::read_plan(path).map_err(|error| format!("{error}."))?;
    let mut file = parse(path, &contents, home)?;
    let notes = std::mem::take(&mut file.notes).iter().map(ToString::to_string).collect();
    let losses = std::mem::take(&mut file.losses);
    Ok(Read { document: file.into(), notes, losses, content: Content::Bytes(contents) })
}

/// Reads the document of a plan's file for a comparison.
pub(super) fn compared(id: PlanId, path: &Path, home: Option<HomePosition>) -> FileReply {
    FileReply::OnDisk { id, document: read(path, home).map(|read| Box::new(read.document)) }
}

fn parse(path: &Path, contents: &[u8], home: Option<HomePosition>) -> Result<PlanFile, String> {
    let name = path.display().to_string();
    let (format, finding) = Format::detect(&name, contents);
    let options = ReadOptions { check: check_setting, home, ..ReadOptions::default() };
    let mut file = format::read(&name, contents, format, &options).map_err(|errors| {
        let more = match errors.len() - 1 {
            0 => String::new(),
            more => format!(" ({more} more problems: `betadeck plan show` lists them)"),
        };
        errors.first().map_or_else(
            || format!("{name} is not a plan."),
            |error| match error.hint.as_str() {
                "" => format!("{}.{more}", error.headline()),
                hint => format!("{}: {hint}.{more}", error.headline()),
            },
        )
    })?;
    file.losses.findings.splice(0..0, finding);
    Ok(file)
}

/// Returns the file of a plan in the format of its extension.
pub(super) fn converted(path: &Path, document: PlanDocument) -> Result<Written, String> {
    let name = path.display();
    let format = Format::from_file_name(&path.to_string_lossy()).ok_or_else(|| {
        format!("The extension of {name} does not give the format: name it {}.", Format::extensions())
    })?;
    let written = format::write(&PlanFile::from(document), format);
    if written.is_refused() {
        let why: Vec<&str> = written.losses.findings.iter().map(|finding| finding.why.as_str()).collect();
        return Err(format!("{name} cannot hold this plan: {}.", why.join("; ")));
    }
    Ok(written)
}

/// Replaces a file as a whole.
pub(super) fn write(path: &Path, contents: &[u8]) -> Result<(), String> {
    let name = path.display();
    let target = link_target(path);
    // The permissions of the directory would allow a replacement.
    if target.metadata().is_ok_and(|there| there.permissions().readonly()) {
        return Err(format!(
            "{name} is write-protected: save under another name, or allow it with chmod u+w."
        ));
    }
    output_file::replace(&target, contents).map_err(|error| format!("Cannot write {name}: {error}."))
}

/// Returns the directories and plan files of a directory.
pub(super) fn list(directory: &Path) -> Result<Listing, String> {
    let cannot = |error: std::io::Error| format!("Cannot list {}: {error}.", directory.display());
    let directory = directory.canonicalize().map_err(cannot)?;
    let mut entries: Vec<Entry> = std::fs::read_dir(&directory)
        .map_err(cannot)?
        .filter_map(Result::ok)
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let is_directory = entry.path().is_dir();
            let is_plan = Format::is_plan_name(&name);
            (!name.starts_with('.') && (is_directory || is_plan)).then_some(Entry { name, is_directory })
        })
        .collect();
    entries.sort_by(|a, b| (!a.is_directory, &a.name).cmp(&(!b.is_directory, &b.name)));
    Ok(Listing { directory, entries })
}
