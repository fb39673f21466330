//! The serial ports: real TCP sockets whose thread runs only when a grant says so.

use core::ffi::{c_int, c_void};
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicBool, AtomicI32, AtomicU16, AtomicU32, AtomicU64};

use super::frames::{SERIAL_PORTS, SerialTotals};
use super::is_active;
use super::libc::{Address, getsockname, real};
use super::turns::Place;

/// The thread of the serial ports.
pub(crate) struct Serial {
    /// The first TCP port for which the executable asks.
    pub(crate) port: AtomicU16,
    pub(crate) listeners: [AtomicI32; SERIAL_PORTS],
    pub(crate) ports: [AtomicU16; SERIAL_PORTS],
    /// The place at which it waits for its turn.
    pub(crate) place: Place,
    /// `true` during its turn.
    pub(crate) has_turn: AtomicBool,
    pub(crate) expected: Totals,
    pub(crate) seen: Totals,
    pub(crate) sent: AtomicU64,
}

pub(crate) struct Totals {
    pub(crate) connections: AtomicU32,
    pub(crate) closed: AtomicU32,
    pub(crate) bytes: AtomicU64,
}

impl Totals {
    const fn new() -> Self {
        Self { connections: AtomicU32::new(0), closed: AtomicU32::new(0), bytes: AtomicU64::new(0) }
    }

    pub(crate) fn reaches(&self, expected: &Self) -> bool {
        self.connections.load(SeqCst) >= expected.connections.load(SeqCst)
            && self.closed.load(SeqCst) >= expected.closed.load(SeqCst)
            && self.bytes.load(SeqCst) >= expected.bytes.load(SeqCst)
    }
}

pub(crate) static SERIAL: Serial = Serial {
    port: AtomicU16::new(0),
    listeners: [const { AtomicI32::new(-1) }; SERIAL_PORTS],
    ports: [const { AtomicU16::new(0) }; SERIAL_PORTS],
    place: Place::new(),
    has_turn: AtomicBool::new(false),
    expected: Totals::new(),
    seen: Totals::new(),
    sent: AtomicU64::new(0),
};

/// Lets the thread of the serial ports run until it has taken in these data and has nothing to write.
pub(crate) fn serve_serial(totals: SerialTotals) {
    SERIAL.expected.connections.store(totals.connections, SeqCst);
    SERIAL.expected.closed.store(totals.closed, SeqCst);
    SERIAL.expected.bytes.store(totals.bytes, SeqCst);
    SERIAL.place.wait_for_thread();
    SERIAL.has_turn.store(true, SeqCst);
    SERIAL.place.run();
}

/// Replaces the function of this name: counts the bytes of the serial ports.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn recv(fd: c_int, bytes: *mut c_void, size: usize, flags: c_int) -> isize {
    let got = real!(recv: fn(c_int, *mut c_void, usize, c_int) -> isize; fd, bytes, size, flags);
    match got {
        0 => _ = SERIAL.seen.closed.fetch_add(1, SeqCst),
        1.. => _ = SERIAL.seen.bytes.fetch_add(got as u64, SeqCst),
        _ => {}
    }
    got
}

/// Replaces the function of this name: counts the bytes of the serial ports.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn send(fd: c_int, bytes: *const c_void, size: usize, flags: c_int) -> isize {
    let sent = real!(send: fn(c_int, *const c_void, usize, c_int) -> isize; fd, bytes, size, flags);
    if sent > 0 {
        SERIAL.sent.fetch_add(sent as u64, SeqCst);
    }
    sent
}

/// Replaces the function of this name: counts the connections to the serial ports.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn accept(fd: c_int, address: *mut c_void, size: *mut u32) -> c_int {
    let accepted = real!(accept: fn(c_int, *mut c_void, *mut u32) -> c_int; fd, address, size);
    if accepted >= 0 {
        SERIAL.seen.connections.fetch_add(1, SeqCst);
    }
    accepted
}

/// Replaces the function of this name, as [`accept`].
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn accept4(fd: c_int, address: *mut c_void, size: *mut u32, flags: c_int) -> c_int {
    let accepted = real!(accept4: fn(c_int, *mut c_void, *mut u32, c_int) -> c_int; fd, address, size, flags);
    if accepted >= 0 {
        SERIAL.seen.connections.fetch_add(1, SeqCst);
    }
    accepted
}

/// Replaces the function of this name: the parent learns the port from the report.
#[unsafe(no_mangle)]
pub extern "C" fn listen(fd: c_int, backlog: c_int) -> c_int {
    let result = real!(listen: fn(c_int, c_int) -> c_int; fd, backlog);
    let serial = SERIAL.listeners.iter().position(|listener| listener.load(SeqCst) == fd);
    if let Some(serial) = serial.filter(|_| is_active()) {
        let mut address = Address { family: 0, port: 0, host: 0, zero: [0; 8] };
        let mut size = size_of::<Address>() as u32;
        // SAFETY: both are writable.
        unsafe { getsockname(fd, &raw mut address, &raw mut size) };
        SERIAL.ports[serial].store(u16::from_be(address.port), SeqCst);
    }
    result
}
