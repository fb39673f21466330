//! The turns of the executable's threads. Exactly one thread runs at a time: the main thread gives each of the others its
//! turn at the place at which it waits.

use core::ptr::null_mut;
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicPtr, AtomicU32};

use super::guests::{self, Guest};
use super::libc::{Scope, wait_for_change, wait_until, wake};
use super::threads::{is_ending, note_wait_for_turn};

/// The states of a place.
const EMPTY: u32 = 0;
const WAITING: u32 = 1;

/// A place at which one thread of the executable waits for its turn.
pub(crate) struct Place {
    /// [`EMPTY`] or [`WAITING`].
    state: AtomicU32,
    /// The guest that waits; null = a thread that the system runs.
    guest: AtomicPtr<Guest>,
}

impl Place {
    pub(crate) const fn new() -> Self {
        Self { state: AtomicU32::new(EMPTY), guest: AtomicPtr::new(null_mut()) }
    }

    /// Waits for the turn of this thread. Returns `false` if the thread must end.
    pub(crate) fn wait(&self) -> bool {
        note_wait_for_turn();
        let guest = guests::current();
        self.guest.store(guest.map_or(null_mut(), |guest| core::ptr::from_ref(guest).cast_mut()), SeqCst);
        self.state.store(WAITING, SeqCst);
        if let Some(guest) = guest {
            guest.leave();
            self.state.store(EMPTY, SeqCst);
            return !is_ending();
        }
        wake(&self.state, Scope::Private);
        while self.state.load(SeqCst) == WAITING && !is_ending() {
            wait_for_change(&self.state, WAITING);
        }
        self.state.store(EMPTY, SeqCst);
        !is_ending()
    }

    /// Waits until a thread waits here. A guest waits already, or never will.
    pub(crate) fn wait_for_thread(&self) {
        wait_until(&self.state, WAITING);
    }

    /// Lets the thread that waits here run until it waits again. Called by the main thread.
    pub(crate) fn run(&self) {
        self.wait_for_thread();
        // SAFETY: guests are static.
        if let Some(guest) = unsafe { self.guest.load(SeqCst).as_ref() } {
            return guest.enter();
        }
        self.state.store(EMPTY, SeqCst);
        wake(&self.state, Scope::Private);
        self.wait_for_thread();
    }

    /// Wakes its thread, so that it looks for the end.
    pub(crate) fn wake(&self) {
        wake(&self.state, Scope::Private);
    }
}
