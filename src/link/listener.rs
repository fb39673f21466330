//! The TCP and the websocket port: listens, admits clients, and refuses web pages of foreign origins and
//! foreign hosts. The TCP port takes a websocket handshake, too: without Web Serial, the App connects to it in this way.

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
use super::notices::{Notices, Stranger};
use super::origin::{self, Refusal};
use super::proto::first_line::ForeignProtocol;
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
/// The first bytes of a websocket handshake.
const HTTP: [u8; 4] = *b"GET ";
/// The time after which the rest of these bytes is looked for.
const REST_OF_HANDSHAKE: Duration = Duration::from_millis(5);
/// The sub-protocol of the Betaflight App.
const BINARY: &str = "binary";
/// The next client number, shared by all doors.
static NEXT_CLIENT: AtomicU64 = AtomicU64::new(1);

/// The protocol below the serial session.
#[derive(Debug, Clone)]
pub(super) enum ListenerKind {
    /// MSP and command line as they are, or below a websocket if the client begins with a handshake.
    Tcp,
    WebSocket,
}

impl ListenerKind {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Tcp => "TCP",
            Self::WebSocket => "websocket",
        }
    }
}

/// A kind of port, and the origins that it serves in addition to the usual ones.
#[derive(Debug, Clone)]
pub(super) struct ListenerRules {
    pub(super) kind: ListenerKind,
    pub(super) allow_origin: Arc<[String]>,
}

/// Admits clients until the listeners close.
pub(super) async fn listen(
    listener: TcpListener,
    rules: ListenerRules,
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
                rules.kind.name()
            ));
            continue;
        };
        stats.client_connected();
        let (rules, channels, stats) = (rules.clone(), channels.clone(), Arc::clone(&stats));
        let notices = notices.clone();
        tasks.spawn(async move {
            // An interactive line consists of small packets in both directions.
            let _only_slower = stream.set_nodelay(true);
            match admit(stream, &rules, &channels, &notices, &seat).await {
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
    rules: &ListenerRules,
    channels: &SharedChannels,
    notices: &Notices,
    seat: &Seat,
) -> Option<ClientStream> {
    if matches!(rules.kind, ListenerKind::Tcp) {
        let is_handshake = tokio::select! {
            () = channels.shutdown.cancelled() => return None,
            () = seat.evicted() => return None,
            is_handshake = begins_with_handshake(&stream) => is_handshake,
        };
        if !is_handshake {
            return Some(ClientStream::Tcp(stream));
        }
    }
    let allow_origin = &rules.allow_origin;
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
        accepted = tokio::time::timeout(HANDSHAKE_TIMEOUT, handshake) => accepted.ok().and_then(Result::ok),
    };
    match refused {
        Some(refusal) => notices.tell(refusal.to_string()),
        None if accepted.is_none() && matches!(rules.kind, ListenerKind::Tcp) => {
            notices.count_stranger(rules.kind.name(), Stranger::Began(ForeignProtocol::Http));
        }
        None => {}
    }
    accepted.map(|socket| ClientStream::WebSocket(Box::new(socket)))
}

/// Waits for the first bytes of a client and leaves them in the stream. Returns `true` if they are those of an HTTP request.
/// MSP and the command line begin otherwise, so that only a client that sends a part of these bytes waits for a moment.
async fn begins_with_handshake(stream: &TcpStream) -> bool {
    let deadline = tokio::time::Instant::now() + HANDSHAKE_TIMEOUT;
    let mut first = [0; HTTP.len()];
    loop {
        match stream.peek(&mut first).await {
            Ok(count) if count == HTTP.len() => return first == HTTP,
            Ok(count) if count > 0 && HTTP.starts_with(&first[..count]) => {}
            Ok(_) | Err(_) => return false,
        }
        if tokio::time::Instant::now() >= deadline {
            return false;
        }
        tokio::time::sleep(REST_OF_HANDSHAKE).await;
    }
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
