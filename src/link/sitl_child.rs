//! A SITL executable as a child of this program: started in a directory of its own, started anew when its `save` has ended
//! it, ended with this program, whatever ends that.
//!
//! A thread of its own waits for the child. What the child prints and how it ends are told in order.

mod launch;

use std::io::{BufRead as _, BufReader, Read};
use std::path::PathBuf;
use std::process::{Child, ExitStatus};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

pub use launch::{LaunchError, launch_firmware};

/// Between two looks at the child.
const LOOK: Duration = Duration::from_millis(20);
/// How long a child may take to end when it is asked to.
const GRACE: Duration = Duration::from_millis(500);
/// Before a child that ended is started again.
const PAUSE: Duration = Duration::from_millis(100);
/// Before one is started again that crashed, so that a log can be read.
const PAUSE_AFTER_CRASH: Duration = Duration::from_secs(1);
/// Longest line of its output that is told whole, bytes.
const LINE_MAX: u64 = 4096;
/// How the lines begin that are not told: the thousands about its storing, and those of each second about its flight, which
/// is seen here anyway.
const NOT_TOLD: [&str; 2] = ["[FLASH_ProgramWord]", "[SITL] t="];

/// How a SITL executable is started.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChildConfig {
    /// The executable.
    pub program: PathBuf,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// Where it runs and keeps its `eeprom.bin`.
    pub directory: PathBuf,
    /// This program, which starts the child so that it cannot outlive it.
    pub launcher: PathBuf,
}

/// What happened to the child.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChildEvent {
    /// It was started.
    Started,
    /// A line of its output.
    Line(String),
    /// It ended; it is started again.
    Ended(ChildEnd),
    /// It cannot be started: why, as a part of a sentence. Nothing follows.
    Failed(String),
}

/// How the child ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChildEnd {
    /// With this exit code.
    Code(i32),
    /// By this signal.
    Signal(i32),
}

impl ChildEnd {
    /// Whether it ended as it does to reboot.
    #[must_use]
    pub fn is_reboot(self) -> bool {
        self == Self::Code(0)
    }
}

impl std::fmt::Display for ChildEnd {
    /// How it ended, as a part of a sentence.
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
    events: mpsc::Receiver<ChildEvent>,
    stop: Arc<AtomicBool>,
    keeper: Option<JoinHandle<()>>,
}

impl SitlChild {
    /// Starts the executable; [`SitlChild::take_event`] tells what becomes of it.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(config: ChildConfig) -> std::io::Result<Self> {
        let (tell, events) = mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let keeper = Keeper { config, tell, stop: Arc::clone(&stop) };
        let keeper = std::thread::Builder::new().name("firmware".to_owned()).spawn(move || keeper.run())?;
        Ok(Self { events, stop, keeper: Some(keeper) })
    }

    /// What happened since.
    pub fn take_event(&mut self) -> Option<ChildEvent> {
        self.events.try_recv().ok()
    }
}

impl Drop for SitlChild {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(keeper) = self.keeper.take() {
            // It does not panic.
            drop(keeper.join());
        }
    }
}

/// Waits for the child and starts it again.
struct Keeper {
    config: ChildConfig,
    tell: mpsc::Sender<ChildEvent>,
    stop: Arc<AtomicBool>,
}

impl Keeper {
    fn run(self) {
        while !self.is_stopped() {
            let mut child = match launch::spawn(&self.config) {
                Ok(child) => child,
                Err(error) => return self.tell(ChildEvent::Failed(error.to_string())),
            };
            self.tell(ChildEvent::Started);
            let readers = [
                child.stdout.take().map(|output| self.listen(output)),
                child.stderr.take().map(|output| self.listen(output)),
            ];
            let ended = self.wait(&mut child);
            for reader in readers.into_iter().flatten() {
                // It ends with the child's output.
                drop(reader.join());
            }
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
        // Nobody listens only while the program ends.
        drop(self.tell.send(event));
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// How the child ended; `None` when it was ended from here.
    fn wait(&self, child: &mut Child) -> std::io::Result<Option<ChildEnd>> {
        loop {
            if let Some(status) = child.try_wait()? {
                return Ok(Some(status.into()));
            }
            if self.is_stopped() {
                end(child)?;
                return Ok(None);
            }
            sleep(LOOK);
        }
    }

    fn pause(&self, pause: Duration) {
        let until = now() + pause;
        while !self.is_stopped() && now() < until {
            sleep(LOOK);
        }
    }

    /// Tells the lines of an output until it ends.
    fn listen(&self, output: impl Read + Send + 'static) -> JoinHandle<()> {
        let tell = self.tell.clone();
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            let mut line = Vec::new();
            while matches!(output.by_ref().take(LINE_MAX).read_until(b'\n', &mut line), Ok(1..)) {
                let text = String::from_utf8_lossy(&line).trim_end().to_owned();
                line.clear();
                if !text.is_empty()
                    && !NOT_TOLD.iter().any(|start| text.starts_with(start))
                    && tell.send(ChildEvent::Line(text)).is_err()
                {
                    return;
                }
            }
        })
    }
}

/// Asks the child to end, and ends it when it does not.
fn end(child: &mut Child) -> std::io::Result<()> {
    #[cfg(unix)]
    if let Some(pid) = rustix::process::Pid::from_raw(child.id() as i32) {
        // It may have ended by itself meanwhile.
        let _gone = rustix::process::kill_process(pid, rustix::process::Signal::TERM);
        let until = now() + GRACE;
        while now() < until {
            if child.try_wait()?.is_some() {
                return Ok(());
            }
            sleep(LOOK);
        }
    }
    child.kill()?;
    child.wait()?;
    Ok(())
}

#[allow(clippy::disallowed_methods, reason = "a thread of its own waits for a process")]
fn sleep(time: Duration) {
    std::thread::sleep(time);
}

#[allow(clippy::disallowed_methods, reason = "a thread of its own waits for a process")]
fn now() -> Instant {
    Instant::now()
}
