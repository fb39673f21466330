//! A flag that signals raise, for work that is done without a runtime.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{AppError, error, stop_signal};

/// A flag that SIGINT, SIGTERM and SIGHUP set. A second signal ends the program at once: it may be waiting for a reader
/// that does not read.
pub(super) fn interrupt_flag() -> Result<Arc<AtomicBool>, AppError> {
    let deaf = |error| AppError::environment(format!("cannot listen for signals: {error}"));
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(deaf)?;
    let stop = {
        let _inside = runtime.enter();
        stop_signal::stop().map_err(deaf)?
    };
    std::thread::Builder::new()
        .name("signals".to_owned())
        .spawn(move || {
            runtime.block_on(stop);
            raised.store(true, Ordering::Relaxed);
            runtime.block_on(async {
                if let Ok(again) = stop_signal::stop() {
                    again.await;
                    std::process::exit(i32::from(error::INTERRUPTED));
                }
            });
        })
        .map_err(|error| AppError::environment(format!("cannot start a thread: {error}")))?;
    Ok(flag)
}
