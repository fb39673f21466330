//! The threads that take in the packets of the simulator: states and RC.

use core::cell::UnsafeCell;
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicBool, AtomicI32, AtomicU16, AtomicUsize};

use super::frames::FDM_BYTES;
use super::turns::Place;

/// A thread of the executable that takes in the packets of one UDP port.
pub(crate) struct Intake {
    /// The UDP port for which the executable asks.
    pub(crate) port: AtomicU16,
    /// Its socket; −1 = not yet.
    pub(crate) fd: AtomicI32,
    /// The place at which it waits for a packet.
    pub(crate) place: Place,
    has_packet: AtomicBool,
    packet: UnsafeCell<[u8; FDM_BYTES]>,
    size: AtomicUsize,
}

// SAFETY: the main thread writes the packet while the intake's own thread waits, which reads it during its turn.
unsafe impl Sync for Intake {}

impl Intake {
    const fn new() -> Self {
        Self {
            port: AtomicU16::new(0),
            fd: AtomicI32::new(-1),
            place: Place::new(),
            has_packet: AtomicBool::new(false),
            packet: UnsafeCell::new([0; FDM_BYTES]),
            size: AtomicUsize::new(0),
        }
    }

    /// Hands a packet to the thread, and returns when it waits for the next one. Called by the main thread.
    pub(crate) fn deliver(&self, packet: &[u8]) {
        self.place.wait_for_thread();
        // SAFETY: the thread waits, and does not touch the packet.
        let place = unsafe { &mut *self.packet.get() };
        place[..packet.len()].copy_from_slice(packet);
        self.size.store(packet.len(), SeqCst);
        self.has_packet.store(true, SeqCst);
        self.place.run();
    }

    /// Waits on the intake's own thread for a packet. A thread that waits has taken in the one before. Returns `false` if the
    /// thread must end.
    pub(crate) fn wait(&self) -> bool {
        self.has_packet.load(SeqCst) || self.place.wait()
    }

    /// Copies the packet to `to`, which has `size` bytes. Returns its size, or `None` if there is none.
    ///
    /// # Safety
    /// `to` points to `size` writable bytes.
    pub(crate) unsafe fn take(&self, to: *mut u8, size: usize) -> Option<usize> {
        if !self.has_packet.swap(false, SeqCst) {
            return None;
        }
        let size = size.min(self.size.load(SeqCst));
        // SAFETY: the main thread does not touch the packet during this turn, and the caller vouches for `to`.
        unsafe { core::ptr::copy_nonoverlapping(self.packet.get().cast::<u8>(), to, size) };
        Some(size)
    }
}

pub(crate) static FDM: Intake = Intake::new();
pub(crate) static RC: Intake = Intake::new();
