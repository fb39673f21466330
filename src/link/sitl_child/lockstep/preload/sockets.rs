//! The sockets, and the waits for them.

use core::ffi::{c_int, c_void};
use core::sync::atomic::Ordering::SeqCst;

use super::frames::{MOTOR_BYTES, SERIAL_PORTS};
use super::intake::{FDM, Intake, RC};
use super::libc::{
    __errno_location, Address, DESCRIPTORS, FAMILY_INTERNET, LOOPBACK, Set, TRY_AGAIN, Timeval, WORD_BITS,
    real,
};
use super::parent::MOTORS;
use super::serial::SERIAL;
use super::{is_active, is_main_thread};

fn contains(set: *const Set, fd: c_int) -> bool {
    // SAFETY: a set that is not null is readable, and the descriptor is below its size.
    !set.is_null()
        && (0..DESCRIPTORS as c_int).contains(&fd)
        && unsafe { (*set)[fd as usize / WORD_BITS] } >> (fd as usize % WORD_BITS) & 1 == 1
}

/// A set of descriptors of a `select`, of which only the words below the highest descriptor exist.
struct Watched {
    set: *mut Set,
    words: usize,
    wanted: Set,
}

impl Watched {
    fn new(set: *mut Set, count: c_int) -> Self {
        let words = (count.max(0) as usize).div_ceil(WORD_BITS).min(DESCRIPTORS / WORD_BITS);
        let mut wanted = [0; DESCRIPTORS / WORD_BITS];
        if !set.is_null() {
            // SAFETY: the caller of `select` vouches for the words below its highest descriptor.
            unsafe { core::ptr::copy_nonoverlapping(set.cast::<u64>(), wanted.as_mut_ptr(), words) };
        }
        Self { set, words, wanted }
    }

    fn put(&self, value: &Set) {
        if !self.set.is_null() {
            // SAFETY: as in `new`.
            unsafe { core::ptr::copy_nonoverlapping(value.as_ptr(), self.set.cast::<u64>(), self.words) };
        }
    }
}

/// Replaces the function of this name: the threads that take in packets, and that of the serial ports, wait here for their
/// turn.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn select(
    count: c_int,
    readable: *mut Set,
    writable: *mut Set,
    failed: *mut Set,
    timeout: *mut Timeval,
) -> c_int {
    if !is_active() || is_main_thread() {
        return real!(select: fn(c_int, *mut Set, *mut Set, *mut Set, *mut Timeval) -> c_int; count, readable, writable, failed, timeout);
    }
    let waits_for = |intake: &Intake| {
        let fd = intake.fd.load(SeqCst);
        fd >= 0 && count == fd + 1 && contains(readable, fd)
    };
    if let Some(intake) = [&FDM, &RC].into_iter().find(|intake| waits_for(intake)) {
        return c_int::from(intake.wait());
    }
    let sets = [readable, writable, failed].map(|set| Watched::new(set, count));
    loop {
        if !SERIAL.has_turn.load(SeqCst) {
            SERIAL.place.wait();
            // A pass through its loop, in which it finds what the main thread has written, or that it must end.
            sets.iter().for_each(|set| set.put(&[0; DESCRIPTORS / WORD_BITS]));
            return 0;
        }
        let is_complete = SERIAL.seen.reaches(&SERIAL.expected);
        let mut longest = Timeval { s: 0, us: if is_complete { 0 } else { 1000 } };
        sets.iter().for_each(|set| set.put(&set.wanted));
        let ready = real!(select: fn(c_int, *mut Set, *mut Set, *mut Set, *mut Timeval) -> c_int; count, readable, writable, failed, &raw mut longest);
        if ready > 0 {
            return ready;
        }
        if is_complete {
            SERIAL.has_turn.store(false, SeqCst);
        }
    }
}

/// Replaces the function of this name: packets of the simulator come from the grant.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn recvfrom(
    fd: c_int,
    bytes: *mut c_void,
    size: usize,
    flags: c_int,
    from: *mut Address,
    from_size: *mut u32,
) -> isize {
    if let Some(intake) = [&FDM, &RC].into_iter().find(|intake| is_active() && intake.fd.load(SeqCst) == fd) {
        if !from.is_null() {
            // SAFETY: the caller vouches for it.
            unsafe { *from = Address { family: FAMILY_INTERNET, port: 0, host: LOOPBACK, zero: [0; 8] } };
        }
        // SAFETY: the caller vouches for the bytes, and the address of the error is valid.
        return match unsafe { intake.take(bytes.cast(), size) } {
            Some(size) => size as isize,
            None => unsafe {
                *__errno_location() = TRY_AGAIN;
                -1
            },
        };
    }
    real!(recvfrom: fn(c_int, *mut c_void, usize, c_int, *mut Address, *mut u32) -> isize; fd, bytes, size, flags, from, from_size)
}

/// Replaces the function of this name: motor packets leave in the report, other packets of the executable not at all.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sendto(
    fd: c_int,
    bytes: *const c_void,
    size: usize,
    flags: c_int,
    to: *const Address,
    to_size: u32,
) -> isize {
    // SAFETY: the caller vouches for the address.
    if !is_active() || to.is_null() || unsafe { (*to).family } != FAMILY_INTERNET {
        return real!(sendto: fn(c_int, *const c_void, usize, c_int, *const Address, u32) -> isize; fd, bytes, size, flags, to, to_size);
    }
    // SAFETY: as above.
    if u16::from_be(unsafe { (*to).port }) == MOTORS.port.load(SeqCst) && size == MOTOR_BYTES {
        for (index, word) in MOTORS.newest.iter().enumerate() {
            // SAFETY: the caller vouches for the bytes, of which there are as many as in the words.
            word.store(unsafe { bytes.cast::<u32>().add(index).read_unaligned() }, SeqCst);
        }
        MOTORS.packets.fetch_add(1, SeqCst);
    }
    size as isize
}

/// Replaces the function of this name: the executable gets ports that the system chooses, so that several fly at once.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bind(fd: c_int, address: *const Address, size: u32) -> c_int {
    // SAFETY: the caller vouches for the address.
    if !is_active() || address.is_null() || unsafe { (*address).family } != FAMILY_INTERNET {
        return real!(bind: fn(c_int, *const Address, u32) -> c_int; fd, address, size);
    }
    // SAFETY: as above.
    let port = u16::from_be(unsafe { (*address).port });
    let chosen = Address { family: FAMILY_INTERNET, port: 0, host: LOOPBACK, zero: [0; 8] };
    let result = real!(bind: fn(c_int, *const Address, u32) -> c_int; fd, &raw const chosen, size_of::<Address>() as u32);
    for intake in [&FDM, &RC] {
        if port == intake.port.load(SeqCst) {
            intake.fd.store(fd, SeqCst);
        }
    }
    let serial = usize::from(port.wrapping_sub(SERIAL.port.load(SeqCst)));
    if serial < SERIAL_PORTS {
        SERIAL.listeners[serial].store(fd, SeqCst);
    }
    result
}
