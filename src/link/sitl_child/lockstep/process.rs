//! The process of an executable in lockstep, and its side of the shared memory.
#![allow(clippy::disallowed_methods, reason = "the length of a step shows whether the processor is busy")]

use std::os::fd::AsFd;
use std::process::Child;
use std::sync::atomic::Ordering::SeqCst;
use std::time::{Duration, Instant};

use super::frames::{BOOT_GRANT, Grant, Report};
use super::handover::{Handover, YIELDS};
use super::page::SharedPage;
use crate::link::sitl_child::events::Events;
use crate::link::sitl_child::launch::{self, LaunchError, Preload};
use crate::link::sitl_child::output::SteppedOutput;
use crate::link::sitl_child::{ChildConfig, ChildEnd, group};

/// The longest part of a wait for a report, and the parts after which the process is looked at.
const LOOK: Duration = Duration::from_millis(10);
const PARTS: u32 = 3;
/// The processor time within a step after which the process counts as hung.
const HUNG_AFTER: Duration = Duration::from_secs(2);
/// The looks in a row at a process that sleeps after which it counts as silent: 10 s. Looks are counted rather than the
/// time, because the machine may sleep, too.
const SILENT_AFTER: u32 = 1000 / PARTS;

/// A running executable. It ends when this is dropped.
#[derive(Debug)]
pub(super) struct Process {
    child: Child,
    output: SteppedOutput,
    page: SharedPage,
    handover: Handover,
    /// `true` if the wait for the report begins with yields.
    yields: bool,
    /// The processor time that it had used when this step first took long.
    used: Option<Duration>,
    /// The looks in a row at which it slept.
    asleep: u32,
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
        let page = SharedPage::new().map_err(failed)?;
        page.granted.store(BOOT_GRANT, SeqCst);
        let mut child = launch::spawn(config, Some((preload, &page.path())))?;
        let output = SteppedOutput::of(&mut child).map_err(failed)?;
        Ok(Self { child, output, page, handover: Handover::default(), yields: false, used: None, asleep: 0 })
    }

    /// Returns the number of the process.
    pub(super) fn id(&self) -> u32 {
        self.child.id()
    }

    /// Returns `true` if its main thread runs the code of other threads.
    pub(super) fn has_guests(&self) -> bool {
        self.page.guests.load(SeqCst) > 0
    }

    /// Gives the executable a grant. A process that has ended takes none; the wait for its report says so.
    pub(super) fn grant(&mut self, grant: &Grant) {
        self.yields = self.handover.begin_step();
        self.page.yields.store(if self.yields { YIELDS } else { 0 }, SeqCst);
        self.page.put_grant(grant);
        #[cfg(target_os = "linux")]
        if self.page.executable_sleeps.load(SeqCst) != 0 {
            use rustix::thread::futex::{Flags, wake};
            let _woken = wake(&self.page.granted, Flags::empty(), 1);
        }
    }

    /// Yields the processor to the executable, so that it may report without a sleep of this program.
    fn yield_to_executable(&mut self, wanted: u32) {
        if !std::mem::take(&mut self.yields) {
            return;
        }
        let start = Instant::now();
        let is_over = || self.page.reported.load(SeqCst) == wanted;
        let came = is_over()
            || (0..YIELDS).any(|_| {
                std::thread::yield_now();
                is_over()
            });
        self.handover.end_step(came, start.elapsed());
    }

    /// Waits until the executable waits for the next grant, for a short time at most.
    ///
    /// # Errors
    /// Returns the reason why there is no report.
    pub(super) fn wait(&mut self) -> Result<Report, NoReport> {
        let wanted = self.page.granted.load(SeqCst);
        self.yield_to_executable(wanted);
        // A process that wakes this one without a report must not hold it, and an interrupted wait may be repeated.
        for _ in 0..PARTS {
            let seen = self.page.reported.load(SeqCst);
            if seen == wanted {
                (self.used, self.asleep) = (None, 0);
                return Ok(self.page.report());
            }
            self.wait_for_change(seen);
        }
        // A child that has printed much cannot go on until this is read.
        self.output.read();
        Err(self.no_report())
    }

    /// Waits for a change of the number of reports, for [`LOOK`] at most.
    fn wait_for_change(&self, seen: u32) {
        #[cfg(target_os = "linux")]
        {
            use rustix::thread::futex::{Flags, Timespec, wait};
            let longest = Timespec { tv_sec: 0, tv_nsec: LOOK.as_nanos() as i64 };
            // A report that comes in between ends the wait, because it has changed the number.
            self.page.program_sleeps.store(1, SeqCst);
            let _changed = wait(&self.page.reported, Flags::empty(), seen, Some(&longest));
            self.page.program_sleeps.store(0, SeqCst);
        }
        #[cfg(not(target_os = "linux"))]
        let _ = seen;
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

    /// Waits for the end of a process, and returns it.
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
