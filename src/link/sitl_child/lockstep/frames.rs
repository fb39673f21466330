//! The two messages of lockstep, one each way per step, and the memory that carries them. This file is compiled into the
//! program and into the preloaded library, so it uses `core` only. All numbers are little-endian.
#![allow(dead_code, unreachable_pub, reason = "each side uses one direction of each message")]

use core::sync::atomic::AtomicU32;
use core::sync::atomic::Ordering::{Relaxed, SeqCst};

/// The size of a state packet, bytes.
pub const FDM_BYTES: usize = 144;
/// The size of an RC packet, bytes.
pub const RC_BYTES: usize = 40;
/// The size of a packet of normalised motor values, bytes.
pub const MOTOR_BYTES: usize = 16;
/// The number of serial ports over TCP.
pub const SERIAL_PORTS: usize = 8;
/// The size of a [`Grant`], bytes.
pub const GRANT_BYTES: usize = 24 + RC_BYTES + FDM_BYTES;
/// The size of a [`Report`], bytes.
pub const REPORT_BYTES: usize = 48 + 2 * SERIAL_PORTS;

/// The memory that the program and the executable share. Each side writes its message, then its number. The other side waits
/// for a change of that number, and is woken if it sleeps.
#[repr(C)]
pub struct Page {
    /// The number of the newest grant. The boot is [`BOOT_GRANT`].
    pub granted: AtomicU32,
    /// The number of the grant whose step is over; 0 = the boot is not.
    pub reported: AtomicU32,
    /// 1 = the executable sleeps until the next grant, and must be woken.
    pub executable_sleeps: AtomicU32,
    /// 1 = the program sleeps until the next report, and must be woken.
    pub program_sleeps: AtomicU32,
    /// The times that the executable yields the processor before it sleeps.
    pub yields: AtomicU32,
    /// The number of threads whose code the main thread of the executable runs.
    pub guests: AtomicU32,
    grant: [AtomicU32; GRANT_BYTES / 4],
    report: [AtomicU32; REPORT_BYTES / 4],
}

/// The grant in which the executable boots.
pub const BOOT_GRANT: u32 = 1;

/// Allows the executable one step.
#[derive(Debug, Clone, PartialEq)]
pub struct Grant {
    /// The state packet of the step.
    pub fdm: [u8; FDM_BYTES],
    /// The RC packet that the executable takes in before the step.
    pub rc: Option<[u8; RC_BYTES]>,
    /// The data on the serial ports that the executable takes in before the step; `None` = the thread of these ports
    /// does nothing.
    pub serial: Option<SerialTotals>,
}

/// The totals of what was sent to the executable over its serial ports since it started.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SerialTotals {
    pub connections: u32,
    /// The connections that were ended.
    pub closed: u32,
    pub bytes: u64,
}

/// Reports that the executable has used up its time.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The clock of the executable, ns.
    pub now_ns: u64,
    /// The packets of motors since the last report.
    pub motor_packets: u32,
    /// The newest packet of motors.
    pub motors: [u8; MOTOR_BYTES],
    /// The number of times that the executable has replaced itself.
    pub run: u32,
    /// The bytes that the executable has sent over its serial ports since it started.
    pub sent: u64,
    /// The TCP ports at which its serial ports listen; 0 = not yet.
    pub ports: [u16; SERIAL_PORTS],
}

const HAS_RC: u8 = 1;
const HAS_SERIAL: u8 = 2;

impl Page {
    /// Publishes a grant. Wake the executable next, if it sleeps.
    pub fn put_grant(&self, grant: &Grant) {
        write(&self.grant, &grant.to_bytes());
        self.granted.fetch_add(1, SeqCst);
    }

    /// Returns the newest grant.
    pub fn grant(&self) -> Grant {
        Grant::from_bytes(&read(&self.grant))
    }

    /// Publishes the report for the newest grant. Wake the program next, if it sleeps.
    pub fn put_report(&self, report: &Report) {
        write(&self.report, &report.to_bytes());
        self.reported.store(self.granted.load(SeqCst), SeqCst);
    }

    /// Returns the newest report.
    pub fn report(&self) -> Report {
        Report::from_bytes(&read(&self.report))
    }
}

fn write(words: &[AtomicU32], bytes: &[u8]) {
    for (word, bytes) in words.iter().zip(bytes.chunks_exact(4)) {
        word.store(u32::from_le_bytes(array(bytes, 0)), Relaxed);
    }
}

fn read<const N: usize>(words: &[AtomicU32]) -> [u8; N] {
    let mut bytes = [0; N];
    for (bytes, word) in bytes.chunks_exact_mut(4).zip(words) {
        bytes.copy_from_slice(&word.load(Relaxed).to_le_bytes());
    }
    bytes
}

impl Grant {
    pub fn to_bytes(&self) -> [u8; GRANT_BYTES] {
        let mut bytes = [0; GRANT_BYTES];
        let SerialTotals { connections, closed, bytes: received } = self.serial.unwrap_or_default();
        bytes[0] =
            if self.rc.is_some() { HAS_RC } else { 0 } | if self.serial.is_some() { HAS_SERIAL } else { 0 };
        bytes[4..8].copy_from_slice(&connections.to_le_bytes());
        bytes[8..12].copy_from_slice(&closed.to_le_bytes());
        bytes[16..24].copy_from_slice(&received.to_le_bytes());
        let (rc, fdm) = bytes[24..].split_at_mut(RC_BYTES);
        rc.copy_from_slice(&self.rc.unwrap_or([0; RC_BYTES]));
        fdm.copy_from_slice(&self.fdm);
        bytes
    }

    pub fn from_bytes(bytes: &[u8; GRANT_BYTES]) -> Self {
        Self {
            fdm: array(bytes, 24 + RC_BYTES),
            rc: (bytes[0] & HAS_RC != 0).then(|| array(bytes, 24)),
            serial: (bytes[0] & HAS_SERIAL != 0).then(|| SerialTotals {
                connections: u32::from_le_bytes(array(bytes, 4)),
                closed: u32::from_le_bytes(array(bytes, 8)),
                bytes: u64::from_le_bytes(array(bytes, 16)),
            }),
        }
    }
}

impl Report {
    pub fn to_bytes(&self) -> [u8; REPORT_BYTES] {
        let mut bytes = [0; REPORT_BYTES];
        bytes[..8].copy_from_slice(&self.now_ns.to_le_bytes());
        bytes[8..12].copy_from_slice(&self.motor_packets.to_le_bytes());
        bytes[12..16].copy_from_slice(&self.run.to_le_bytes());
        bytes[16..24].copy_from_slice(&self.sent.to_le_bytes());
        bytes[24..40].copy_from_slice(&self.motors);
        for (bytes, port) in bytes[48..].chunks_exact_mut(2).zip(self.ports) {
            bytes.copy_from_slice(&port.to_le_bytes());
        }
        bytes
    }

    pub fn from_bytes(bytes: &[u8; REPORT_BYTES]) -> Self {
        Self {
            now_ns: u64::from_le_bytes(array(bytes, 0)),
            motor_packets: u32::from_le_bytes(array(bytes, 8)),
            motors: array(bytes, 24),
            run: u32::from_le_bytes(array(bytes, 12)),
            sent: u64::from_le_bytes(array(bytes, 16)),
            ports: core::array::from_fn(|port| u16::from_le_bytes(array(bytes, 48 + 2 * port))),
        }
    }
}

/// Returns the `N` bytes from `start` on.
fn array<const N: usize>(bytes: &[u8], start: usize) -> [u8; N] {
    core::array::from_fn(|index| bytes[start + index])
}
