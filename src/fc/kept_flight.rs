//! A flight of an executable in simulated time that another process can fly again: the inputs of the executable, and copies
//! of the protocol with it.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::Remote;
use super::remote::Input;
use super::remote_link::RemoteLink;
use super::stepped::Stepped;
use crate::link::lockstep::{KeptRun, Lockstep, NotAgain};
use crate::link::proto::sitl_feed::FeedConfig;
use crate::signals::SimTime;
use crate::vehicle::RemoteController;

/// The time between two copies of the protocol, and the most copies.
const EVERY: Duration = Duration::from_secs(1);
const MOST: usize = 3600;

/// The protocol after a step, and the time of the link then.
#[derive(Debug, Clone)]
struct Kept {
    step: u64,
    elapsed: Duration,
    remote: Arc<Remote>,
}

/// Copies of the protocol in a run of an executable, oldest first.
#[derive(Debug, Clone, Default)]
pub(super) struct Copies(VecDeque<Kept>);

impl Copies {
    /// Keeps a copy if the newest one is old.
    pub(super) fn keep(&mut self, step: u64, elapsed: Duration, remote: &Remote) {
        if self.0.back().is_none_or(|kept| elapsed >= kept.elapsed + EVERY) {
            if self.0.len() == MOST {
                self.0.pop_front();
            }
            self.0.push_back(Kept { step, elapsed, remote: Arc::new(remote.clone()) });
        }
    }

    /// Forgets the copies, because another run begins.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Returns the newest copy after at most so many steps.
    fn latest(&self, steps: u64) -> Option<&Kept> {
        self.0.iter().rev().find(|kept| kept.step <= steps)
    }

    /// Returns the copies after at most so many steps.
    fn until(&self, steps: u64) -> Self {
        Self(self.0.iter().filter(|kept| kept.step <= steps).cloned().collect())
    }
}

/// The flight of an executable since its boot. It can be flown again to any of its steps.
#[derive(Debug, Clone)]
pub struct KeptFlight {
    pub(super) run: KeptRun,
    pub(super) feed: FeedConfig,
    /// The steps of the run, and the times of the link and of the vehicle after them.
    pub(super) steps: u64,
    pub(super) elapsed: Duration,
    pub(super) end: SimTime,
    pub(super) earlier: Copies,
}

impl KeptFlight {
    /// Lets a second process, in an empty folder, compute the flight up to this time of the vehicle. `goes_on` gets the time
    /// of the vehicle so far.
    ///
    /// # Errors
    /// Returns the reason if that is before the boot, if the flight is not the same again, or if `goes_on` returns `false`.
    pub fn fly(
        &self,
        until: SimTime,
        folder: PathBuf,
        now: Instant,
        mut goes_on: impl FnMut(SimTime) -> bool,
    ) -> Result<RemoteLink, NotAgain> {
        let step = self.run.step_length();
        let before_end = Duration::from_micros(self.end.0.saturating_sub(until.0));
        let back = (before_end.as_nanos() / step.as_nanos().max(1)) as u64;
        let steps = self.steps.checked_sub(back).ok_or(NotAgain::BeforeBoot)?;
        let kept = self.earlier.latest(steps).filter(|_| steps <= self.run.steps).ok_or(NotAgain::NotKept)?;
        let (mut remote, mut mailbox) = (Remote::clone(&kept.remote), RemoteController::default());
        let time = |of: u64| self.elapsed.saturating_sub(times(step, self.steps.saturating_sub(of)));
        let follow = |done: u64, bytes: &[u8]| {
            if done > kept.step {
                // The first flight has sent and reported the same.
                remote.handle_timeout(time(done - 1));
                while remote.poll_transmit().is_some() {}
                if !bytes.is_empty() {
                    remote.handle(Input::Received(bytes), time(done));
                }
                while remote.poll_event().is_some() {}
                remote.deliver(&mut mailbox, None, None);
            }
            let left = times(step, steps.saturating_sub(done));
            goes_on(SimTime(until.0.saturating_sub(left.as_micros() as u64)))
        };
        let (lockstep, newest) = self.run.clone().compute(steps, folder, follow)?;
        let mut remote = remote.at(place_of(&lockstep));
        let earlier = self.earlier.until(steps);
        // Requests since the copy are unknown here.
        remote.outdate_settings(time(steps));
        let newest = newest.as_ref().map(|packet| &packet[..]);
        let steps = Stepped::resumed(lockstep, self.feed, time(steps), newest);
        Ok(RemoteLink::of_steps((remote, steps), (earlier, until), now))
    }
}

fn times(step: Duration, count: u64) -> Duration {
    step * u32::try_from(count).unwrap_or(u32::MAX)
}

/// Returns the address of the serial port of an executable in simulated time, for sentences.
pub(super) fn place_of(lockstep: &Lockstep) -> String {
    format!("the serial port of process {}", lockstep.id())
}
