//! Results of an earlier run. They must not look like those of a run that cannot start.

use std::ffi::OsString;
use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Seek as _};
use std::path::{Path, PathBuf};

use crate::blackbox::FIRST_LINE;
use crate::firmware::blackbox::WRITER_LINE;
use crate::recording::{ReadError, TAIL, read_summary};
use crate::storage;

/// The most bytes of a file that are read.
const LOOKED_AT: u64 = 1 << 20;
/// The options for files of results.
const OPTIONS: [&str; 10] = [
    "--json",
    "--csv",
    "--junit",
    "--markdown",
    "--gpx",
    "--kml",
    "--geojson",
    "--record",
    "--report",
    "--blackbox",
];
/// The start of a table of samples.
const SAMPLES: &str = "time (s),boot_time (s),state,waypoint,";
/// The commands that write these results.
const COMMANDS: [&str; 3] = ["fly", "check", "campaign"];

/// Removes a file if it has the results of an earlier run of this program. All other files stay.
pub(in crate::app) fn remove_results(path: &Path) {
    let target = storage::link_target(path);
    if holds_results(&target) {
        std::fs::remove_file(target).ok();
    }
}

/// Does the same for the files in a command line that could not be parsed.
pub(in crate::app) fn remove_results_of(arguments: &[OsString]) {
    let words: Vec<&str> = arguments.iter().map(|word| word.to_str().unwrap_or_default()).collect();
    if !words.get(1).is_some_and(|command| COMMANDS.contains(command)) {
        return;
    }
    for (at, word) in words.iter().enumerate() {
        let value = match word.split_once('=') {
            Some((option, value)) if OPTIONS.contains(&option) => Some(value),
            _ if OPTIONS.contains(word) => words.get(at + 1).copied(),
            _ => None,
        };
        if let Some(path) = value.map(PathBuf::from) {
            remove_results(&path);
        }
    }
}

/// Returns `true` if a regular file begins like the results of this program.
fn holds_results(path: &Path) -> bool {
    if !path.symlink_metadata().is_ok_and(|there| there.is_file()) {
        return false;
    }
    let Ok(mut file) = File::open(path) else { return false };
    let mut head = Vec::new();
    let is_read = file.by_ref().take(TAIL as u64).read_to_end(&mut head).is_ok() && file.rewind().is_ok();
    if is_read && !matches!(read_summary(&head, &[]), Err(ReadError::NoRecording)) {
        return true;
    }
    if head.starts_with(FIRST_LINE.as_bytes()) {
        return is_own_log(&head);
    }
    let mut start = Vec::new();
    let mut lines = BufReader::new(file.take(LOOKED_AT));
    for _ in 0..2 {
        if lines.read_until(b'\n', &mut start).is_err() {
            return false;
        }
    }
    let Ok(start) = std::str::from_utf8(&start) else { return false };
    let (first, second) = start.split_once('\n').unwrap_or((start, ""));
    let is_event = || {
        let line: Result<serde_json::Value, _> = serde_json::from_str(first);
        line.is_ok_and(|line| line.get("event").is_some_and(serde_json::Value::is_string))
    };
    let summaries = ["### – Nothing was judged", "### ✅ All flights passed", "### ❌ Some flights failed"];
    second.starts_with("<testsuites name=\"betadeck\"")
        || second.starts_with("<gpx version=\"1.1\" creator=\"betadeck")
        || second.starts_with("<!-- betadeck (")
        || second.starts_with("<!-- betadeck report -->")
        || first == "<!-- betadeck flight -->"
        || first.starts_with("{\"type\":\"FeatureCollection\",\"generator\":\"betadeck (")
        || summaries.contains(&first)
        || first.starts_with(SAMPLES)
        || is_event()
}

/// Returns `true` if the header of a blackbox log has the line of this program.
fn is_own_log(head: &[u8]) -> bool {
    let mark = format!("H {WRITER_LINE}:betadeck ");
    head.split(|byte| *byte == b'\n').any(|line| line.starts_with(mark.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_this_program_wrote_is_removed() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        let files = [
            ("flight.json", "{\"t\":0.0,\"event\":\"boot\"}\n{\"t\":1.0,\"event\":\"armed\"}\n", true),
            ("run.xml", "<?xml version=\"1.0\"?>\n<testsuites name=\"betadeck\" tests=\"1\">\n", true),
            (
                "track.gpx",
                "<?xml?>\n<gpx version=\"1.1\" creator=\"betadeck (simulated)\" xmlns=\"x\">\n",
                true,
            ),
            ("track.kml", "<?xml?>\n<!-- betadeck (simulated) -->\n<kml>\n", true),
            (
                "track.geojson",
                "{\"type\":\"FeatureCollection\",\"generator\":\"betadeck (simulated)\",\"features\":[\n",
                true,
            ),
            ("log.kml", "<?xml?>\n<!-- betadeck (from a log) -->\n<kml>\n", true),
            ("plan.kml", "<?xml?>\n<kml>\n", false),
            ("plan.geojson", "{\"type\":\"FeatureCollection\",\n", false),
            ("samples.csv", "time (s),boot_time (s),state,waypoint,lat (deg)\n,0,IDLE,,40\n", true),
            ("flight.html", "<!DOCTYPE html>\n<!-- betadeck report -->\n<html>\n", true),
            ("flight.md", "<!-- betadeck flight -->\n### x\n", true),
            ("page.html", "<!DOCTYPE html>\n<html>\n", false),
            ("plan.csv", "latitude,longitude,altitude(m)\n", false),
            ("run.md", "### ✅ All flights passed\n\n1 of 1\n", true),
            ("other.xml", "<?xml version=\"1.0\"?>\n<testsuites name=\"cargo\">\n", false),
            ("other.json", "{\"name\":\"plan\"}\n", false),
            ("plan.txt", "waypoint insert 0 40 -79 2000 0 LAND 0 NONE\n", false),
            (
                "own.bbl",
                "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\nH Log writer:betadeck 1\n",
                true,
            ),
            (
                "real.bbl",
                "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\n",
                false,
            ),
            ("empty", "", false),
        ];
        let mut line: Vec<OsString> = vec!["betadeck".into(), "fly".into()];
        for (name, text, _) in files {
            std::fs::write(at(name), text).expect("written");
            line.push(format!("--json={}", at(name).display()).into());
        }
        remove_results_of(&[line[0].clone(), "serve".into(), line[2].clone()]);
        assert!(at("flight.json").exists(), "a file that goes on is not the result of a run");
        remove_results_of(&line);
        for (name, _, is_removed) in files {
            assert_eq!(at(name).exists(), !is_removed, "{name}");
        }
    }
}
