//! `betadeck convert`: one plan format to another.

use super::error::{self, AppError};
use super::setup;
use crate::args::{ConvertArgs, OutputFile};
use crate::plan::format;

/// Converts, and says what the target format cannot carry.
pub fn run(args: &ConvertArgs) -> Result<u8, AppError> {
    let source = args.source().map_err(|error| AppError::input(error.to_string()))?;
    let target = args.target().map_err(AppError::input)?;
    let file = setup::read_plan(&source)?;
    for note in &file.notes {
        error::tell(&note.to_string());
    }
    let written = format::write(&file, target);
    for loss in &written.lost {
        error::tell(&format!("not carried: {loss}"));
    }
    match &args.output {
        OutputFile::Stdout => error::write_stdout(written.text.as_bytes()),
        OutputFile::File(path) => std::fs::write(path, &written.text)
            .map(|()| 0)
            .map_err(|error| AppError::environment(format!("cannot write {}: {error}", path.display()))),
    }
}
