//! `betadeck convert`: converts a plan to another format, and reports each part that differs there.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::Path;

use strum::IntoEnumIterator as _;

use super::error::{self, AppError, USAGE};
use super::output_file::{self, KeptFiles};
use super::setup;
use crate::args::{ConvertArgs, OutputFile, PlanArg};
use crate::flight::setup::check_setting;
use crate::plan::format::loss::Severity;
use crate::plan::format::{self, Format, PlanFile, ReadOptions};
use crate::report::conversion::Conversion;
use crate::storage::link_target;
use crate::text::printable;

/// The exit code of a plan that changed, with `--strict`.
const CHANGED: u8 = 1;

/// Converts, and reports the differences.
pub(super) fn run(args: &ConvertArgs) -> Result<u8, AppError> {
    if args.list {
        return error::print(&list());
    }
    let source = args.source().map_err(|error| AppError::input(error.to_string()))?;
    let target = args.target().map_err(AppError::input)?;
    let options = ReadOptions { check: check_setting, ..args.read_options() };
    let read = setup::read_plan_with(&source, &options).and_then(|(format, file)| {
        let name = source.display_name();
        match file.plan.waypoints.is_empty() {
            true => Err(AppError::input(format!("{name} has no waypoints: there is nothing to convert"))),
            false => Ok((format, file)),
        }
    });
    let (format, file) = match read {
        Err(error) if args.json => {
            print_json(&Conversion::refused(target, &error.message), args.output() == OutputFile::Stdout)?;
            return Err(error);
        }
        read => read?,
    };
    for note in &file.notes {
        error::tell(&note.to_string());
    }
    let file = PlanFile { home: file.home.or(options.home), ..file };
    let written = format::write_with(&file, target, &args.write_options());
    let is_refused = written.is_refused();
    let output = args.output();
    match &output {
        _ if is_refused => {}
        OutputFile::Stdout => error::write_stdout(&written.contents).map(drop)?,
        OutputFile::File(path) => {
            let mut kept = KeptFiles::default();
            if let PlanArg::File(input, _) = &source {
                kept.keep("the plan that was read", input);
            }
            setup::keep_own_files(&mut kept);
            kept.claim("the output", path)?;
            write(path, &written.contents, args.force)?;
        }
    }
    let conversion = Conversion::new(format, &file, target, written.losses);
    if !args.json {
        conversion.lines().iter().for_each(|line| error::tell(line));
    } else {
        print_json(&conversion, output == OutputFile::Stdout)?;
    }
    Ok(match conversion.worst() {
        _ if is_refused => USAGE,
        Some(worst) if args.strict && worst > Severity::Info => CHANGED,
        _ => 0,
    })
}

/// Prints the report: on standard error if standard output is for the plan.
fn print_json(conversion: &Conversion, has_plan: bool) -> Result<(), AppError> {
    if has_plan {
        error::tell_json(&conversion.json());
        return Ok(());
    }
    let line = format!("{}\n", printable::json(&conversion.json()));
    error::write_stdout(line.as_bytes()).map(drop)
}

/// Returns the table of the formats.
fn list() -> String {
    let rows = Format::iter().map(|format| {
        let info = format.info();
        let endings: Vec<String> =
            info.endings.iter().chain(info.also).map(|ending| format!(".{ending}")).collect();
        let ways = if info.writes { "read, write" } else { "read" };
        (format.to_string(), endings.join(" "), ways, info)
    });
    let rows: Vec<_> = rows.collect();
    let width = rows.iter().map(|(_, endings, ..)| endings.len()).max().unwrap_or_default();
    rows.iter()
        .map(|(name, endings, ways, info)| {
            format!("{name:<7}  {endings:<width$}  {ways:<11}  {}: {}\n", info.title, info.carries)
        })
        .collect()
}

/// Writes the file. An existing file may be the work of the user, so it is replaced only on request.
fn write(path: &Path, contents: &[u8], force: bool) -> Result<(), AppError> {
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
            if holds_data {
                // A full disk leaves the old contents.
                return output_file::replace(&link_target(path), contents).map_err(problem);
            }
            File::create(path)
        }
        opened => opened,
    };
    file.and_then(|mut file| file.write_all(contents)).map_err(problem)
}
