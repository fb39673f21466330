//! A restart by `exec`: the executable replaces itself, and stays in lockstep.

use core::cell::UnsafeCell;
use core::ffi::{CStr, c_char, c_int};
use core::sync::atomic::AtomicI32;
use core::sync::atomic::Ordering::SeqCst;

use super::libc::{SET_DESCRIPTOR_FLAGS, fcntl, getenv, getpid, real, setenv};
use super::parent::PAGE_FILE;
use super::{PRELOAD, RUN, SETTINGS, is_active};

/// The longest text that is kept, with its zero.
const LONGEST: usize = 512;

/// The process that the parent started. Its own child processes leave lockstep.
static PROCESS: AtomicI32 = AtomicI32::new(-1);
static LIBRARY: Text = Text::new();
static START_SETTINGS: Text = Text::new();

/// A text with a terminating zero that is kept for the environment of the next executable.
struct Text(UnsafeCell<[u8; LONGEST]>);

// SAFETY: only the main thread writes it, before other threads exist.
unsafe impl Sync for Text {}

impl Text {
    const fn new() -> Self {
        Self(UnsafeCell::new([0; LONGEST]))
    }

    /// Stores the text. A longer one is cut.
    fn set(&self, text: &[u8]) {
        // SAFETY: there is one thread.
        let place = unsafe { &mut *self.0.get() };
        let size = text.len().min(LONGEST - 1);
        place[..size].copy_from_slice(&text[..size]);
        place[size] = 0;
    }

    fn get(&self) -> &[u8; LONGEST] {
        // SAFETY: nobody writes it any more.
        unsafe { &*self.0.get() }
    }
}

/// Stores the settings and the path of the library for a restart.
pub(crate) fn keep(settings: &CStr) {
    // SAFETY: names and values end with a zero.
    unsafe {
        PROCESS.store(getpid(), SeqCst);
        let library = getenv(PRELOAD.as_ptr());
        if !library.is_null() {
            LIBRARY.set(CStr::from_ptr(library).to_bytes());
        }
    }
    // The descriptor and the number of the run are added at the restart.
    let ends =
        settings.to_bytes().iter().enumerate().filter(|(_, byte)| **byte == b',').map(|(index, _)| index);
    let end = ends.clone().nth(6).unwrap_or(settings.to_bytes().len());
    START_SETTINGS.set(&settings.to_bytes()[..end]);
}

/// Prepares the environment of the executable that replaces this one.
fn stay_in_lockstep() {
    // SAFETY: has no conditions.
    if !is_active() || unsafe { getpid() } != PROCESS.load(SeqCst) {
        return;
    }
    let mut text = [0; LONGEST + 32];
    let mut end = START_SETTINGS.get().iter().position(|byte| *byte == 0).unwrap_or(0);
    text[..end].copy_from_slice(&START_SETTINGS.get()[..end]);
    let page = PAGE_FILE.load(SeqCst);
    for number in [page as u32, RUN.load(SeqCst) + 1] {
        text[end] = b',';
        end += 1;
        let digits = number.checked_ilog10().unwrap_or(0);
        for place in (0..=digits).rev() {
            text[end] = b'0' + (number / 10_u32.pow(place) % 10) as u8;
            end += 1;
        }
    }
    // SAFETY: the texts end with a zero.
    unsafe {
        fcntl(page, SET_DESCRIPTOR_FLAGS, 0);
        setenv(SETTINGS.as_ptr(), text.as_ptr().cast(), 1);
        setenv(PRELOAD.as_ptr(), LIBRARY.get().as_ptr().cast(), 1);
    }
}

unsafe extern "C" {
    static environ: *const *const c_char;
}

/// Replaces the function of this name.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn execv(path: *const c_char, arguments: *const *const c_char) -> c_int {
    stay_in_lockstep();
    real!(execv: fn(*const c_char, *const *const c_char) -> c_int; path, arguments)
}

/// Replaces the function of this name.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn execvp(path: *const c_char, arguments: *const *const c_char) -> c_int {
    stay_in_lockstep();
    real!(execvp: fn(*const c_char, *const *const c_char) -> c_int; path, arguments)
}

/// Replaces the function of this name. In the process of the executable the environment is its own.
///
/// # Safety
/// As for the C library's function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn execve(
    path: *const c_char,
    arguments: *const *const c_char,
    environment: *const *const c_char,
) -> c_int {
    stay_in_lockstep();
    // SAFETY: the C library keeps it valid.
    let own = unsafe { environ };
    // SAFETY: has no conditions.
    let is_own = is_active() && unsafe { getpid() } == PROCESS.load(SeqCst);
    let environment = if is_own { own } else { environment };
    real!(execve: fn(*const c_char, *const *const c_char, *const *const c_char) -> c_int; path, arguments, environment)
}
