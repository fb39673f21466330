//! An allocator that measures the memory that a piece of work takes on its thread, and counts its allocations.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The memory that a piece of work took, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Taken {
    /// The peak above the memory held at the start.
    pub(crate) peak: usize,
    /// The sum of all allocations, freed or not. A reallocation counts with its whole new size.
    pub(crate) total: usize,
}

thread_local! {
    static HELD: Cell<isize> = const { Cell::new(0) };
    static MAX_HELD: Cell<isize> = const { Cell::new(0) };
    static TOTAL: Cell<usize> = const { Cell::new(0) };
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Meter;

fn take(bytes: usize) {
    ALLOCATIONS.set(ALLOCATIONS.get() + 1);
    TOTAL.set(TOTAL.get().wrapping_add(bytes));
    HELD.set(HELD.get() + bytes as isize);
    MAX_HELD.set(MAX_HELD.get().max(HELD.get()));
}

fn give_back(bytes: usize) {
    HELD.set(HELD.get() - bytes as isize);
}

// SAFETY: every call goes to the system allocator unchanged; measuring touches only thread-local cells that need no
// allocation and no destructor.
unsafe impl GlobalAlloc for Meter {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        take(layout.size());
        // SAFETY: the caller upholds the contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        take(layout.size());
        // SAFETY: the caller upholds the contract.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        // Both blocks are held while the contents move.
        take(new_size);
        give_back(layout.size());
        // SAFETY: the caller upholds the contract.
        unsafe { System.realloc(memory, layout, new_size) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        give_back(layout.size());
        // SAFETY: the caller upholds the contract.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Meter = Meter;

/// Runs `work` and returns its result and the memory that it took.
pub(crate) fn measured<R>(work: impl FnOnce() -> R) -> (R, Taken) {
    let (held, total) = (HELD.get(), TOTAL.get());
    MAX_HELD.set(held);
    let result = work();
    let peak = usize::try_from(MAX_HELD.get() - held).unwrap_or_default();
    (result, Taken { peak, total: TOTAL.get().wrapping_sub(total) })
}

/// Returns the number of allocations of this thread so far.
pub(crate) fn allocations() -> u64 {
    ALLOCATIONS.get()
}
