//! Threads of the executable that run on its main thread. A change of threads by the system costs most of a step, so a new
//! thread hands its stack and its thread-local data to the main thread, and sleeps until it has to end. The main thread then
//! enters its code at each turn.

use core::cell::UnsafeCell;
use core::ffi::{c_int, c_void};
use core::ptr::null_mut;
use core::sync::atomic::Ordering::SeqCst;
use core::sync::atomic::{AtomicBool, AtomicPtr, AtomicU32, AtomicUsize};

use super::libc::{
    Context, SET_MASK, SIGNAL_WORDS, Scope, getcontext, makecontext, pthread_sigmask, real, setcontext,
    swapcontext, wait_for_change, wait_until, wake,
};
use super::local::{local_data, set_local_data};
use super::parent::page;

/// The most guests. Further threads run on their own.
const GUESTS: usize = 8;
/// The stack on which the system's thread of a guest sleeps, bytes.
const SLEEPING_STACK: usize = 16 << 10;

/// The states of a guest.
const FREE: u32 = 0;
const STARTING: u32 = 1;
const SLEEPING: u32 = 2;
const RETURNING: u32 = 3;

/// A thread of the executable whose code runs on the main thread.
pub(crate) struct Guest {
    state: AtomicU32,
    /// The function of the thread, its argument, and its thread-local data.
    function: AtomicUsize,
    argument: AtomicPtr<c_void>,
    local_data: AtomicUsize,
    /// The thread that the system knows.
    thread: AtomicUsize,
    /// `true` once the function has returned.
    is_over: AtomicBool,
    contexts: UnsafeCell<Contexts>,
}

struct Contexts {
    /// The place at which the code goes on.
    code: Context,
    /// The sleep of the thread that the system knows.
    sleep: Context,
    stack: [u8; SLEEPING_STACK],
}

// SAFETY: one thread at a time uses the contexts: the guest's own until it sleeps, and after it returns; the main thread in
// between.
unsafe impl Sync for Guest {}

impl Guest {
    const fn new() -> Self {
        Self {
            state: AtomicU32::new(FREE),
            function: AtomicUsize::new(0),
            argument: AtomicPtr::new(null_mut()),
            local_data: AtomicUsize::new(0),
            thread: AtomicUsize::new(0),
            is_over: AtomicBool::new(false),
            contexts: UnsafeCell::new(Contexts {
                code: Context::new(),
                sleep: Context::new(),
                stack: [0; SLEEPING_STACK],
            }),
        }
    }

    /// Runs the guest's code until it leaves. Called by the main thread.
    pub(crate) fn enter(&'static self) {
        CURRENT.store(core::ptr::from_ref(self).cast_mut(), SeqCst);
        MAIN_DATA.store(local_data(), SeqCst);
        // SAFETY: the guest has left its code, so its context and its thread-local data are complete; `leave` and `begin`
        // restore those of the main thread.
        unsafe {
            set_local_data(self.local_data.load(SeqCst));
            swapcontext(MAIN.0.get(), &raw mut (*self.contexts.get()).code);
        }
        CURRENT.store(null_mut(), SeqCst);
        if self.is_over.load(SeqCst) {
            self.state.store(RETURNING, SeqCst);
            wake(&self.state, Scope::Private);
        }
    }

    /// Goes back to the main thread, and returns when it enters this guest the next time. Called by the guest's code.
    pub(crate) fn leave(&self) {
        // SAFETY: the main thread waits in `enter`, which sets the thread-local data of this guest again.
        unsafe {
            set_local_data(MAIN_DATA.load(SeqCst));
            swapcontext(&raw mut (*self.contexts.get()).code, MAIN.0.get());
        }
    }
}

/// The guest whose code runs; null = none.
static CURRENT: AtomicPtr<Guest> = AtomicPtr::new(null_mut());
static MAIN_DATA: AtomicUsize = AtomicUsize::new(0);
static MAIN: MainContext = MainContext(UnsafeCell::new(Context::new()));
static ALL: [Guest; GUESTS] = [const { Guest::new() }; GUESTS];

struct MainContext(UnsafeCell<Context>);

// SAFETY: only the main thread uses it.
unsafe impl Sync for MainContext {}

/// Returns the guest whose code calls this; `None` on a thread of the system.
pub(crate) fn current() -> Option<&'static Guest> {
    // SAFETY: guests are static.
    let guest = unsafe { CURRENT.load(SeqCst).as_ref() }?;
    (guest.local_data.load(SeqCst) == local_data()).then_some(guest)
}

/// Creates a thread as a guest, and runs it until it waits for its turn. Returns `None` if there are too many, otherwise the
/// result of the C library.
pub(crate) fn create(
    thread: *mut usize,
    attributes: *const c_void,
    function: *const c_void,
    argument: *mut c_void,
) -> Option<c_int> {
    let guest = ALL.iter().find(|guest| guest.state.load(SeqCst) == FREE)?;
    guest.function.store(function as usize, SeqCst);
    guest.argument.store(argument, SeqCst);
    guest.is_over.store(false, SeqCst);
    guest.state.store(STARTING, SeqCst);
    let (begin, own) = (begin as *const c_void, core::ptr::from_ref(guest).cast_mut().cast::<c_void>());
    let result = real!(pthread_create: fn(*mut usize, *const c_void, *const c_void, *mut c_void) -> c_int; thread, attributes, begin, own);
    if result != 0 {
        guest.state.store(FREE, SeqCst);
        return Some(result);
    }
    // SAFETY: the C library has written it.
    guest.thread.store(unsafe { *thread }, SeqCst);
    wait_until(&guest.state, SLEEPING);
    if let Some(page) = page() {
        page.guests.fetch_add(1, SeqCst);
    }
    guest.enter();
    Some(0)
}

/// Lets a guest run to its end, because the main thread waits for it.
pub(crate) fn finish(thread: usize) {
    let is_this =
        |guest: &&Guest| guest.state.load(SeqCst) == SLEEPING && guest.thread.load(SeqCst) == thread;
    if let Some(guest) = ALL.iter().find(is_this) {
        while !guest.is_over.load(SeqCst) {
            guest.enter();
        }
    }
}

/// Begins on the thread that the system has created, and hands the rest over to the main thread.
extern "C" fn begin(guest: *mut c_void) -> *mut c_void {
    // SAFETY: `create` passes a static guest, whose contexts nobody else uses yet. The function is that of the executable.
    unsafe {
        let guest: &'static Guest = &*guest.cast();
        guest.local_data.store(local_data(), SeqCst);
        let contexts = guest.contexts.get();
        // A handler on the sleeping thread would use the thread-local data of code that runs elsewhere.
        let (every, mut before) = ([u64::MAX; SIGNAL_WORDS], [0; SIGNAL_WORDS]);
        pthread_sigmask(SET_MASK, &raw const every, &raw mut before);
        getcontext(&raw mut (*contexts).sleep);
        pthread_sigmask(SET_MASK, &raw const before, core::ptr::null_mut());
        (*contexts).sleep.use_stack(&raw mut (*contexts).stack);
        makecontext(&raw mut (*contexts).sleep, sleep as *const c_void, 1, guest);
        swapcontext(&raw mut (*contexts).code, &raw mut (*contexts).sleep);
        // From here on the main thread runs it.
        let function: extern "C" fn(*mut c_void) -> *mut c_void =
            core::mem::transmute(guest.function.load(SeqCst));
        let result = function(guest.argument.load(SeqCst));
        guest.is_over.store(true, SeqCst);
        guest.leave();
        // From here on its own thread, which ends.
        guest.state.store(FREE, SeqCst);
        result
    }
}

/// Sleeps on the thread that the system knows, until the code has come to its end there.
extern "C" fn sleep(guest: &'static Guest) {
    guest.state.store(SLEEPING, SeqCst);
    wake(&guest.state, Scope::Private);
    while guest.state.load(SeqCst) != RETURNING {
        wait_for_change(&guest.state, SLEEPING);
    }
    // SAFETY: the main thread has left the code for the last time.
    unsafe { setcontext(&raw const (*guest.contexts.get()).code) };
}
