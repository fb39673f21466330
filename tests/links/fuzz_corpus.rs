//! The fuzz targets as ordinary tests. They run on every stored case, on every beginning of a short case, and
//! on mutations of all cases. The mutations are the same in every run.

#![allow(clippy::print_stderr, reason = "a case that fails is shown")]

#[path = "../fuzz_bodies/lib.rs"]
mod fuzz_bodies;

use std::path::{Path, PathBuf};

use fuzz_bodies::{
    airframe, betaloop, blackbox, cli, configuration, door, eeprom, fc_client, fdm, history, journal,
    msp_stream, plan_file, rc, recording, scenario, screen, servo, settings_file,
};

/// The longest stored case, in bytes, whose beginnings are all tested too.
const SHORT: usize = 64;
/// The most bytes of a mutant. Long ones take long and find little.
const MAX_MUTANT: usize = 4096;

/// Pieces that have a meaning for some target.
const WORDS: [&[u8]; 43] = [
    b"\n",
    b"\r\n",
    b"#",
    b"\t",
    b" ",
    b"=",
    b"-",
    b"\x02",
    b"\x03",
    b"\x04",
    b"\x1e\x1e",
    b"$M<",
    b"$X<",
    b"\xff",
    b"\0",
    b"0",
    b"-1",
    b"255",
    b"256",
    b"65535",
    b"65536",
    b"2147483648",
    b"-2147483649",
    b"99999999999999999999",
    b"1e999",
    b"nan",
    b"0.0000001",
    b"set ",
    b"waypoint insert 0 1 2 3 0 HOLD 0 ORBIT\n",
    b"waypoint remove 0\n",
    b"profile 1\n",
    b"batch start\n",
    b"batch end\n",
    b"defaults nosave\n",
    b"save\n",
    b"diff all\n",
    b"[[waypoint]]\n",
    b"base = \"iris\"\n",
    b"setting\t",
    b"kept\tmaster\t0\t\t",
    b"H Product:Blackbox flight data recorder by Nicholas Sherlock\n",
    b"E\xffEnd of log\0",
    b"H Field I name:loopIteration,time,a\n",
];

/// A generator of numbers from a seed (splitmix64).
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % sides.max(1) as u64) as usize
    }

    fn pick<'t, T: ?Sized>(&mut self, of: &[&'t T]) -> &'t T {
        of[self.roll(of.len())]
    }

    /// Returns a range of `bytes`, usually a short one.
    fn range(&mut self, bytes: &[u8]) -> std::ops::Range<usize> {
        let start = self.roll(bytes.len() + 1);
        let most = (bytes.len() - start).min(if self.roll(4) == 0 { usize::MAX } else { 16 });
        start..start + self.roll(most + 1)
    }

    /// Makes one to eight changes.
    fn mutate(&mut self, stored: &[u8], others: &[(PathBuf, Vec<u8>)]) -> Vec<u8> {
        let mut bytes = stored.to_vec();
        for _ in 0..=self.roll(8) {
            let range = self.range(&bytes);
            match self.roll(7) {
                0 if !bytes.is_empty() => {
                    let at = self.roll(bytes.len());
                    bytes[at] ^= 1 << self.roll(8);
                }
                1 if !bytes.is_empty() => {
                    let at = self.roll(bytes.len());
                    bytes[at] = self.roll(256) as u8;
                }
                2 => drop(bytes.drain(range)),
                3 => {
                    let copy = bytes[range.clone()].to_vec();
                    let at = self.roll(bytes.len() + 1);
                    drop(bytes.splice(at..at, copy));
                }
                4 => {
                    let (_, other) = &others[self.roll(others.len())];
                    let piece = self.range(other);
                    drop(bytes.splice(range, other[piece].iter().copied()));
                }
                _ => {
                    let word = self.pick(&WORDS);
                    drop(bytes.splice(range, word.iter().copied()));
                }
            }
            bytes.truncate(MAX_MUTANT);
        }
        bytes
    }
}

/// The running case. It is kept when it fails.
struct Case<'a> {
    of: &'a Path,
    bytes: &'a [u8],
}

impl Drop for Case<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz-finding.bin");
            let written = std::fs::write(&kept, self.bytes);
            eprintln!("from {}: \"{}\"", self.of.display(), self.bytes.escape_ascii());
            eprintln!("kept as {}: {written:?}; see fuzz/README.md", kept.display());
        }
    }
}

fn corpus(folder: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = test_support::path("tests/corpus").join(folder);
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("a folder of stored cases")
        .map(|entry| entry.expect("an entry").path())
        .map(|path| (path.clone(), std::fs::read(path).expect("a file")))
        .collect();
    files.sort();
    assert!(!files.is_empty(), "no stored cases");
    files
}

/// Returns the cases that fuzzing found for a target. There may be none yet.
fn found(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = format!("found/{target}");
    let is_there = test_support::path("tests/corpus").join(&folder).is_dir();
    if is_there { corpus(&folder) } else { Vec::new() }
}

/// Runs a target on the cases that fuzzing found for it and on its stored cases.
fn check(target: &str, run: fn(&[u8]), mutants: usize) {
    for (path, found) in found(target) {
        let _kept_if_it_fails = Case { of: &path, bytes: &found };
        run(&found);
    }
    check_stored(target, run, mutants);
}

/// Runs a target on the cases of one folder, on every beginning of the short ones, and on mutations.
fn check_stored(folder: &str, run: fn(&[u8]), mutants: usize) {
    let cases = corpus(folder);
    for (path, stored) in &cases {
        let run = |bytes: &[u8]| {
            let _kept_if_it_fails = Case { of: path, bytes };
            run(bytes);
        };
        run(stored);
        for end in 0..stored.len().min(SHORT) {
            run(&stored[..end]);
        }
        let mut dice = Dice(stored.len() as u64);
        for _ in 0..mutants {
            run(&dice.mutate(stored, &cases));
        }
    }
}

#[test]
fn airframe_files() {
    check("airframe", airframe::run, 400);
}

#[test]
fn launcher_files() {
    check("betaloop", betaloop::run, 400);
}

#[test]
fn blackbox_logs() {
    check("blackbox", blackbox::run, 400);
}

#[test]
fn configuration_files() {
    check("configuration", configuration::run, 40);
}

#[test]
fn history_files() {
    check("history", history::run, 400);
}

#[test]
fn kept_screens_and_layouts() {
    check("screen", screen::run, 400);
}

#[test]
fn journals_of_plans() {
    check("journal", journal::run, 400);
}

#[test]
fn scenario_files() {
    check("scenario", scenario::run, 60);
}

#[test]
fn command_lines() {
    check("cli", cli::run, 16);
}

#[test]
fn connections_to_a_door() {
    check("door", door::run, 100);
}

#[test]
fn stored_images() {
    check("eeprom", eeprom::run, 20);
}

#[test]
fn flight_controllers_answers() {
    check("fc_client", fc_client::run, 100);
}

#[test]
fn simulator_datagrams() {
    check("fdm", fdm::run, 100);
}

#[test]
fn client_streams() {
    check("msp_stream", msp_stream::run, 16);
}

#[test]
fn damaged_frames() {
    check_stored("msp", msp_stream::run, 16);
}

#[test]
fn plan_files() {
    check("plan_file", plan_file::run, 80);
}

#[test]
fn rc_datagrams() {
    check("rc", rc::run, 100);
}

#[test]
fn recordings_of_flights() {
    check("recording", recording::run, 200);
}

#[test]
fn motor_datagrams() {
    check("servo", servo::run, 1000);
}

#[test]
fn settings_files() {
    check("settings_file", settings_file::run, 16);
}

/// Returns the names in a folder.
fn names(folder: &str) -> Vec<String> {
    let folder = test_support::path(folder);
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn every_target_has_a_body_a_corpus_and_a_test() {
    let tests = include_str!("fuzz_corpus.rs");
    let build = include_str!("../../fuzz/Cargo.toml");
    let (bodies, folders) = (names("tests/fuzz_bodies"), names("tests/corpus"));
    let targets = names("fuzz/fuzz_targets");
    assert!(!targets.is_empty());
    for file in targets {
        let name = file.trim_end_matches(".rs");
        assert!(bodies.contains(&file), "{file}");
        assert!(folders.iter().any(|folder| folder == name), "{name}");
        assert!(tests.contains(&format!("check(\"{name}\", {name}::run, ")), "{name}");
        assert!(build.contains(&format!("path = \"fuzz_targets/{file}\"")), "{name}");
    }
}
