//! The plan files, seen from the user interface.
#![allow(clippy::disallowed_methods, reason = "the shell of the user interface waits in wall-clock time")]

use std::sync::mpsc::Sender;
use std::time::Duration;

use tokio::sync::{mpsc, watch};
use tokio::time::timeout;

use super::editor::{FileReply, FileRequest};

/// Longest wait for an edit to be kept: a disk that hangs must not hold the screen up.
const PATIENCE: Duration = Duration::from_millis(100);

/// The plan files, seen from the user interface.
#[derive(Debug)]
pub struct FilesLink {
    requests: Sender<FileRequest>,
    pub(super) replies: mpsc::UnboundedReceiver<FileReply>,
    /// How many requests were carried out.
    done: watch::Receiver<u64>,
    asked: u64,
    /// The number of the newest edit among the requests.
    edited: u64,
}

impl FilesLink {
    /// The link to whoever carries out `requests`, sends `replies`, and counts in `done` what was carried out.
    pub fn new(
        requests: Sender<FileRequest>,
        replies: mpsc::UnboundedReceiver<FileReply>,
        done: watch::Receiver<u64>,
    ) -> Self {
        Self { requests, replies, done, asked: 0, edited: 0 }
    }

    /// Asks; whether anybody listens.
    pub(super) fn ask(&mut self, request: FileRequest) -> bool {
        self.asked += 1;
        if matches!(request, FileRequest::Journal(..)) {
            self.edited = self.asked;
        }
        self.requests.send(request).is_ok()
    }

    /// Waits until the newest edit is kept: what the screen shows survives the program.
    pub(super) async fn keep_edits(&mut self) {
        let edited = self.edited;
        // Slow or gone: the files tell that themselves.
        timeout(PATIENCE, self.done.wait_for(|&done| done >= edited)).await.ok();
    }
}
