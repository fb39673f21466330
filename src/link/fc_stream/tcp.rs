//! A TCP port: a simulated flight controller, or a bridge to a serial port.
#![allow(clippy::disallowed_methods, reason = "a host that says nothing is waited for in wall time")]

use std::time::Duration;

use tokio::net::TcpStream;

use super::reason;

/// The time after which an attempt to reach a silent host is given up.
pub(super) const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);

/// Connects to a TCP port.
///
/// # Errors
/// Returns the reason as part of a sentence.
pub(super) async fn connect(host: &str, port: u16) -> Result<TcpStream, String> {
    match tokio::time::timeout(CONNECT_TIMEOUT, TcpStream::connect((host, port))).await {
        Ok(Ok(stream)) => {
            // Requests are small packets that wait for their answers.
            let _only_slower = stream.set_nodelay(true);
            Ok(stream)
        }
        Ok(Err(error)) => Err(reason(&error)),
        Err(_) => Err(format!("{host} does not answer")),
    }
}
