//! Writes settings of the craft in a file, as lines of the command line.

use std::path::PathBuf;

use super::on_disk;
use crate::screen_files::plan_files::on_disk::Content;
use crate::ui::files::FileReply;

/// Writes settings in a new file. `count` is their number.
pub(super) fn save(path: PathBuf, text: &str, count: usize) -> FileReply {
    if Content::of(&path).is_there() {
        return FileReply::Failed(format!("{} exists: name another file.", path.display()));
    }
    match on_disk::write(&path, text.as_bytes()) {
        Ok(()) => FileReply::SavedSettings { path, count },
        Err(sentence) => FileReply::Failed(sentence),
    }
}
