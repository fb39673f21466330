//! The progress of a campaign on standard error, with the rate and the remaining time.
#![allow(clippy::disallowed_methods, reason = "measures the rate of flights")]

use std::io::{IsTerminal as _, Write as _};
use std::time::{Duration, Instant};

use crate::process::error;
use crate::process::patient_output::PatientOutput;

/// Width of the bar, characters.
const WIDTH: u64 = 24;
/// The least interval between two pictures on a terminal.
const ON_TERMINAL: Duration = Duration::from_millis(200);
/// The interval between two lines in a log.
const IN_LOG: Duration = Duration::from_secs(60);

/// The bar, or lines of a log.
pub(super) struct Progress {
    is_terminal: bool,
    is_shown: bool,
    started: Instant,
    shown: Instant,
    /// The number of flights; `None` = not known in advance.
    all: Option<u64>,
    /// The number of flights that were flown before.
    before: u64,
}

impl Progress {
    pub(super) fn new(all: Option<u64>, before: u64) -> Self {
        let now = Instant::now();
        let is_terminal = std::io::stderr().is_terminal();
        Self { is_terminal, is_shown: false, started: now, shown: now, all, before }
    }

    /// Shows the number of flights that are over, and of failures among them, from time to time.
    pub(super) fn show(&mut self, done: u64, failed: u64) {
        let interval = if self.is_terminal { ON_TERMINAL } else { IN_LOG };
        if self.shown.elapsed() < interval || self.all.is_some_and(|all| done >= all) {
            return;
        }
        self.shown = Instant::now();
        let text = line(done, self.all, done.saturating_sub(self.before), self.seconds(), failed);
        if self.is_terminal {
            let bar = self.all.map_or_else(String::new, |all| bar(done, all));
            PatientOutput(std::io::stderr()).write_all(format!("\r\x1b[K{bar}{text}").as_bytes()).ok();
            self.is_shown = true;
        } else {
            error::tell(&text);
        }
    }

    /// Removes the bar, so that lines can be printed.
    pub(super) fn clear(&mut self) {
        if self.is_shown {
            PatientOutput(std::io::stderr()).write_all(b"\r\x1b[K").ok();
            self.is_shown = false;
        }
    }

    /// Returns the seconds since the start.
    pub(super) fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }
}

/// Returns the bar with a space behind it.
fn bar(done: u64, all: u64) -> String {
    let filled = (WIDTH * done.min(all) / all.max(1)) as usize;
    "█".repeat(filled) + &"░".repeat(WIDTH as usize - filled) + " "
}

/// Returns the line: `431 of 1000 flights, 16.3 a second, 35 s left, 2 failed`.
fn line(done: u64, all: Option<u64>, new: u64, seconds: f64, failed: u64) -> String {
    let rate = new as f64 / seconds.max(1e-3);
    let mut line = all.map_or_else(|| format!("{done} flights"), |all| format!("{done} of {all} flights"));
    if new > 0 {
        line.push_str(&format!(", {rate:.1} a second"));
        if let Some(all) = all {
            line.push_str(&format!(", {} left", duration(all.saturating_sub(done) as f64 / rate)));
        }
    }
    if failed > 0 {
        line.push_str(&format!(", {failed} failed"));
    }
    line
}

/// Returns a duration for people: `35 s`, `12 min`, `3 h 20 min`.
fn duration(seconds: f64) -> String {
    let minutes = (seconds / 60.0).round() as u64;
    match seconds {
        seconds if seconds < 100.0 => format!("{seconds:.0} s"),
        _ if minutes < 100 => format!("{minutes} min"),
        _ => format!("{} h {} min", minutes / 60, minutes % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_that_of_the_new_flights() {
        assert_eq!(
            line(431, Some(1000), 331, 20.0, 2),
            "431 of 1000 flights, 16.6 a second, 34 s left, 2 failed"
        );
        assert_eq!(line(30, None, 30, 10.0, 0), "30 flights, 3.0 a second");
        assert_eq!(line(100, Some(1000), 0, 0.0, 0), "100 of 1000 flights");
    }

    #[test]
    fn durations_are_short() {
        for (seconds, text) in [(9.6, "10 s"), (720.0, "12 min"), (12_000.0, "3 h 20 min")] {
            assert_eq!(duration(seconds), text);
        }
    }
}
