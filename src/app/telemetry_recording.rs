//! The telemetry log of a connection: `--tlog FILE`.
#![allow(clippy::disallowed_methods, reason = "frames of a log have the time of day")]

use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use tokio::sync::mpsc;

use crate::link::{FcStream, StreamEvent};
use crate::mavlink::tlog::LogWriter;
use crate::process::error::AppError;

/// The number of pieces that wait in each direction.
const QUEUE: usize = 64;

/// Creates the file of a log.
///
/// # Errors
/// Returns an error if the file exists or cannot be created.
pub(super) fn create(path: &Path) -> Result<File, AppError> {
    OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(path)
        .map_err(|error| AppError::environment(format!("cannot create {}: {error}", path.display())))
}

/// Returns the same stream. The frames of both directions are also written to `file`.
pub(super) fn recorded(stream: FcStream, file: File) -> FcStream {
    let FcStream { to, from, place, bytes_per_s } = stream;
    let (sent, outgoing) = mpsc::channel(QUEUE);
    let (incoming, received) = mpsc::channel(QUEUE);
    tokio::spawn(pass_on((from, incoming), (outgoing, to), file));
    FcStream { to: sent, from: received, place, bytes_per_s }
}

async fn pass_on(
    (mut from, incoming): (mpsc::Receiver<StreamEvent>, mpsc::Sender<StreamEvent>),
    (mut outgoing, to): (mpsc::Receiver<Vec<u8>>, mpsc::Sender<Vec<u8>>),
    file: File,
) {
    let (mut down, mut up) = (LogWriter::default(), LogWriter::default());
    let mut file = Some(file);
    loop {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let mut log = Vec::new();
        let is_open = tokio::select! {
            Some(event) = from.recv() => {
                if let StreamEvent::Bytes(bytes) = &event {
                    down.write(now, bytes, &mut log);
                }
                incoming.send(event).await.is_ok()
            }
            Some(bytes) = outgoing.recv() => {
                up.write(now, &bytes, &mut log);
                to.send(bytes).await.is_ok()
            }
            () = incoming.closed() => false,
            else => false,
        };
        if let Some(Err(error)) = file.as_mut().map(|file| file.write_all(&log)) {
            file = None;
            let sentence = format!("The telemetry is not recorded any further: {error}.");
            drop(incoming.send(StreamEvent::Notice(sentence)).await);
        }
        if !is_open {
            return;
        }
    }
}
