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
pub(crate) const SET_DESCRIPTOR_FLAGS: c_int = 2;
pub(crate) const CLOSED_ON_EXEC: c_int = 1;
pub(crate) const READABLE_WRITABLE: c_int = 3;
pub(crate) const MAP_SHARED: c_int = 1;
const FUTEX_WAIT: c_int = 0;
const FUTEX_WAKE: c_int = 1;
#[cfg(target_arch = "x86_64")]
pub(crate) const SYS_FUTEX: c_long = 202;
#[cfg(target_arch = "aarch64")]
pub(crate) const SYS_FUTEX: c_long = 98;
pub(crate) const NEXT_DEFINITION: *mut c_void = -1_isize as *mut c_void;
pub(crate) const SET_MASK: c_int = 2;
/// The words of a set of signals.
pub(crate) const SIGNAL_WORDS: usize = 16;
pub(crate) const TRY_AGAIN: c_int = 11;

pub(crate) type Set = [u64; DESCRIPTORS / WORD_BITS];

unsafe extern "C" {
    pub(crate) fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
    pub(crate) fn getenv(name: *const c_char) -> *const c_char;
    pub(crate) fn setenv(name: *const c_char, value: *const c_char, replace: c_int) -> c_int;
    pub(crate) fn unsetenv(name: *const c_char) -> c_int;
    pub(crate) fn fcntl(fd: c_int, command: c_int, ...) -> c_int;
    pub(crate) fn syscall(number: c_long, ...) -> c_long;
    pub(crate) fn pthread_self() -> usize;
    pub(crate) fn mmap(
        address: *mut c_void,
        size: usize,
        access: c_int,
        flags: c_int,
        fd: c_int,
        offset: i64,
    ) -> *mut c_void;
    pub(crate) fn getauxval(kind: u64) -> u64;
    pub(crate) fn getcontext(to: *mut Context) -> c_int;
    pub(crate) fn setcontext(from: *const Context) -> c_int;
    pub(crate) fn swapcontext(to: *mut Context, from: *const Context) -> c_int;
    pub(crate) fn makecontext(context: *mut Context, function: *const c_void, count: c_int, ...);
    pub(crate) fn pthread_sigmask(
        how: c_int,
        set: *const [u64; SIGNAL_WORDS],
        before: *mut [u64; SIGNAL_WORDS],
    ) -> c_int;
    pub(crate) fn sched_yield() -> c_int;
    pub(crate) fn getpid() -> c_int;
    pub(crate) fn getppid() -> c_int;
    pub(crate) fn getsockname(fd: c_int, address: *mut Address, size: *mut u32) -> c_int;
    pub(crate) fn __errno_location() -> *mut c_int;
    pub(crate) fn _exit(code: c_int) -> !;
}

/// The registers and the stack of code that goes on later. Its beginning and a size that suffices on all processors.
#[repr(C, align(16))]
pub struct Context {
    flags: usize,
    next: *mut Self,
    stack: *mut c_void,
    stack_flags: c_int,
    stack_size: usize,
    rest: [usize; 1024],
}

impl Context {
    pub(crate) const fn new() -> Self {
        Self {
            flags: 0,
            next: core::ptr::null_mut(),
            stack: core::ptr::null_mut(),
            stack_flags: 0,
            stack_size: 0,
            rest: [0; 1024],
        }
    }

    /// Sets the stack on which a new function runs.
    pub(crate) fn use_stack<const N: usize>(&mut self, stack: *mut [u8; N]) {
        (self.stack, self.stack_size) = (stack.cast(), N);
    }
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

/// The threads that use a word to wait: those of this process, or also the parent's.
#[derive(Clone, Copy)]
pub(crate) enum Scope {
    Shared = 0,
    Private = 128,
}

/// Wakes all threads that wait for a change of the word.
pub(crate) fn wake(word: &AtomicU32, scope: Scope) {
    // SAFETY: the kernel only compares the address.
    unsafe { syscall(SYS_FUTEX, word.as_ptr(), FUTEX_WAKE | scope as c_int, c_int::MAX) };
}

/// Waits for a change of a word of this process from this value.
pub(crate) fn wait_for_change(word: &AtomicU32, value: u32) {
    let forever = core::ptr::null::<Timespec>();
    // SAFETY: the word lives as long as the program.
    unsafe { syscall(SYS_FUTEX, word.as_ptr(), FUTEX_WAIT | Scope::Private as c_int, value, forever) };
}

/// Waits for a change of a word that the parent shares from this value, for a second at most.
pub(crate) fn wait_for_grant(word: &AtomicU32, value: u32) {
    let second = Timespec { s: 1, ns: 0 };
    // SAFETY: the word lives as long as the program, and the time as long as the call.
    unsafe {
        syscall(SYS_FUTEX, word.as_ptr(), FUTEX_WAIT | Scope::Shared as c_int, value, &raw const second)
    };
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
