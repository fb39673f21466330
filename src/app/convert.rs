//! `betadeck convert`: converts a plan to another format.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::Path;

use super::error::{self, AppError};
use super::output_file::KeptFiles;
use super::setup;
use crate::args::{ConvertArgs, OutputFile, PlanArg};
use crate::plan::format;

/// Converts, and reports the parts that the target format cannot hold.
pub(super) fn run(args: &ConvertArgs) -> Result<u8, AppError> {
    let source = args.source().map_err(|error| AppError::input(error.to_string()))?;
    let target = args.target().map_err(AppError::input)?;
    let file = setup::read_plan(&source)?;
    if file.plan.waypoints.is_empty() {
        let name = source.display_name();
        return Err(AppError::input(format!("{name} has no waypoints: there is nothing to convert")));
    }
    for note in &file.notes {
        error::tell(&note.to_string());
    }
    let written = format::write(&file, target);
    match &args.output {
        OutputFile::Stdout => error::write_stdout(written.text.as_bytes()).map(drop)?,
        OutputFile::File(path) => {
            let mut kept = KeptFiles::default();
            if let PlanArg::File(input, _) = &source {
                kept.keep("the plan that was read", input);
            }
            setup::keep_own_files(&mut kept);
            kept.claim("the output", path)?;
            write(path, &written.text, args.force)?;
        }
    }
    for loss in &written.lost {
        error::tell(&format!("not carried: {loss}"));
    }
    Ok(0)
}

/// Writes the file. An existing file may be the work of the user, so it is replaced only on request.
fn write(path: &Path, text: &str, force: bool) -> Result<(), AppError> {
    let problem = |error| AppError::environment(format!("cannot write {}: {error}", path.display()));
    let file = match OpenOptions::new().write(true).create_new(true).open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            // Pipes and devices have no contents to lose.
            let holds_data = std::fs::metadata(path).map_err(problem)?.is_file();
            if holds_data && !force {
                return Err(AppError::environment(format!(
                    "{} exists: name another file, or replace it with --force",
                    path.display()
                )));
            }
            File::create(path)
        }
        opened => opened,
    };
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(problem)
}
