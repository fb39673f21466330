//! Waiting for the signals that end the program.

use std::future::Future;
use std::io;

/// Listens for SIGINT, SIGTERM and SIGHUP from this call on; what it gives back ends when one of them arrives. To be
/// called inside a runtime.
///
/// # Errors
/// When the system installs no signal handler.
#[cfg(unix)]
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

/// Listens for Ctrl-C; what it gives back ends when it arrives.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub fn stop() -> io::Result<impl Future<Output = ()>> {
    Ok(async {
        if tokio::signal::ctrl_c().await.is_err() {
            std::future::pending().await
        }
    })
}
