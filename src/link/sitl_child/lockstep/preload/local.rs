//! The register that points to the thread-local data of a thread.

#[cfg(target_arch = "x86_64")]
use core::ffi::c_long;
#[cfg(target_arch = "x86_64")]
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};

#[cfg(target_arch = "x86_64")]
use super::libc::{getauxval, syscall};

/// `true` if programs may write the register themselves.
#[cfg(target_arch = "x86_64")]
static IS_WRITABLE: AtomicBool = AtomicBool::new(false);

/// Finds out how the register can be written.
pub(crate) fn prepare() {
    #[cfg(target_arch = "x86_64")]
    {
        const CAPABILITIES_2: u64 = 26;
        const MAY_WRITE: u64 = 2;
        // SAFETY: has no conditions.
        IS_WRITABLE.store(unsafe { getauxval(CAPABILITIES_2) } & MAY_WRITE != 0, Relaxed);
    }
}

/// Returns the address of the thread-local data.
#[inline(always)]
pub(crate) fn local_data() -> usize {
    let address: usize;
    // SAFETY: on x86-64 the data begin with their own address; on ARM64 programs may read the register.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        core::arch::asm!("mov {}, fs:0", out(reg) address, options(nostack, preserves_flags));
        #[cfg(target_arch = "aarch64")]
        core::arch::asm!("mrs {}, tpidr_el0", out(reg) address, options(nostack, preserves_flags));
    }
    address
}

/// Sets the address of the thread-local data.
///
/// # Safety
/// They are the data of the thread whose code runs next, and no code that uses others runs before.
#[inline(always)]
pub(crate) unsafe fn set_local_data(address: usize) {
    // SAFETY: the caller vouches for it.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        if IS_WRITABLE.load(Relaxed) {
            core::arch::asm!("wrfsbase {}", in(reg) address, options(nostack, preserves_flags));
        } else {
            const SYS_ARCH_PRCTL: c_long = 158;
            const SET_FS: c_long = 0x1002;
            syscall(SYS_ARCH_PRCTL, SET_FS, address);
        }
        #[cfg(target_arch = "aarch64")]
        core::arch::asm!("msr tpidr_el0, {}", in(reg) address, options(nostack, preserves_flags));
    }
}
