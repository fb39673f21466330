//! The TCP and the websocket door: listens, lets clients in, refuses web pages of foreign origins.

#![allow(clippy::disallowed_methods, reason = "the doors wait for people and programs")]

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::net::{TcpListener, TcpStream};
use tokio_tungstenite::tungstenite::handshake::server::{ErrorResponse, Request as Handshake, Response};
use tokio_tungstenite::tungstenite::http::{HeaderValue, StatusCode, header};
use tokio_tungstenite::tungstenite::protocol::WebSocketConfig;
use tokio_util::task::TaskTracker;

use super::client::{Client, SharedChannels};
use super::client_stream::ClientStream;
use super::endpoint_stats::EndpointStats;
use super::origin;
use super::request::{ClientId, Request};

/// Most clients of one door.
const CLIENTS_MAX: u32 = 32;
/// How long a websocket handshake may take.
const HANDSHAKE_TIMEOUT: Duration = Duration::from_secs(10);
/// Pause after a client could not be accepted (too many open files).
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);
/// Largest websocket message.
const MESSAGE_MAX: usize = 64 * 1024;
/// The sub-protocol of the Betaflight App.
const BINARY: &str = "binary";
/// Most origins that are remembered as reported.
const REMEMBERED_MAX: usize = 64;
/// Most characters of an origin in a notice.
const ORIGIN_SHOWN: usize = 100;

/// Numbers for clients, shared by all doors.
static NEXT_CLIENT: AtomicU64 = AtomicU64::new(1);

/// The protocol below the serial session.
#[derive(Debug, Clone)]
pub(super) enum ListenerKind {
    Tcp,
    WebSocket {
        /// Origins that are served besides the usual ones.
        allow_origin: Arc<[String]>,
        /// Origins whose refusal was reported already.
        reported: Arc<Mutex<BTreeSet<String>>>,
    },
}

impl ListenerKind {
    fn name(&self) -> &'static str {
        match self {
            Self::Tcp => "TCP",
            Self::WebSocket { .. } => "websocket",
        }
    }
}

/// Lets clients in until the doors close.
pub(super) async fn listen(
    listener: TcpListener,
    kind: ListenerKind,
    channels: SharedChannels,
    stats: Arc<EndpointStats>,
    tasks: TaskTracker,
) {
    let mut reported_full = false;
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
        if stats.client_connected() > CLIENTS_MAX {
            stats.client_disconnected();
            stats.error();
            if !std::mem::replace(&mut reported_full, true) {
                let notice = format!(
                    "The {} door serves {CLIENTS_MAX} clients at once: another one was turned away.",
                    kind.name()
                );
                // When nobody has time to listen, it is seen in the door's count of errors.
                drop(channels.requests.try_send(Request::Notice(notice)));
            }
            continue;
        }
        let (kind, channels, stats) = (kind.clone(), channels.clone(), Arc::clone(&stats));
        tasks.spawn(async move {
            // An interactive line is small packets both ways.
            let _only_slower = stream.set_nodelay(true);
            match admit(stream, &kind, &channels).await {
                Some(stream) => {
                    let id = ClientId(NEXT_CLIENT.fetch_add(1, Relaxed));
                    Client::new(id, stream, channels, Arc::clone(&stats)).serve().await;
                }
                None => stats.error(),
            }
            stats.client_disconnected();
        });
    }
}

/// The client's stream, once it is admitted.
async fn admit(stream: TcpStream, kind: &ListenerKind, channels: &SharedChannels) -> Option<ClientStream> {
    let ListenerKind::WebSocket { allow_origin, reported } = kind else {
        return Some(ClientStream::Tcp(stream));
    };
    let mut refused = None;
    #[expect(clippy::result_large_err, reason = "the type of the handshake's callback is given")]
    let callback = |request: &Handshake, response: Response| {
        let origin = request.headers().get(header::ORIGIN).map(|value| value.to_str().unwrap_or("?"));
        if origin::is_served(origin, allow_origin) {
            return Ok(with_sub_protocol(request, response));
        }
        refused = origin.map(shown);
        Err(forbidden())
    };
    let config =
        WebSocketConfig::default().max_message_size(Some(MESSAGE_MAX)).max_frame_size(Some(MESSAGE_MAX));
    let handshake = tokio_tungstenite::accept_hdr_async_with_config(stream, callback, Some(config));
    let accepted = tokio::select! {
        () = channels.shutdown.cancelled() => return None,
        accepted = tokio::time::timeout(HANDSHAKE_TIMEOUT, handshake) => accepted.ok()?,
    };
    if let Some(origin) = refused
        && is_first_refusal(reported, &origin)
    {
        let notice = format!(
            "A web page of {origin} tried to reach the craft through the websocket and was refused: start with \
             --allow-origin {origin} to serve it."
        );
        let _session_gone = channels.requests.send(Request::Notice(notice)).await;
    }
    accepted.ok().map(|socket| ClientStream::WebSocket(Box::new(socket)))
}

/// Chooses the sub-protocol when it is offered: browsers fail a handshake that ignores what they asked for.
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

/// An origin as it may stand in a notice.
fn shown(origin: &str) -> String {
    origin.chars().filter(char::is_ascii_graphic).take(ORIGIN_SHOWN).collect()
}

/// Whether a refusal was not reported before; a page that tries again and again is reported once.
fn is_first_refusal(reported: &Mutex<BTreeSet<String>>, origin: &str) -> bool {
    let mut reported = reported.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    reported.len() < REMEMBERED_MAX && reported.insert(origin.to_owned())
}
