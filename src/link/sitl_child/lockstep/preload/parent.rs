//! The reports to the parent and its grants.

use core::ptr::null_mut;
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicI32, AtomicPtr, AtomicU16, AtomicU32};

use super::RUN;
use super::clock::NOW_NS;
use super::frames::{MOTOR_BYTES, Page, Report};
use super::intake::{FDM, RC};
use super::libc::{
    _exit, MAP_SHARED, READABLE_WRITABLE, Scope, getppid, mmap, sched_yield, wait_for_grant, wake,
};
use super::serial::{SERIAL, serve_serial};

/// The memory that the parent shares; null = the library does nothing.
static PAGE: AtomicPtr<Page> = AtomicPtr::new(null_mut());
/// Its descriptor, which is kept for a restart by `exec`.
pub(crate) static PAGE_FILE: AtomicI32 = AtomicI32::new(-1);

/// The process that gives the grants.
static PARENT: AtomicI32 = AtomicI32::new(0);

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

/// Maps the memory of this descriptor.
pub(crate) fn open_page(descriptor: i32) {
    const FAILED: usize = usize::MAX;
    // SAFETY: the system chooses an address that nothing uses.
    let page = unsafe { mmap(null_mut(), size_of::<Page>(), READABLE_WRITABLE, MAP_SHARED, descriptor, 0) };
    if page as usize != FAILED {
        PAGE_FILE.store(descriptor, SeqCst);
        // SAFETY: has no conditions.
        PARENT.store(unsafe { getppid() }, SeqCst);
        PAGE.store(page.cast(), SeqCst);
    }
}

/// Returns the memory that the parent shares; `None` if the library does nothing.
pub(crate) fn page() -> Option<&'static Page> {
    // SAFETY: the mapping stays, and its numbers are atomic.
    unsafe { PAGE.load(SeqCst).as_ref() }
}

/// Reports that the step is over, waits for the next grant, and has the threads of the executable take its data in.
pub(crate) fn end_step() {
    let Some(page) = page() else { return };
    let granted = page.granted.load(SeqCst);
    page.put_report(&report());
    if page.program_sleeps.load(SeqCst) != 0 {
        wake(&page.reported, Scope::Shared);
    }
    for _ in 0..page.yields.load(SeqCst) {
        if page.granted.load(SeqCst) != granted {
            break;
        }
        // SAFETY: has no conditions.
        unsafe { sched_yield() };
    }
    while page.granted.load(SeqCst) == granted {
        // A grant that comes in between ends the wait, because it has changed the number.
        page.executable_sleeps.store(1, SeqCst);
        wait_for_grant(&page.granted, granted);
        page.executable_sleeps.store(0, SeqCst);
        // SAFETY: has no conditions, and ends the process.
        unsafe {
            if page.granted.load(SeqCst) == granted && getppid() != PARENT.load(SeqCst) {
                _exit(0);
            }
        }
    }
    let grant = page.grant();
    if let Some(rc) = grant.rc {
        RC.deliver(&rc);
    }
    if let Some(totals) = grant.serial {
        serve_serial(totals);
    }
    FDM.deliver(&grant.fdm);
}

fn report() -> Report {
    let mut motors = [0; MOTOR_BYTES];
    for (bytes, word) in motors.chunks_exact_mut(4).zip(&MOTORS.newest) {
        bytes.copy_from_slice(&word.load(SeqCst).to_ne_bytes());
    }
    Report {
        now_ns: NOW_NS.load(SeqCst),
        motor_packets: MOTORS.packets.swap(0, SeqCst),
        motors,
        run: RUN.load(SeqCst),
        sent: SERIAL.sent.load(SeqCst),
        ports: core::array::from_fn(|port| SERIAL.ports[port].load(SeqCst)),
    }
}
