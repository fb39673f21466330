//! The user interface's link to the plan files.
#![allow(clippy::disallowed_methods, reason = "the shell of the user interface waits in wall-clock time")]

use std::sync::mpsc::Sender;
use std::time::Duration;

use tokio::sync::{mpsc, watch};
use tokio::time::timeout;

use super::editor::{FileReply, FileRequest};

/// The longest wait for an edit to be kept. A slow disk must not block the screen.
const PATIENCE: Duration = Duration::from_millis(100);

/// The user interface's link to the plan files.
#[derive(Debug)]
pub struct FilesLink {
    requests: Sender<FileRequest>,
    pub(super) replies: mpsc::UnboundedReceiver<FileReply>,
    /// The number of requests carried out.
    done: watch::Receiver<u64>,
    asked: u64,
    /// The number of the newest edit among the requests.
    edited: u64,
}

impl FilesLink {
    /// Returns the link to the thread that carries out `requests`, sends `replies`, and counts finished requests in
    /// `done`.
    pub fn new(
        requests: Sender<FileRequest>,
        replies: mpsc::UnboundedReceiver<FileReply>,
        done: watch::Receiver<u64>,
    ) -> Self {
        Self { requests, replies, done, asked: 0, edited: 0 }
    }

    /// Sends a request. Returns `false` if nobody receives it.
    pub(super) fn ask(&mut self, request: FileRequest) -> bool {
        self.asked += 1;
        if matches!(request, FileRequest::Journal(..)) {
            self.edited = self.asked;
        }
        self.requests.send(request).is_ok()
    }

    /// Waits until the newest edit is kept, so that the edits on the screen survive the program.
    pub(super) async fn keep_edits(&mut self) {
        let edited = self.edited;
        // If the files are slow or gone, they report it themselves.
        timeout(PATIENCE, self.done.wait_for(|&done| done >= edited)).await.ok();
    }
}
