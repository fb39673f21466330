//! The threads that take in the packets of the simulator: states and RC.

use core::cell::UnsafeCell;
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicI32, AtomicU16, AtomicU32, AtomicUsize};

use super::frames::FDM_BYTES;
use super::libc::{wait_for_change, wait_until, wake};
use super::parent::next_state;
use super::threads::is_ending;

/// The states of a thread that takes in packets.
const BUSY: u32 = 0;
const IDLE: u32 = 1;
const HAS_PACKET: u32 = 2;

/// A thread of the executable that takes in the packets of one UDP port.
pub(crate) struct Intake {
    /// The UDP port for which the executable asks.
    pub(crate) port: AtomicU16,
    /// Its socket; −1 = not yet.
    pub(crate) fd: AtomicI32,
    /// [`BUSY`], [`IDLE`] or [`HAS_PACKET`].
    state: AtomicU32,
    packet: UnsafeCell<[u8; FDM_BYTES]>,
    size: AtomicUsize,
}

// SAFETY: only one thread writes the packet, in the state IDLE or on the intake's own thread, which reads it in the state
// HAS_PACKET.
unsafe impl Sync for Intake {}

impl Intake {
    const fn new() -> Self {
        Self {
            port: AtomicU16::new(0),
            fd: AtomicI32::new(-1),
            state: AtomicU32::new(BUSY),
            packet: UnsafeCell::new([0; FDM_BYTES]),
            size: AtomicUsize::new(0),
        }
    }

    /// Hands a packet to the thread, and returns when it waits for the next one.
    pub(crate) fn deliver(&self, packet: &[u8]) {
        wait_until(&self.state, IDLE);
        self.put(packet);
        wake(&self.state);
        wait_until(&self.state, IDLE);
    }

    fn put(&self, packet: &[u8]) {
        // SAFETY: the thread does not touch the packet while it is idle, and a thread may do so itself.
        let place = unsafe { &mut *self.packet.get() };
        place[..packet.len()].copy_from_slice(packet);
        self.size.store(packet.len(), SeqCst);
        self.state.store(HAS_PACKET, SeqCst);
    }

    /// Waits on the thread of the states for the state of the next grant. Returns `false` if the thread must end.
    pub(crate) fn wait_for_state(&self) -> bool {
        if self.state.load(SeqCst) != HAS_PACKET {
            let Some(state) = next_state() else { return false };
            self.put(&state);
        }
        true
    }

    /// Wakes its thread, so that it looks for the end.
    pub(crate) fn wake(&self) {
        wake(&self.state);
    }

    /// Waits for a packet of another thread. A thread that waits has taken in the one before. Returns `false` if the thread
    /// must end.
    pub(crate) fn wait(&self) -> bool {
        if self.state.load(SeqCst) == BUSY {
            self.state.store(IDLE, SeqCst);
            wake(&self.state);
        }
        while self.state.load(SeqCst) == IDLE && !is_ending() {
            wait_for_change(&self.state, IDLE);
        }
        !is_ending()
    }

    /// Copies the packet to `to`, which has `size` bytes. Returns its size, or `None` if there is none.
    ///
    /// # Safety
    /// `to` points to `size` writable bytes.
    pub(crate) unsafe fn take(&self, to: *mut u8, size: usize) -> Option<usize> {
        if self.state.load(SeqCst) != HAS_PACKET {
            return None;
        }
        let size = size.min(self.size.load(SeqCst));
        // SAFETY: no other thread touches the packet in this state, and the caller vouches for `to`.
        unsafe { core::ptr::copy_nonoverlapping(self.packet.get().cast::<u8>(), to, size) };
        // The thread is idle again when it waits for the next packet.
        self.state.store(BUSY, SeqCst);
        Some(size)
    }
}

pub(crate) static FDM: Intake = Intake::new();
pub(crate) static RC: Intake = Intake::new();
