//! The TCP and the websocket door: listens, admits clients, and refuses web pages of foreign origins and
//! foreign hosts.

#![allow(clippy::disallowed_methods, reason = "the doors wait for people and programs")]

use std::net::IpAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;

use tokio::net::{TcpListener, TcpStream};
use tokio_tungstenite::tungstenite::handshake::server::{ErrorResponse, Request as Handshake, Response};
use tokio_tungstenite::tungstenite::http::{HeaderName, HeaderValue, StatusCode, header};
use tokio_tungstenite::tungstenite::protocol::WebSocketConfig;
use tokio_util::task::TaskTracker;

use super::client::{Client, SharedChannels};
use super::client_stream::{ClientStream, MESSAGE_MAX};
use super::endpoint_stats::EndpointStats;
use super::notices::Notices;
use super::origin::{self, Refusal};
use super::request::ClientId;
use super::seats::{CLIENTS_MAX, Seat, Seats};

/// The longest time that a websocket handshake may take.
const HANDSHAKE_TIMEOUT: Duration = Duration::from_secs(10);
/// The pause after a client could not be accepted (too many open files).
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);
/// The bytes that a websocket reads at once.
const READ_BUFFER: usize = 16 * 1024;
/// The maximum number of bytes that a websocket holds until the client takes them: one message and the
/// answers to control frames.
const WRITE_BUFFER_MAX: usize = 2 * MESSAGE_MAX;
/// The sub-protocol of the Betaflight App.
const BINARY: &str = "binary";
/// The next client number, shared by all doors.
static NEXT_CLIENT: AtomicU64 = AtomicU64::new(1);

/// The protocol below the serial session.
#[derive(Debug, Clone)]
pub(super) enum ListenerKind {
    Tcp,
    WebSocket {
        /// Origins that are served in addition to the usual ones.
        allow_origin: Arc<[String]>,
    },
}

impl ListenerKind {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Tcp => "TCP",
            Self::WebSocket { .. } => "websocket",
        }
    }
}

/// Admits clients until the doors close.
pub(super) async fn listen(
    listener: TcpListener,
    kind: ListenerKind,
    channels: SharedChannels,
    notices: Notices,
    stats: Arc<EndpointStats>,
    seats: Seats,
    tasks: TaskTracker,
) {
    loop {
        let stream = tokio::select! {
            () = channels.shutdown.cancelled() => return,
            accepted = listener.accept() => match accepted {
                Ok((stream, _)) => stream,
                Err(_) => {
                    stats.error();
                    tokio::time::sleep(ACCEPT_PAUSE).await;
                    continue;
                }
            },
        };
        let Some(seat) = seats.take(ClientId(NEXT_CLIENT.fetch_add(1, Relaxed))) else {
            stats.error();
            notices.tell(format!(
                "The {} door serves {CLIENTS_MAX} clients at once: another one was refused.",
                kind.name()
            ));
            continue;
        };
        stats.client_connected();
        let (kind, channels, stats) = (kind.clone(), channels.clone(), Arc::clone(&stats));
        let notices = notices.clone();
        tasks.spawn(async move {
            // An interactive line consists of small packets in both directions.
            let _only_slower = stream.set_nodelay(true);
            match admit(stream, &kind, &channels, &notices, &seat).await {
                Some(stream) => {
                    Client::new(seat, stream, channels, notices, Arc::clone(&stats)).serve().await;
                }
                None => {
                    drop(seat);
                    stats.error();
                }
            }
            stats.client_disconnected();
        });
    }
}

/// Returns the client's stream once it is admitted.
async fn admit(
    stream: TcpStream,
    kind: &ListenerKind,
    channels: &SharedChannels,
    notices: &Notices,
    seat: &Seat,
) -> Option<ClientStream> {
    let ListenerKind::WebSocket { allow_origin } = kind else {
        return Some(ClientStream::Tcp(stream));
    };
    let own_address = stream.local_addr().ok()?.ip();
    let mut refused = None;
    #[expect(clippy::result_large_err, reason = "the type of the handshake's callback is given")]
    let callback = |request: &Handshake, response: Response| match judge(request, own_address, allow_origin) {
        Ok(()) => Ok(with_sub_protocol(request, response)),
        Err(refusal) => {
            refused = Some(refusal);
            Err(forbidden())
        }
    };
    let config = WebSocketConfig::default()
        .max_message_size(Some(MESSAGE_MAX))
        .max_frame_size(Some(MESSAGE_MAX))
        .read_buffer_size(READ_BUFFER)
        .write_buffer_size(0)
        .max_write_buffer_size(WRITE_BUFFER_MAX);
    let handshake = tokio_tungstenite::accept_hdr_async_with_config(stream, callback, Some(config));
    let accepted = tokio::select! {
        () = channels.shutdown.cancelled() => return None,
        () = seat.evicted() => return None,
        accepted = tokio::time::timeout(HANDSHAKE_TIMEOUT, handshake) => accepted.ok()?,
    };
    if let Some(refusal) = refused {
        notices.tell(refusal.to_string());
    }
    accepted.ok().map(|socket| ClientStream::WebSocket(Box::new(socket)))
}

/// Checks the origin and the host of a handshake. Every copy of a repeated header must pass.
fn judge(request: &Handshake, own_address: IpAddr, allowed: &[String]) -> Result<(), Refusal> {
    let values = |name: HeaderName| {
        request.headers().get_all(name).into_iter().map(|value| value.to_str().unwrap_or("?"))
    };
    values(header::ORIGIN).try_for_each(|origin| origin::judge_origin(origin, allowed))?;
    values(header::HOST).try_for_each(|host| origin::judge_host(host, own_address, allowed))
}

/// Selects the sub-protocol if the client offers it. Browsers fail a handshake that ignores the sub-protocol
/// they offered.
fn with_sub_protocol(request: &Handshake, mut response: Response) -> Response {
    let offered = request.headers().get_all(header::SEC_WEBSOCKET_PROTOCOL);
    let mut offered =
        offered.iter().filter_map(|value| value.to_str().ok()).flat_map(|value| value.split(','));
    if offered.any(|protocol| protocol.trim() == BINARY) {
        response.headers_mut().insert(header::SEC_WEBSOCKET_PROTOCOL, HeaderValue::from_static(BINARY));
    }
    response
}

fn forbidden() -> ErrorResponse {
    let mut response =
        ErrorResponse::new(Some("this page may not reach the craft: see --allow-origin\n".to_owned()));
    *response.status_mut() = StatusCode::FORBIDDEN;
    response
}
