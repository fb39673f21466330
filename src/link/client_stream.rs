//! The byte stream of a client, over TCP or a websocket.

use std::io;

use futures_util::{SinkExt, StreamExt as _};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::{self, Bytes, Message};

/// The maximum number of bytes read from TCP at once.
const CHUNK: usize = 4096;
/// The largest websocket message in both directions.
pub(super) const MESSAGE_MAX: usize = 64 * 1024;

#[derive(Debug)]
pub(super) enum ClientStream {
    Tcp(TcpStream),
    /// Boxed because it is large.
    WebSocket(Box<WebSocketStream<TcpStream>>),
}

impl ClientStream {
    /// Returns the next bytes, or `None` when the client is gone. Cancelling the wait loses nothing.
    pub(super) async fn read(&mut self) -> io::Result<Option<Bytes>> {
        match self {
            Self::Tcp(stream) => {
                let mut chunk = [0; CHUNK];
                let count = stream.read(&mut chunk).await?;
                Ok((count > 0).then(|| Bytes::copy_from_slice(&chunk[..count])))
            }
            Self::WebSocket(socket) => match socket.next().await {
                // A text message counts as its bytes.
                Some(Ok(Message::Binary(bytes))) => Ok(Some(bytes)),
                Some(Ok(Message::Text(text))) => Ok(Some(text.into())),
                Some(Ok(Message::Ping(_) | Message::Pong(_) | Message::Frame(_))) => Ok(Some(Bytes::new())),
                Some(Ok(Message::Close(_))) | None => Ok(None),
                Some(Err(error)) => ended(error).map(|()| None),
            },
        }
    }

    /// Sends bytes. A websocket carries them as one message unless they exceed [`MESSAGE_MAX`]. An empty
    /// vector only flushes pending data, such as answers to control frames.
    pub(super) async fn write(&mut self, bytes: Vec<u8>) -> io::Result<()> {
        match self {
            Self::Tcp(stream) => stream.write_all(&bytes).await,
            Self::WebSocket(socket) => {
                let mut bytes = Bytes::from(bytes);
                while !bytes.is_empty() {
                    let message = bytes.split_to(bytes.len().min(MESSAGE_MAX));
                    socket.send(Message::Binary(message)).await.or_else(ended)?;
                }
                socket.flush().await.or_else(ended)
            }
        }
    }

    /// Returns the name of the door through which the client came.
    pub(super) fn door(&self) -> &'static str {
        match self {
            Self::Tcp(_) => "TCP",
            Self::WebSocket(_) => "websocket",
        }
    }

    /// Returns `true` for a websocket.
    pub(super) fn is_websocket(&self) -> bool {
        matches!(self, Self::WebSocket(_))
    }

    pub(super) async fn close(&mut self) -> io::Result<()> {
        match self {
            Self::Tcp(stream) => stream.shutdown().await,
            // Uses the sink's `close`, which also answers a client that closed first.
            Self::WebSocket(socket) => SinkExt::close(socket.as_mut()).await.or_else(ended),
        }
    }
}

/// Treats a closed connection as a normal end instead of an error.
fn ended(error: tungstenite::Error) -> io::Result<()> {
    match error {
        tungstenite::Error::ConnectionClosed | tungstenite::Error::AlreadyClosed => Ok(()),
        tungstenite::Error::Io(error) => Err(error),
        other => Err(io::Error::other(other)),
    }
}
