//! The lines that the child prints.

use std::io::{BufRead as _, BufReader, Read};
use std::sync::Arc;
use std::thread::JoinHandle;

use super::events::Events;
use super::now;

/// The longest line of its output that is reported whole, bytes.
const LINE_MAX: u64 = 4096;
/// The beginnings of lines that are not reported: the thousands about its storing, and those of each second
/// about its flight, which this program shows anyway.
const NOT_REPORTED: [&str; 2] = ["[FLASH_ProgramWord]", "[SITL] t="];

/// Reports the lines of an output until it ends.
pub(super) fn listen(events: &Arc<Events>, output: impl Read + Send + 'static) -> JoinHandle<()> {
    let events = Arc::clone(events);
    std::thread::spawn(move || {
        let mut output = BufReader::new(output);
        let mut line = Vec::new();
        while matches!(output.by_ref().take(LINE_MAX).read_until(b'\n', &mut line), Ok(1..)) {
            let text = line.trim_ascii_end();
            if !text.is_empty() && !NOT_REPORTED.iter().any(|start| text.starts_with(start.as_bytes())) {
                events.add_line(text, now());
            }
            line.clear();
        }
    })
}
