//! A SITL executable as a child of this program. It runs in its own directory, is restarted after its `save`
//! has ended it, and ends with this program, whatever the cause.
//!
//! A separate thread waits for the child. The lines that the child prints and its end are reported in order.

mod events;
mod group;
mod launch;
pub mod lockstep;
mod output;

use std::path::PathBuf;
use std::process::{Child, ExitStatus};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use events::Events;
pub use launch::{LaunchError, launch_firmware};

/// The interval between two checks of the child.
const LOOK: Duration = Duration::from_millis(20);
/// The longest time that a child may take to end on request, and to deliver its output after its end.
const GRACE: Duration = Duration::from_millis(500);
/// The pause before a child that ended is restarted.
const PAUSE: Duration = Duration::from_millis(100);
/// The pause before a child that crashed is restarted, so that a log can be read.
const PAUSE_AFTER_CRASH: Duration = Duration::from_secs(1);

/// The settings to start a SITL executable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChildConfig {
    pub program: PathBuf,
    pub arguments: Vec<String>,
    /// The directory in which it runs and keeps its `eeprom.bin`.
    pub directory: PathBuf,
    /// This program. It starts the child in such a way that the child cannot outlive it.
    pub launcher: PathBuf,
}

/// An event of the child.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChildEvent {
    Started,
    /// A line of its output.
    Line(String),
    /// The number of lines that are not reported because the child prints more than can be read.
    NotShown(u64),
    /// The child ended. It is restarted.
    Ended(ChildEnd),
    /// The child cannot be started, with the reason as part of a sentence. No events follow.
    Failed(String),
}

/// The way in which the child ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChildEnd {
    /// With this exit code.
    Code(i32),
    Signal(i32),
}

impl ChildEnd {
    /// Returns `true` if it ended in the way of a reboot.
    pub fn is_reboot(self) -> bool {
        self == Self::Code(0)
    }
}

impl std::fmt::Display for ChildEnd {
    /// Writes the end as part of a sentence.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Code(code) => write!(f, "with exit code {code}"),
            Self::Signal(signal) => write!(f, "by signal {signal}"),
        }
    }
}

impl From<ExitStatus> for ChildEnd {
    fn from(status: ExitStatus) -> Self {
        #[cfg(unix)]
        if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
            return Self::Signal(signal);
        }
        Self::Code(status.code().unwrap_or(-1))
    }
}

/// The child and the thread that waits for it. Dropping it ends both.
#[derive(Debug)]
pub struct SitlChild {
    events: Arc<Events>,
    stop: Arc<AtomicBool>,
    keeper: Option<JoinHandle<()>>,
}

impl SitlChild {
    /// Starts the executable. [`SitlChild::take_event`] reports its events.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(config: ChildConfig) -> std::io::Result<Self> {
        let events = Arc::new(Events::default());
        let stop = Arc::new(AtomicBool::new(false));
        let keeper = Keeper { config, events: Arc::clone(&events), stop: Arc::clone(&stop) };
        let keeper = std::thread::Builder::new().name("firmware".to_owned()).spawn(move || keeper.run())?;
        Ok(Self { events, stop, keeper: Some(keeper) })
    }

    pub fn take_event(&mut self) -> Option<ChildEvent> {
        self.events.take(now())
    }
}

impl Drop for SitlChild {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(keeper) = self.keeper.take() {
            // The thread does not panic.
            drop(keeper.join());
        }
    }
}

/// Waits for the child and restarts it.
struct Keeper {
    config: ChildConfig,
    events: Arc<Events>,
    stop: Arc<AtomicBool>,
}

impl Keeper {
    fn run(self) {
        while !self.is_stopped() {
            let mut child = match launch::spawn(&self.config, None) {
                Ok(child) => child,
                Err(error) => return self.tell(ChildEvent::Failed(error.to_string())),
            };
            self.tell(ChildEvent::Started);
            let readers = [
                child.stdout.take().map(|out| output::listen(&self.events, out)),
                child.stderr.take().map(|out| output::listen(&self.events, out)),
            ];
            let ended = self.wait(&mut child);
            read_to_the_end(readers.into_iter().flatten());
            match ended {
                Ok(Some(end)) => {
                    if let ChildEnd::Code(code) = end
                        && let Some(error) = launch::error_of_code(code, &self.config)
                    {
                        return self.tell(ChildEvent::Failed(error));
                    }
                    self.tell(ChildEvent::Ended(end));
                    self.pause(if end.is_reboot() { PAUSE } else { PAUSE_AFTER_CRASH });
                }
                Ok(None) => return,
                Err(error) => return self.tell(ChildEvent::Failed(error.to_string())),
            }
        }
    }

    fn tell(&self, event: ChildEvent) {
        self.events.add(event);
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Waits for the end of the child. Returns `None` if this program ended it. Its own child processes end
    /// with it.
    fn wait(&self, child: &mut Child) -> std::io::Result<Option<ChildEnd>> {
        let by_itself = loop {
            if group::has_ended(child)? {
                break true;
            }
            if self.is_stopped() {
                group::ask_to_end(child);
                let until = now() + GRACE;
                while now() < until && !group::has_ended(child)? {
                    sleep(LOOK);
                }
                break false;
            }
            sleep(LOOK);
        };
        let status = group::reap(child)?;
        Ok(by_itself.then(|| status.into()))
    }

    fn pause(&self, pause: Duration) {
        let until = now() + pause;
        while !self.is_stopped() && now() < until {
            sleep(LOOK);
        }
    }
}

/// Waits for the threads that read the output of a child that has ended. A thread is abandoned if a process
/// that has left the child's group still holds its output.
fn read_to_the_end(readers: impl Iterator<Item = JoinHandle<()>>) {
    let until = now() + GRACE;
    for reader in readers {
        while !reader.is_finished() && now() < until {
            sleep(LOOK);
        }
    }
}

#[allow(clippy::disallowed_methods, reason = "a thread of its own waits for a process")]
fn sleep(time: Duration) {
    std::thread::sleep(time);
}

#[allow(clippy::disallowed_methods, reason = "a thread of its own waits for a process")]
fn now() -> Instant {
    Instant::now()
}
