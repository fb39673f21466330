//! Wakes a session's thread when a command or a request arrives.

use std::sync::Arc;
use std::task::{Wake, Waker};
use std::thread::Thread;

struct ThreadWaker(Thread);

impl Wake for ThreadWaker {
    fn wake(self: Arc<Self>) {
        self.0.unpark();
    }
}

/// Returns a waker that unparks the present thread.
pub(super) fn of_this_thread() -> Waker {
    Waker::from(Arc::new(ThreadWaker(std::thread::current())))
}
