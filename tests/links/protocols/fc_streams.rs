//! Streams to a flight controller over real sockets and a pseudo-terminal pair. They connect, move bytes,
//! report errors, and reconnect by themselves.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

mod serial;
mod tcp;
mod websocket;

use std::time::Duration;

use betadeck::link::{FcStream, StreamEvent};

/// The time limit of every wait. Nothing in these tests takes this long unless it hangs.
const PATIENCE: Duration = Duration::from_secs(600);

fn open(place: &str) -> FcStream {
    FcStream::open(place.parse().unwrap())
}

/// Returns the next event.
async fn next(stream: &mut FcStream) -> StreamEvent {
    tokio::time::timeout(PATIENCE, stream.from.recv()).await.expect("an event").expect("a task")
}

/// Returns the reason of the next loss.
async fn lost(stream: &mut FcStream) -> String {
    match next(stream).await {
        StreamEvent::Lost(reason) => reason,
        other => panic!("{other:?}"),
    }
}

async fn connected(stream: &mut FcStream) {
    assert_eq!(next(stream).await, StreamEvent::Connected);
}

/// Returns the next bytes, at least as many as expected.
async fn bytes(stream: &mut FcStream, count: usize) -> Vec<u8> {
    let mut all = Vec::new();
    while all.len() < count {
        match next(stream).await {
            StreamEvent::Bytes(bytes) => all.extend(bytes),
            other => panic!("{other:?} after {all:?}"),
        }
    }
    all
}

async fn send(stream: &FcStream, bytes: &[u8]) {
    stream.to.send(bytes.to_vec()).await.expect("a task");
}
