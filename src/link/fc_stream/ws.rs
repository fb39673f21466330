//! A websocket, with TLS if the program is built with it.
#![allow(clippy::disallowed_methods, reason = "a host that says nothing is waited for in wall time")]

#[cfg(feature = "tls")]
mod tls;

use futures_util::{SinkExt as _, StreamExt as _};
use tokio::net::TcpStream;
use tokio::sync::mpsc;
#[cfg(feature = "tls")]
use tokio_tungstenite::connect_async_tls_with_config;
#[cfg(not(feature = "tls"))]
use tokio_tungstenite::connect_async_with_config;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::error::{Error, ProtocolError, SubProtocolError};
use tokio_tungstenite::tungstenite::http::{HeaderValue, Uri, header};
use tokio_tungstenite::tungstenite::protocol::WebSocketConfig;
use tokio_tungstenite::tungstenite::{Bytes, Message};
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream};

use super::tcp::CONNECT_TIMEOUT;
use super::{CHUNK, CLOSED, Ended, StreamEvent, reason};

/// The sub-protocol under which firmware and bridges exchange bytes.
const BINARY: &str = "binary";
/// The largest message that is accepted.
const MESSAGE_MAX: usize = 1024 * 1024;

pub(super) type Socket = WebSocketStream<MaybeTlsStream<TcpStream>>;

/// Connects to a websocket.
///
/// # Errors
/// Returns the reason as part of a sentence.
pub(super) async fn connect(uri: &Uri) -> Result<Socket, String> {
    let attempt = async {
        match handshake(uri, true).await {
            // A bridge without support for sub-protocols exchanges bytes all the same.
            Err(Error::Protocol(ProtocolError::SecWebSocketSubProtocolError(
                SubProtocolError::NoSubProtocol,
            ))) => handshake(uri, false).await,
            other => other,
        }
        .map_err(|error| refusal(&error))
    };
    match tokio::time::timeout(CONNECT_TIMEOUT, attempt).await {
        Ok(connected) => connected,
        Err(_) => Err(format!("{} does not answer", uri.host().unwrap_or_default())),
    }
}

async fn handshake(uri: &Uri, offer_binary: bool) -> Result<Socket, Error> {
    let mut request = uri.into_client_request()?;
    if offer_binary {
        request.headers_mut().insert(header::SEC_WEBSOCKET_PROTOCOL, HeaderValue::from_static(BINARY));
    }
    let config = WebSocketConfig::default()
        .max_message_size(Some(MESSAGE_MAX))
        .max_frame_size(Some(MESSAGE_MAX))
        .write_buffer_size(0);
    #[cfg(feature = "tls")]
    let attempt = connect_async_tls_with_config(request, Some(config), true, tls::connector(uri).await?);
    #[cfg(not(feature = "tls"))]
    let attempt = connect_async_with_config(request, Some(config), true);
    let (socket, _) = attempt.await?;
    Ok(socket)
}

/// Moves bytes until the connection is lost or the session no longer needs them. Sets `heard` once bytes have
/// arrived.
pub(super) async fn pump(
    socket: Socket,
    to: &mut mpsc::Receiver<Vec<u8>>,
    from: &mpsc::Sender<StreamEvent>,
    heard: &mut bool,
) -> Ended {
    let (mut sink, mut stream) = socket.split();
    let read = async {
        loop {
            let bytes = match stream.next().await {
                // A text message counts as its bytes.
                Some(Ok(Message::Binary(bytes))) => bytes,
                Some(Ok(Message::Text(text))) => text.into(),
                Some(Ok(Message::Ping(_) | Message::Pong(_) | Message::Frame(_))) => continue,
                Some(Ok(Message::Close(_))) | None => return Ended::closed(),
                Some(Err(error)) => return Ended::Lost(refusal(&error)),
            };
            *heard = true;
            // A message may be long. Pieces keep the amount that the receiver takes between two steps as
            // small as on a slow line.
            for piece in bytes.chunks(CHUNK) {
                if from.send(StreamEvent::Bytes(piece.to_vec())).await.is_err() {
                    return Ended::Dropped;
                }
            }
        }
    };
    let write = async {
        while let Some(bytes) = to.recv().await {
            if let Err(error) = sink.send(Message::Binary(Bytes::from(bytes))).await {
                return Ended::Lost(refusal(&error));
            }
        }
        Ended::Dropped
    };
    tokio::select! {
        ended = read => ended,
        ended = write => ended,
        () = from.closed() => Ended::Dropped,
    }
}

/// Returns the error as part of a sentence.
fn refusal(error: &Error) -> String {
    match error {
        Error::ConnectionClosed
        | Error::AlreadyClosed
        | Error::Protocol(ProtocolError::ResetWithoutClosingHandshake) => CLOSED.to_owned(),
        #[cfg(feature = "tls")]
        Error::Io(error) => tls::refusal(error).unwrap_or_else(|| reason(error)),
        #[cfg(not(feature = "tls"))]
        Error::Io(error) => reason(error),
        Error::Tls(error) => format!("TLS fails: {error}"),
        Error::Http(response) => {
            format!("no websocket is served there (the server answers {})", response.status())
        }
        other => format!("no websocket is served there ({other})"),
    }
}
