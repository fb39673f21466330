//! The preloaded library, and the executables into which it can be loaded.

use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

/// The library that `build.rs` compiled; empty for a system on which it does not work.
static LIBRARY: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/lockstep.so"));

/// The reason why an executable cannot run in simulated time, as part of a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
pub enum NoLockstep {
    #[strum(to_string = "this system cannot preload a library into it (Linux on x86-64 or ARM64 can)")]
    System,
    #[strum(to_string = "it is a script or another kind of file, not an executable for this machine")]
    Foreign,
    #[strum(to_string = "it is linked statically, so nothing can be preloaded into it")]
    Static,
    #[strum(to_string = "it is linked against another C library than glibc")]
    OtherLibrary,
}

/// Checks that the library can be loaded into an executable.
///
/// # Errors
/// Returns the reason if it cannot. A file that cannot be read counts as loadable: its start reports the error.
pub fn check_lockstep(program: &Path) -> Result<(), NoLockstep> {
    if LIBRARY.is_empty() {
        return Err(NoLockstep::System);
    }
    let mut head = vec![0; 4096];
    let Ok(read) = File::open(program).and_then(|mut file| file.read(&mut head)) else { return Ok(()) };
    head.truncate(read);
    let own = LIBRARY.get(..20).unwrap_or_default();
    // The magic number, the word size, the byte order and, in bytes 18 and 19, the processor.
    if head.len() < 64 || head[..6] != own[..6] || head[18..20] != own[18..20] {
        return Err(NoLockstep::Foreign);
    }
    match interpreter(&head) {
        None => Err(NoLockstep::Static),
        Some(loader) if contains(loader, b"musl") => Err(NoLockstep::OtherLibrary),
        Some(_) => Ok(()),
    }
}

/// Returns the path of the loader in the head of a 64-bit little-endian ELF file; `None` if it names none.
fn interpreter(head: &[u8]) -> Option<&[u8]> {
    const INTERPRETER: u32 = 3;
    const ENTRY: usize = 56;
    let number = |at: usize| Some(u64::from_le_bytes(head.get(at..at + 8)?.try_into().ok()?));
    let table = usize::try_from(number(32)?).ok()?;
    let count = usize::from(u16::from_le_bytes(head.get(56..58)?.try_into().ok()?));
    (0..count).find_map(|index| {
        let entry = table.checked_add(index * ENTRY)?;
        let kind = u32::from_le_bytes(head.get(entry..entry + 4)?.try_into().ok()?);
        let place = usize::try_from(number(entry + 8)?).ok()?;
        let size = usize::try_from(number(entry + 32)?).ok()?;
        (kind == INTERPRETER).then(|| head.get(place..place.checked_add(size)?))?
    })
}

fn contains(bytes: &[u8], word: &[u8]) -> bool {
    bytes.windows(word.len()).any(|window| window == word)
}

/// The library as a file in memory, which ends with this program.
#[derive(Debug)]
pub(super) struct LoadedLibrary {
    #[cfg(target_os = "linux")]
    file: File,
}

impl LoadedLibrary {
    /// Writes the library into memory.
    ///
    /// # Errors
    /// Returns the system's error.
    pub(super) fn new() -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        {
            let memory = rustix::fs::memfd_create("betadeck-lockstep", rustix::fs::MemfdFlags::CLOEXEC)?;
            let mut file = File::from(memory);
            file.write_all(LIBRARY)?;
            Ok(Self { file })
        }
        #[cfg(not(target_os = "linux"))]
        Err(io::ErrorKind::Unsupported.into())
    }

    /// Returns the path at which a child process of this program finds it.
    pub(super) fn path(&self) -> PathBuf {
        #[cfg(target_os = "linux")]
        return path_for_child(&self.file);
        #[cfg(not(target_os = "linux"))]
        PathBuf::new()
    }
}

/// Returns the path at which a child process of this program finds an open file.
pub(super) fn path_for_child(file: &File) -> PathBuf {
    #[cfg(unix)]
    {
        use std::os::fd::AsRawFd as _;
        PathBuf::from(format!("/proc/{}/fd/{}", std::process::id(), file.as_raw_fd()))
    }
    #[cfg(not(unix))]
    {
        let _ = file;
        PathBuf::new()
    }
}
