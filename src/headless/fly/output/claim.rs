//! The output files of the options, checked before anything is written.

use std::path::{Path, PathBuf};

use crate::args::{FlyArgs, OutputFile, PlanArg};
use crate::files::log_output::file_of_one;
use crate::files::output_file::Writer;
use crate::files::{log_output, output_file};
use crate::headless::setup;
use crate::process::error::AppError;

/// Checks that no output replaces a file that must be kept. If all outputs are allowed, removes the results of an
/// earlier flight, because this flight may fail before it begins.
pub(in crate::headless::fly) fn claim(args: &FlyArgs) -> Result<(), AppError> {
    if [&args.json, &args.csv].iter().all(|output| **output == Some(OutputFile::Stdout)) {
        return Err(AppError::input(
            "--json - and --csv - both go to standard output: name a file for one of them",
        ));
    }
    let mut kept = setup::kept_files(&args.flight, Some(&args.plan));
    args.backdrop.iter().for_each(|path| kept.keep("--backdrop", path));
    let log = log_file(args);
    let files = || files(args).chain(log.as_deref().map(|path| (log_output::OPTION, path)));
    files().try_for_each(|(option, path)| kept.claim(option, path))?;
    if !args.force {
        files().try_for_each(|(option, path)| refuse_to_replace(option, path))?;
    }
    files().for_each(|(option, path)| output_file::remove_results(Writer::Fly, option, path));
    Ok(())
}

/// Refuses to replace a file that no flight wrote.
fn refuse_to_replace(option: &str, path: &Path) -> Result<(), AppError> {
    if output_file::may_replace(option, path) {
        return Ok(());
    }
    Err(AppError::input(format!(
        "{option} {} would overwrite a file that is not the {option} of an earlier flight: name another file, or add --force",
        path.display()
    )))
}

/// Returns the file of the blackbox log, if one is wanted.
pub(in crate::headless::fly) fn log_file(args: &FlyArgs) -> Option<PathBuf> {
    let plan = match &args.plan {
        PlanArg::Builtin(plan) => plan.name.into(),
        PlanArg::File(path, _) => path.file_stem().unwrap_or_default().to_string_lossy(),
        PlanArg::Stdin(_) => "plan".into(),
    };
    args.blackbox.as_deref().map(|path| file_of_one(path, &plan))
}

/// Returns the other output files of the options, with their options.
fn files(args: &FlyArgs) -> impl Iterator<Item = (&'static str, &Path)> {
    let of_stream = [("--json", &args.json), ("--csv", &args.csv)];
    let streams = of_stream.into_iter().filter_map(|(option, output)| match output {
        Some(OutputFile::File(path)) => Some((option, path.as_path())),
        Some(OutputFile::Stdout) | None => None,
    });
    let whole = [
        ("--gpx", &args.gpx),
        ("--kml", &args.kml),
        ("--geojson", &args.geojson),
        ("--record", &args.record),
        ("--report", &args.report),
        ("--markdown", &args.markdown),
    ];
    streams.chain(whole.into_iter().filter_map(|(option, path)| Some((option, path.as_deref()?))))
}
