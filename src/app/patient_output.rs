//! Standard output and standard error of the commands that end in order after a signal. A reader that has stopped reading
//! makes them wait, but after a signal not for long: then it counts as one that went away.
#![allow(clippy::disallowed_methods, reason = "a reader is given a short time")]

use std::io::{self, ErrorKind, Write};
use std::os::fd::AsFd;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

/// How long a reader may take after a signal.
const PATIENCE: Duration = Duration::from_millis(700);
/// How often the signal is looked for while nobody reads.
const INTERVAL: Timespec = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };
/// Most bytes that a pipe takes at once when it takes any.
const AT_ONCE: usize = 4096;

/// When the signal came.
static INTERRUPTED: OnceLock<Instant> = OnceLock::new();

/// Lets writers wait only a short time from now on.
pub(super) fn lose_patience() {
    INTERRUPTED.get_or_init(Instant::now);
}

/// A stream that is written without a buffer.
#[derive(Debug)]
pub(super) struct PatientOutput<S>(pub(super) S);

impl<S: AsFd> Write for PatientOutput<S> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let stream = self.0.as_fd();
        loop {
            match poll(&mut [PollFd::new(&stream, PollFlags::OUT)], Some(&INTERVAL)) {
                Ok(0) | Err(Errno::INTR) => {}
                Ok(_) => match rustix::io::write(stream, &bytes[..bytes.len().min(AT_ONCE)]) {
                    Err(Errno::INTR | Errno::AGAIN) => {}
                    written => return Ok(written?),
                },
                Err(error) => return Err(error.into()),
            }
            if INTERRUPTED.get().is_some_and(|since| since.elapsed() >= PATIENCE) {
                return Err(ErrorKind::BrokenPipe.into());
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
