//! The beginning and the end of the executable's threads. The main thread goes on once a thread that it has created waits for
//! its turn, and before a restart it waits for the end of the others.

use core::ffi::{c_int, c_void};
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize};

use super::intake::{FDM, RC};
use super::libc::{CLOCK_REALTIME, Timespec, pthread_self, real};
use super::serial::SERIAL;
use super::{guests, is_main_thread};

const TIMED_OUT: c_int = 110;
const MILLISECOND_NS: i64 = 1_000_000;
const SECOND_NS: i64 = 1_000_000_000;
/// The number of looks for the first wait of another thread, and the pause between them, ns. A thread that never waits for
/// a turn costs this time.
const LOOKS: u32 = 5000;
const LOOK_NS: i64 = 50_000;

/// `true` if the executable's threads run on their own.
pub(crate) static HAS_OWN_THREADS: AtomicBool = AtomicBool::new(false);

/// The thread for whose end the main thread waits; 0 = none.
static JOINED: AtomicUsize = AtomicUsize::new(0);

/// The number of times that threads came to wait for their turn.
static WAITS: AtomicU32 = AtomicU32::new(0);

/// Records that a thread comes to wait for its turn.
pub(crate) fn note_wait_for_turn() {
    WAITS.fetch_add(1, SeqCst);
}

/// Replaces the function of this name: the main thread goes on once the new thread waits for its turn. Upstream's thread of
/// the serial ports walks through their list while the main thread adds to it: a port that is not listening yet is lost.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pthread_create(
    thread: *mut usize,
    attributes: *const c_void,
    start: *const c_void,
    argument: *mut c_void,
) -> c_int {
    let is_guest = is_main_thread() && !HAS_OWN_THREADS.load(SeqCst);
    if let Some(result) = is_guest.then(|| guests::create(thread, attributes, start, argument)).flatten() {
        return result;
    }
    let before = WAITS.load(SeqCst);
    let result = real!(pthread_create: fn(*mut usize, *const c_void, *const c_void, *mut c_void) -> c_int; thread, attributes, start, argument);
    if result == 0 && is_main_thread() {
        for _ in 0..LOOKS {
            if WAITS.load(SeqCst) != before {
                break;
            }
            let pause = Timespec { s: 0, ns: LOOK_NS };
            real!(nanosleep: fn(*const Timespec, *mut Timespec) -> c_int; &raw const pause, core::ptr::null_mut());
        }
    }
    result
}

/// Returns `true` once the main thread waits for the end of this thread, which then waits for no turn any more. The others
/// still wait, so that what the threads print at their ends has one order.
pub(crate) fn is_ending() -> bool {
    // SAFETY: has no conditions.
    JOINED.load(SeqCst) == unsafe { pthread_self() }
}

/// Replaces the function of this name: if the main thread waits for another thread, that thread goes on.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pthread_join(thread: usize, result: *mut *mut c_void) -> c_int {
    if !is_main_thread() {
        return real!(pthread_join: fn(usize, *mut *mut c_void) -> c_int; thread, result);
    }
    JOINED.store(thread, SeqCst);
    guests::finish(thread);
    loop {
        // A wake-up before the thread waits has no effect, so it is repeated.
        for place in [&FDM.place, &RC.place, &SERIAL.place] {
            place.wake();
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
