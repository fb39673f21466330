//! A websocket, with or without TLS.
#![allow(clippy::disallowed_methods, reason = "a host that says nothing is waited for in wall time")]

use std::sync::Arc;

use futures_util::{SinkExt as _, StreamExt as _};
use rustls::{ClientConfig, RootCertStore};
use tokio::net::TcpStream;
use tokio::sync::mpsc;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::error::{Error, ProtocolError, SubProtocolError};
use tokio_tungstenite::tungstenite::http::{HeaderValue, Uri, header};
use tokio_tungstenite::tungstenite::protocol::WebSocketConfig;
use tokio_tungstenite::tungstenite::{Bytes, Message};
use tokio_tungstenite::{Connector, MaybeTlsStream, WebSocketStream, connect_async_tls_with_config};

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
        let connector = match uri.scheme_str() {
            Some("wss") => Connector::Rustls(tls_config().await?),
            _ => Connector::Plain,
        };
        match handshake(uri, connector.clone(), true).await {
            // A bridge without support for sub-protocols exchanges bytes all the same.
            Err(Error::Protocol(ProtocolError::SecWebSocketSubProtocolError(
                SubProtocolError::NoSubProtocol,
            ))) => handshake(uri, connector, false).await,
            other => other,
        }
        .map_err(|error| refusal(&error))
    };
    match tokio::time::timeout(CONNECT_TIMEOUT, attempt).await {
        Ok(connected) => connected,
        Err(_) => Err(format!("{} does not answer", uri.host().unwrap_or_default())),
    }
}

async fn handshake(uri: &Uri, connector: Connector, offer_binary: bool) -> Result<Socket, Error> {
    let mut request = uri.into_client_request()?;
    if offer_binary {
        request.headers_mut().insert(header::SEC_WEBSOCKET_PROTOCOL, HeaderValue::from_static(BINARY));
    }
    let config = WebSocketConfig::default()
        .max_message_size(Some(MESSAGE_MAX))
        .max_frame_size(Some(MESSAGE_MAX))
        .write_buffer_size(0);
    let (socket, _) = connect_async_tls_with_config(request, Some(config), true, Some(connector)).await?;
    Ok(socket)
}

/// Returns a TLS configuration with the certificates that this machine trusts.
async fn tls_config() -> Result<Arc<ClientConfig>, String> {
    let load = tokio::task::spawn_blocking(|| {
        let mut roots = RootCertStore::empty();
        roots.add_parsable_certificates(rustls_native_certs::load_native_certs().certs);
        roots
    });
    let roots = load.await.map_err(|error| error.to_string())?;
    if roots.is_empty() {
        return Err("this machine has no trusted certificates (package ca-certificates)".to_owned());
    }
    let config = ClientConfig::builder_with_provider(Arc::new(rustls::crypto::ring::default_provider()))
        .with_safe_default_protocol_versions()
        .map_err(|error| error.to_string())?
        .with_root_certificates(roots)
        .with_no_client_auth();
    Ok(Arc::new(config))
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
        Error::Io(error) => match error.get_ref().and_then(|error| error.downcast_ref::<rustls::Error>()) {
            Some(rustls::Error::InvalidCertificate(why)) => {
                format!("its certificate is not trusted ({why})")
            }
            Some(error) => format!("TLS fails: {error}"),
            None => reason(error),
        },
        Error::Tls(error) => format!("TLS fails: {error}"),
        Error::Http(response) => {
            format!("no websocket is served there (the server answers {})", response.status())
        }
        other => format!("no websocket is served there ({other})"),
    }
}
