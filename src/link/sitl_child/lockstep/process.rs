//! The process of an executable in lockstep, and the socket pair that carries grants and reports.

use std::io::{ErrorKind, Read as _, Write as _};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::time::Duration;

use super::frames::{Grant, REPORT_BYTES, Report};
use crate::link::sitl_child::events::Events;
use crate::link::sitl_child::launch::{self, LaunchError, Preload};
use crate::link::sitl_child::{ChildConfig, ChildEnd, group, output};

/// The interval at which a wait for a report looks at the process.
const LOOK: Duration = Duration::from_millis(50);
/// The processor time within a step after which the process counts as hung.
const HUNG_AFTER: Duration = Duration::from_secs(2);

/// A running executable. It ends when this is dropped.
#[derive(Debug)]
pub(super) struct Process {
    child: Child,
    socket: UnixStream,
    /// The part of a report that has arrived.
    bytes: [u8; REPORT_BYTES],
    arrived: usize,
    /// The processor time that it had used when this step first took long.
    used: Option<Duration>,
}

/// The reason why there is no report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoReport {
    /// The process has ended.
    Ended(ChildEnd),
    /// The process has replaced itself, and waits for its first step.
    Replaced,
    /// It computes, but does not end its step.
    Hung,
    /// It does not compute: the host or a debugger has stopped it. The next wait continues.
    Stopped,
}

impl Process {
    pub(super) fn start(
        config: &ChildConfig,
        preload: &Preload,
        events: &Arc<Events>,
    ) -> Result<Self, LaunchError> {
        let failed = |error| LaunchError::Start { program: config.program.clone(), error };
        let (socket, other) = UnixStream::pair().map_err(failed)?;
        socket.set_read_timeout(Some(LOOK)).map_err(failed)?;
        let mut child = launch::spawn(config, Stdio::from(OwnedFd::from(other)), Some(preload))?;
        // The threads end with the output.
        let _readers = [
            child.stdout.take().map(|out| output::listen(events, out)),
            child.stderr.take().map(|out| output::listen(events, out)),
        ];
        Ok(Self { child, socket, bytes: [0; REPORT_BYTES], arrived: 0, used: None })
    }

    /// Returns the number of the process.
    pub(super) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Sends a grant. A process that has ended takes none; the wait for its report says so.
    pub(super) fn grant(&mut self, grant: &Grant) {
        drop(self.socket.write_all(&grant.to_bytes()));
    }

    /// Waits until the executable waits for the next grant, for a short time at most.
    ///
    /// # Errors
    /// Returns the reason why there is no report.
    pub(super) fn wait(&mut self) -> Result<Report, NoReport> {
        loop {
            match self.socket.read(&mut self.bytes[self.arrived..]) {
                Ok(0) => return Err(NoReport::Ended(self.end())),
                Ok(read) => {
                    self.arrived += read;
                    if self.arrived == REPORT_BYTES {
                        self.arrived = 0;
                        self.used = None;
                        return Ok(Report::from_bytes(&self.bytes));
                    }
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    let now_used = processor_time(self.child.id());
                    let used = *self.used.get_or_insert(now_used);
                    let is_hung = now_used.saturating_sub(used) >= HUNG_AFTER;
                    return Err(if is_hung { NoReport::Hung } else { NoReport::Stopped });
                }
                Err(_) => return Err(NoReport::Ended(self.end())),
            }
        }
    }

    /// Waits for the end of a process that has closed its socket, and returns it.
    fn end(&mut self) -> ChildEnd {
        group::reap(&mut self.child).map_or(ChildEnd::Code(-1), ChildEnd::from)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        drop(group::reap(&mut self.child));
    }
}

/// Returns the processor time that a process has used; zero if the system does not say.
fn processor_time(id: u32) -> Duration {
    const TICK: Duration = Duration::from_millis(10);
    let text = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
    // The name of the program, in parentheses, may contain spaces.
    let fields = text.rsplit_once(')').map_or("", |(_, fields)| fields).split_ascii_whitespace();
    let ticks: u32 = fields.skip(11).take(2).filter_map(|field| field.parse::<u32>().ok()).sum();
    TICK * ticks
}
