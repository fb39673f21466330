//! Standard output and standard error of the commands that end cleanly after a signal. If a reader stops reading,
//! they wait. After a signal they wait only a short time, and then treat the reader as gone.
#![allow(clippy::disallowed_methods, reason = "a reader is given a short time")]

use std::io::{self, ErrorKind, Write};
use std::os::fd::AsFd;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

/// The time that a reader has after a signal.
const PATIENCE: Duration = Duration::from_millis(700);
/// The interval between two checks for the signal while there is no reader.
const INTERVAL: Timespec = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };
/// The number of bytes that a pipe accepts at once if it accepts any.
const AT_ONCE: usize = 4096;

/// The time of the signal.
static INTERRUPTED: OnceLock<Instant> = OnceLock::new();

/// Makes writers wait only a short time from now on.
pub(crate) fn lose_patience() {
    INTERRUPTED.get_or_init(Instant::now);
}

/// A stream without a buffer.
#[derive(Debug)]
pub(crate) struct PatientOutput<S>(pub(crate) S);

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
