//! Waiting for the signals that end the program.
#![allow(clippy::disallowed_methods, reason = "a program that hangs in a write is given a short time")]

use std::future::Future;
use std::io;
use std::time::Duration;

use super::error;

/// How long the program may take to end in order. It cannot when nobody reads what it writes.
const PATIENCE: Duration = Duration::from_millis(700);

/// Like [`stop`], and ends the program soon after the signal even when it hangs in a write. To be called inside a runtime with
/// threads of its own.
///
/// # Errors
/// When the system installs no signal handler.
pub(super) fn stop_in_time() -> io::Result<impl Future<Output = ()>> {
    let signal = stop()?;
    let (arrived, heard) = tokio::sync::oneshot::channel();
    // In a task of its own: the one that waits for the end may be the one that hangs.
    tokio::spawn(async move {
        signal.await;
        arrived.send(()).ok();
        std::thread::spawn(|| {
            std::thread::sleep(PATIENCE);
            crate::ui::restore_terminal_modes();
            std::process::exit(i32::from(error::INTERRUPTED));
        });
    });
    Ok(async move { drop(heard.await) })
}

/// Listens for SIGINT, SIGTERM and SIGHUP from this call on; what it gives back ends when one of them arrives. To be
/// called inside a runtime.
///
/// # Errors
/// When the system installs no signal handler.
pub(super) fn stop() -> io::Result<impl Future<Output = ()>> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut interrupt = signal(SignalKind::interrupt())?;
    let mut terminate = signal(SignalKind::terminate())?;
    let mut hangup = signal(SignalKind::hangup())?;
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hangup.recv() => {}
        }
    })
}
