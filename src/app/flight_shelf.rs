//! The library of recorded flights for the screen.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use clap::ValueEnum;

use crate::args::DisplayArgs;
use crate::files::flight_library;
use crate::files::flight_library::{FOLDER, Known};
use crate::recording::Listed;
use crate::report::flights::FlightRow;
use crate::ui::flights::{FlightShelf, LibraryFlight};

/// The library in a state directory.
pub(super) struct Shelf {
    state: PathBuf,
    known: Mutex<Known>,
    /// The options of the screen that shows a flight.
    display: Vec<OsString>,
}

impl Shelf {
    /// Returns the library in a state directory. A flight is shown in the colours, characters and units of this screen.
    pub(super) fn new(state: &Path, display: &DisplayArgs) -> Self {
        let options = [
            option("--theme", display.theme),
            option("--charset", display.charset),
            option("--units", display.units),
        ];
        Self {
            state: state.to_owned(),
            known: Mutex::default(),
            display: options.into_iter().flatten().map(OsString::from).collect(),
        }
    }
}

/// Returns an option with its value, if it has one.
fn option<T: ValueEnum>(name: &str, value: Option<T>) -> Option<String> {
    let value = value?.to_possible_value()?;
    Some(format!("{name}={}", value.get_name()))
}

impl FlightShelf for Shelf {
    fn list(&self) -> Result<Vec<LibraryFlight>, String> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let listed = known.list(&self.state).map_err(|error| {
            format!("The library of flights {} cannot be read: {error}.", self.state.join(FOLDER).display())
        })?;
        Ok(listed.iter().map(flight).collect())
    }

    fn delete(&self, file: &Path) -> Result<(), String> {
        flight_library::remove(&self.state, file)
    }

    fn show(&self, files: &[PathBuf], again: bool) -> Command {
        let program = std::env::current_exe().unwrap_or_else(|_| "betadeck".into());
        let mut command = Command::new(program);
        command.arg(if again { "open" } else { "replay" }).args(files).args(&self.display);
        command
    }
}

fn flight(listed: &Listed) -> LibraryFlight {
    let row = FlightRow::from(listed);
    LibraryFlight {
        file: listed.file.clone(),
        date: row.date,
        plan: row.plan,
        verdict: row.verdict,
        reason: row.reason,
        duration: row.duration,
        bytes: listed.bytes,
        is_readable: listed.summary.is_ok(),
        is_growing: listed.is_growing,
    }
}
