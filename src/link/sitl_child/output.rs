//! The lines that the child prints.

use std::io::{self, BufRead as _, BufReader, Read};
use std::os::fd::OwnedFd;
use std::process::Child;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use super::events::Events;
use super::now;

/// The longest line of its output that is reported whole, bytes.
const LINE_MAX: u64 = 4096;
/// The beginnings of lines that are not reported: the thousands about its storing, and those of each second
/// about its flight, which this program shows anyway.
const NOT_REPORTED: [&str; 2] = ["[FLASH_ProgramWord]", "[SITL] t="];

/// The most reads of an output at a time.
const READS_MAX: usize = 32;
/// The most lines that wait for their step. Further ones are counted.
const WAITING_MAX: usize = 1000;

/// Returns the text of a line, if it is reported.
fn reported(line: &[u8]) -> Option<&[u8]> {
    let text = line.trim_ascii_end();
    let is_reported =
        !text.is_empty() && !NOT_REPORTED.iter().any(|start| text.starts_with(start.as_bytes()));
    is_reported.then_some(text)
}

/// The outputs of a child in lockstep. Their lines are reported between two steps, so that each comes at the same step in
/// each run. A thread that reads them would report them at some instant of the wall clock.
#[derive(Debug)]
pub(super) struct SteppedOutput {
    pipes: Vec<Pipe>,
    lines: Vec<Vec<u8>>,
    omitted: u64,
}

#[derive(Debug)]
struct Pipe {
    end: OwnedFd,
    /// The part of a line that has arrived.
    line: Vec<u8>,
}

impl SteppedOutput {
    /// Takes the outputs of a child.
    ///
    /// # Errors
    /// Returns the system's error if they cannot be read without waiting.
    pub(super) fn of(child: &mut Child) -> io::Result<Self> {
        let ends = [child.stdout.take().map(OwnedFd::from), child.stderr.take().map(OwnedFd::from)];
        let mut pipes = Vec::new();
        for end in ends.into_iter().flatten() {
            rustix::io::ioctl_fionbio(&end, true)?;
            pipes.push(Pipe { end, line: Vec::new() });
        }
        Ok(Self { pipes, lines: Vec::new(), omitted: 0 })
    }

    /// Reads what the child has printed, so that it can go on printing.
    pub(super) fn read(&mut self) {
        for Pipe { end, line } in &mut self.pipes {
            let mut bytes = [0; 4096];
            // A child that prints without an end must not hold this thread.
            for _ in 0..READS_MAX {
                let read = match rustix::io::read(&*end, &mut bytes) {
                    Ok(0) => break,
                    Ok(read) => read,
                    Err(rustix::io::Errno::INTR) => continue,
                    Err(_) => break,
                };
                for &byte in &bytes[..read] {
                    line.push(byte);
                    if byte == b'\n' || line.len() as u64 == LINE_MAX {
                        keep(line, &mut self.lines, &mut self.omitted);
                    }
                }
            }
        }
    }

    /// Reports the lines that were read. `now` is the time of the step, and decides how many are shown.
    pub(super) fn report(&mut self, events: &Events, now: Instant) {
        self.lines.drain(..).for_each(|line| events.add_line(&line, now));
        events.omit(std::mem::take(&mut self.omitted));
    }

    /// Reports the last lines of a child that has ended, also those without an end.
    pub(super) fn finish(&mut self, events: &Events, now: Instant) {
        self.read();
        for pipe in &mut self.pipes {
            keep(&mut pipe.line, &mut self.lines, &mut self.omitted);
        }
        self.report(events, now);
    }
}

/// Keeps a line, and begins the next.
fn keep(line: &mut Vec<u8>, lines: &mut Vec<Vec<u8>>, omitted: &mut u64) {
    match reported(line) {
        Some(_) if lines.len() >= WAITING_MAX => *omitted += 1,
        Some(text) => lines.push(text.to_vec()),
        None => {}
    }
    line.clear();
}

/// Reports the lines of an output until it ends.
pub(super) fn listen(events: &Arc<Events>, output: impl Read + Send + 'static) -> JoinHandle<()> {
    let events = Arc::clone(events);
    std::thread::spawn(move || {
        let mut output = BufReader::new(output);
        let mut line = Vec::new();
        while matches!(output.by_ref().take(LINE_MAX).read_until(b'\n', &mut line), Ok(1..)) {
            if let Some(text) = reported(&line) {
                events.add_line(text, now());
            }
            line.clear();
        }
    })
}
