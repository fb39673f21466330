//! The library that is preloaded into a SITL executable to run it in simulated time. It replaces some functions of the C
//! library, so that exactly one thread runs at a time and every step begins with a message of the parent:
//!
//! ```text
//! parent ──Grant──▶ main thread: gives the RC thread, the serial thread and the state thread their turns, in which they
//!                   take their data in, and runs until its clock has advanced by a step
//! parent ◀─Report── main thread waits
//! ```
//!
//! * The clock is a number. A sleep of the main thread advances it at once, up to the *horizon*; at the horizon the thread
//!   waits for the next grant. A reading by the main thread advances it a little, otherwise a loop that waits for the
//!   clock would never end. Other threads read it without an effect.
//! * State and RC packets arrive in the grant. The sockets for them exist, but carry nothing. Motor packets leave in the
//!   report.
//! * The serial ports are real TCP sockets at ports that the system chooses. Their thread runs only when a grant says so,
//!   until it has taken in what the parent has sent and written what it has.
//! * Grants and reports are in memory that the parent shares, and wake the other side by a futex. The code of the other
//!   threads runs on the main thread (`guests`), or, if the parent says so, on threads of their own.
//!
//! `build.rs` compiles this file on its own. It uses `core` and the C library only, and opens no file and no socket: the
//! memory of the parent is inherited. Linux on 64-bit processors.
#![no_std]

mod clock;
mod exec;
#[path = "../frames.rs"]
mod frames;
mod guests;
mod intake;
mod libc;
mod local;
mod parent;
mod serial;
mod sockets;
mod threads;
mod turns;

use core::ffi::{CStr, c_int};
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicU32, AtomicUsize};

use clock::{HORIZON_NS, START_NS, STEP_NS};
use intake::{FDM, RC};
use libc::{_exit, CLOSED_ON_EXEC, SET_DESCRIPTOR_FLAGS, fcntl, getenv, pthread_self, unsetenv};
use parent::MOTORS;
use serial::SERIAL;
use threads::HAS_OWN_THREADS;

/// The variable with the ports of the executable and the length of a step:
/// `fdm,rc,motors,serial,step_ns,boot_ns,own_threads,page`, where `own_threads` is 1 if its threads run on their own, and `page`
/// is the descriptor of the shared memory. After a restart by `exec`, the number of the run follows.
pub(crate) const SETTINGS: &CStr = c"BETADECK_LOCKSTEP";
pub(crate) const PRELOAD: &CStr = c"LD_PRELOAD";

/// The number of the restarts by `exec`.
pub(crate) static RUN: AtomicU32 = AtomicU32::new(0);
static MAIN_THREAD: AtomicUsize = AtomicUsize::new(0);
#[used]
#[unsafe(link_section = ".init_array")]
static AT_START: extern "C" fn() = start;

/// Reads the settings and maps the shared memory.
extern "C" fn start() {
    // SAFETY: the name ends with a zero, and the value, if any, too.
    let settings = unsafe {
        let text = getenv(SETTINGS.as_ptr());
        if text.is_null() {
            return;
        }
        CStr::from_ptr(text)
    };
    let mut numbers = [0_u64; 9];
    for (number, text) in numbers.iter_mut().zip(settings.to_bytes().split(|byte| *byte == b',')) {
        for digit in text {
            *number = number.wrapping_mul(10).wrapping_add(u64::from(digit.wrapping_sub(b'0')));
        }
    }
    let [fdm, rc, motors, serial, step_ns, boot_ns, own_threads, page, run] = numbers;
    exec::keep(settings);
    RUN.store(run as u32, SeqCst);
    FDM.port.store(fdm as u16, SeqCst);
    RC.port.store(rc as u16, SeqCst);
    MOTORS.port.store(motors as u16, SeqCst);
    SERIAL.port.store(serial as u16, SeqCst);
    STEP_NS.store(step_ns, SeqCst);
    HORIZON_NS.store(START_NS + boot_ns, SeqCst);
    HAS_OWN_THREADS.store(own_threads != 0, SeqCst);
    local::prepare();
    // SAFETY: descriptors are numbers, and the names end with a zero. Programs that the executable starts inherit neither the
    // library nor the memory.
    unsafe {
        MAIN_THREAD.store(pthread_self(), SeqCst);
        fcntl(page as c_int, SET_DESCRIPTOR_FLAGS, CLOSED_ON_EXEC);
        unsetenv(PRELOAD.as_ptr());
        unsetenv(SETTINGS.as_ptr());
    }
    parent::open_page(page as c_int);
}

pub(crate) fn is_active() -> bool {
    parent::page().is_some()
}

pub(crate) fn is_main_thread() -> bool {
    // SAFETY: has no conditions.
    is_active() && unsafe { pthread_self() } == MAIN_THREAD.load(SeqCst)
}

#[panic_handler]
fn panicked(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: ends the process.
    unsafe { _exit(134) }
}
