//! Files that an option wrote in an earlier run: they may be replaced, and results must not look like those of a run that
//! cannot start.

use std::ffi::OsString;
use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::Path;

use crate::blackbox::FIRST_LINE;
use crate::firmware::blackbox::WRITER_LINE;
use crate::recording::{ReadError, TAIL, read_summary};

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

/// A command that recognises the files of its earlier runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Writer {
    Fly,
    Check,
}

/// Removes a regular file if the same option of the same command wrote it, as far as its text says so for certain. All other
/// files stay, links and what they lead to as well.
pub(crate) fn remove_results(writer: Writer, option: &str, path: &Path) {
    if path.symlink_metadata().is_ok_and(|there| there.is_file()) && is_result(writer, option, path) {
        std::fs::remove_file(path).ok();
    }
}

/// Returns `true` if the output of `option` of `fly` may replace a file: there is none, it is empty or not a regular one, or
/// an earlier flight wrote it.
pub(crate) fn may_replace(option: &str, path: &Path) -> bool {
    let is_kept = path.metadata().is_ok_and(|there| there.is_file() && there.len() > 0);
    !is_kept
        || match option {
            "--record" => head(path).is_some_and(|head| is_recording(&head)),
            "--blackbox" => head(path).is_some_and(|head| is_own_log(&head)),
            option => is_result(Writer::Fly, option, path),
        }
}

/// Returns the existing files that the output options of a command line name, in its order. The command line need not be
/// right.
pub(crate) fn named_outputs(arguments: &[OsString]) -> Vec<String> {
    let words: Vec<&str> = arguments.iter().map(|word| word.to_str().unwrap_or_default()).collect();
    let values = words.iter().enumerate().filter_map(|(at, word)| match word.split_once('=') {
        Some((option, value)) if OPTIONS.contains(&option) => Some(value),
        _ if OPTIONS.contains(word) => words.get(at + 1).copied(),
        _ => None,
    });
    values.filter(|value| Path::new(value).is_file()).map(str::to_owned).collect()
}

/// Returns the beginning of a file.
fn head(path: &Path) -> Option<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path).ok()?.take(TAIL as u64).read_to_end(&mut head).ok()?;
    Some(head)
}

fn is_recording(head: &[u8]) -> bool {
    !matches!(read_summary(head, &[]), Err(ReadError::NoRecording))
}

/// Returns `true` if the header of a blackbox log has the line of this program.
fn is_own_log(head: &[u8]) -> bool {
    let mark = format!("H {WRITER_LINE}:betadeck ");
    head.starts_with(FIRST_LINE.as_bytes())
        && head.split(|byte| *byte == b'\n').any(|line| line.starts_with(mark.as_bytes()))
}

/// Returns `true` if the text of a file begins as the output of this option of this command, and of no other.
fn is_result(writer: Writer, option: &str, path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    let mut lines = BufReader::new(file.take(LOOKED_AT));
    let mut start = Vec::new();
    for _ in 0..2 {
        if lines.read_until(b'\n', &mut start).is_err() {
            return false;
        }
    }
    let Ok(start) = std::str::from_utf8(&start) else { return false };
    let (first, second) = start.split_once('\n').unwrap_or((start, ""));
    let is_event = |name: &str| {
        let line: Result<serde_json::Value, _> = serde_json::from_str(first);
        line.is_ok_and(|line| line.get("event").is_some_and(|event| event == name))
    };
    let mut is_page = |kind: &str| {
        let mut page = String::new();
        second.starts_with("<!-- betadeck report -->")
            && lines.read_to_string(&mut page).is_ok()
            && page.contains(&format!("<p class=\"kind\">{kind}</p>"))
    };
    let summaries = ["### – Nothing was judged", "### ✅ All flights passed", "### ❌ Some flights failed"];
    match (writer, option) {
        (Writer::Fly, "--json") => is_event("boot"),
        (Writer::Fly, "--csv") => first.starts_with(SAMPLES),
        (Writer::Fly, "--gpx") => second.starts_with("<gpx version=\"1.1\" creator=\"betadeck (simulated)"),
        (Writer::Fly, "--kml") => second.starts_with("<!-- betadeck (simulated) -->"),
        (Writer::Fly, "--geojson") => {
            first.starts_with("{\"type\":\"FeatureCollection\",\"generator\":\"betadeck (simulated)\"")
        }
        (Writer::Fly, "--markdown") => first == "<!-- betadeck flight -->",
        (Writer::Fly, "--report") => is_page("Flight of a plan by betadeck"),
        (Writer::Check, "--json") => is_event("flight") || is_event("run"),
        (Writer::Check, "--junit") => {
            second.starts_with("<testsuites name=\"betadeck\"") && second.contains(" skipped=\"")
        }
        (Writer::Check, "--markdown") => summaries.contains(&first),
        (Writer::Check, "--report") => is_page("Scenarios flown by betadeck"),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOG: &str = "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\nH Log writer:betadeck 1\n";

    #[test]
    fn only_what_the_same_option_of_the_same_command_wrote_is_removed() {
        let directory = tempfile::tempdir().expect("a directory");
        let at = |name: &str| directory.path().join(name);
        let of = |writer, option, text: &str, is_removed: bool| {
            let path = at("file");
            std::fs::write(&path, text).expect("written");
            remove_results(writer, option, &path);
            assert_eq!(path.exists(), !is_removed, "{option}: {text}");
        };
        let flight = "{\"t\":0.0,\"event\":\"boot\"}\n{\"t\":1.0,\"event\":\"armed\"}\n";
        of(Writer::Fly, "--json", flight, true);
        of(Writer::Fly, "--csv", flight, false);
        of(Writer::Check, "--json", flight, false);
        of(Writer::Fly, "--json", "{\"event\":\"campaign\",\"format\":1}\n{\"event\":\"flight\"}\n", false);
        of(Writer::Check, "--json", "{\"case\":\"calm\",\"event\":\"flight\"}\n", true);
        let suites = "<?xml?>\n<testsuites name=\"betadeck\" tests=\"1\" failures=\"0\" skipped=\"0\">\n";
        of(Writer::Check, "--junit", suites, true);
        of(Writer::Check, "--junit", &suites.replace(" skipped=\"0\"", ""), false);
        of(Writer::Check, "--junit", &suites.replace("betadeck", "cargo"), false);
        let gpx = "<?xml?>\n<gpx version=\"1.1\" creator=\"betadeck (simulated)\" xmlns=\"x\">\n";
        of(Writer::Fly, "--gpx", gpx, true);
        of(Writer::Fly, "--gpx", &gpx.replace("simulated", "from a log"), false);
        of(Writer::Fly, "--kml", "<?xml?>\n<!-- betadeck (simulated) -->\n<kml>\n", true);
        of(Writer::Fly, "--kml", "<?xml?>\n<kml>\n", false);
        of(Writer::Fly, "--geojson", "{\"type\":\"FeatureCollection\",\n", false);
        of(Writer::Fly, "--csv", "time (s),boot_time (s),state,waypoint,lat (deg)\n,0,IDLE,,40\n", true);
        of(Writer::Fly, "--csv", "latitude,longitude,altitude(m)\n", false);
        let page = |kind: &str| {
            format!("<!DOCTYPE html>\n<!-- betadeck report -->\n<html>\n<p class=\"kind\">{kind}</p>\n")
        };
        of(Writer::Fly, "--report", &page("Flight of a plan by betadeck"), true);
        of(Writer::Fly, "--report", &page("Campaign by betadeck"), false);
        of(Writer::Check, "--report", &page("Scenarios flown by betadeck"), true);
        of(Writer::Fly, "--markdown", "<!-- betadeck flight -->\n### x\n", true);
        of(Writer::Check, "--markdown", "### ✅ All flights passed\n\n1 of 1\n", true);
        of(Writer::Fly, "--blackbox", LOG, false);
        of(Writer::Fly, "--json", "", false);
        // A link stays, and the file that it leads to.
        std::fs::write(at("far.json"), flight).expect("written");
        std::os::unix::fs::symlink(at("far.json"), at("link.json")).expect("a link");
        remove_results(Writer::Fly, "--json", &at("link.json"));
        assert!(at("link.json").exists() && at("far.json").exists());
    }

    #[test]
    fn a_flight_replaces_only_what_a_flight_wrote() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("file");
        for option in OPTIONS {
            assert!(may_replace(option, &path), "there is no file");
            std::fs::write(&path, "").expect("written");
            assert!(may_replace(option, &path), "an empty file has nothing to lose");
            std::fs::write(&path, "my notes\n").expect("written");
            assert!(!may_replace(option, &path), "{option}");
            std::fs::write(&path, LOG).expect("written");
            assert_eq!(may_replace(option, &path), option == "--blackbox", "{option}");
            std::fs::remove_file(&path).expect("removed");
        }
        assert!(may_replace("--json", Path::new("/dev/null")));
    }

    #[test]
    fn the_outputs_of_a_wrong_command_line_are_found() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("a.json");
        std::fs::write(&path, "x").expect("written");
        let path = path.display().to_string();
        let line: Vec<OsString> =
            ["betadeck", "fly", &format!("--json={path}"), "--gpx", &path, "--kml", "none.kml", "--csv"]
                .map(OsString::from)
                .into();
        assert_eq!(named_outputs(&line), [path.clone(), path]);
    }
}
