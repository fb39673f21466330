//! The process of an executable in lockstep, and the pipes that carry grants and reports.

use std::io::{ErrorKind, PipeReader, PipeWriter, Read as _, Write as _};
use std::os::fd::{AsFd, AsRawFd as _};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use super::frames::{Grant, REPORT_BYTES, Report};
use crate::link::sitl_child::events::Events;
use crate::link::sitl_child::launch::{self, LaunchError, Preload};
use crate::link::sitl_child::output::SteppedOutput;
use crate::link::sitl_child::{ChildConfig, ChildEnd, group};

/// The interval at which a wait for a report looks at the process.
const LOOK: Duration = Duration::from_millis(50);
/// The processor time within a step after which the process counts as hung.
const HUNG_AFTER: Duration = Duration::from_secs(2);
/// The looks in a row at a process that sleeps after which it counts as silent: 10 s. Looks are counted rather than the
/// time, because the machine may sleep, too.
const SILENT_AFTER: u32 = 200;

/// A running executable. It ends when this is dropped.
#[derive(Debug)]
pub(super) struct Process {
    child: Child,
    output: SteppedOutput,
    grants: PipeWriter,
    reports: PipeReader,
    /// The end of the executable, until it has opened its own. The end of the process then closes the pipe.
    reports_end: Option<PipeWriter>,
    /// The part of a report that has arrived.
    bytes: [u8; REPORT_BYTES],
    arrived: usize,
    /// The processor time that it had used when this step first took long.
    used: Option<Duration>,
    /// The looks in a row at which it slept.
    asleep: u32,
    /// `true` if it does not take the grants in.
    is_full: bool,
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
    /// It does not compute: the host or a debugger has stopped it, or the machine is busy. The next wait continues.
    Stopped,
    /// It sleeps, and has not ended its step for 10 s.
    Silent,
    /// It breaks a rule of the messages; its fault as the rest of a sentence.
    Faulty(&'static str),
}

impl Process {
    pub(super) fn start(config: &ChildConfig, preload: &Preload) -> Result<Self, LaunchError> {
        let failed = |error| LaunchError::Start { program: config.program.clone(), error };
        let (grants_end, grants) = std::io::pipe().map_err(failed)?;
        let (reports, reports_end) = std::io::pipe().map_err(failed)?;
        let pipe = format!("/proc/{}/fd/{}", std::process::id(), reports_end.as_raw_fd());
        let mut child = launch::spawn(config, Stdio::from(grants_end), Some((preload, &pipe)))?;
        let output = SteppedOutput::of(&mut child).map_err(failed)?;
        // A process that does not read its grants must not hold this thread.
        rustix::io::ioctl_fionbio(&grants, true).map_err(|error| failed(error.into()))?;
        Ok(Self {
            child,
            output,
            grants,
            reports,
            reports_end: Some(reports_end),
            bytes: [0; REPORT_BYTES],
            arrived: 0,
            used: None,
            asleep: 0,
            is_full: false,
        })
    }

    /// Returns the number of the process.
    pub(super) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Sends a grant. A process that has ended takes none; the wait for its report says so.
    pub(super) fn grant(&mut self, grant: &Grant) {
        // The system takes a message of this size whole or not at all.
        let written = self.grants.write(&grant.to_bytes());
        self.is_full = written.is_err_and(|error| error.kind() == ErrorKind::WouldBlock);
    }

    /// Waits until the executable waits for the next grant, for a short time at most.
    ///
    /// # Errors
    /// Returns the reason why there is no report.
    pub(super) fn wait(&mut self) -> Result<Report, NoReport> {
        if self.is_full {
            return Err(NoReport::Faulty("reports steps without reading the messages that grant them"));
        }
        loop {
            if !is_readable(&self.reports) {
                // A child that has printed much cannot go on until this is read.
                self.output.read();
                return Err(self.no_report());
            }
            match self.reports.read(&mut self.bytes[self.arrived..]) {
                Ok(0) => return Err(NoReport::Ended(self.end())),
                Ok(read) => {
                    self.arrived += read;
                    if self.arrived == REPORT_BYTES {
                        self.arrived = 0;
                        (self.used, self.asleep) = (None, 0);
                        self.reports_end = None;
                        return Ok(Report::from_bytes(&self.bytes));
                    }
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return Err(NoReport::Ended(self.end())),
            }
        }
    }

    /// Reports the lines that it has printed up to the last report.
    pub(super) fn report_output(&mut self, events: &Events, now: Instant) {
        self.output.read();
        self.output.report(events, now);
    }

    /// Reports the last lines of a process that has ended.
    pub(super) fn finish_output(&mut self, events: &Events, now: Instant) {
        self.output.finish(events, now);
    }

    /// Returns the reason why nothing has come from it for some time.
    pub(super) fn no_report(&mut self) -> NoReport {
        // A copy of the process, or this program until the first report, may hold the pipe open after its end.
        if group::has_ended(&mut self.child).unwrap_or(true) {
            return NoReport::Ended(self.end());
        }
        let Status { is_asleep, used: now_used } = Status::of(self.child.id());
        let used = *self.used.get_or_insert(now_used);
        self.asleep = if is_asleep { self.asleep + 1 } else { 0 };
        if now_used.saturating_sub(used) >= HUNG_AFTER {
            NoReport::Hung
        } else if self.asleep >= SILENT_AFTER {
            NoReport::Silent
        } else {
            NoReport::Stopped
        }
    }

    /// Waits for the end of a process that has closed its pipe, and returns it.
    fn end(&mut self) -> ChildEnd {
        group::reap(&mut self.child).map_or(ChildEnd::Code(-1), ChildEnd::from)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        drop(group::reap(&mut self.child));
    }
}

/// Waits until something can be read, for a short time at most.
pub(super) fn is_readable(source: &impl AsFd) -> bool {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let longest = Timespec { tv_sec: 0, tv_nsec: LOOK.as_nanos() as i64 };
    // The end of the other side counts as readable. An interrupted wait is like one that ended early.
    poll(&mut [PollFd::new(source, PollFlags::IN)], Some(&longest)).is_ok_and(|ready| ready > 0)
}

/// The status of a process as the system reports it.
#[derive(Debug, Default)]
struct Status {
    /// `true` if its main thread waits for something other than the processor, a disk or a debugger.
    is_asleep: bool,
    /// The processor time of all its threads.
    used: Duration,
}

impl Status {
    /// Returns the status of a process; the default if the system does not report it.
    fn of(id: u32) -> Self {
        const TICK: Duration = Duration::from_millis(10);
        let text = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
        // The name of the program, in parentheses, may contain spaces.
        let mut fields = text.rsplit_once(')').map_or("", |(_, fields)| fields).split_ascii_whitespace();
        let is_asleep = fields.next() == Some("S");
        let ticks: u32 = fields.skip(10).take(2).filter_map(|field| field.parse::<u32>().ok()).sum();
        Self { is_asleep, used: TICK * ticks }
    }
}
