//! The executable. All code is in the library.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(betadeck::app::run(std::env::args_os()))
}
