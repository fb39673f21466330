//! The signals that end the program.
#![allow(clippy::disallowed_methods, reason = "a program that hangs in a write is given a short time")]

use std::future::Future;
use std::io;
use std::time::Duration;

use super::error;

/// The time for the program to end cleanly. It cannot end if its output has no reader.
const PATIENCE: Duration = Duration::from_millis(700);

/// Works like [`stop`], and also ends the program soon after the signal if a write blocks. Must be called inside a
/// runtime with threads of its own.
///
/// # Errors
/// Returns an error if the system installs no signal handler.
pub(crate) fn stop_in_time() -> io::Result<impl Future<Output = ()>> {
    let signal = stop()?;
    let (arrived, heard) = tokio::sync::oneshot::channel();
    // This needs a task of its own, because the waiting task may be the one that blocks.
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

/// Listens for SIGINT, SIGTERM and SIGHUP from this call on. The returned future ends when one of them arrives. Must be
/// called inside a runtime.
///
/// # Errors
/// Returns an error if the system installs no signal handler.
pub(crate) fn stop() -> io::Result<impl Future<Output = ()>> {
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
