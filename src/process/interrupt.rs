//! A flag that signals set, for work without a runtime.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{error, patient_output, runtime, stop_signal};
use crate::process::error::AppError;

/// Returns a flag that SIGINT, SIGTERM and SIGHUP set. After that, the program waits only a short time for its
/// output. A second signal ends the program at once.
pub(crate) fn interrupt_flag() -> Result<Arc<AtomicBool>, AppError> {
    let deaf = |error| AppError::environment(format!("cannot listen for signals: {error}"));
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let runtime = runtime::on_this_thread()?;
    let stop = {
        let _inside = runtime.enter();
        stop_signal::stop().map_err(deaf)?
    };
    std::thread::Builder::new()
        .name("signals".to_owned())
        .spawn(move || {
            runtime.block_on(stop);
            raised.store(true, Ordering::Relaxed);
            patient_output::lose_patience();
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
