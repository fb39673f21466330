//! `betadeck campaign merge`: the files of all shards as one.

use std::path::PathBuf;

use super::outputs;
use crate::args::MergeArgs;
use crate::campaign::Shard;
use crate::files::output_file::StreamedOutput;
use crate::headless::campaign::loaded::{Loaded, differs};
use crate::headless::campaign::outputs::{Outputs, Titles};
use crate::headless::campaign::run_file::RunReader;
use crate::headless::report;
use crate::process::error;
use crate::process::error::AppError;

/// The most missing shards that are named.
const SHOWN: usize = 20;

/// Merges and answers. The exit code is 0 if every goal was met.
pub(super) fn run(args: &MergeArgs, repeat: &[String]) -> Result<u8, AppError> {
    outputs::claim(&args.output, Some(&args.out), &args.parts)?;
    let parts = sorted(args)?;
    let header = match parts.first() {
        Some((_, part)) => part.header().of_shard(Shard::WHOLE),
        None => return Err(AppError::internal("no part")),
    };
    let loaded = Loaded::from_run(header.clone())?;
    let mut outputs = Outputs::begin(&args.output, &loaded, Shard::WHOLE)?;
    let mut out = StreamedOutput::begin(&args.out)?;
    let mut write = |text: &str| out.add(format!("{text}\n").as_bytes());
    write(&header.line())?;
    let mut lost = Vec::new();
    for (path, mut part) in parts {
        while let Some(line) = part.next()? {
            outputs.add(&line.record)?;
            write(&line.text)?;
        }
        if part.lines() < part.wanted() {
            let sides = part.header().sides();
            let path = path.display();
            lost.push(format!(
                "{path} (shard {}) ends after {} of {} flights: finish it with betadeck campaign {path}",
                part.shard(),
                part.lines() / sides,
                part.wanted() / sides
            ));
        }
    }
    if !lost.is_empty() {
        return Err(AppError::input(lost.join("\n")));
    }
    out.finish()?;
    // A merge needs its output.
    let words = [repeat, &["--out".to_owned(), args.out.display().to_string()]].concat();
    let command = report::command(&words);
    let titles = Titles { loaded: &loaded, run: Some(&args.out), shard: Shard::WHOLE, command: &command };
    let answer = outputs.finish(&titles)?;
    Ok(if answer.is_met() { 0 } else { error::FAILED })
}

/// Returns the parts in the order of their shards. Every shard must be there once.
fn sorted(args: &MergeArgs) -> Result<Vec<(PathBuf, RunReader)>, AppError> {
    let mut parts: Vec<(PathBuf, RunReader)> = Vec::new();
    let mut problems = Vec::new();
    for path in &args.parts {
        let part = RunReader::open(path)?;
        if let Some((first_path, first)) = parts.first() {
            if first.header().id != part.header().id {
                problems.push(format!(
                    "{} does not belong to the campaign of {}: {}",
                    path.display(),
                    first_path.display(),
                    differs(first.header(), part.header())
                ));
                continue;
            }
            if first.shard().of != part.shard().of {
                problems.push(format!(
                    "{} is shard {}, and {} is shard {}: the campaign was divided twice",
                    path.display(),
                    part.shard(),
                    first_path.display(),
                    first.shard()
                ));
                continue;
            }
        }
        if let Some((twin, _)) = parts.iter().find(|(_, known)| known.shard() == part.shard()) {
            problems.push(format!(
                "shard {} is there twice: {} and {}",
                part.shard(),
                twin.display(),
                path.display()
            ));
            continue;
        }
        parts.push((path.clone(), part));
    }
    parts.sort_by_key(|(_, part)| part.shard().number);
    if let Some((_, first)) = parts.first() {
        let of = first.shard().of;
        let there: Vec<u64> = parts.iter().map(|(_, part)| part.shard().number).collect();
        let missing: Vec<String> = (1..=of)
            .filter(|number| there.binary_search(number).is_err())
            .map(|number| format!("{number}/{of}"))
            .take(SHOWN)
            .collect();
        if let Some(first) = missing.first() {
            problems.push(format!(
                "the shards {} are missing: fly them with the same command and --shard {first}",
                missing.join(", ")
            ));
        }
    }
    if problems.is_empty() { Ok(parts) } else { Err(AppError::input(problems.join("\n"))) }
}
