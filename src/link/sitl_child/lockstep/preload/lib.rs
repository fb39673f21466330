//! The library that is preloaded into a SITL executable to run it in simulated time. It replaces some functions of the C
//! library, so that exactly one thread runs at a time and every step begins with a message of the parent:
//!
//! ```text
//! parent ──Grant──▶ state thread: RC thread and serial thread take their data in, then the state thread its own
//!                   main thread runs until its clock has advanced by a step
//! parent ◀─Report── main thread waits, and the state thread for the next grant
//! ```
//!
//! * The clock is a number. A sleep of the main thread advances it at once, up to the *horizon*; at the horizon the thread
//!   waits for the next grant. A reading by the main thread advances it a little, otherwise a loop that waits for the
//!   clock would never end. Other threads read it without an effect.
//! * State and RC packets arrive in the grant. The sockets for them exist, but carry nothing. Motor packets leave in the
//!   report.
//! * The serial ports are real TCP sockets at ports that the system chooses. Their thread runs only when a grant says so,
//!   until it has taken in what the parent has sent and written what it has.
//!
//! `build.rs` compiles this file on its own. It uses `core` and the C library only, opens no file but `/dev/null`, and no
//! socket: the two pipes to the parent are inherited. Linux on 64-bit processors.
#![no_std]

mod clock;
mod exec;
#[path = "../frames.rs"]
mod frames;
mod intake;
mod libc;
mod parent;
mod serial;
mod sockets;
mod threads;

use core::ffi::{CStr, c_int};
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicU32, AtomicUsize};

use clock::{HORIZON_NS, START_NS, STEP_NS};
use intake::{FDM, RC};
use libc::{
    _exit, CLOSED_ON_EXEC, DUPLICATE_CLOSED_ON_EXEC, READ_WRITE, SET_DESCRIPTOR_FLAGS, close, dup2, fcntl,
    getenv, open, pthread_self, unsetenv,
};
use parent::{GRANTS, MOTORS, REPORTS};
use serial::SERIAL;

/// The variable with the ports of the executable and the length of a step:
/// `fdm,rc,motors,serial,step_ns,boot_ns,reports`, where `reports` is the descriptor of the pipe for the reports. After a
/// restart by `exec`, the descriptor of the pipe with the grants and the number of the run follow.
pub(crate) const SETTINGS: &CStr = c"BETADECK_LOCKSTEP";
pub(crate) const PRELOAD: &CStr = c"LD_PRELOAD";

/// The number of the restarts by `exec`.
pub(crate) static RUN: AtomicU32 = AtomicU32::new(0);
static MAIN_THREAD: AtomicUsize = AtomicUsize::new(0);
#[used]
#[unsafe(link_section = ".init_array")]
static AT_START: extern "C" fn() = start;

/// Reads the settings and takes over standard input, which is the pipe with the grants.
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
    let [fdm, rc, motors, serial, step_ns, boot_ns, reports, grants, run] = numbers;
    exec::keep(settings);
    RUN.store(run as u32, SeqCst);
    FDM.port.store(fdm as u16, SeqCst);
    RC.port.store(rc as u16, SeqCst);
    MOTORS.port.store(motors as u16, SeqCst);
    SERIAL.port.store(serial as u16, SeqCst);
    STEP_NS.store(step_ns, SeqCst);
    HORIZON_NS.store(START_NS + boot_ns, SeqCst);
    // SAFETY: descriptors are numbers, and the paths end with a zero. Programs that the executable starts inherit neither
    // the library nor the pipes.
    unsafe {
        MAIN_THREAD.store(pthread_self(), SeqCst);
        fcntl(reports as c_int, SET_DESCRIPTOR_FLAGS, CLOSED_ON_EXEC);
        REPORTS.store(reports as c_int, SeqCst);
        let grants = if grants > 0 {
            fcntl(grants as c_int, SET_DESCRIPTOR_FLAGS, CLOSED_ON_EXEC);
            grants as c_int
        } else {
            let grants = fcntl(0, DUPLICATE_CLOSED_ON_EXEC, 100);
            let empty = open(c"/dev/null".as_ptr(), READ_WRITE);
            dup2(empty, 0);
            close(empty);
            grants
        };
        unsetenv(PRELOAD.as_ptr());
        unsetenv(SETTINGS.as_ptr());
        GRANTS.store(grants, SeqCst);
    }
}

pub(crate) fn is_active() -> bool {
    GRANTS.load(SeqCst) >= 0
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
