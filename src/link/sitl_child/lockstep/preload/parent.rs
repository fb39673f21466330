//! The reports to the parent and its grants.

use core::ffi::c_int;
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicI32, AtomicU16, AtomicU32};

use super::RUN;
use super::clock::NOW_NS;
use super::frames::{FDM_BYTES, GRANT_BYTES, Grant, MOTOR_BYTES, Report};
use super::intake::RC;
use super::libc::{__errno_location, _exit, read, wait_for_change, wake, write};
use super::serial::{SERIAL, serve_serial};
use super::threads::{is_ending, note_wait_for_grant};

/// The pipe with the grants; −1 = the library does nothing.
pub(crate) static GRANTS: AtomicI32 = AtomicI32::new(-1);
/// The pipe for the reports.
pub(crate) static REPORTS: AtomicI32 = AtomicI32::new(-1);

/// The motor packets of the step.
pub(crate) struct Motors {
    /// The UDP port to which the executable sends them.
    pub(crate) port: AtomicU16,
    pub(crate) packets: AtomicU32,
    pub(crate) newest: [AtomicU32; MOTOR_BYTES / 4],
}

pub(crate) static MOTORS: Motors = Motors {
    port: AtomicU16::new(0),
    packets: AtomicU32::new(0),
    newest: [const { AtomicU32::new(0) }; MOTOR_BYTES / 4],
};

/// The number of grants that were read, and the number of those whose data are taken in.
static READ: AtomicU32 = AtomicU32::new(0);
static TAKEN: AtomicU32 = AtomicU32::new(0);

/// Reports that the step is over, and waits until the data of the next grant are taken in.
pub(crate) fn end_step() {
    // Another thread takes the next grant in, perhaps before this thread waits for it.
    let taken = TAKEN.load(SeqCst);
    report();
    while TAKEN.load(SeqCst) == taken {
        wait_for_change(&TAKEN, taken);
    }
}

fn report() {
    let mut motors = [0; MOTOR_BYTES];
    for (bytes, word) in motors.chunks_exact_mut(4).zip(&MOTORS.newest) {
        bytes.copy_from_slice(&word.load(SeqCst).to_ne_bytes());
    }
    let report = Report {
        now_ns: NOW_NS.load(SeqCst),
        motor_packets: MOTORS.packets.swap(0, SeqCst),
        motors,
        run: RUN.load(SeqCst),
        sent: SERIAL.sent.load(SeqCst),
        ports: core::array::from_fn(|port| SERIAL.ports[port].load(SeqCst)),
    };
    let bytes = report.to_bytes();
    let mut done = 0;
    while done < bytes.len() {
        // SAFETY: the rest of the bytes is readable.
        let written =
            unsafe { write(REPORTS.load(SeqCst), bytes[done..].as_ptr().cast(), bytes.len() - done) };
        done += moved(written);
    }
}

/// Lets the main thread go on, waits for the next grant, and has its RC packet and serial data taken in. Returns its state;
/// `None` if the thread must end. The thread of the states calls it when it has taken in the state before.
pub(crate) fn next_state() -> Option<[u8; FDM_BYTES]> {
    let read_before = READ.load(SeqCst);
    if TAKEN.swap(read_before, SeqCst) != read_before {
        wake(&TAKEN);
    }
    let mut bytes = [0; GRANT_BYTES];
    let mut done = 0;
    note_wait_for_grant(true);
    while done < bytes.len() && !is_ending() {
        // SAFETY: the rest of the bytes is writable.
        let got = unsafe { read(GRANTS.load(SeqCst), bytes[done..].as_mut_ptr().cast(), bytes.len() - done) };
        done += moved(got);
    }
    note_wait_for_grant(false);
    if is_ending() {
        return None;
    }
    READ.store(read_before.wrapping_add(1), SeqCst);
    let grant = Grant::from_bytes(&bytes);
    if let Some(rc) = grant.rc {
        RC.deliver(&rc);
    }
    if let Some(totals) = grant.serial {
        serve_serial(totals);
    }
    Some(grant.fdm)
}

/// Returns the number of bytes that a system call moved; 0 if a signal interrupted it. Ends the process without a parent.
fn moved(result: isize) -> usize {
    const INTERRUPTED: c_int = 4;
    // SAFETY: the address of the error of this thread is valid. `_exit` ends the process.
    unsafe {
        if result == 0 || result < 0 && *__errno_location() != INTERRUPTED {
            _exit(0);
        }
    }
    result.max(0) as usize
}
