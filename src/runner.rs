//! The runner of flights: paced or free, with an embedded or a remote flight controller, observed by subscribers.
//!
//! A round has three parts: the due ticks, the exchange with a remote flight controller, and a rest until the next tick
//! is due. A flight controller in simulated time exchanges after each tick. Headless flights run with [`Runner::fly`]. The session runs its own rounds, because users and clients act
//! between them.
#![allow(clippy::disallowed_methods, reason = "this is where wall time meets simulated time")]

mod pacer;
pub mod parallel;
mod subscriber;

use std::time::{Duration, Instant};

use crate::events::{Event, SessionEvent};
use crate::fc::{EXCHANGE_PAUSE, RemoteLink, RemoteNotice};

pub use pacer::{Pacer, SPEED_RANGE};
pub use subscriber::{Flying, Subscriber, tick};

/// The most ticks between two looks at the clock and at a request to stop, without a remote flight controller.
const FREE_SLICE: u64 = 4096;
/// The same with a remote flight controller.
const REMOTE_SLICE: u64 = 50;
/// The longest rest of a paced flight.
const MAX_REST: Duration = Duration::from_millis(1);

/// The lost real time from which a flight counts as disturbed: the motors did not follow the craft.
const DISTURBING: Duration = Duration::from_millis(500);

/// Relates the time of a vehicle to the wall clock, and owns the link to its remote flight controller.
#[derive(Debug)]
pub struct Runner {
    /// The due ticks.
    pub pacer: Pacer,
    /// The link to the remote flight controller, if there is one.
    pub link: Option<RemoteLink>,
    step_us: u64,
    /// The most ticks of a round.
    slice: u64,
    started: Instant,
}

/// The reason why a flight did not reach its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stopped {
    /// The user stopped the flight.
    Interrupted,
    /// A subscriber cannot go on.
    BySubscriber,
    /// The remote flight controller is unusable. The text is a sentence.
    Failed(String),
}

impl Runner {
    /// Returns a runner for steps of `step_us` microseconds at `speed` times real time (infinite: as fast as
    /// possible). `link` leads to the vehicle's flight controller, if that is remote.
    pub fn new(step_us: u64, speed: f64, link: Option<RemoteLink>) -> Self {
        let slice = if link.is_some() { REMOTE_SLICE } else { FREE_SLICE };
        Self { pacer: Pacer::new(step_us, speed), link, step_us, slice, started: Instant::now() }
    }

    /// Returns the same runner with at most `slice` ticks in a round.
    pub fn with_slice(self, slice: u64) -> Self {
        Self { slice, ..self }
    }

    /// Returns the link to the remote flight controller, if there is one.
    pub fn link(&self) -> Option<&RemoteLink> {
        self.link.as_ref()
    }

    /// Returns the link to the remote flight controller, for its record.
    pub fn link_mut(&mut self) -> Option<&mut RemoteLink> {
        self.link.as_mut()
    }

    /// Returns the time of the link's protocol, for its deadlines: simulated time, or wall time.
    pub fn protocol_time(&self) -> Duration {
        self.link.as_ref().map_or_else(|| self.elapsed(), |link| link.protocol_time(Instant::now()))
    }

    /// Begins to count the real time that a flight loses.
    pub fn begin_flight(&mut self) {
        self.pacer.take_lost();
    }

    /// Returns the addition to the verdict of a flight that a stalled machine or firmware has disturbed; an empty text for
    /// any other flight. Simulated time loses nothing.
    pub fn disturbance(&mut self) -> String {
        let is_on_wall_clock = self.link.as_ref().is_some_and(|link| !link.is_in_steps());
        let lost = self.pacer.take_lost();
        if is_on_wall_clock { disturbed_by(lost) } else { String::new() }
    }

    /// Returns the wall time since the runner was created.
    pub fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    /// Returns the number of ticks that are due at `now`, counted from the start.
    pub fn due(&mut self, now: Duration) -> u64 {
        let speed = self.pacer.speed();
        let most = self.link.as_ref().map(|link| link.most_steps(self.step_us, speed, Instant::now()));
        self.pacer.due(now, self.slice.min(most.unwrap_or(u64::MAX)))
    }

    /// Returns the time until the next round at `now`, at most `longest`. A remote flight controller that this
    /// program feeds gets its states at the rate of the steps.
    pub fn rest(&self, now: Duration, longest: Duration) -> Duration {
        let Some(link) = &self.link else { return longest };
        if link.is_in_steps() {
            return match self.pacer.next_due() {
                Some(due) => due.saturating_sub(now).min(longest),
                None if self.pacer.is_paused() => longest,
                None => Duration::ZERO,
            };
        }
        match self.pacer.next_due() {
            Some(_) if link.is_fed() && self.pacer.is_behind() => EXCHANGE_PAUSE,
            Some(due) if link.is_fed() => due.saturating_sub(now),
            _ => link.pause(Instant::now()).map_or(longest, |pause| pause.min(longest)),
        }
    }

    /// Flies to the end.
    ///
    /// # Errors
    /// Returns the reason why the flight did not reach its end.
    pub fn fly<F: Flying>(
        &mut self,
        flight: &mut F,
        subscriber: &mut impl Subscriber<F>,
        is_stopped: impl Fn() -> bool,
    ) -> Result<F::End, Stopped> {
        loop {
            if let Some(end) = self.round(flight, subscriber, &is_stopped)? {
                return Ok(end);
            }
        }
    }

    /// Runs one round of at most one tick. What its caller decides after it depends on no clock: a longer round ends early if
    /// the machine is busy.
    ///
    /// # Errors
    /// Returns the reason why the flight does not go on.
    pub fn single_round<F: Flying>(
        &mut self,
        flight: &mut F,
        subscriber: &mut impl Subscriber<F>,
        is_stopped: impl Fn() -> bool,
    ) -> Result<Option<F::End>, Stopped> {
        let slice = std::mem::replace(&mut self.slice, 1);
        let end = self.round(flight, subscriber, is_stopped);
        self.slice = slice;
        end
    }

    /// Runs one round. Returns the end if the flight is over.
    ///
    /// # Errors
    /// Returns the reason why the flight does not go on.
    pub fn round<F: Flying>(
        &mut self,
        flight: &mut F,
        subscriber: &mut impl Subscriber<F>,
        is_stopped: impl Fn() -> bool,
    ) -> Result<Option<F::End>, Stopped> {
        let due = self.due(self.elapsed());
        let is_in_steps = self.link.as_ref().is_some_and(RemoteLink::is_in_steps);
        for _ in 0..due {
            let end = tick(flight, subscriber);
            if !subscriber.goes_on() {
                return Err(Stopped::BySubscriber);
            }
            if end.is_some() {
                return Ok(end);
            }
            if is_in_steps {
                self.exchange(flight, subscriber)?;
                if self.link.as_ref().is_some_and(RemoteLink::is_busy) {
                    break;
                }
            }
        }
        if is_stopped() {
            return Err(Stopped::Interrupted);
        }
        if !is_in_steps || due == 0 {
            self.exchange(flight, subscriber)?;
        }
        if self.link.is_some() || due < self.slice {
            subscriber.before_rest();
            std::thread::sleep(self.rest(self.elapsed(), MAX_REST));
        }
        if subscriber.goes_on() { Ok(None) } else { Err(Stopped::BySubscriber) }
    }

    /// Exchanges the results of the ticks with the remote flight controller, and reports the notices about it.
    fn exchange<F: Flying>(
        &mut self,
        flight: &mut F,
        subscriber: &mut impl Subscriber<F>,
    ) -> Result<(), Stopped> {
        let Some(link) = &mut self.link else { return Ok(()) };
        for notice in link.exchange(flight.vehicle_mut(), None, Instant::now()) {
            if let RemoteNotice::Failed(sentence) = notice {
                return Err(Stopped::Failed(sentence));
            }
            let time = flight.vehicle().time();
            subscriber.event(&Event { time, kind: SessionEvent::Remote(notice) });
        }
        Ok(())
    }
}

/// Returns the addition to the verdict of a flight on the wall clock that has lost this much time.
fn disturbed_by(lost: Duration) -> String {
    if lost < DISTURBING {
        return String::new();
    }
    let lost_s = lost.as_secs_f64();
    format!("; disturbed: the machine or the firmware stalled, and {lost_s:.1} s of real time were lost")
}

#[cfg(test)]
mod tests;
