//! Flies again after a change of one of the files.
#![allow(clippy::disallowed_methods, reason = "looks at files from time to time")]

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};

use super::{fly, load, output};
use crate::args::CheckArgs;
use crate::launch::RemoteFirmware;
use crate::process::error;
use crate::process::error::AppError;

/// The interval between two checks of the files.
const INTERVAL: Duration = Duration::from_millis(200);

/// Flies, waits for a change, and flies again, until a signal.
pub(super) fn run(
    args: &CheckArgs,
    repeat: &[String],
    firmware: Option<&RemoteFirmware>,
    interrupted: &Arc<AtomicBool>,
) -> Result<u8, AppError> {
    if args.what.is_empty() {
        return Err(AppError::input("--watch needs files: built-in scenarios do not change"));
    }
    // The files of the last run. A file that cannot be read now is watched, too.
    let mut files: Vec<PathBuf> = args.what.iter().map(PathBuf::from).collect();
    loop {
        let seen = stamps(&files);
        output::remove_earlier(args)?;
        match load::load(args) {
            Ok(loaded) => {
                for file in &loaded.files {
                    if !files.contains(file) {
                        files.push(file.clone());
                    }
                }
                fly(&loaded, args, repeat, firmware, interrupted)?;
            }
            Err(error) => error::tell(&error.message),
        }
        let seen = if seen.len() == files.len() { seen } else { stamps(&files) };
        error::tell("Waiting for the files to change; Ctrl-C ends.");
        while stamps(&files) == seen {
            if interrupted.load(Ordering::Relaxed) {
                return Ok(error::INTERRUPTED);
            }
            std::thread::sleep(INTERVAL);
        }
        if interrupted.load(Ordering::Relaxed) {
            return Ok(error::INTERRUPTED);
        }
    }
}

/// Returns the times of the last change and the sizes of the files.
fn stamps(files: &[PathBuf]) -> Vec<Option<(SystemTime, u64)>> {
    files
        .iter()
        .map(|file| {
            file.metadata().ok().and_then(|metadata| Some((metadata.modified().ok()?, metadata.len())))
        })
        .collect()
}
