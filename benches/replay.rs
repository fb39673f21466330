//! The time to open a long blackbox log, to show any of its instants, to draw its series, and to write its table.
//!
//! `cargo bench --bench replay`. Goals, for 20 minutes at 4 kHz: any instant within 50 ms, a curve within 100 ms, memory
//! beside the file below 100 MB.
//!
//! The table is measured against a decoder in C if `BETADECK_C_DECODER` has the path of its program, `blackbox_decode` of
//! betaflight/blackbox-tools, built with `-O3`. `BETADECK_LOG` has the path of a log to measure with; without it a log is
//! made. The goal is a ratio below 1.
#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench may stop, measures time and prints it"
)]

use std::fs::File;
use std::io::{self, Write as _};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

use betadeck::blackbox::decode::LogSource;
use betadeck::replay::{CurvesRequest, LogFlights, PastFlight, PastFlights as _};
use betadeck::report::log_export::write_csv;
use betadeck::signals::SimTime;

use test_support::MadeLog;

/// The number of instants that are shown.
const SEEKS: u64 = 400;
/// The shown times of the curves, s.
const SPANS_S: [f64; 6] = [0.1, 1.0, 10.0, 60.0, 300.0, 1200.0];
/// The tables that are written; the fastest one counts.
const TABLES: usize = 3;

/// A file in memory.
#[derive(Debug, Clone)]
struct Memory(Arc<Vec<u8>>);

impl LogSource for Memory {
    fn size(&self) -> u64 {
        self.0.len() as u64
    }

    fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.as_slice().read_at(offset, buffer)
    }
}

/// Runs something and returns its result with the time it took.
fn timed<T>(run: impl FnOnce() -> T) -> (T, Duration) {
    let started = Instant::now();
    let result = run();
    (result, started.elapsed())
}

/// Returns the memory that the process holds, MB.
fn resident_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).map_or(0.0, |kb: f64| kb / 1000.0)
}

fn main() {
    table();
    let bytes = MadeLog { seconds: 1200, hz: 4000, ..MadeLog::default() }.bytes();
    let file_mb = bytes.len() as f64 / 1e6;
    println!("20 minutes at 4 kHz: {file_mb:.0} MB");
    let before_mb = resident_mb();
    let mut flights = LogFlights::new("long.bbl", Memory(Arc::new(bytes)));
    let (read, index) = timed(|| flights.read(&mut |_| true));
    assert_eq!(read, Ok(true));
    let (mut flight, open) = timed(|| flights.open(0).unwrap());
    let overview = flight.overview();
    println!("read once: {index:.2?} ({:.0} MB/s), opened: {open:.2?}", file_mb / index.as_secs_f64());
    println!("memory: {:.1} MB, {} pictures", resident_mb() - before_mb, overview.pictures.len());
    seeks(&mut *flight);
    let gyro = overview.series.iter().position(|series| series.name == "gyroADC[0]").unwrap();
    for span_s in SPANS_S {
        let middle_s = overview.first.as_secs_f64() + 600.0;
        let at = |seconds: f64| SimTime::from_secs_f64((middle_s + seconds).max(0.0));
        let (from, to) = (at(-1.5 * span_s), at(1.5 * span_s));
        let request = CurvesRequest { series: vec![gyro], from, to, steps: 2400 };
        let (curves, took) = timed(|| flight.curves(&request).unwrap());
        println!("a curve of {span_s:>6} s on the screen: {took:>9.2?}, {} curve", curves.len());
    }
}

/// Writes the table of a log, and lets the decoder in C do the same.
fn table() {
    let given = std::env::var_os("BETADECK_LOG").map(|path| std::fs::read(path).unwrap());
    let bytes = given.unwrap_or_else(|| MadeLog { seconds: 224, hz: 4000, ..MadeLog::default() }.bytes());
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(&bytes).unwrap();
    let flights = LogFlights::new("table.bbl", Memory(Arc::new(bytes)));
    let fastest = |run: &dyn Fn() -> u64| {
        let all = (0..TABLES).map(|_| timed(run));
        all.map(|(frames, took)| (took, frames)).min().unwrap()
    };
    let (own, frames) = fastest(&|| {
        let log = flights.start(None, || false).unwrap().unwrap();
        let null = File::create("/dev/null").unwrap();
        write_csv(&log, flights.source().clone(), None, null, || false).unwrap().log.counts.main
    });
    println!("a table of {frames} frames: {own:.2?}");
    let Some(decoder) = std::env::var_os("BETADECK_C_DECODER") else { return };
    let (other, _) = fastest(&|| {
        let mut command = Command::new(&decoder);
        command.arg("--stdout").arg(file.path()).stdout(Stdio::null()).stderr(Stdio::null());
        assert!(command.status().unwrap().success(), "the decoder failed");
        0
    });
    let ratio = own.as_secs_f64() / other.as_secs_f64();
    println!("the decoder in C: {other:.2?}; ratio {ratio:.2}");
}

/// Shows instants all over the flight, none near the one before.
fn seeks(flight: &mut dyn PastFlight) {
    let overview = flight.overview();
    let length_us = overview.last.0 - overview.first.0;
    let mut times: Vec<Duration> = (0..SEEKS)
        .map(|seek| {
            let share = (seek * 2_654_435_761) % SEEKS;
            let time = SimTime(overview.first.0 + length_us / SEEKS * share);
            timed(|| flight.at(time).unwrap()).1
        })
        .collect();
    times.sort();
    let mean = times.iter().sum::<Duration>() / u32::try_from(SEEKS).unwrap_or(1);
    println!("any instant: mean {mean:.2?}, longest {:.2?}", times[times.len() - 1]);
}
