//! The clock and the sleeps.

use core::ffi::{c_int, c_uint, c_void};
use core::sync::atomic::AtomicU64;
use core::sync::atomic::Ordering::SeqCst;

use super::libc::{
    CLOCK_PROCESS, CLOCK_REALTIME, CLOCK_REALTIME_COARSE, TIMER_ABSOLUTE, Timespec, Timeval, real,
};
use super::parent::end_step;
use super::{is_active, is_main_thread};

/// The clock at the start, ns. It is not 0, because a program may take that for "not set".
pub(crate) const START_NS: u64 = 1_000_000_000;
/// The calendar time at the start, s: 1 January 2026.
const START_DATE_S: u64 = 1_767_225_600;
/// The advance of the clock with each reading by the main thread, ns.
const READING_NS: u64 = 200;
const SECOND_NS: u64 = 1_000_000_000;

pub(crate) static NOW_NS: AtomicU64 = AtomicU64::new(START_NS);
pub(crate) static HORIZON_NS: AtomicU64 = AtomicU64::new(START_NS);
pub(crate) static STEP_NS: AtomicU64 = AtomicU64::new(0);

/// Advances the clock of the main thread to `until_ns`, step by step as far as the parent allows it.
fn sleep_until(until_ns: u64) {
    while HORIZON_NS.load(SeqCst) < until_ns {
        end_step();
        HORIZON_NS.fetch_add(STEP_NS.load(SeqCst), SeqCst);
    }
    NOW_NS.fetch_max(until_ns, SeqCst);
}

fn date_ns() -> u64 {
    START_DATE_S * SECOND_NS + NOW_NS.load(SeqCst) - START_NS
}

fn duration_ns(time: Timespec) -> u64 {
    (time.s.max(0) as u64).saturating_mul(SECOND_NS).saturating_add(time.ns.max(0) as u64)
}

/// Advances the clock by the cost of a reading, if the main thread reads it.
fn count_reading() {
    if is_main_thread() {
        NOW_NS.fetch_add(READING_NS, SeqCst);
    }
}

/// Replaces the function of this name: all clocks but those of processor time are simulated.
///
/// # Safety
/// `time` is writable, as for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn clock_gettime(id: c_int, time: *mut Timespec) -> c_int {
    if !is_active() || CLOCK_PROCESS.contains(&id) {
        return real!(clock_gettime: fn(c_int, *mut Timespec) -> c_int; id, time);
    }
    count_reading();
    let ns = match id {
        CLOCK_REALTIME | CLOCK_REALTIME_COARSE => date_ns(),
        _ => NOW_NS.load(SeqCst),
    };
    // SAFETY: the caller vouches for it.
    unsafe { *time = Timespec { s: (ns / SECOND_NS) as i64, ns: (ns % SECOND_NS) as i64 } };
    0
}

/// Replaces the function of this name. The thread of the serial ports gets the real time: it ends connections that were
/// silent for two minutes, and simulated minutes pass in a second.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gettimeofday(time: *mut Timeval, zone: *mut c_void) -> c_int {
    if !is_main_thread() || time.is_null() {
        return real!(gettimeofday: fn(*mut Timeval, *mut c_void) -> c_int; time, zone);
    }
    count_reading();
    let us = date_ns() / 1000;
    // SAFETY: the caller vouches for it.
    unsafe { *time = Timeval { s: (us / 1_000_000) as i64, us: (us % 1_000_000) as i64 } };
    0
}

/// Replaces the function of this name.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn time(to: *mut i64) -> i64 {
    if !is_active() {
        return real!(time: fn(*mut i64) -> i64; to);
    }
    let date_s = (date_ns() / SECOND_NS) as i64;
    if !to.is_null() {
        // SAFETY: the caller vouches for it.
        unsafe { *to = date_s };
    }
    date_s
}

/// Replaces the function of this name: a sleep of the main thread takes simulated time only.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nanosleep(length: *const Timespec, left: *mut Timespec) -> c_int {
    if !is_main_thread() {
        return real!(nanosleep: fn(*const Timespec, *mut Timespec) -> c_int; length, left);
    }
    // SAFETY: the caller vouches for it.
    let length_ns = duration_ns(unsafe { *length });
    sleep_until(NOW_NS.load(SeqCst).saturating_add(length_ns));
    0
}

/// Replaces the function of this name, as [`nanosleep`].
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn clock_nanosleep(
    id: c_int,
    flags: c_int,
    length: *const Timespec,
    left: *mut Timespec,
) -> c_int {
    if !is_main_thread() {
        return real!(clock_nanosleep: fn(c_int, c_int, *const Timespec, *mut Timespec) -> c_int; id, flags, length, left);
    }
    // SAFETY: the caller vouches for it.
    let length_ns = duration_ns(unsafe { *length });
    let now_ns = NOW_NS.load(SeqCst);
    let until_ns = match (flags & TIMER_ABSOLUTE != 0, id) {
        (false, _) => now_ns.saturating_add(length_ns),
        (true, CLOCK_REALTIME) => (length_ns + START_NS).saturating_sub(START_DATE_S * SECOND_NS),
        (true, _) => length_ns,
    };
    sleep_until(until_ns.max(now_ns));
    0
}

/// Replaces the function of this name, as [`nanosleep`].
#[unsafe(no_mangle)]
pub extern "C" fn usleep(us: c_uint) -> c_int {
    if !is_main_thread() {
        return real!(usleep: fn(c_uint) -> c_int; us);
    }
    sleep_until(NOW_NS.load(SeqCst) + u64::from(us) * 1000);
    0
}
