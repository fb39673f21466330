//! Streams over websockets.

use futures_util::{SinkExt as _, StreamExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::handshake::server::{ErrorResponse, Request, Response};

use betadeck::link::StreamEvent;

use crate::protocols::fc_streams::{bytes, connected, lost, next, open, send};

/// Accepts a connection as a server that chooses the sub-protocol `binary`, or none. Returns the offered
/// sub-protocol too.
async fn serve(listener: &TcpListener, chooses: bool) -> (WebSocketStream<TcpStream>, Option<String>) {
    loop {
        let (stream, _) = listener.accept().await.unwrap();
        let mut offered = None;
        #[expect(clippy::result_large_err, reason = "the type of the handshake's callback is given")]
        let callback = |request: &Request, mut response: Response| -> Result<Response, ErrorResponse> {
            if let Some(protocol) = request.headers().get("sec-websocket-protocol") {
                offered = Some(protocol.to_str().unwrap().to_owned());
                if chooses {
                    response.headers_mut().insert("sec-websocket-protocol", protocol.clone());
                }
            }
            Ok(response)
        };
        let socket = tokio_tungstenite::accept_hdr_async(stream, callback).await.unwrap();
        // A client that insists on the sub-protocol connects again without it.
        if chooses || offered.is_none() {
            return (socket, offered);
        }
    }
}

#[tokio::test]
async fn messages_are_bytes_and_a_closed_socket_comes_back() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let mut stream = open(&format!("ws:{}", listener.local_addr().unwrap()));
    for chooses in [true, false] {
        let (mut socket, offered) = serve(&listener, chooses).await;
        assert_eq!(offered.as_deref(), chooses.then_some("binary"));
        connected(&mut stream).await;
        send(&stream, b"$M<\x00\x01\x01").await;
        assert_eq!(socket.next().await.unwrap().unwrap(), Message::binary(&b"$M<\x00\x01\x01"[..]));
        socket.send(Message::Ping("?".into())).await.unwrap();
        socket.send(Message::binary(&b"\xff\x00"[..])).await.unwrap();
        socket.send(Message::text("# ")).await.unwrap();
        assert_eq!(bytes(&mut stream, 4).await, b"\xff\x00# ");
        assert_eq!(socket.next().await.unwrap().unwrap(), Message::Pong("?".into()));
        socket.close(None).await.unwrap();
        assert_eq!(lost(&mut stream).await, "the other end closed the connection");
    }
}

#[tokio::test]
async fn a_long_message_comes_in_pieces() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let mut stream = open(&format!("ws:{}", listener.local_addr().unwrap()));
    let (mut socket, _) = serve(&listener, true).await;
    connected(&mut stream).await;
    let long: Vec<u8> = (0..100_000_u32).map(|number| number as u8).collect();
    socket.send(Message::binary(long.clone())).await.unwrap();
    let mut all = Vec::new();
    while all.len() < long.len() {
        let StreamEvent::Bytes(piece) = next(&mut stream).await else { panic!("it is connected") };
        assert!(piece.len() <= 4096, "{} bytes at once", piece.len());
        all.extend(piece);
    }
    assert_eq!(all, long);
}

#[tokio::test]
async fn a_reply_that_is_no_websocket_is_reported_in_a_sentence() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    tokio::spawn(async move {
        while let Ok((mut stream, _)) = listener.accept().await {
            let mut request = [0; 1024];
            let _read = tokio::io::AsyncReadExt::read(&mut stream, &mut request).await;
            let answer = b"HTTP/1.1 404 Not Found\r\ncontent-length: 0\r\n\r\n";
            let _sent = tokio::io::AsyncWriteExt::write_all(&mut stream, answer).await;
        }
    });
    let reported = lost(&mut open(&format!("ws://{address}"))).await;
    assert_eq!(reported, "no websocket is served there (the server answers 404 Not Found)");
    #[cfg(feature = "tls")]
    {
        let reported = lost(&mut open(&format!("wss://{address}"))).await;
        assert!(reported.starts_with("TLS fails: "), "{reported}");
    }
}
