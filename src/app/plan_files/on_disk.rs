//! Plan files and directories as they are on disk.

use std::io::ErrorKind;
use std::path::Path;

use crate::app::{input_file, output_file};
use crate::flight::setup::check_setting;
use crate::plan::edit::PlanDocument;
use crate::plan::format::{self, Format, PlanFile};
use crate::storage::link_target;
use crate::ui::editor::{Entry, Listing};

/// What a file holds, to find out whether another program changed it: its time stamp and length do not show every change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Content {
    /// Nothing is there, or nothing of it was seen.
    Missing,
    Text(String),
    /// Something that is not read as a plan: why.
    Unreadable(String),
}

impl Content {
    /// Reads what is there now.
    pub(super) fn of(path: &Path) -> Self {
        match path.metadata() {
            Err(error) if error.kind() == ErrorKind::NotFound => Self::Missing,
            Err(error) => Self::Unreadable(error.to_string()),
            // A pipe would give what it has to whoever reads first.
            Ok(there) if !there.is_file() => Self::Unreadable("not a file".to_owned()),
            Ok(_) => match input_file::read(path) {
                Ok(text) => Self::Text(text),
                Err(error) => Self::Unreadable(error.to_string()),
            },
        }
    }

    /// Whether something is there.
    pub(super) fn is_there(&self) -> bool {
        *self != Self::Missing
    }

    /// Whether this is the text that was seen before.
    pub(super) fn is_known_as(&self, seen: &Self) -> bool {
        matches!(self, Self::Text(_)) && self == seen
    }

    /// Whether it is exactly what [`write`] makes of a document.
    pub(super) fn is_written(&self, path: &Path, document: &PlanDocument) -> bool {
        let Self::Text(text) = self else { return false };
        Format::from_file_name(&path.display().to_string())
            .is_some_and(|format| *text == format::write(&PlanFile::from(document.clone()), format).text)
    }

    /// Whether it is this document, as written here or by another program.
    pub(super) fn is_document(&self, path: &Path, document: &PlanDocument) -> bool {
        let Self::Text(text) = self else { return false };
        self.is_written(path, document) || parse(path, text).is_ok_and(|(there, _)| there == *document)
    }
}

/// Reads a plan; what the reader skipped, as sentences; the content it was read from.
pub(super) fn read(path: &Path) -> Result<(PlanDocument, Vec<String>, Content), String> {
    let text = input_file::read(path).map_err(|error| format!("{error}."))?;
    let (document, notes) = parse(path, &text)?;
    Ok((document, notes, Content::Text(text)))
}

fn parse(path: &Path, text: &str) -> Result<(PlanDocument, Vec<String>), String> {
    let name = path.display().to_string();
    let format = Format::from_file_name(&name).unwrap_or_else(|| Format::of_text(text));
    let mut file = format::parse_checked(&name, text, format, check_setting).map_err(|errors| {
        let more = match errors.len() - 1 {
            0 => String::new(),
            more => format!(" ({more} more problems: `betadeck plan show` lists them)"),
        };
        errors.first().map_or_else(|| format!("{name} is no plan."), |error| format!("{error}{more}"))
    })?;
    let notes = std::mem::take(&mut file.notes).iter().map(ToString::to_string).collect();
    Ok((file.into(), notes))
}

/// Writes a plan; what its format cannot carry, as sentences, and the content that was written. The file is replaced as
/// a whole.
pub(super) fn write(path: &Path, document: PlanDocument) -> Result<(Vec<String>, Content), String> {
    let name = path.display().to_string();
    let Some(format) = Format::from_file_name(&name) else {
        return Err(format!("{name} has no ending that tells the format: name it {}.", Format::endings()));
    };
    let written = format::write(&PlanFile::from(document), format);
    let target = link_target(path);
    // The directory would let it be replaced.
    if target.metadata().is_ok_and(|there| there.permissions().readonly()) {
        return Err(format!(
            "{name} is write-protected: save under another name, or allow it with chmod u+w."
        ));
    }
    output_file::replace(&target, written.text.as_bytes())
        .map_err(|error| format!("Cannot write {name}: {error}."))?;
    Ok((written.lost, Content::Text(written.text)))
}

/// The directories and plan files of a directory.
pub(super) fn list(directory: &Path) -> Result<Listing, String> {
    let cannot = |error: std::io::Error| format!("Cannot list {}: {error}.", directory.display());
    let directory = directory.canonicalize().map_err(cannot)?;
    let mut entries: Vec<Entry> = std::fs::read_dir(&directory)
        .map_err(cannot)?
        .filter_map(Result::ok)
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let is_directory = entry.path().is_dir();
            let is_plan = Format::from_file_name(&name).is_some();
            (!name.starts_with('.') && (is_directory || is_plan)).then_some(Entry { name, is_directory })
        })
        .collect();
    entries.sort_by(|a, b| (!a.is_directory, &a.name).cmp(&(!b.is_directory, &b.name)));
    Ok(Listing { directory, entries })
}
