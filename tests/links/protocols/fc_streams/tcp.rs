//! Streams over TCP.

use betadeck::link::StreamEvent;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpListener;

use crate::protocols::fc_streams::{bytes, connected, lost, next, open, send};

#[tokio::test]
async fn bytes_go_both_ways_and_a_closed_connection_comes_back() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let place = format!("tcp:{}", listener.local_addr().unwrap());
    let mut stream = open(&place);
    assert_eq!((stream.place.as_str(), stream.bytes_per_s), (place.as_str(), None));
    for round in 0..3 {
        let (mut peer, _) = listener.accept().await.unwrap();
        connected(&mut stream).await;
        send(&stream, b"ping").await;
        let mut heard = [0; 4];
        peer.read_exact(&mut heard).await.unwrap();
        assert_eq!(&heard, b"ping", "round {round}");
        peer.write_all(b"pong").await.unwrap();
        assert_eq!(bytes(&mut stream, 4).await, b"pong");
        drop(peer);
        assert_eq!(lost(&mut stream).await, "the other end closed the connection");
        // Nobody receives this, and it is not kept for the next connection.
        send(&stream, b"late").await;
    }
}

#[tokio::test]
async fn a_refusal_is_reported_once_until_somebody_answers() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    drop(listener);
    let mut stream = open(&format!("tcp:{address}"));
    assert_eq!(lost(&mut stream).await, "nothing listens there (connection refused)");
    let listener = TcpListener::bind(address).await.unwrap();
    connected(&mut stream).await;
    let (mut peer, _) = listener.accept().await.unwrap();
    peer.write_all(b"here").await.unwrap();
    assert_eq!(bytes(&mut stream, 4).await, b"here");
    drop((peer, listener));
    assert_eq!(lost(&mut stream).await, "the other end closed the connection");
    assert_eq!(lost(&mut stream).await, "nothing listens there (connection refused)");
}

#[tokio::test]
async fn one_that_serves_another_client_is_named_as_such() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let mut stream = open(&format!("tcp:{}", listener.local_addr().unwrap()));
    for _ in 0..3 {
        drop(listener.accept().await.unwrap());
        connected(&mut stream).await;
        let reason = lost(&mut stream).await;
        assert!(reason.contains("closed the connection at once"), "{reason}");
        assert!(reason.contains("a server for a single client does: close the other program"), "{reason}");
    }
}

#[tokio::test]
async fn a_name_that_nobody_has_is_reported() {
    let mut stream = open("tcp:no-such-host.invalid:5761");
    let reason = lost(&mut stream).await;
    assert!(!reason.is_empty() && !reason.contains("os error"), "{reason}");
}

#[tokio::test]
async fn the_connection_ends_with_the_stream() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let mut stream = open(&format!("tcp:{}", listener.local_addr().unwrap()));
    let (mut peer, _) = listener.accept().await.unwrap();
    assert_eq!(next(&mut stream).await, StreamEvent::Connected);
    drop(stream);
    let mut rest = Vec::new();
    peer.read_to_end(&mut rest).await.unwrap();
    assert!(rest.is_empty());
}

#[tokio::test]
async fn a_peer_that_takes_nothing_does_not_stop_the_reading() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let mut stream = open(&format!("tcp:{}", listener.local_addr().unwrap()));
    let (mut peer, _) = listener.accept().await.unwrap();
    connected(&mut stream).await;
    // More than the system's buffers and the queue hold.
    while stream.to.try_send(vec![0; 1 << 20]).is_ok() {
        tokio::task::yield_now().await;
    }
    peer.write_all(b"still here").await.unwrap();
    assert_eq!(bytes(&mut stream, 10).await, b"still here");
}
