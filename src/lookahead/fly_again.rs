//! A flight of a remote firmware, flown again from its boot to an instant by another process.

use std::any::Any;
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::time::Instant;

use crate::fc::{KeptFlight, RemoteLink};
use crate::signals::SimTime;
use crate::storage::FirmwareFolder;

/// A firmware that has flown again to an instant.
pub struct FlownAgain {
    /// The link to the firmware, which continues from the instant.
    pub link: RemoteLink,
    /// The folder of the firmware. It must outlive `link`.
    pub keeps: Box<dyn Any + Send>,
}

impl fmt::Debug for FlownAgain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FlownAgain").field("link", &self.link).finish_non_exhaustive()
    }
}

/// The progress of a flight that is flown again.
#[derive(Debug, Default)]
pub struct Progress {
    reached_us: AtomicU64,
    stopped: Arc<AtomicBool>,
}

impl Progress {
    /// Records the instant that the flight has reached.
    pub fn reach(&self, time: SimTime) {
        self.reached_us.store(time.0, Ordering::Relaxed);
    }

    /// Returns the flag that is set when the result is no longer wanted.
    pub fn stopped(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stopped)
    }
}

type Fly = dyn Fn(SimTime, &Progress) -> Result<FlownAgain, String> + Send + Sync;

/// Flies a flight again, with the same inputs, to an instant.
#[derive(Clone)]
pub struct FlyAgain(Arc<Fly>);

impl FlyAgain {
    /// Returns a value that flies by `fly`, which returns a sentence if it fails.
    pub fn new(
        fly: impl Fn(SimTime, &Progress) -> Result<FlownAgain, String> + Send + Sync + 'static,
    ) -> Self {
        Self(Arc::new(fly))
    }

    /// Returns a value that flies this flight.
    pub fn of(kept: KeptFlight) -> Self {
        Self::new(move |until, progress| {
            let folder = FirmwareFolder::make().map_err(|error| {
                format!("The firmware cannot fly again, because its folder cannot be made: {error}.")
            })?;
            let stopped = progress.stopped();
            #[allow(clippy::disallowed_methods, reason = "the link counts from here on the wall clock")]
            let now = Instant::now();
            let goes_on = |time: SimTime| {
                progress.reach(time);
                !stopped.load(Ordering::Relaxed)
            };
            let link = kept.fly(until, folder.path().to_owned(), now, goes_on);
            let link = link.map_err(|reason| format!("The flight is not flown again: {reason}."))?;
            Ok(FlownAgain { link, keeps: Box::new(folder) })
        })
    }

    /// Starts the flight on a thread of its own. The present thread is unparked at its end.
    pub fn start(&self, until: SimTime) -> std::io::Result<FlyingAgain> {
        let (done, result) = mpsc::channel();
        let (fly, waiting) = (Arc::clone(&self.0), std::thread::current());
        let progress = Arc::new(Progress::default());
        let followed = Arc::clone(&progress);
        let thread = std::thread::Builder::new().name("fly-again".to_owned()).spawn(move || {
            let (kept, gone) = mpsc::channel::<()>();
            let flown = fly(until, &followed);
            // The record of the flight is not needed any more.
            drop(fly);
            let flown = flown.map(|flown| FlownAgain { keeps: Box::new((flown.keeps, kept)), ..flown });
            drop(done.send(flown));
            waiting.unpark();
            // A child process ends with the thread that started it, so the thread waits until nothing needs the child.
            let _gone = gone.recv();
        })?;
        Ok(FlyingAgain { until, progress, result: Some(result), thread: Some(thread) })
    }
}

impl fmt::Debug for FlyAgain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("FlyAgain")
    }
}

/// A flight that is flown again at the moment.
#[derive(Debug)]
pub struct FlyingAgain {
    until: SimTime,
    progress: Arc<Progress>,
    /// `None` once the result is taken.
    result: Option<mpsc::Receiver<Result<FlownAgain, String>>>,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl Drop for FlyingAgain {
    fn drop(&mut self) {
        self.progress.stopped.store(true, Ordering::Relaxed);
        // Without a receiver the thread ends, with the process and the folder of the firmware.
        if self.result.take().is_some() {
            drop(self.thread.take().map(std::thread::JoinHandle::join));
        }
    }
}

impl FlyingAgain {
    /// Returns the instant that the flight has reached, and the one that it goes to.
    pub fn progress(&self) -> (SimTime, SimTime) {
        (SimTime(self.progress.reached_us.load(Ordering::Relaxed)), self.until)
    }

    /// Returns the instant and the result; `None` while the flight goes on.
    pub fn result(&mut self) -> Option<(SimTime, Result<FlownAgain, String>)> {
        let result = match self.result.as_ref()?.try_recv() {
            Ok(result) => result,
            Err(mpsc::TryRecvError::Empty) => return None,
            Err(mpsc::TryRecvError::Disconnected) => {
                Err("The flight could not be flown again: its thread has ended.".to_owned())
            }
        };
        self.result = None;
        Some((self.until, result))
    }
}
