//! Builds the asynchronous runtimes.

use std::os::fd::AsFd as _;

use tokio::runtime::{Builder, Runtime};

use crate::process::error::AppError;

/// The number of files that a runtime opens, and some spare ones. It panics if it gets no file for its signals.
const FILES: usize = 16;

/// Builds a runtime with this number of threads of its own.
///
/// # Errors
/// Returns an error if the system does not give the needed resources.
pub(crate) fn with_threads(threads: usize) -> Result<Runtime, AppError> {
    build(Builder::new_multi_thread().worker_threads(threads))
}

/// Builds a runtime that works on the waiting thread.
///
/// # Errors
/// Returns the errors of [`with_threads`].
pub(crate) fn on_this_thread() -> Result<Runtime, AppError> {
    build(&mut Builder::new_current_thread())
}

fn build(builder: &mut Builder) -> Result<Runtime, AppError> {
    let files: Result<Vec<_>, _> =
        (0..FILES).map(|_| std::io::stdout().as_fd().try_clone_to_owned()).collect();
    drop(files.map_err(|error| {
        AppError::environment(format!("cannot open enough files: {error}; allow more with `ulimit -n 256`"))
    })?);
    builder.enable_all().build().map_err(|error| AppError::environment(format!("cannot start: {error}")))
}
