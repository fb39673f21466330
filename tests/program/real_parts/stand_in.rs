//! A stand-in for the public executable, with its measured behaviour and its faults: one TCP client, a command line
//! that stays open for the next client, a clock that follows the stamps, a crash if a state arrives before it has
//! booted, and a `save` that ends the program. It flies nothing: its motors never turn.

pub(crate) mod cli;
pub(crate) mod msp;
pub(crate) mod packet;
pub(crate) mod process;
pub(crate) mod program;
pub(crate) mod receiver;
pub(crate) mod serial;

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::JoinHandle;
use std::time::Duration;

use cli::Memory;
use program::{End, Ports, Shared, Sockets, live};
use receiver::Seen;
use test_support::free_port;

/// The time until it is started again.
const RESTART: Duration = Duration::from_millis(300);

/// A stand-in that runs in this process, as if another program had started it. It is started again when it reboots.
pub(crate) struct StandIn {
    pub(crate) ports: Ports,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Vec<End>>>,
}

impl StandIn {
    /// Starts it. It sends its motors to these ports.
    pub(crate) fn start(raw: u16, motors: u16) -> Self {
        let mut sockets = Sockets::bind(Ports { raw, motors, fdm: 0, rc: 0, tcp: 0 }).unwrap();
        sockets.listen().unwrap();
        let (ports, shared) = (sockets.ports(), Arc::new(Shared::default()));
        let seen = Arc::clone(&shared);
        let thread = std::thread::spawn(move || {
            let (mut memory, mut ends) = (Memory::new(), Vec::new());
            while ends.last() != Some(&End::Stopped) {
                if !ends.is_empty() {
                    // It is started again. The packets that arrived meanwhile are lost.
                    std::thread::sleep(RESTART);
                    sockets.forget();
                }
                // The first run has booted long ago.
                ends.push(live(&mut sockets, &mut memory, !ends.is_empty(), &seen));
            }
            ends
        });
        Self { ports, shared, thread: Some(thread) }
    }

    /// Returns the statistics of the packets received since it booted.
    pub(crate) fn seen(&self) -> Seen {
        *self.shared.seen.lock().unwrap()
    }

    /// Returns the error of its clock against the wall clock, µs.
    pub(crate) fn clock_error_us(&self) -> f64 {
        *self.shared.clock_error_us.lock().unwrap()
    }

    /// Makes it hang, or lets it go on.
    pub(crate) fn hang(&self, hangs: bool) {
        self.shared.hangs.store(hangs, Ordering::Relaxed);
    }

    /// Stops it and returns the end of each of its runs.
    pub(crate) fn stop(mut self) -> Vec<End> {
        self.shared.stop.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap()
    }
}

impl Drop for StandIn {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A failed test has already reported the reason.
            drop(thread.join());
        }
    }
}

/// Returns free ports.
pub(crate) fn free_ports() -> Ports {
    let [raw, motors, fdm, rc, tcp] = std::array::from_fn(|_| free_port());
    Ports { raw, motors, fdm, rc, tcp }
}
