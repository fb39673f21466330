//! A simulator that keeps the rules of the public plugin, in simulated wall time.

use std::collections::VecDeque;

use super::{MS, packet};

/// A plugin that takes one servo packet and sends one state per step. It waits if there is no packet.
pub(crate) struct Plugin {
    /// `true` once its socket is bound.
    pub(crate) bound: bool,
    pub(crate) paused: bool,
    /// The servo packets that it has not read yet.
    pub(crate) socket: VecDeque<()>,
    online: bool,
    misses: u32,
    pub(crate) steps: u64,
    step_us: u64,
    /// The time at which it began to wait for a packet, µs.
    pub(crate) waiting_since: u64,
}

impl Plugin {
    /// Creates a simulator with steps of a millisecond.
    pub(crate) fn new() -> Self {
        Self::with_steps(MS)
    }

    pub(crate) fn with_steps(step_us: u64) -> Self {
        Self {
            bound: false,
            paused: false,
            socket: VecDeque::new(),
            online: false,
            misses: 0,
            steps: 0,
            step_us,
            waiting_since: 0,
        }
    }

    /// Returns the state that it sends at `now`, if it completes a step.
    pub(crate) fn run(&mut self, now: u64) -> Option<Vec<u8>> {
        if !self.bound || self.paused || now < self.waiting_since {
            return None;
        }
        if self.socket.pop_front().is_some() {
            self.online = true;
            self.misses = 0;
        } else {
            let patience = if self.online { 1000 * MS } else { MS };
            if now - self.waiting_since < patience {
                return None;
            }
            self.misses += 1;
            if self.misses > 5 {
                self.online = false;
            }
        }
        self.waiting_since = now + self.step_us;
        self.steps += 1;
        self.online.then(|| packet((self.steps - 1) as f64 * self.step_us as f64 * 1e-6))
    }
}
