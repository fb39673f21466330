//! The memory that this program shares with an executable in lockstep.
#![allow(
    unsafe_code,
    reason = "memory that two processes share is mapped with calls that the compiler cannot check"
)]

use std::fs::File;
use std::io;
use std::ops::Deref;
use std::path::PathBuf;
use std::ptr::NonNull;

use super::frames::Page;

/// A page in a file in memory, which ends with this program and the processes that have mapped it.
#[derive(Debug)]
pub(super) struct SharedPage {
    page: NonNull<Page>,
    /// The executable opens it by its path.
    file: File,
}

// SAFETY: the page consists of atomic numbers, and the mapping belongs to no thread.
unsafe impl Send for SharedPage {}

impl SharedPage {
    /// Maps a page of zeros.
    ///
    /// # Errors
    /// Returns the system's error.
    #[cfg(target_os = "linux")]
    pub(super) fn new() -> io::Result<Self> {
        use rustix::fs::{MemfdFlags, SealFlags, fcntl_add_seals, memfd_create};
        use rustix::mm::{MapFlags, ProtFlags, mmap};
        let memory = memfd_create("betadeck-page", MemfdFlags::CLOEXEC | MemfdFlags::ALLOW_SEALING)?;
        let file = File::from(memory);
        file.set_len(size_of::<Page>() as u64)?;
        // An access beyond the end of a file that the executable has shortened would end this program.
        fcntl_add_seals(&file, SealFlags::SHRINK | SealFlags::GROW | SealFlags::SEAL)?;
        let (access, flags) = (ProtFlags::READ | ProtFlags::WRITE, MapFlags::SHARED);
        // SAFETY: the system chooses an address that nothing uses.
        let address = unsafe { mmap(std::ptr::null_mut(), size_of::<Page>(), access, flags, &file, 0) }?;
        let page = NonNull::new(address.cast()).ok_or(io::ErrorKind::AddrNotAvailable)?;
        Ok(Self { page, file })
    }

    #[cfg(not(target_os = "linux"))]
    pub(super) fn new() -> io::Result<Self> {
        Err(io::ErrorKind::Unsupported.into())
    }

    /// Returns the path at which a child process of this program finds it.
    pub(super) fn path(&self) -> PathBuf {
        super::library::path_for_child(&self.file)
    }
}

impl Deref for SharedPage {
    type Target = Page;

    fn deref(&self) -> &Page {
        // SAFETY: the mapping has the size of a page, is aligned to one of the system's, and lives as long as this. All
        // values of its numbers are valid, whatever the executable writes.
        unsafe { self.page.as_ref() }
    }
}

impl Drop for SharedPage {
    fn drop(&mut self) {
        // SAFETY: nothing refers to the mapping any more.
        #[cfg(target_os = "linux")]
        let _unmapped = unsafe { rustix::mm::munmap(self.page.as_ptr().cast(), size_of::<Page>()) };
    }
}
