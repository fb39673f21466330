//! The end of the executable's threads: before it restarts, its main thread waits for the others, which wait for their turn.

use core::ffi::{c_int, c_void};
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicBool, AtomicUsize};

use super::intake::RC;
use super::is_main_thread;
use super::libc::{CLOCK_REALTIME, Timespec, pthread_kill, pthread_self, real, siginterrupt, signal, wake};
use super::serial::SERIAL;

/// A signal that the executable does not use. It interrupts the read of the thread of the states.
const SIGNAL: c_int = 23;
const TIMED_OUT: c_int = 110;
const MILLISECOND_NS: i64 = 1_000_000;
const SECOND_NS: i64 = 1_000_000_000;

static IS_ENDING: AtomicBool = AtomicBool::new(false);
/// The thread that waits for a grant; 0 = none.
static WAITING: AtomicUsize = AtomicUsize::new(0);

/// Returns `true` once the main thread waits for the end of the others. No thread waits for its turn any more.
pub(crate) fn is_ending() -> bool {
    IS_ENDING.load(SeqCst)
}

/// Records that this thread waits for a grant, or does no longer.
pub(crate) fn note_wait_for_grant(waits: bool) {
    // SAFETY: has no conditions.
    WAITING.store(if waits { unsafe { pthread_self() } } else { 0 }, SeqCst);
}

extern "C" fn interrupted(_: c_int) {}

/// Replaces the function of this name: if the main thread waits for another thread, all threads go on.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pthread_join(thread: usize, result: *mut *mut c_void) -> c_int {
    if !is_main_thread() {
        return real!(pthread_join: fn(usize, *mut *mut c_void) -> c_int; thread, result);
    }
    IS_ENDING.store(true, SeqCst);
    // SAFETY: the handler does nothing.
    unsafe {
        signal(SIGNAL, interrupted as extern "C" fn(c_int) as usize);
        siginterrupt(SIGNAL, 1);
    }
    loop {
        // A wake-up before the thread waits has no effect, so it is repeated.
        wake(&SERIAL.wanted);
        RC.wake();
        let waiting = WAITING.load(SeqCst);
        if waiting != 0 {
            // SAFETY: a thread that waits exists.
            unsafe { pthread_kill(waiting, SIGNAL) };
        }
        let mut until = Timespec { s: 0, ns: 0 };
        real!(clock_gettime: fn(c_int, *mut Timespec) -> c_int; CLOCK_REALTIME, &raw mut until);
        until.ns += MILLISECOND_NS;
        if until.ns >= SECOND_NS {
            until = Timespec { s: until.s + 1, ns: until.ns - SECOND_NS };
        }
        let joined = real!(pthread_timedjoin_np: fn(usize, *mut *mut c_void, *const Timespec) -> c_int; thread, result, &raw const until);
        if joined != TIMED_OUT {
            return joined;
        }
    }
}
