//! A simulator that keeps the rules of the public plugin, in simulated wall time.

use std::collections::VecDeque;

use super::{MS, packet};

/// One servo packet a step, one state a step, a wait when there is none.
pub(crate) struct Plugin {
    /// Whether its socket is bound.
    pub(crate) bound: bool,
    pub(crate) paused: bool,
    /// Servo packets that it has not read yet.
    pub(crate) socket: VecDeque<()>,
    online: bool,
    misses: u32,
    pub(crate) steps: u64,
    step_us: u64,
    /// When it began to wait for a packet, µs.
    pub(crate) waiting_since: u64,
}

impl Plugin {
    /// A simulator with steps of a millisecond.
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

    /// The state it sends at `now`, if it completes a step.
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
