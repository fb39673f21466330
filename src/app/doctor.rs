//! `betadeck doctor`: is everything here that the program needs?

use std::fmt::Write as _;
use std::io::IsTerminal as _;
use std::path::Path;

use super::error::{self, AppError};
use super::layers;
use crate::ui::layout::SMALLEST;

/// Prints what was found; exit code 0 when all is well.
pub fn run() -> Result<u8, AppError> {
    let mut report = format!("betadeck {}\n", env!("CARGO_PKG_VERSION"));
    let mut well = true;
    match layers::directories() {
        Ok(directories) => {
            let config = directories.config.join("config.toml");
            let found = if config.exists() { "present" } else { "none, defaults apply" };
            let _ = writeln!(report, "✓ configuration file  {} ({found})", config.display());
            well &= state_directory(&mut report, &directories.state);
        }
        Err(error) => {
            well = false;
            let _ = writeln!(report, "✗ directories         {}", error.message);
        }
    }
    well &= terminal(&mut report);
    error::write_stdout(report.as_bytes())?;
    Ok(if well { 0 } else { error::ENVIRONMENT })
}

/// The nearest existing folder above decides whether the directory can be made.
fn state_directory(report: &mut String, path: &Path) -> bool {
    let existing = path.ancestors().find(|folder| folder.exists());
    let writable = existing.is_some_and(|folder| {
        folder.is_dir() && rustix::fs::access(folder, rustix::fs::Access::WRITE_OK).is_ok()
    });
    let (mark, word) =
        if writable { ('✓', "writable") } else { ('✗', "not writable: choose one with --state-dir") };
    let _ = writeln!(report, "{mark} state directory     {} ({word})", path.display());
    writable
}

/// A terminal is needed for the user interface only, so none at all is no fault.
fn terminal(report: &mut String) -> bool {
    if !std::io::stdout().is_terminal() {
        let _ = writeln!(report, "✓ terminal            none here; betadeck fly needs none");
        return true;
    }
    match crossterm::terminal::size() {
        Ok((columns, rows)) if columns >= SMALLEST.0 && rows >= SMALLEST.1 => {
            let _ = writeln!(report, "✓ terminal            {columns}x{rows}");
            true
        }
        Ok((columns, rows)) => {
            let _ = writeln!(
                report,
                "✗ terminal            {columns}x{rows}: needs at least {}x{}",
                SMALLEST.0, SMALLEST.1
            );
            false
        }
        Err(error) => {
            let _ = writeln!(report, "✗ terminal            size unknown: {error}");
            false
        }
    }
}
