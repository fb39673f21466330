//! The names of the files: one for a flight, a folder for several.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::OPTION;
use crate::files::output_file::KeptFiles;
use crate::process::error::AppError;

/// The extension of the files in a folder.
const EXTENSION: &str = "bbl";
/// The extensions of logs. A missing path with one of them is meant as a file.
const OF_LOGS: [&str; 3] = [EXTENSION, "bfl", "txt"];

/// The files of the logs of a run, by the number of the flight.
#[derive(Debug)]
pub(crate) struct LogFiles(Vec<PathBuf>);

impl LogFiles {
    /// Chooses the files for flights with these names: for one flight the path itself, or a file in it if it is a folder;
    /// for several flights a file of each in the folder, which is created if it is missing.
    ///
    /// # Errors
    /// Returns an error if several flights cannot have a folder, or if a file would replace one that must be kept.
    pub(crate) fn claim(path: &Path, flights: &[String], kept: &KeptFiles) -> Result<Self, AppError> {
        let files = match flights {
            [flight] => vec![file_of_one(path, flight)],
            _ => {
                make_folder(path, flights.len())?;
                in_folder(path, flights)
            }
        };
        // They differ from each other, so it is enough to compare them with the others.
        files.iter().try_for_each(|file| kept.check(OPTION, file))?;
        Ok(Self(files))
    }

    /// Returns the file of a flight.
    pub(crate) fn of(&self, flight: usize) -> Option<&Path> {
        self.0.get(flight).map(PathBuf::as_path)
    }
}

/// Returns the file of a single flight.
pub(crate) fn file_of_one(path: &Path, flight: &str) -> PathBuf {
    if path.is_dir() { path.join(format!("{}.{EXTENSION}", file_name(flight))) } else { path.to_owned() }
}

fn make_folder(path: &Path, flights: usize) -> Result<(), AppError> {
    let name = path.display();
    if path.is_dir() {
        return Ok(());
    }
    let extension = path.extension().unwrap_or_default();
    if path.exists() || OF_LOGS.iter().any(|log| extension.eq_ignore_ascii_case(log)) {
        return Err(AppError::input(format!(
            "{OPTION} {name} is not a folder, and each of the {flights} flights has a log: name a folder"
        )));
    }
    std::fs::create_dir(path)
        .map_err(|error| AppError::environment(format!("cannot create the folder {name}: {error}")))
}

/// Returns a file for each flight. Flights with the same name get numbers.
fn in_folder(folder: &Path, flights: &[String]) -> Vec<PathBuf> {
    let mut used = BTreeSet::new();
    let mut unused = |flight: &String| {
        let name = file_name(flight);
        let mut numbered = (2_usize..).map(|number| format!("{name}-{number}"));
        let mut candidate = name.clone();
        while !used.insert(candidate.clone()) {
            candidate = numbered.next().unwrap_or_default();
        }
        folder.join(format!("{candidate}.{EXTENSION}"))
    };
    flights.iter().map(&mut unused).collect()
}

/// Returns a name with letters, digits and dashes only.
fn file_name(flight: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || ['-', '_', '.'].contains(&letter);
    let parts = flight.split(|letter| !is_plain(letter)).filter(|part| !part.is_empty());
    let name = parts.collect::<Vec<_>>().join("-");
    let name: String = name.trim_start_matches('.').chars().take(100).collect();
    if name.is_empty() { "flight".to_owned() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(flights: &[&str]) -> Vec<String> {
        let flights: Vec<String> = flights.iter().map(|flight| (*flight).to_owned()).collect();
        let files = in_folder(Path::new("logs"), &flights);
        files.iter().map(|file| file.display().to_string()).collect()
    }

    #[test]
    fn each_flight_has_a_file_with_its_name() {
        assert_eq!(
            names(&["hold wind=5@270, calm", "hold", "hold", "HOLD/../x", "...", ""]),
            [
                "logs/hold-wind-5-270-calm.bbl",
                "logs/hold.bbl",
                "logs/hold-2.bbl",
                "logs/HOLD-..-x.bbl",
                "logs/flight.bbl",
                "logs/flight-2.bbl",
            ]
        );
    }

    #[test]
    fn several_flights_need_a_folder() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        std::fs::write(at("file"), "").expect("written");
        let flights = ["a".to_owned(), "b".to_owned()];
        let kept = KeptFiles::default();
        for name in ["file", "new.bbl", "new.BFL"] {
            let error = LogFiles::claim(&at(name), &flights, &kept).expect_err("refused");
            assert!(error.to_string().contains("each of the 2 flights has a log: name a folder"), "{error}");
            assert!(!at(name).is_dir(), "{name}");
        }
        let files = LogFiles::claim(&at("new"), &flights, &kept).expect("created");
        assert_eq!(files.of(1), Some(at("new/b.bbl").as_path()));
        assert_eq!(files.of(2), None);
        assert!(at("new").is_dir());
        assert!(LogFiles::claim(&at("none/new"), &flights, &kept).is_err());
    }

    #[test]
    fn one_flight_has_a_file_or_a_folder() {
        let directory = tempfile::tempdir().expect("a directory");
        assert_eq!(file_of_one(&directory.path().join("x.bbl"), "square"), directory.path().join("x.bbl"));
        assert_eq!(file_of_one(directory.path(), "square"), directory.path().join("square.bbl"));
    }

    #[test]
    fn no_log_replaces_a_file_that_is_kept() {
        let directory = tempfile::tempdir().expect("a directory");
        let plan = directory.path().join("b.bbl");
        std::fs::write(&plan, "").expect("written");
        let mut kept = KeptFiles::default();
        kept.keep("the plan", &plan);
        let flights = ["a".to_owned(), "b".to_owned()];
        let error = LogFiles::claim(directory.path(), &flights, &kept).expect_err("refused");
        assert!(error.to_string().contains("would overwrite the plan"), "{error}");
    }
}
