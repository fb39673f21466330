//! `betadeck flights`: lists the library of recorded flights.

use crate::args::FlightsArgs;
use crate::files::flight_library;
use crate::headless::setup;
use crate::process::error;
use crate::process::error::AppError;
use crate::report::flights::{json_line, table};
use crate::text::printable;

/// Prints the recordings, the newest first.
pub(super) fn run(args: &FlightsArgs) -> Result<u8, AppError> {
    let state = match &args.state_dir {
        Some(directory) if !directory.is_dir() => {
            let name = directory.display();
            return Err(AppError::input(format!(
                "--state-dir {name} is not a directory: name one that the screen used"
            )));
        }
        named => setup::state_directory(named.as_deref())?,
    };
    let flights = flight_library::list(&state).map_err(|error| {
        let folder = state.join(flight_library::FOLDER);
        AppError::environment(format!("cannot read {}: {error}", folder.display()))
    })?;
    if args.json {
        let lines = flights.iter().map(|flight| format!("{}\n", printable::json(&json_line(flight))));
        return error::write_stdout(lines.collect::<String>().as_bytes());
    }
    if flights.is_empty() {
        error::tell("No flights yet: the screen records each flight from the moment the craft is armed.");
        return Ok(0);
    }
    error::print(&table(&flights))
}
