//! The progress of a run, on a terminal only.

use std::io::{IsTerminal as _, Write as _};

use crate::process::patient_output::PatientOutput;
use crate::text::printable;

/// Width of the bar, characters.
const WIDTH: usize = 24;

/// The bar on standard error.
pub(crate) struct Bar {
    is_wanted: bool,
    is_shown: bool,
}

impl Bar {
    pub(crate) fn new() -> Self {
        Self { is_wanted: std::io::stderr().is_terminal(), is_shown: false }
    }

    /// Removes the bar, so that lines can be printed.
    pub(crate) fn clear(&mut self) {
        if self.is_shown {
            PatientOutput(std::io::stderr()).write_all(b"\r\x1b[K").ok();
            self.is_shown = false;
        }
    }

    /// Shows the share of a run that is done, with a text.
    pub(crate) fn show(&mut self, done: usize, all: usize, text: &str) {
        if !self.is_wanted || done >= all {
            return;
        }
        let filled = WIDTH * done / all.max(1);
        let bar = "█".repeat(filled) + &"░".repeat(WIDTH - filled);
        let text = format!("\r\x1b[K{bar} {}", printable::name(text));
        PatientOutput(std::io::stderr()).write_all(text.as_bytes()).ok();
        self.is_shown = true;
    }
}
