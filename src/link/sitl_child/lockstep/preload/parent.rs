//! The reports to the parent and its grants.

use core::ffi::c_int;
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicU16, AtomicU32};

use super::clock::NOW_NS;
use super::frames::{GRANT_BYTES, Grant, MOTOR_BYTES, Report};
use super::intake::{FDM, RC};
use super::libc::{__errno_location, _exit, read, write};
use super::serial::{SERIAL, serve_serial};
use super::{PARENT, RUN};

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
/// Reports to the parent that the step is over.
pub(crate) fn report() {
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
            unsafe { write(PARENT.load(SeqCst), bytes[done..].as_ptr().cast(), bytes.len() - done) };
        done += moved(written);
    }
}

/// Waits for the next grant, and has its data taken in.
pub(crate) fn take_grant() {
    let mut bytes = [0; GRANT_BYTES];
    let mut done = 0;
    while done < bytes.len() {
        // SAFETY: the rest of the bytes is writable.
        let got = unsafe { read(PARENT.load(SeqCst), bytes[done..].as_mut_ptr().cast(), bytes.len() - done) };
        done += moved(got);
    }
    let grant = Grant::from_bytes(&bytes);
    if let Some(rc) = grant.rc {
        RC.deliver(&rc);
    }
    if let Some(totals) = grant.serial {
        serve_serial(totals);
    }
    FDM.deliver(&grant.fdm);
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
