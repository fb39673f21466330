//! The parts of the C library and of the kernel that this library uses.

use core::ffi::{CStr, c_char, c_int, c_long, c_void};
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicU32, AtomicUsize};

#[repr(C)]
#[derive(Clone, Copy)]
pub struct Timespec {
    pub(crate) s: i64,
    pub(crate) ns: i64,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct Timeval {
    pub(crate) s: i64,
    pub(crate) us: i64,
}

/// An Internet address, as the kernel expects it: numbers in network byte order.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Address {
    pub(crate) family: u16,
    pub(crate) port: u16,
    pub(crate) host: u32,
    pub(crate) zero: [u8; 8],
}

pub(crate) const FAMILY_INTERNET: u16 = 2;
pub(crate) const LOOPBACK: u32 = u32::from_be_bytes([127, 0, 0, 1]).to_be();
pub(crate) const CLOCK_REALTIME: c_int = 0;
pub(crate) const CLOCK_REALTIME_COARSE: c_int = 5;
pub(crate) const CLOCK_PROCESS: [c_int; 2] = [2, 3];
pub(crate) const TIMER_ABSOLUTE: c_int = 1;
pub(crate) const DESCRIPTORS: usize = 1024;
pub(crate) const WORD_BITS: usize = 64;
pub(crate) const DUPLICATE_CLOSED_ON_EXEC: c_int = 1030;
pub(crate) const SET_DESCRIPTOR_FLAGS: c_int = 2;
pub(crate) const CLOSED_ON_EXEC: c_int = 1;
pub(crate) const READ_WRITE: c_int = 2;
const FUTEX_WAIT_PRIVATE: c_int = 128;
const FUTEX_WAKE_PRIVATE: c_int = 129;
#[cfg(target_arch = "x86_64")]
pub(crate) const SYS_FUTEX: c_long = 202;
#[cfg(target_arch = "aarch64")]
pub(crate) const SYS_FUTEX: c_long = 98;
pub(crate) const NEXT_DEFINITION: *mut c_void = -1_isize as *mut c_void;
pub(crate) const TRY_AGAIN: c_int = 11;

pub(crate) type Set = [u64; DESCRIPTORS / WORD_BITS];

unsafe extern "C" {
    pub(crate) fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
    pub(crate) fn getenv(name: *const c_char) -> *const c_char;
    pub(crate) fn setenv(name: *const c_char, value: *const c_char, replace: c_int) -> c_int;
    pub(crate) fn unsetenv(name: *const c_char) -> c_int;
    pub(crate) fn fcntl(fd: c_int, command: c_int, ...) -> c_int;
    pub(crate) fn open(path: *const c_char, flags: c_int, ...) -> c_int;
    pub(crate) fn dup2(from: c_int, to: c_int) -> c_int;
    pub(crate) fn close(fd: c_int) -> c_int;
    pub(crate) fn read(fd: c_int, bytes: *mut c_void, size: usize) -> isize;
    pub(crate) fn write(fd: c_int, bytes: *const c_void, size: usize) -> isize;
    pub(crate) fn syscall(number: c_long, ...) -> c_long;
    pub(crate) fn pthread_self() -> usize;
    pub(crate) fn pthread_kill(thread: usize, signal: c_int) -> c_int;
    pub(crate) fn signal(number: c_int, handler: usize) -> usize;
    pub(crate) fn siginterrupt(number: c_int, interrupts: c_int) -> c_int;
    pub(crate) fn getpid() -> c_int;
    pub(crate) fn getsockname(fd: c_int, address: *mut Address, size: *mut u32) -> c_int;
    pub(crate) fn __errno_location() -> *mut c_int;
    pub(crate) fn _exit(code: c_int) -> !;
}

/// A function of the C library that this library replaces, found at its first use.
pub(crate) struct Replaced {
    name: &'static CStr,
    address: AtomicUsize,
}

impl Replaced {
    pub(crate) const fn new(name: &'static CStr) -> Self {
        Self { name, address: AtomicUsize::new(0) }
    }

    pub(crate) fn address(&self) -> usize {
        let known = self.address.load(SeqCst);
        if known != 0 {
            return known;
        }
        // SAFETY: the name ends with a zero.
        let found = unsafe { dlsym(NEXT_DEFINITION, self.name.as_ptr()) } as usize;
        if found == 0 {
            // SAFETY: ends the process.
            unsafe { _exit(127) }
        }
        self.address.store(found, SeqCst);
        found
    }
}

/// Calls the C library's own definition of a replaced function.
macro_rules! real {
    ($name:ident: fn($($type:ty),*) -> $result:ty; $($argument:expr),*) => {{
        static REPLACED: super::libc::Replaced = super::libc::Replaced::new(match core::ffi::CStr::from_bytes_with_nul(concat!(stringify!($name), "\0").as_bytes()) {
            Ok(name) => name,
            Err(_) => panic!("a name without zeros"),
        });
        // SAFETY: the address is that of the C library's function of this name and type.
        let function = unsafe {
            core::mem::transmute::<usize, unsafe extern "C" fn($($type),*) -> $result>(REPLACED.address())
        };
        // SAFETY: the arguments are those of the caller, or local values.
        unsafe { function($($argument),*) }
    }};
}
pub(crate) use real;

/// Wakes all threads that wait for a change of the word.
pub(crate) fn wake(word: &AtomicU32) {
    // SAFETY: the kernel only compares the address.
    unsafe { syscall(SYS_FUTEX, word.as_ptr(), FUTEX_WAKE_PRIVATE, c_int::MAX) };
}

/// Waits for a change of the word from this value.
pub(crate) fn wait_for_change(word: &AtomicU32, value: u32) {
    // SAFETY: the word lives as long as the program.
    unsafe { syscall(SYS_FUTEX, word.as_ptr(), FUTEX_WAIT_PRIVATE, value, core::ptr::null::<Timespec>()) };
}

pub(crate) fn wait_until(word: &AtomicU32, value: u32) {
    loop {
        let seen = word.load(SeqCst);
        if seen == value {
            return;
        }
        wait_for_change(word, seen);
    }
}
