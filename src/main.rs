//! The executable. All code is in the library.

#![forbid(unsafe_code)]

use std::process::ExitCode;

use betadeck::process::Build;

fn main() -> ExitCode {
    let (revision, time_s) = betadeck_revision::revision!();
    ExitCode::from(betadeck::app::run(std::env::args_os(), Build { revision, time_s }))
}
