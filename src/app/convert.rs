//! `betadeck convert`: converts a plan to another format, and reports each part that differs there.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use strum::IntoEnumIterator as _;

use crate::args::{ConvertArgs, OutputFile, PlanArg};
use crate::files::output_file;
use crate::files::output_file::KeptFiles;
use crate::flight::setup::check_setting;
use crate::headless::setup;
use crate::plan::format::loss::{Finding, LossReport, Severity};
use crate::plan::format::{self, Format, PlanFile, ReadOptions, Written};
use crate::process::error;
use crate::process::error::{AppError, USAGE};
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
    let parts = if args.split { file.parts() } else { vec![file.clone()] };
    let written: Vec<Written> =
        parts.iter().map(|part| format::write_with(part, target, &args.write_options())).collect();
    let is_refused = written.iter().any(Written::is_refused);
    let output = args.output();
    match &output {
        _ if is_refused => {}
        OutputFile::Stdout => {
            for part in &written {
                error::write_stdout(&part.contents)?;
            }
        }
        OutputFile::File(path) => {
            let paths = paths(path, parts.len());
            let mut kept = KeptFiles::default();
            if let PlanArg::File(input, _) = &source {
                kept.keep("the plan that was read", input);
            }
            setup::keep_own_files(&mut kept);
            paths.iter().try_for_each(|path| kept.claim("the output", path))?;
            // No part is written if another one would replace a file.
            paths.iter().try_for_each(|path| refuse_to_replace(path, args.force))?;
            for (path, part) in paths.iter().zip(&written) {
                write(path, &part.contents, args.force)?;
            }
        }
    }
    let conversion = Conversion::new(format, &file, target, joined(written));
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

/// Returns the file of each part: the named one for a single part, else with `-1`, `-2` and so on before its extension.
fn paths(path: &Path, parts: usize) -> Vec<PathBuf> {
    let numbered = |number: usize| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let extension = path
            .extension()
            .map_or_else(String::new, |extension| format!(".{}", extension.to_string_lossy()));
        path.with_file_name(format!("{stem}-{number}{extension}"))
    };
    if parts == 1 { vec![path.to_owned()] } else { (1..=parts).map(numbered).collect() }
}

/// Returns the losses of all parts as those of one file.
fn joined(written: Vec<Written>) -> LossReport {
    let parts = written.len();
    let mut all = LossReport::default();
    for (number, Written { losses, .. }) in (1..).zip(written) {
        all.items += losses.items;
        all.waypoints += losses.waypoints;
        all.findings.extend(losses.findings.into_iter().map(|finding| match parts {
            1 => finding,
            _ => Finding { field: format!("part {number}, {}", finding.field), ..finding },
        }));
    }
    if parts > 1 {
        let why = "a plan holds at most 30 waypoints: each part begins where the one before ends";
        all.add(Finding::new(Severity::Info, "parts", why).values("", parts.to_string()));
    }
    all
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
        let extensions: Vec<String> =
            info.extensions.iter().chain(info.also).map(|extension| format!(".{extension}")).collect();
        let ways = if info.writes { "read, write" } else { "read" };
        (format.to_string(), extensions.join(" "), ways, info)
    });
    let rows: Vec<_> = rows.collect();
    let width = rows.iter().map(|(_, extensions, ..)| extensions.len()).max().unwrap_or_default();
    rows.iter()
        .map(|(name, extensions, ways, info)| {
            format!("{name:<7}  {extensions:<width$}  {ways:<11}  {}: {}\n", info.title, info.carries)
        })
        .collect()
}

/// Returns `true` for a file with contents to lose; pipes and devices have none.
fn holds_data(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|there| there.is_file())
}

fn refuse_to_replace(path: &Path, force: bool) -> Result<(), AppError> {
    if holds_data(path) && !force {
        let name = path.display();
        return Err(AppError::environment(format!(
            "{name} exists: name another file, or replace it with --force"
        )));
    }
    Ok(())
}

/// Writes the file. An existing file may be the work of the user, so it is replaced only on request.
fn write(path: &Path, contents: &[u8], force: bool) -> Result<(), AppError> {
    let problem = |error| AppError::environment(format!("cannot write {}: {error}", path.display()));
    let file = match OpenOptions::new().write(true).create_new(true).open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            refuse_to_replace(path, force)?;
            if holds_data(path) {
                // A full disk leaves the old contents.
                return output_file::replace(&link_target(path), contents).map_err(problem);
            }
            File::create(path)
        }
        opened => opened,
    };
    file.and_then(|mut file| file.write_all(contents)).map_err(problem)
}
