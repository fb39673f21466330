//! Plan files and directories as they are on disk.

use std::os::unix::fs::MetadataExt as _;
use std::path::Path;

use crate::app::{input_file, output_file};
use crate::flight::setup::check_setting;
use crate::plan::edit::PlanDocument;
use crate::plan::format::{self, Format, PlanFile};
use crate::storage::link_target;
use crate::ui::editor::{Entry, Listing};

/// Tells whether a file is still the one that was seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    inode: u64,
    length: u64,
    seconds: i64,
    nanoseconds: i64,
}

impl Stamp {
    /// Of what is there; `None` = nothing is.
    pub(super) fn of(path: &Path) -> Option<Self> {
        let metadata = path.metadata().ok()?;
        Some(Self {
            inode: metadata.ino(),
            length: metadata.len(),
            seconds: metadata.mtime(),
            nanoseconds: metadata.mtime_nsec(),
        })
    }
}

/// Reads a plan; what the reader skipped, as sentences.
pub(super) fn read(path: &Path) -> Result<(PlanDocument, Vec<String>), String> {
    let text = input_file::read(path).map_err(|error| format!("{error}."))?;
    let name = path.display().to_string();
    let format = Format::from_file_name(&name).unwrap_or_else(|| Format::of_text(&text));
    let mut file = format::parse_checked(&name, &text, format, check_setting).map_err(|errors| {
        let more = match errors.len() - 1 {
            0 => String::new(),
            more => format!(" ({more} more problems: `betadeck plan show` lists them)"),
        };
        errors.first().map_or_else(|| format!("{name} is no plan."), |error| format!("{error}{more}"))
    })?;
    let notes = std::mem::take(&mut file.notes).iter().map(ToString::to_string).collect();
    Ok((file.into(), notes))
}

/// Whether the file holds exactly what [`write`] makes of this document.
pub(super) fn holds(path: &Path, document: &PlanDocument) -> bool {
    Format::from_file_name(&path.display().to_string()).is_some_and(|format| {
        let written = format::write(&PlanFile::from(document.clone()), format).text;
        input_file::read(path).is_ok_and(|text| text == written)
    })
}

/// Writes a plan; what its format cannot carry, as sentences. The file is replaced as a whole.
pub(super) fn write(path: &Path, document: PlanDocument) -> Result<Vec<String>, String> {
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
    Ok(written.lost)
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
