//! The library of recorded flights, as the screen lists it.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A flight of the library. Its texts come from its file and may have any characters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LibraryFlight {
    pub file: PathBuf,
    /// Date and time, UTC: `2026-05-09 07:29:33`; empty for a file that cannot be read.
    pub date: String,
    /// The name of the plan.
    pub plan: String,
    /// The result in a word or two.
    pub verdict: String,
    /// The reason of the result, or the reason why the file cannot be read.
    pub reason: String,
    /// `3:45`.
    pub duration: String,
    pub bytes: u64,
    /// `true` if it can be shown.
    pub is_readable: bool,
    /// `true` while it is being recorded.
    pub is_growing: bool,
}

impl LibraryFlight {
    /// Returns `true` if each word of a query occurs in the flight.
    fn has(&self, query: &str) -> bool {
        let all = format!("{} {} {} {}", self.date, self.plan, self.verdict, self.reason).to_lowercase();
        query.to_lowercase().split_whitespace().all(|word| all.contains(word))
    }

    /// Returns the flight in a few words, for questions.
    pub(in crate::ui) fn name(&self) -> String {
        match self.file.file_name().filter(|_| self.date.is_empty()) {
            Some(name) => name.to_string_lossy().into_owned(),
            None => format!("{} {}", self.date, self.plan),
        }
    }
}

/// The library on the disk. Errors are sentences.
pub trait FlightShelf: Send + Sync {
    /// Returns the flights, the newest first.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be read.
    fn list(&self) -> Result<Vec<LibraryFlight>, String>;

    /// Deletes a flight.
    ///
    /// # Errors
    /// Returns the reason for which it stays.
    fn delete(&self, file: &Path) -> Result<(), String>;

    /// Returns the command that shows one flight, or two beside each other. `again` flies the first one again from its
    /// inputs.
    fn show(&self, files: &[PathBuf], again: bool) -> Command;
}

impl fmt::Debug for dyn FlightShelf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("FlightShelf")
    }
}

/// The list of the library as it was read last.
#[derive(Debug, Clone, Default)]
pub struct FlightsState {
    /// The flights, the newest first; `None` until they are read. The error is a sentence.
    pub list: Option<Result<Vec<LibraryFlight>, String>>,
    /// `true` while an answer is awaited.
    is_asked: bool,
}

impl FlightsState {
    /// Returns the flights that match a query, in the order of the list.
    pub(in crate::ui) fn matching(&self, query: &str) -> Vec<&LibraryFlight> {
        self.all().iter().filter(|flight| flight.has(query)).collect()
    }

    /// Returns all flights.
    pub(in crate::ui) fn all(&self) -> &[LibraryFlight] {
        self.list.as_ref().and_then(|list| list.as_ref().ok()).map_or(&[], Vec::as_slice)
    }

    /// Returns `true` if the list has to be asked for, because no answer is awaited. It is awaited from now on.
    pub(in crate::ui) fn ask(&mut self) -> bool {
        !std::mem::replace(&mut self.is_asked, true)
    }

    /// Takes the list.
    pub(in crate::ui) fn take(&mut self, list: Result<Vec<LibraryFlight>, String>) {
        self.list = Some(list);
        self.is_asked = false;
    }

    /// Gives up the next look at the library.
    pub(in crate::ui) fn rest(&mut self) {
        self.is_asked = false;
    }

    /// Removes a flight that was deleted.
    pub(in crate::ui) fn forget(&mut self, file: &Path) {
        if let Some(Ok(list)) = &mut self.list {
            list.retain(|flight| flight.file != file);
        }
    }
}
